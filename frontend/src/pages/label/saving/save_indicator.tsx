import { useRef, useSyncExternalStore } from "react";
import { formatQuantity } from "../../../design/format";
import { Icon, type IconName } from "../../../design/icons";
import type { Kept, Outbox, SaveState } from "../../../labelling/outbox";
import "./save_indicator.css";

/** Says at any time whether everything decided has reached the server. */
export function SaveIndicator({ outbox }: { outbox: Outbox }) {
  const state = useSyncExternalStore(outbox.subscribe, outbox.getState);
  const { icon, text, title } = describe(state);
  const content = (
    <>
      <Icon name={icon} />
      <span>{text}</span>
    </>
  );
  // Each verdict is saved: only what goes wrong, and its end, is worth saying aloud.
  const aloud = useRef(false);
  if (state.kind !== "saved") aloud.current = state.kind !== "saving";
  return (
    <span className="save-indicator-region" aria-live={aloud.current ? "polite" : "off"}>
      {state.kind === "offline" ? (
        <button
          type="button"
          className="save-indicator save-indicator--offline"
          title={title}
          onClick={() => outbox.retry()}
        >
          {content}
        </button>
      ) : (
        <span className={`save-indicator save-indicator--${state.kind}`} title={title}>
          {content}
        </span>
      )}
    </span>
  );
}

const KEPT: Record<Kept, string> = {
  kept: "kept here",
  storing: "being kept",
  lost: "only in this tab",
};

function describe(state: SaveState): { icon: IconName; text: string; title: string } {
  switch (state.kind) {
    case "saved":
      return { icon: "saved", text: "All saved", title: "Every decision has reached the server." };
    case "saving":
      return { icon: "saving", text: "Saving", title: `${state.waiting} on the way to the server.` };
    case "offline":
      return {
        icon: "offline",
        text: `Offline, ${state.waiting} ${KEPT[state.kept]}`,
        title: `${state.problem.message} ${
          state.kept === "lost"
            ? `This browser stores nothing for this page, so keep the tab open: ${formatQuantity(state.waiting, "decision")} would be lost with it.`
            : "The decisions are kept in this browser and sent again by themselves."
        } Click to try now.`,
      };
    case "stale":
      return {
        icon: "warning",
        text: `${state.stale.length} kept here`,
        title: "Others decided differently meanwhile; on the image you say whose verdict stands.",
      };
    case "refused":
      return {
        icon: "warning",
        text: `${state.refused.length} refused`,
        title: state.refused[0]?.problem.message ?? "The server refused decisions.",
      };
  }
}
