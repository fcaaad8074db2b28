import { useSyncExternalStore } from "react";
import { Icon } from "../../design/icons";
import { secondOutbox } from "./second_outbox";
import "../label/save_indicator.css";

/** Says whether the second verdicts have reached the server. */
export function SecondSaveIndicator() {
  const state = useSyncExternalStore(secondOutbox.subscribe, secondOutbox.getState);
  if (state.kind === "offline") {
    return (
      <button
        type="button"
        className="save-indicator save-indicator--offline"
        title={`${state.problem.message} Click to try now.`}
        onClick={() => secondOutbox.retry()}
      >
        <Icon name="offline" />
        <span>Offline, {state.waiting} kept here</span>
      </button>
    );
  }
  if (state.kind === "refused") {
    return (
      <span className="save-indicator save-indicator--refused" title={state.refused[0]?.problem.message}>
        <Icon name="warning" />
        <span>{state.refused.length} refused</span>
      </span>
    );
  }
  return (
    <span className={`save-indicator save-indicator--${state.kind === "saved" ? "saved" : "saving"}`}>
      <Icon name={state.kind === "saved" ? "saved" : "saving"} />
      <span>{state.kind === "saved" ? "All saved" : "Saving"}</span>
    </span>
  );
}
