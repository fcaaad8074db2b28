import type { RefObject } from "react";
import type { SecondReview } from "../../api/team_endpoints";
import type { Scene } from "../../canvas/scene";
import { lineStyle, styleName } from "../../canvas/style";
import { Badge } from "../../design/badge";
import { Button, IconButton } from "../../design/button";
import { formatCount } from "../../design/format";
import { Keys } from "../../design/kbd";
import { Magnifier } from "../../image_view/magnifier";
import { isBent, verdictAt } from "../../labelling/label_state";
import type { LabelStore } from "../../labelling/label_store";
import { EvidenceSection } from "../label/evidence/evidence_section";
import { ProgressSection } from "../label/review/progress_section";
import { VerdictButtons } from "../label/selection/verdict_buttons";
import { useLabelState } from "../label/session/use_store";
import type { SecondActions } from "./second_commands";

interface SecondPanelProps {
  review: SecondReview;
  store: LabelStore;
  scene: Scene;
  bitmap: ImageBitmap | null;
  actions: SecondActions;
  panelRef: RefObject<HTMLElement | null>;
}

/** Progress, the selected candidate and its verdict. */
export function SecondPanel({ review, store, scene, bitmap, actions, panelRef }: SecondPanelProps) {
  const state = useLabelState(store);
  const { selected, counts } = state;
  const candidate = selected === null ? undefined : state.candidates[selected];
  const verdict = selected === null ? null : verdictAt(state, selected);
  return (
    <aside className="image-panel" aria-label="Second review" ref={panelRef} tabIndex={-1} id="second-panel">
      <div className="image-panel__scroll">
        <section className="panel-section" aria-label="About this review">
          <div className="panel-heading">
            <h2>Second review</h2>
            <Badge tone={review.status === "done" ? "success" : "neutral"}>
              {review.status === "done" ? "Done" : "Open"}
            </Badge>
          </div>
          <p className="muted panel-hint">
            You don't see what the first person decided; where you two differ, somebody decides between you.
          </p>
        </section>
        <ProgressSection state={state} onShown={(shown) => store.setShown(shown)} />
        <section className="panel-section" aria-label="Selected candidate">
          <VerdictButtons current={verdict} onJudge={actions.judge} />
          {candidate === undefined || selected === null || verdict === null ? (
            <p className="muted panel-hint">Click a line or press Tab to select one.</p>
          ) : (
            <>
              <Magnifier
                scene={scene}
                bitmap={bitmap}
                index={selected}
                colour={lineStyle(styleName(verdict, isBent(state, selected))).colour}
              />
              <EvidenceSection imageId={review.image_id} segmentId={candidate.id} />
            </>
          )}
        </section>
      </div>
      <footer className="image-panel__footer">
        <IconButton icon="undo" label="Undo" keys={["Z"]} side="up" tone="default" onClick={actions.undo} />
        <IconButton
          icon="redo"
          label="Redo"
          keys={["Shift", "Z"]}
          side="up"
          tone="default"
          onClick={actions.redo}
        />
        {counts.undecided > 0 ? (
          <Button className="image-panel__wide" onClick={actions.rejectUndecided}>
            Reject {formatCount(counts.undecided)} left <Keys keys={["R"]} />
          </Button>
        ) : (
          <Button tone="primary" className="image-panel__wide" onClick={actions.finish}>
            Second review done <Keys keys={["Enter"]} />
          </Button>
        )}
      </footer>
    </aside>
  );
}
