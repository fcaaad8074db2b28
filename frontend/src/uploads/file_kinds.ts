/** What a file is, told from its path; the server decides in the end. */

export type FileKind = "image" | "labels" | "table" | "zip" | "other";

/** For the file dialog. */
export const ACCEPTED = ".png,.jpg,.jpeg,.tif,.tiff,.bmp,.webp,.pgm,.ppm,.pnm,.zip,.npy,.npz,.json,.csv";

const IMAGE = /\.(png|jpe?g|tiff?|bmp|webp|pgm|ppm|pnm)$/i;
const SEGMENTS = /\.(npy|npz|json)$/i;
const TABLE = /(^|\/)(images\.csv|cameras?\.json)$/;
const LABEL_SUFFIX = /_edge_segments_(filtered|ambiguous)$/;

export function kindOf(path: string): FileKind {
  if (TABLE.test(path)) return "table";
  if (IMAGE.test(path)) return "image";
  if (SEGMENTS.test(path)) return "labels";
  if (/\.zip$/i.test(path)) return "zip";
  return "other";
}

/** Files that systems leave behind in folders, and folders that programs keep for themselves. */
export function isHidden(path: string): boolean {
  return path
    .split("/")
    .some(
      (part) => part.startsWith(".") || part === "__MACOSX" || part === "Thumbs.db" || part === "desktop.ini",
    );
}

/** What an image and its label files have in common: the path without `images/` or `labels/` and without endings. */
export function pairKey(path: string): string {
  const stem = path.replace(/\.[^./]+$/, "").replace(LABEL_SUFFIX, "");
  return stem.replace(/(^|\/)(images|labels)\//, "$1").normalize("NFC");
}
