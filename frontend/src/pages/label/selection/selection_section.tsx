import type { RefObject } from "react";
import type { ImageDetail, SegmentFacts } from "../../../api/types";
import type { Scene } from "../../../canvas/scene";
import { lineStyle, styleName } from "../../../canvas/style";
import type { CanvasView } from "../../../canvas/view";
import { IconButton } from "../../../design/button";
import { formatCount } from "../../../design/format";
import { usePalette } from "../../../design/palette";
import { copyLink } from "../../../image_view/copy_link";
import { Magnifier } from "../../../image_view/magnifier";
import { isBent, type LabelState, reasonAt, selectedPlace, verdictAt } from "../../../labelling/label_state";
import { suggestedAt } from "../../../labelling/suggestions/suggestions";
import type { PageActions } from "../actions/page_actions";
import { EvidenceSection } from "../evidence/evidence_section";
import { useJudging } from "../people/judging";
import { LookingOnly } from "../people/looking_only";
import { StageSection } from "../stages/stage_section";
import { SuggestionFact } from "../suggestions/suggestion_fact";
import { ReasonButtons } from "./reason_buttons";
import { SeveralSelected } from "./several_selected";
import { addressOf } from "./use_segment_address";
import { VerdictButtons } from "./verdict_buttons";

interface SelectionSectionProps {
  image: ImageDetail;
  state: LabelState;
  scene: Scene;
  bitmap: ImageBitmap | null;
  actions: PageActions;
  viewRef: RefObject<CanvasView | null>;
  /** Whether it is told how the candidate was found. */
  stages: boolean;
}

/** The selected candidate: close-ups, facts and the verdict. */
export function SelectionSection(props: SelectionSectionProps) {
  const { image, state, scene, bitmap, actions, viewRef, stages } = props;
  const { judges, why } = useJudging();
  const palette = usePalette();
  const { selected } = state;
  const candidate = selected === null ? undefined : state.candidates[selected];
  const verdict = selected === null ? null : verdictAt(state, selected);
  const several = state.selection.length > 1;
  const common = commonOf(state.selection.map((index) => verdictAt(state, index)));
  const reason = commonOf(state.selection.map((index) => reasonAt(state, index)));
  return (
    <section className="panel-section" aria-label="Selected candidate">
      <div className="panel-heading">
        <h2>Candidate</h2>
        <span className="panel-heading__end muted numeric">
          {selected === null
            ? "none selected"
            : several
              ? `${formatCount(state.selection.length)} selected`
              : `${formatCount(selectedPlace(state) ?? 0)} of ${formatCount(state.candidates.length)}`}
          {candidate === undefined ? null : (
            <IconButton
              small
              icon="copy"
              label="Copy link"
              side="end"
              onClick={() => copyLink(addressOf(candidate.id), "Link to this candidate copied")}
            />
          )}
        </span>
      </div>
      <VerdictButtons current={several ? (common ?? "several") : verdict} onJudge={actions.judge} />
      {judges ? (
        <ReasonButtons
          current={reason ?? null}
          disabled={selected === null}
          onChoose={actions.chooseReason}
        />
      ) : (
        <LookingOnly why={why ?? ""} />
      )}
      {several ? (
        <SeveralSelected state={state} />
      ) : candidate === undefined || selected === null || verdict === null ? (
        <p className="muted panel-hint">Click a line or press Tab to select one.</p>
      ) : (
        <>
          <Magnifier
            scene={scene}
            bitmap={bitmap}
            index={selected}
            colour={
              lineStyle(
                styleName(verdict, isBent(state, selected), suggestedAt(state.suggesting, selected)),
                palette,
              ).colour
            }
          />
          <SuggestionFact suggesting={state.suggesting} index={selected} />
          <EvidenceSection imageId={image.id} segmentId={candidate.id} />
          <Facts candidate={candidate} />
          {judges ? (
            <StageSection
              imageId={image.id}
              candidate={candidate}
              index={selected}
              scene={scene}
              viewRef={viewRef}
              open={stages}
              onToggle={actions.toggleStages}
            />
          ) : null}
        </>
      )}
    </section>
  );
}

/** What all have in common; undefined where they differ, or there are none. */
function commonOf<T>(values: readonly T[]): T | undefined {
  const [first] = values;
  return values.every((value) => value === first) ? first : undefined;
}

const ORIGINS: Readonly<Record<SegmentFacts["origin"], string>> = {
  pipeline: "pipeline",
  manual: "drawn by hand",
  import: "imported",
};

function Facts({ candidate }: { candidate: SegmentFacts }) {
  const facts: [string, string, string?][] = [
    ["Length", `${candidate.length.toFixed(1)} px`],
    ["Points", String(candidate.n_points)],
    ["Score", number(candidate.score), "Evidence for an edge, 0 to 1"],
    ["Residual", withUnit(candidate.residual), "RMS deviation from straight after undistortion"],
    ["Straightness", number(candidate.straightness), "Probability of being straight under the lens"],
    ["Origin", ORIGINS[candidate.origin]],
  ];
  return (
    <>
      {candidate.straight === false ? (
        <p className="panel-note">Fails the straightness test under the camera's lens.</p>
      ) : null}
      <dl className="facts">
        {facts.map(([name, value, hint]) => (
          <div key={name} title={hint}>
            <dt>{name}</dt>
            <dd className="numeric">{value}</dd>
          </div>
        ))}
      </dl>
    </>
  );
}

function number(value: number | null): string {
  return value === null ? "–" : value.toFixed(2);
}

function withUnit(value: number | null): string {
  return value === null ? "–" : `${value.toFixed(2)} px`;
}
