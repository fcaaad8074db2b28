import { useSyncExternalStore } from "react";
import type { LabelState } from "../../labelling/label_state";
import type { LabelStore } from "../../labelling/label_store";
import type { SaveState } from "../../labelling/outbox";
import { outbox } from "../../labelling/outbox_start";

export function useLabelState(store: LabelStore): LabelState {
  return useSyncExternalStore(store.subscribe, store.getState);
}

export function useSaveState(): SaveState {
  return useSyncExternalStore(outbox.subscribe, outbox.getState);
}
