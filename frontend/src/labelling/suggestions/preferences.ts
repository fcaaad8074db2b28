/** How a person likes suggestions to be, kept in this browser: shown or not, and from which probability on. */

import type { Thresholds } from "./suggestions";

export interface SuggestionPreferences {
  readonly shown: boolean;
  /** Null: as the model recommends. */
  readonly keep: number | null;
  readonly reject: number | null;
}

const STORAGE_KEY = "clearlines.suggestions";
const DEFAULTS: SuggestionPreferences = { shown: true, keep: null, reject: null };

/** Where each threshold may lie; between the two a person looks. */
export const THRESHOLD_RANGES = { keep: [0.5, 1], reject: [0, 0.5] } as const;

export function readSuggestionPreferences(storage: Storage): SuggestionPreferences {
  try {
    const stored = JSON.parse(storage.getItem(STORAGE_KEY) ?? "{}") as Partial<SuggestionPreferences>;
    return {
      shown: typeof stored.shown === "boolean" ? stored.shown : DEFAULTS.shown,
      keep: within(stored.keep, THRESHOLD_RANGES.keep),
      reject: within(stored.reject, THRESHOLD_RANGES.reject),
    };
  } catch {
    return DEFAULTS;
  }
}

export function writeSuggestionPreferences(storage: Storage, preferences: SuggestionPreferences): void {
  try {
    storage.setItem(STORAGE_KEY, JSON.stringify(preferences));
  } catch {
    // Storage may be full or forbidden; the preference then lasts as long as the page.
  }
}

/** The thresholds that hold: the person's own, else those of the model. */
export function thresholdsFor(preferences: SuggestionPreferences, recommended: Thresholds): Thresholds {
  return { keep: preferences.keep ?? recommended.keep, reject: preferences.reject ?? recommended.reject };
}

function within(value: unknown, [low, high]: readonly [number, number]): number | null {
  return typeof value === "number" && value >= low && value <= high ? value : null;
}
