import { dismissToast } from "../../../design/toast";

/** Messages about what was done on an image, most of them with an undo, which never reaches into another image. */
export const REJECTED_TOAST = "reject-undecided";
export const MANY_TOAST = "many";
export const EDIT_TOAST = "edit";
export const HISTORY_TOAST = "history";

/** What was done is taken back, or done again: what they offered is past. */
export function dismissUndoToasts(): void {
  for (const key of [REJECTED_TOAST, MANY_TOAST, EDIT_TOAST]) dismissToast(key);
}

/** They go with their image. */
export function dismissImageToasts(): void {
  dismissUndoToasts();
  dismissToast(HISTORY_TOAST);
}
