/** What is said of a lens's export files. */

import type { GivenIntrinsics } from "../../../api/camera_endpoints";
import type { ExportOption, Intrinsics } from "../../../api/camera_types";
import { digits, px } from "../length_text";

export const NOTHING_GIVEN: GivenIntrinsics = { focal_length: null, cx: null, cy: null };

/** "exact", "0.012 px", "refused". */
export function errorText({ allowed, error }: Pick<ExportOption, "allowed" | "error">): string {
  if (!allowed) return "refused";
  if (error === null) return "";
  return error.maximum < 5e-4 ? "exact" : px(error.rms);
}

/** "0.012 px RMS, 0.050 px at most". */
export function wholeErrorText({ error }: Pick<ExportOption, "error">): string {
  if (error === null) return "–";
  if (error.maximum < 5e-4) return "exact";
  return `${px(error.rms)} RMS, ${px(error.maximum)} at most`;
}

const SOURCES: Record<Intrinsics["source"], string> = {
  given: "as given",
  estimated: "estimated from the images",
  nominal: "nominal: made up, since these images don't tell it",
};

/** "Focal length 721 px, estimated from the images; principal point (610, 172)". */
export function intrinsicsText({ focal_length, principal_point, source }: Intrinsics): string {
  const [x, y] = principal_point;
  return `Focal length ${px(focal_length)}, ${SOURCES[source]}; principal point (${digits(x)}, ${digits(y)})`;
}

/** A line for a shell that fetches the file. */
export function curlText(origin: string, path: string, fileName: string): string {
  return `curl -fsS ${quoted(`${origin}${path}`)} -o ${quoted(fileName)}`;
}

/** In single quotes, within which a shell leaves everything alone. */
function quoted(text: string): string {
  return `'${text.replaceAll("'", "'\\''")}'`;
}

/**
 * The focal length and principal point out of what was typed; null where a number is missing or makes no sense.
 *
 * @param typed Texts; the principal point may be left out as a whole.
 */
export function readGiven(typed: { focal: string; cx: string; cy: string }): GivenIntrinsics | null {
  const focal_length = number(typed.focal);
  if (focal_length === null || focal_length <= 0) return null;
  if (typed.cx.trim() === "" && typed.cy.trim() === "") return { focal_length, cx: null, cy: null };
  const [cx, cy] = [number(typed.cx), number(typed.cy)];
  return cx === null || cy === null ? null : { focal_length, cx, cy };
}

function number(text: string): number | null {
  const value = Number(text.trim().replace(",", "."));
  return text.trim() === "" || !Number.isFinite(value) ? null : value;
}
