import { useSyncExternalStore } from "react";
import type { LabelState } from "../../../labelling/label_state";
import type { LabelStore } from "../../../labelling/label_store";

export function useLabelState(store: LabelStore): LabelState {
  return useSyncExternalStore(store.subscribe, store.getState);
}
