/** How a person likes to work, kept in this browser. */

import { FOCUSES, SHOW_ALL, type Shown } from "./label_state";
import { REVIEW_ORDERS, type ReviewOrder } from "./order";

export interface LabelPreferences {
  readonly order: ReviewOrder;
  readonly shown: Shown;
}

const STORAGE_KEY = "clearlines.label";
const DEFAULTS: LabelPreferences = { order: "position", shown: SHOW_ALL };

export function readPreferences(storage: Storage): LabelPreferences {
  try {
    const { order, shown } = JSON.parse(storage.getItem(STORAGE_KEY) ?? "{}") as Partial<LabelPreferences>;
    return {
      order: REVIEW_ORDERS.find((known) => known === order) ?? DEFAULTS.order,
      shown: {
        verdicts: { ...DEFAULTS.shown.verdicts, ...shown?.verdicts },
        bent: shown?.bent ?? DEFAULTS.shown.bent,
        ranges: { ...DEFAULTS.shown.ranges, ...shown?.ranges },
        focus: FOCUSES.find((known) => known === shown?.focus) ?? DEFAULTS.shown.focus,
      },
    };
  } catch {
    return DEFAULTS;
  }
}

export function writePreferences(storage: Storage, preferences: LabelPreferences): void {
  try {
    storage.setItem(STORAGE_KEY, JSON.stringify(preferences));
  } catch {
    // Storage may be full or forbidden; the preference then lasts as long as the page.
  }
}
