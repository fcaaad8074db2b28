import { keepPreviousData, useQuery } from "@tanstack/react-query";
import { type RefObject, useEffect, useMemo, useState } from "react";
import { asProblem } from "../../../api/problem";
import { stagesQuery } from "../../../api/queries";
import type { SegmentFacts } from "../../../api/types";
import type { Scene } from "../../../canvas/scene";
import { middleOf, type StageTrace, traceStages } from "../../../canvas/stage_trace";
import type { CanvasView } from "../../../canvas/view";
import { Button } from "../../../design/button";
import { sentence } from "../../../design/format";
import { describeStages } from "../../../labelling/stage_text";
import { JoinList } from "./join_list";
import { ScoreTable } from "./score_table";
import { StageLegend } from "./stage_legend";

interface StageDetailsProps {
  imageId: number;
  candidate: SegmentFacts;
  index: number;
  scene: Scene;
  viewRef: RefObject<CanvasView | null>;
}

const NOT_FOUND_HERE: Partial<Record<SegmentFacts["origin"], string>> = {
  manual: "A person drew this segment; the detector didn't find it.",
  import: "This segment was imported; how it was found isn't known here.",
};

export function StageDetails({ imageId, candidate, index, scene, viewRef }: StageDetailsProps) {
  const why = NOT_FOUND_HERE[candidate.origin];
  const query = useQuery({
    ...stagesQuery(imageId, candidate.id),
    enabled: why === undefined,
    // The panel keeps its height, and with it its place, while the next candidate's answer is on its way.
    placeholderData: keepPreviousData,
  });
  const { data, error, isPlaceholderData, refetch } = query;
  const history = why === undefined && error === null ? data : undefined;
  const shown = history === undefined || isPlaceholderData ? null : history;
  const trace = useMemo(
    () => (shown === null ? null : traceStages(scene.polylines, index, shown)),
    [scene, index, shown],
  );
  const [marked, setMarked] = useMarkedGap(candidate.id);
  useDrawnStages(viewRef, trace, marked);

  if (why !== undefined) return <p className="stages__note muted">{why}</p>;
  if (error !== null) return <Failure error={error} onRetry={refetch} />;
  if (history === undefined) {
    return (
      <p className="stages__loading muted" role="status">
        <span className="spinner" aria-hidden="true" /> Detecting the image again
      </p>
    );
  }
  return (
    <div className="stages__content" aria-busy={shown === null}>
      <p className="stages__summary">{describeStages(history)}</p>
      <StageLegend history={history} />
      <JoinList
        joins={history.joins}
        marked={marked}
        onMark={setMarked}
        onShow={(join) => {
          const gap = trace?.gaps[join];
          if (gap !== undefined) viewRef.current?.lookAt(middleOf(gap));
        }}
      />
      <ScoreTable history={history} />
    </div>
  );
}

/** What can't be told, calmly where the server says that there is no history, else as an error. */
function Failure({ error, onRetry }: { error: unknown; onRetry: () => void }) {
  const { code, message, hint } = asProblem(error);
  const text = [message, hint].flatMap((part) => (part ? [sentence(part)] : [])).join(" ");
  if (code === "no-history") return <p className="panel-note">{text}</p>;
  return (
    <div className="stages__failure" role="alert">
      <p>{text}</p>
      <Button small icon="retry" onClick={onRetry}>
        Try again
      </Button>
    </div>
  );
}

/** The join that is pointed at; another candidate begins without one. */
function useMarkedGap(candidateId: number): [number | null, (join: number | null) => void] {
  const [marked, setMarked] = useState<{ id: number; join: number | null }>({ id: candidateId, join: null });
  return [
    marked.id === candidateId ? marked.join : null,
    (join: number | null) => setMarked({ id: candidateId, join }),
  ];
}

function useDrawnStages(
  viewRef: RefObject<CanvasView | null>,
  trace: StageTrace | null,
  marked: number | null,
): void {
  useEffect(() => {
    const view = viewRef.current;
    view?.setStages(trace, marked);
    return () => view?.setStages(null, null);
  }, [viewRef, trace, marked]);
}
