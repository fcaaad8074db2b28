import type { RefObject } from "react";
import type { ImageDetail } from "../../api/types";
import { useRights } from "../../api/use_rights";
import type { Scene } from "../../canvas/scene";
import type { CanvasView } from "../../canvas/view";
import { Button, IconButton } from "../../design/button";
import { formatCount } from "../../design/format";
import { Keys } from "../../design/kbd";
import { Segmented } from "../../design/segmented";
import type { Shown } from "../../labelling/label_state";
import type { LabelStore } from "../../labelling/label_store";
import { REVIEW_ORDER_NAMES, REVIEW_ORDERS } from "../../labelling/order";
import type { ImageLook } from "../../labelling/views/image_look";
import type { PageActions } from "./actions/page_actions";
import { changeShown } from "./filter/change_shown";
import { RangeSection } from "./filter/range_section";
import { ImageSection } from "./review/image_section";
import { ProgressSection } from "./review/progress_section";
import { SelectionSection } from "./selection/selection_section";
import { useLabelState } from "./session/use_store";
import { changeOrder } from "./suggestions/change_order";
import { SuggestionSection } from "./suggestions/suggestion_section";
import type { SuggestionSession } from "./suggestions/use_suggestions";
import { judgeMany } from "./tools/judge_many";
import { ViewSection } from "./views/view_section";

interface SidePanelProps {
  slug: string;
  image: ImageDetail;
  store: LabelStore;
  scene: Scene;
  bitmap: ImageBitmap | null;
  actions: PageActions;
  viewRef: RefObject<CanvasView | null>;
  suggestions: SuggestionSession;
  /** Whether it is told how the selected candidate was found. */
  stages: boolean;
  discarding: boolean;
  look: ImageLook;
  onLook: (look: ImageLook) => void;
  panelRef: RefObject<HTMLElement | null>;
}

export function SidePanel({
  slug,
  image,
  store,
  scene,
  bitmap,
  actions,
  viewRef,
  suggestions,
  stages,
  discarding,
  look,
  onLook,
  panelRef,
}: SidePanelProps) {
  const state = useLabelState(store);
  const { label: judges } = useRights();

  const onShown = (shown: Shown) => changeShown(store, shown);

  return (
    <aside className="image-panel" aria-label="Review" ref={panelRef} tabIndex={-1} id="label-panel">
      <div className="image-panel__scroll">
        <ProgressSection state={state} onShown={onShown} />
        {state.candidates.length > 0 ? (
          <RangeSection
            state={state}
            onShown={onShown}
            onSelect={(indices) => store.selectAll(indices)}
            onReject={(indices) => judgeMany(store, indices, "reject")}
          />
        ) : null}
        {judges && state.candidates.length > 0 ? (
          <SuggestionSection slug={slug} state={state} viewRef={viewRef} session={suggestions} />
        ) : null}
        <SelectionSection
          image={image}
          state={state}
          scene={scene}
          bitmap={bitmap}
          actions={actions}
          viewRef={viewRef}
          stages={stages}
        />
        <section className="panel-section" aria-label="Order of review">
          <span className="field__label" aria-hidden="true">
            Order of review <Keys keys={["O"]} />
          </span>
          <Segmented
            label="Order of review"
            name="review-order"
            value={state.order}
            choices={REVIEW_ORDERS.map((order) => ({
              value: order,
              label: REVIEW_ORDER_NAMES[order].short,
              title: REVIEW_ORDER_NAMES[order].whole,
            }))}
            onChange={(order) => changeOrder(store, order)}
          />
        </section>
        <ViewSection look={look} onChange={onLook} />
        <ImageSection
          slug={slug}
          image={image}
          actions={actions}
          discarding={discarding}
          ready={bitmap !== null}
        />
      </div>
      {judges ? (
        <JudgeFooter store={store} image={image} actions={actions} />
      ) : (
        <LookFooter image={image} actions={actions} />
      )}
    </aside>
  );
}

interface FooterProps {
  image: ImageDetail;
  actions: PageActions;
}

function JudgeFooter({ store, image, actions }: FooterProps & { store: LabelStore }) {
  const state = useLabelState(store);
  return (
    <footer className="image-panel__footer">
      <IconButton
        icon="undo"
        label="Undo"
        keys={["Z"]}
        side="up"
        tone="default"
        disabled={state.history.done.length === 0}
        onClick={actions.undo}
      />
      <IconButton
        icon="redo"
        label="Redo"
        keys={["Shift", "Z"]}
        side="up"
        tone="default"
        disabled={state.history.undone.length === 0}
        onClick={actions.redo}
      />
      {state.counts.undecided > 0 ? (
        <Button className="image-panel__wide" onClick={actions.rejectUndecided}>
          Reject {formatCount(state.counts.undecided)} left <Keys keys={["R"]} />
        </Button>
      ) : (
        <Button tone="primary" className="image-panel__wide" onClick={actions.finish}>
          {image.status === "open" ? "Image done" : "Next image"} <Keys keys={["Enter"]} />
        </Button>
      )}
    </footer>
  );
}

/** Of whoever can't judge: there is nothing to do but go on. */
function LookFooter({ image, actions }: FooterProps) {
  return (
    <footer className="image-panel__footer">
      <Button
        tone="primary"
        className="image-panel__wide"
        disabled={image.next_id === null}
        onClick={() => actions.goToImage(1)}
      >
        Next image <Keys keys={["N"]} />
      </Button>
    </footer>
  );
}
