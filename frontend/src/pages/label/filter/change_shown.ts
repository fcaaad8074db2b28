import type { Shown } from "../../../labelling/label_state";
import type { LabelStore } from "../../../labelling/label_store";
import { readPreferences, writePreferences } from "../../../labelling/preferences";

/** Changes what is shown, here and on the images to come. */
export function changeShown(store: LabelStore, shown: Shown): void {
  store.setShown(shown);
  writePreferences(localStorage, { ...readPreferences(localStorage), shown });
}
