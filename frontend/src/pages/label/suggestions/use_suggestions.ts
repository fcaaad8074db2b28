import { useQuery } from "@tanstack/react-query";
import { type RefObject, useEffect, useMemo, useState } from "react";
import { getSuggestions } from "../../../api/endpoints";
import { suggestionsQuery } from "../../../api/queries";
import type { SuggestionModelName } from "../../../api/types";
import type { CanvasView } from "../../../canvas/view";
import { firstPaint } from "../../../image_view/first_paint";
import type { LabelStore } from "../../../labelling/label_store";
import { bringSuggestions } from "../../../labelling/suggestions/bring_suggestions";
import type { SuggestionActions } from "../../../labelling/suggestions/commands_suggestions";
import {
  readSuggestionPreferences,
  type SuggestionPreferences,
  writeSuggestionPreferences,
} from "../../../labelling/suggestions/preferences";
import type { Thresholds } from "../../../labelling/suggestions/suggestions";
import { suggestionActions } from "./suggestion_actions";

export interface SuggestionSession {
  readonly model: SuggestionModelName | null;
  /** What the model recommends; null as long as nothing is known. */
  readonly recommended: Thresholds | null;
  readonly failed: boolean;
  readonly preferences: SuggestionPreferences;
  readonly prefer: (preferences: SuggestionPreferences) => void;
  readonly actions: SuggestionActions;
}

/** Brings an image's suggestions into its store; one model for as long as the image is open. */
export function useSuggestions(
  imageId: number,
  store: LabelStore | null,
  viewRef: RefObject<CanvasView | null>,
  judges: boolean,
): SuggestionSession {
  const query = useQuery({
    ...suggestionsQuery(imageId),
    queryFn: () => firstPaint.whenPainted(imageId).then(() => getSuggestions(imageId)),
    enabled: judges && store !== null,
  });
  const { data } = query;
  const [preferences, setPreferences] = useState(() => readSuggestionPreferences(localStorage));

  useEffect(() => {
    if (store !== null && data !== undefined) bringSuggestions(store, data, preferences);
  }, [store, data, preferences]);

  const known = store !== null && data !== undefined;
  return useMemo(() => {
    const prefer = (next: SuggestionPreferences) => {
      setPreferences(next);
      writeSuggestionPreferences(localStorage, next);
    };
    return {
      model: data?.model ?? null,
      recommended: data?.thresholds ?? null,
      failed: query.isError,
      preferences,
      prefer,
      actions: suggestionActions({ store, viewRef, known, preferences, prefer }),
    };
  }, [data, query.isError, store, viewRef, known, preferences]);
}
