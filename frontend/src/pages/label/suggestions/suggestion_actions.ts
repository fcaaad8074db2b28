import type { RefObject } from "react";
import type { CanvasView } from "../../../canvas/view";
import { toast } from "../../../design/toast";
import type { LabelStore } from "../../../labelling/label_store";
import { orderAfter, REVIEW_ORDER_NAMES } from "../../../labelling/order";
import type { SuggestionActions } from "../../../labelling/suggestions/commands_suggestions";
import type { SuggestionPreferences } from "../../../labelling/suggestions/preferences";
import { describeAccepted } from "../../../labelling/suggestions/suggestions";
import { REJECTED_TOAST } from "../actions/image_toasts";
import { changeOrder } from "./change_order";

const HINT_TOAST = "suggestions";
const HINT_DURATION = 2_500;

interface Parts {
  store: LabelStore | null;
  viewRef: RefObject<CanvasView | null>;
  /** Whether the suggestions have come. */
  known: boolean;
  preferences: SuggestionPreferences;
  prefer: (preferences: SuggestionPreferences) => void;
}

export function suggestionActions({ store, viewRef, known, preferences, prefer }: Parts): SuggestionActions {
  const hint = (message: string) => toast({ key: HINT_TOAST, message, duration: HINT_DURATION });

  function acceptSuggestions(): void {
    if (store === null) return;
    const refusal = whyNot(known, preferences);
    const counts = refusal === null ? store.acceptSuggested(viewRef.current?.linesOnScreen() ?? []) : null;
    if (counts === null || counts.keep + counts.reject === 0) {
      hint(refusal ?? "Nothing is suggested on the screen");
      return;
    }
    const accepted = store.getState().history.done.at(-1)?.id;
    toast({
      // It takes the place of what the last key for many did: only one of them can be taken back.
      key: REJECTED_TOAST,
      message: describeAccepted(counts),
      action: {
        label: "Undo",
        run: () => store.getState().history.done.at(-1)?.id === accepted && store.undo(),
      },
    });
  }

  return {
    acceptSuggestions,
    toggleSuggestions: () => {
      prefer({ ...preferences, shown: !preferences.shown });
      hint(preferences.shown ? "Suggestions hidden" : "Suggestions shown");
    },
    nextOrder: () => {
      if (store === null) return;
      const order = orderAfter(store.getState().order);
      changeOrder(store, order);
      hint(`Order: ${REVIEW_ORDER_NAMES[order].whole.toLowerCase()}`);
    },
  };
}

/** Why nothing can be accepted at all; null where something may be. */
function whyNot(known: boolean, { shown }: SuggestionPreferences): string | null {
  if (!known) return "The suggestions aren't there yet";
  return shown ? null : "Suggestions are hidden; Shift+S shows them";
}
