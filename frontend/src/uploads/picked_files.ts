/** Files out of a drop or a file dialog, with their paths. */

import type { FileToSend } from "../api/upload";
import { isHidden, kindOf } from "./file_kinds";

export interface Picked {
  files: FileToSend[];
  /** Files of folders that are no images, labels or zips; nobody asked for each of them, so they stay behind. */
  leftOut: number;
  /** Name of the one folder or zip that was picked. */
  name: string | null;
}

/** The part of the browser's FileSystemEntry that is read here. */
export interface Entry {
  readonly isFile: boolean;
  readonly isDirectory: boolean;
  readonly name: string;
}

interface FileEntry extends Entry {
  file(done: (file: File) => void, failed: (error: unknown) => void): void;
}

interface FolderEntry extends Entry {
  createReader(): {
    readEntries(done: (entries: Entry[]) => void, failed: (error: unknown) => void): void;
  };
}

/** What a drop holds. Must be called while the event is handled: afterwards the browser empties it. */
export function droppedEntries(transfer: DataTransfer): Entry[] {
  return Array.from(transfer.items, (item) => item.webkitGetAsEntry()).filter((entry) => entry !== null);
}

/** Reads dropped files, and folders with all that is in them; a path starts with the dropped folder's name. */
export async function readEntries(entries: readonly Entry[]): Promise<Picked> {
  const files: FileToSend[] = [];
  let leftOut = 0;
  const waiting = entries.map((entry) => ({ entry, folder: "" }));
  for (let next = waiting.shift(); next; next = waiting.shift()) {
    const { entry, folder } = next;
    const path = folder + entry.name;
    if (isHidden(path)) continue;
    if (entry.isDirectory) {
      const inside = await folderContent(entry as FolderEntry);
      waiting.unshift(...inside.map((child) => ({ entry: child, folder: `${path}/` })));
    } else if (folder !== "" && kindOf(path) === "other") {
      leftOut += 1;
    } else {
      files.push({ file: await fileOf(entry as FileEntry), path });
    }
  }
  const [only] = entries;
  return {
    files,
    leftOut,
    name: entries.length === 1 && only ? datasetName(only.name, only.isDirectory) : null,
  };
}

/** Files out of a file dialog; those of a folder dialog know their path. */
export function readFileList(list: Iterable<File>): Picked {
  const all = Array.from(list, (file) => ({ file, path: file.webkitRelativePath || file.name }));
  const visible = all.filter(({ path }) => !isHidden(path));
  const files = visible.filter(({ path }) => !path.includes("/") || kindOf(path) !== "other");
  const [first] = files;
  const folder = first?.path.includes("/") ? first.path.split("/")[0] : undefined;
  const name = folder ?? (files.length === 1 && first ? datasetName(first.path, false) : null);
  return { files, leftOut: visible.length - files.length, name };
}

function datasetName(name: string, isFolder: boolean): string | null {
  if (isFolder) return name;
  return kindOf(name) === "zip" ? name.replace(/\.zip$/i, "") : null;
}

/** A folder's reader gives its entries in portions, and an empty one at the end. */
async function folderContent(folder: FolderEntry): Promise<Entry[]> {
  const reader = folder.createReader();
  const found: Entry[] = [];
  for (;;) {
    const portion = await new Promise<Entry[]>((resolve, reject) => reader.readEntries(resolve, reject));
    if (portion.length === 0) break;
    found.push(...portion);
  }
  return found.sort((a, b) => (a.name < b.name ? -1 : 1));
}

function fileOf(entry: FileEntry): Promise<File> {
  return new Promise((resolve, reject) => entry.file(resolve, reject));
}
