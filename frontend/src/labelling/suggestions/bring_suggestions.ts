import type { ImageSuggestions } from "../../api/types";
import type { LabelStore } from "../label_store";
import { type SuggestionPreferences, thresholdsFor } from "./preferences";
import { byCandidate } from "./suggestions";

/** Lets an image's store show what the server suggests, as the person likes it. */
export function bringSuggestions(
  store: LabelStore,
  answer: ImageSuggestions,
  preferences: SuggestionPreferences,
): void {
  store.setSuggesting({
    of: byCandidate(store.getState().candidates, answer),
    thresholds: thresholdsFor(preferences, answer.thresholds),
    shown: preferences.shown,
  });
}
