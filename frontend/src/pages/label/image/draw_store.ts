import type { CanvasView } from "../../../canvas/view";
import { getPalette, subscribeToPalette } from "../../../design/palette";
import { candidateLook, changedLooks } from "../../../labelling/candidate_look";
import type { LabelStore } from "../../../labelling/label_store";
import type { Preview } from "../../../labelling/tools/preview";
import { calmly } from "../tools/calmly";

/** Keeps the canvas in step with the store, and with what a tool touches, until the returned function is called. */
export function drawStore(view: CanvasView, store: LabelStore, preview: Preview): () => void {
  let drawn = { state: store.getState(), touched: preview.get() };
  drawAll();
  view.setSelected(drawn.state.selected);
  if (drawn.state.selected !== null && drawn.state.followRequest > 0) view.show(drawn.state.selected);

  function drawAll(): void {
    view.setLook(candidateLook(store.getState(), preview.get(), getPalette()));
  }

  function draw(): void {
    const next = { state: store.getState(), touched: preview.get() };
    const { state } = next;
    const changed = changedLooks(drawn, next);
    if (changed === null) drawAll();
    else if (changed.length > 0) view.setLook(candidateLook(state, next.touched, getPalette()), changed);
    if (state.selected !== drawn.state.selected) view.setSelected(state.selected);
    const followed = state.followRequest !== drawn.state.followRequest;
    drawn = next;
    if (followed && state.selected !== null) view.show(state.selected);
  }

  // A stroke is drawn as fast as the hand moves; what it touches may be hundreds of lines.
  const touched = calmly(draw);
  const stops = [store.subscribe(draw), preview.subscribe(touched.call), subscribeToPalette(drawAll)];
  return () => {
    touched.forget();
    for (const stop of stops) stop();
  };
}
