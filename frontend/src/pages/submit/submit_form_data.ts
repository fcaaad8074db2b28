/** What is sent with a submission. */

import type { FileToSend } from "../../api/upload";

export interface SubmissionFields {
  method: string;
  label: string;
  description: string;
  code_url: string;
  paper_url: string;
  visibility: "public" | "private";
  anonymous: boolean;
  webhook_url: string;
}

export const NO_FIELDS: SubmissionFields = {
  method: "",
  label: "",
  description: "",
  code_url: "",
  paper_url: "",
  visibility: "public",
  anonymous: false,
  webhook_url: "",
};

/** The form that is posted: the files alone for a check, with the fields for a submission; empty ones are left out. */
export function formOf(files: readonly FileToSend[], fields: SubmissionFields | null): FormData {
  const form = new FormData();
  for (const [name, value] of Object.entries(fields ?? {})) {
    const text = typeof value === "boolean" ? String(value) : value.trim();
    if (text !== "") form.append(name, text);
  }
  for (const { file, path } of files) form.append("files", file, path);
  return form;
}

export function bytesOf(files: readonly FileToSend[]): number {
  return files.reduce((sum, { file }) => sum + file.size, 0);
}
