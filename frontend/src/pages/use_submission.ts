import { useQuery, useQueryClient } from "@tanstack/react-query";
import { useEffect } from "react";
import { getSubmission, submissionEventsUrl } from "../api/board_endpoints";
import { boardKeys, submissionQuery } from "../api/board_queries";
import { followSubmission, isFinal } from "../api/follow_submission";

/** A submission, followed as long as something about it goes on. */
export function useSubmission(id: number) {
  const client = useQueryClient();
  const query = useQuery(submissionQuery(id));
  const goesOn = query.data !== undefined && !isFinal(query.data);
  useEffect(() => {
    if (!goesOn) return;
    return followSubmission({
      connect: () => new EventSource(submissionEventsUrl(id)),
      ask: () => getSubmission(id),
      later: (run, milliseconds) => {
        const timer = setTimeout(run, milliseconds);
        return () => clearTimeout(timer);
      },
      onChange: (submission) => {
        client.setQueryData(boardKeys.submission(id), submission);
        if (!isFinal(submission)) return;
        void client.invalidateQueries({ queryKey: boardKeys.splits });
        void client.invalidateQueries({ queryKey: boardKeys.method(submission.method.slug) });
      },
    });
  }, [client, id, goesOn]);
  return query;
}
