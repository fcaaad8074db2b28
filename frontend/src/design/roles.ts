import type { Role } from "../api/board_types";

export const ROLES: readonly Role[] = ["reader", "submitter", "annotator", "maintainer", "admin"];

/** What each role may do, in a sentence. */
export const MAY: Readonly<Record<Role, string>> = {
  admin: "May do everything, and manage accounts.",
  maintainer: "May label, freeze splits and see hidden ones.",
  annotator: "May label.",
  submitter: "May submit results.",
  reader: "May look at what is public.",
};
