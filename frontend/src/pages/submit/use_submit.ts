import { useQueryClient } from "@tanstack/react-query";
import { useCallback, useEffect, useRef, useState } from "react";
import { postSubmission, validateSubmission } from "../../api/board_endpoints";
import { boardKeys } from "../../api/board_queries";
import type { Submission, UploadError, Validation } from "../../api/board_types";
import { asProblem } from "../../api/problem";
import type { Problem } from "../../api/types";
import type { FileToSend } from "../../api/upload";
import { formOf, type SubmissionFields } from "./submit_form_data";
import { readErrors } from "./upload_errors";

export type Attempt =
  | { state: "idle" }
  | { state: "checking" | "sending"; sent: number; total: number }
  | { state: "valid"; validation: Validation }
  /** Something is wrong with the files, all of which is listed. */
  | { state: "refused"; title: string; errors: UploadError[] }
  /** Something else is in the way: the limit of the day, the deadline, the connection. */
  | { state: "stopped"; problem: Problem };

/** Checks and sends files; what is under way is broken off when other files are chosen or the page is left. */
export function useSubmit(split: string) {
  const client = useQueryClient();
  const [attempt, setAttempt] = useState<Attempt>({ state: "idle" });
  const running = useRef<AbortController | null>(null);
  useEffect(() => () => running.current?.abort(), []);

  const begin = useCallback((state: "checking" | "sending") => {
    running.current?.abort();
    const controller = new AbortController();
    running.current = controller;
    const onProgress = (sent: number, total: number) => {
      if (!controller.signal.aborted) setAttempt({ state, sent, total });
    };
    onProgress(0, 0);
    return { onProgress, signal: controller.signal };
  }, []);

  const refuse = useCallback((error: unknown, signal: AbortSignal) => {
    if (signal.aborted) return;
    const problem = asProblem(error);
    const errors = readErrors(problem);
    setAttempt(
      errors.length > 0 ? { state: "refused", title: problem.title, errors } : { state: "stopped", problem },
    );
  }, []);

  const check = useCallback(
    async (files: readonly FileToSend[]) => {
      const options = begin("checking");
      try {
        const validation = await validateSubmission(split, formOf(files, null), options);
        if (!options.signal.aborted) setAttempt({ state: "valid", validation });
      } catch (error) {
        refuse(error, options.signal);
      }
    },
    [split, begin, refuse],
  );

  const send = useCallback(
    async (files: readonly FileToSend[], fields: SubmissionFields): Promise<Submission | null> => {
      const options = begin("sending");
      try {
        const submission = await postSubmission(split, formOf(files, fields), options);
        client.setQueryData(boardKeys.submission(submission.id), submission);
        void client.invalidateQueries({ queryKey: boardKeys.split(split) });
        setAttempt({ state: "idle" });
        return submission;
      } catch (error) {
        refuse(error, options.signal);
        return null;
      }
    },
    [client, split, begin, refuse],
  );

  const reset = useCallback(() => {
    running.current?.abort();
    setAttempt({ state: "idle" });
  }, []);

  return { attempt, check, send, reset };
}
