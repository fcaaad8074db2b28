/** Edits by hand, as the label page has to know them: groups of decisions that also change which lines there are. */

import type { Edit, EditKind } from "../../api/types";

/** Segments that edits added or replaced: undo and redo make them come and go. */
export function editedSegments(edits: readonly Edit[]): Set<number> {
  return new Set(edits.flatMap(({ added, replaced }) => [...added, ...replaced]));
}

/**
 * Whether candidates were fetched before an edit was made, undone or done again.
 *
 * @param has Whether a segment is among them.
 */
export function isOutOfDate(edits: readonly Edit[], has: (segmentId: number) => boolean): boolean {
  const standing = edits.filter(({ undone_at }) => undone_at === null);
  const gone = new Set(standing.flatMap(({ replaced }) => replaced));
  for (const { added, undone_at } of edits) if (undone_at !== null) for (const id of added) gone.add(id);
  const there = standing.flatMap(({ added }) => added).filter((id) => !gone.has(id));
  return [...gone].some(has) || !there.every(has);
}

const DONE: Readonly<Record<EditKind, string>> = {
  trace: "Line added",
  cut: "Line cut in two",
  trim: "End trimmed",
  join: "Two lines joined",
  extend: "Line extended",
};

/** "Line added, 312 px". */
export function describeEdit(kind: EditKind, lengths: readonly number[]): string {
  const sizes = lengths.map((length) => `${Math.round(length).toLocaleString("en")} px`);
  return sizes.length === 0 ? DONE[kind] : `${DONE[kind]}, ${sizes.join(" and ")}`;
}

const NAMES: Readonly<Record<EditKind, string>> = {
  trace: "added line",
  cut: "cut",
  trim: "trim",
  join: "join",
  extend: "extension",
};

/** "Undone: cut". */
export function describeEditReplay(replay: "undo" | "redo", kind: EditKind): string {
  return `${replay === "undo" ? "Undone" : "Redone"}: ${NAMES[kind]}`;
}
