/** What a split is frozen with, as a form holds it. */

import type { NewSplit, Visibility } from "../../api/board_types";

export interface FreezeFields {
  name: string;
  description: string;
  minLength: string;
  visibility: Visibility;
  /** As a field of date and time holds it: local, without seconds; empty for none. */
  closesAt: string;
  /** Empty for the server's own. */
  dailyLimit: string;
}

export const NEW_SPLIT: FreezeFields = {
  name: "",
  description: "",
  minLength: "0",
  visibility: "open",
  closesAt: "",
  dailyLimit: "",
};

/** What is sent; empty fields are left out, so that the server's defaults stand. */
export function newSplit(fields: FreezeFields): NewSplit {
  const description = fields.description.trim();
  return {
    name: fields.name.trim(),
    min_length: Number(fields.minLength),
    visibility: fields.visibility,
    ...(description === "" ? {} : { description }),
    ...(fields.closesAt === "" ? {} : { closes_at: new Date(fields.closesAt).toISOString() }),
    ...(fields.dailyLimit === "" ? {} : { daily_limit: Number(fields.dailyLimit) }),
  };
}
