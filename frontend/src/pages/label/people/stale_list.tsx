import { useEffect, useState, useSyncExternalStore } from "react";
import { Button } from "../../../design/button";
import { formatQuantity } from "../../../design/format";
import { Icon } from "../../../design/icons";
import { Keys } from "../../../design/kbd";
import type { LabelStore } from "../../../labelling/label_store";
import { outbox } from "../../../labelling/outbox_start";
import { type StaleCandidate, staleCandidates } from "../../../labelling/people/stale_decisions";
import { VerdictMark } from "../selection/verdict_mark";
import "./people.css";

interface StaleListProps {
  imageId: number;
  store: LabelStore;
}

/** Candidates on which another person decided differently meanwhile: one says whose verdict stands. */
export function StaleList({ imageId, store }: StaleListProps) {
  const stale = useSyncExternalStore(outbox.subscribe, outbox.getStale);
  const candidates = staleCandidates(stale, imageId);
  const [place, setPlace] = useState(0);
  const at = Math.min(place, candidates.length - 1);
  const current = candidates[at];

  useEffect(() => {
    if (current === undefined) return;
    function onKeyDown(event: KeyboardEvent): void {
      if (event.key.toLowerCase() !== "t" || event.repeat || isTyping(event)) return;
      if (event.ctrlKey || event.metaKey || event.altKey || current === undefined) return;
      event.preventDefault();
      event.stopPropagation();
      settle([current], event.shiftKey);
    }
    window.addEventListener("keydown", onKeyDown, { capture: true });
    return () => window.removeEventListener("keydown", onKeyDown, { capture: true });
  }, [current]);

  if (current === undefined) return null;
  const show = (index: number) => {
    setPlace(index);
    const segmentId = candidates[index]?.segmentId;
    const found = store.getState().candidates.findIndex((candidate) => candidate.id === segmentId);
    if (found >= 0) store.select(found, { follow: true });
  };
  return (
    <section className="stale-list" aria-label="Decided differently by others">
      <p className="stale-list__head" role="status">
        <Icon name="warning" />
        <span>
          <strong>{peopleOf(candidates)}</strong> decided on {formatQuantity(candidates.length, "candidate")}{" "}
          of yours meanwhile. Yours {candidates.length === 1 ? "is" : "are"} kept here until you say whose
          stands.
        </span>
      </p>
      <ol className="stale-list__rows">
        {candidates.map((candidate, index) => (
          <li key={candidate.segmentId} aria-current={index === at}>
            <button type="button" className="stale-list__row" onClick={() => show(index)}>
              <span>
                <VerdictMark name={candidate.mine} /> yours: {candidate.mine}
              </span>
              <span>
                <VerdictMark name={candidate.theirs.verdict} /> {candidate.theirs.person ?? "theirs"}:{" "}
                {candidate.theirs.verdict}
              </span>
            </button>
            <Button small onClick={() => settle([candidate], true)}>
              Keep mine {index === at ? <Keys keys={["Shift", "T"]} /> : null}
            </Button>
            <Button small onClick={() => settle([candidate], false)}>
              Take theirs {index === at ? <Keys keys={["T"]} /> : null}
            </Button>
          </li>
        ))}
      </ol>
      {candidates.length > 1 ? (
        <p className="stale-list__all">
          <Button small tone="quiet" onClick={() => settle(candidates, true)}>
            Keep all mine
          </Button>
          <Button small tone="quiet" onClick={() => settle(candidates, false)}>
            Take all theirs
          </Button>
        </p>
      ) : null}
    </section>
  );
}

function settle(candidates: readonly StaleCandidate[], mine: boolean): void {
  const decisions = candidates.flatMap((candidate) => candidate.decisions);
  if (mine) outbox.keepMine(decisions);
  else outbox.takeTheirs(decisions);
}

function peopleOf(candidates: readonly StaleCandidate[]): string {
  const names = new Set(candidates.map(({ theirs }) => theirs.person ?? "Someone else"));
  return [...names].join(", ");
}

function isTyping({ target }: KeyboardEvent): boolean {
  return target instanceof Element && target.matches("input, textarea, select, [contenteditable]");
}
