/** How a person likes to look at errors, kept in this browser. */

import { DEFAULT_ORDER, ERROR_ORDERS, type ErrorOrder } from "./errors";

export interface ViewerPreferences {
  readonly order: ErrorOrder;
}

const STORAGE_KEY = "clearlines.viewer";

export function readPreferences(storage: Storage): ViewerPreferences {
  const stored = parsed(storage);
  return {
    order: ERROR_ORDERS.find((known) => known === stored.order) ?? DEFAULT_ORDER,
  };
}

export function writePreferences(storage: Storage, preferences: ViewerPreferences): void {
  try {
    storage.setItem(STORAGE_KEY, JSON.stringify(preferences));
  } catch {
    // Storage may be full or forbidden; the preference then lasts as long as the page.
  }
}

function parsed(storage: Storage): Partial<Record<keyof ViewerPreferences, unknown>> {
  try {
    return JSON.parse(storage.getItem(STORAGE_KEY) ?? "{}");
  } catch {
    return {};
  }
}
