import { useSyncExternalStore } from "react";
import { Button } from "../../../design/button";
import { sentence } from "../../../design/format";
import { Icon } from "../../../design/icons";
import { Keys } from "../../../design/kbd";
import type { TraceSession, TraceState } from "../../../labelling/drawing/trace_session";

/** What to do next while a line is traced, and what went wrong. */
export function TraceBanner({ session }: { session: TraceSession }) {
  const state = useSyncExternalStore(session.subscribe, session.getState);
  const { clicks, trace, problem, saving } = state;
  const complete = clicks.length > 1;
  const missing = complete && problem?.code === "no-edge";
  return (
    <div className="banner banner--wrapping" role="status">
      <Icon name={complete && problem !== null ? "warning" : "pencil"} />
      <span>{textOf(state)}</span>
      {missing ? (
        <Button small onClick={() => session.keepStraight()}>
          Keep it as drawn
        </Button>
      ) : null}
      {complete && !missing && (trace !== null || problem !== null) ? (
        <Button small tone="primary" disabled={saving} onClick={() => session.accept()}>
          {problem === null ? "Keep" : "Try again"} <Keys keys={["Enter"]} />
        </Button>
      ) : null}
      {clicks.length > 0 ? (
        <Button small tone="quiet" disabled={saving} onClick={() => session.removeLast()}>
          Take back <Keys keys={["⌫"]} />
        </Button>
      ) : null}
    </div>
  );
}

function textOf({ clicks, trace, problem, saving }: TraceState) {
  if (clicks.length === 0) return "Click two points of a missing line. Esc ends.";
  if (clicks.length === 1) return "Click where the line ends.";
  if (saving) return "Saving the line…";
  if (problem?.code === "no-edge") {
    return (
      <>
        <strong>No edge here.</strong> Click closer to it, or a point in between.
      </>
    );
  }
  if (problem !== null) {
    return (
      <>
        <strong>Not saved.</strong> {sentence(problem.message)} The line stays here.
      </>
    );
  }
  if (trace === null) return "Looking for the edge…";
  return (
    <>
      <strong>{trace.length.toFixed(0)} px</strong> traced, {trace.residual.toFixed(2)} px from straight.
    </>
  );
}
