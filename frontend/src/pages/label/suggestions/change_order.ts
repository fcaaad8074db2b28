import type { LabelStore } from "../../../labelling/label_store";
import type { ReviewOrder } from "../../../labelling/order";
import { readPreferences, writePreferences } from "../../../labelling/preferences";

/** Reviews in another order, from its beginning, here and on every image to come. */
export function changeOrder(store: LabelStore, order: ReviewOrder): void {
  store.setOrder(order);
  store.selectFirstUndecided();
  writePreferences(localStorage, { ...readPreferences(localStorage), order });
}
