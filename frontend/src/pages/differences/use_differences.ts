import { type QueryClient, useQuery, useQueryClient } from "@tanstack/react-query";
import { useCallback, useEffect, useMemo, useRef, useState } from "react";
import { asProblem } from "../../api/problem";
import {
  adjudicate,
  type Difference,
  differencesQuery,
  takeAdjudicationBack,
  teamKeys,
} from "../../api/team_endpoints";
import { toast } from "../../design/toast";
import {
  chosen,
  type DifferencesState,
  decided,
  type Judged,
  keyOf,
  opened,
  stepped,
  steppedImage,
  takenBack,
} from "./differences_state";

const NONE = opened([]);

export interface Differences {
  state: DifferencesState;
  loaded: boolean;
  error: unknown;
  retry: () => void;
  current: Difference | null;
  decide: (verdict: Judged) => void;
  /** Takes the current difference's decision back, or the latest one that was made here. */
  takeBack: (which: "current" | "latest") => void;
  step: (direction: 1 | -1) => void;
  stepImage: (direction: 1 | -1) => void;
  choose: (index: number) => void;
}

/** All differences of a dataset, and what can be done with the one that is looked at. */
export function useDifferences(slug: string): Differences {
  const client = useQueryClient();
  const { data, error, refetch } = useQuery(differencesQuery(slug));
  const [state, setState] = useState<DifferencesState>(NONE);
  const latest = useRef(state);
  latest.current = state;
  useEffect(() => {
    if (data !== undefined) setState(opened(data));
  }, [data]);

  const send = useCallback(
    async (asked: Promise<Difference>, take: typeof decided) => {
      try {
        const answer = await asked;
        setState((before) => take(before, answer));
        forget(client, slug, answer.image_id);
      } catch (failure) {
        toast({ key: "adjudication", tone: "danger", message: asProblem(failure).message });
      }
    },
    [client, slug],
  );

  const actions = useMemo(
    () => ({
      decide: (verdict: Judged) => {
        const difference = currentOf(latest.current);
        if (difference === null) return;
        void send(adjudicate(difference, verdict, crypto.randomUUID()), decided);
      },
      takeBack: (which: "current" | "latest") => {
        const { done, differences } = latest.current;
        const difference =
          which === "current"
            ? currentOf(latest.current)
            : differences.find((known) => keyOf(known) === done.at(-1));
        if (difference == null || difference.adjudicated === null) {
          toast({ key: "adjudication", message: "Nothing to take back", duration: 2_000 });
          return;
        }
        void send(takeAdjudicationBack(difference), takenBack);
      },
      step: (direction: 1 | -1) => setState((before) => stepped(before, direction)),
      stepImage: (direction: 1 | -1) => setState((before) => steppedImage(before, direction)),
      choose: (index: number) => setState((before) => chosen(before, index)),
    }),
    [send],
  );

  return {
    state,
    loaded: data !== undefined,
    error,
    retry: () => refetch(),
    current: currentOf(state),
    ...actions,
  };
}

function currentOf({ differences, current }: DifferencesState): Difference | null {
  return current === null ? null : (differences[current] ?? null);
}

/** What was fetched of the image and of the agreement is out of date now. */
function forget(client: QueryClient, slug: string, imageId: number): void {
  void client.invalidateQueries({ queryKey: teamKeys.agreement(slug) });
  client.removeQueries({
    queryKey: ["images", imageId, "annotations"],
    predicate: (query) => query.getObserversCount() === 0,
  });
}
