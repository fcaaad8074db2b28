import { Icon, type IconName } from "../../design/icons";
import type { SaveState } from "../../labelling/outbox";
import { useSaveState } from "./use_store";

/** Says at any time whether everything decided has reached the server. */
export function SaveIndicator() {
  const state = useSaveState();
  const { icon, text, title } = describe(state);
  return (
    <span className={`save-indicator save-indicator--${state.kind}`} role="status" title={title}>
      <Icon name={icon} />
      <span>{text}</span>
    </span>
  );
}

function describe(state: SaveState): { icon: IconName; text: string; title: string } {
  switch (state.kind) {
    case "saved":
      return { icon: "saved", text: "All saved", title: "Every decision has reached the server." };
    case "saving":
      return { icon: "saving", text: "Saving", title: `${state.waiting} on the way to the server.` };
    case "offline":
      return {
        icon: "offline",
        text: `Offline, ${state.waiting} kept here`,
        title: `${state.problem.message} The decisions are kept in this browser and sent again by themselves.`,
      };
    case "refused":
      return {
        icon: "warning",
        text: `${state.refused.length} refused`,
        title: state.refused[0]?.problem.message ?? "The server refused decisions.",
      };
  }
}
