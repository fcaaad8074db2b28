/** The outbox of second reviews: what waits is kept apart from first verdicts, under the second review's id. */

import { getConfiguration } from "../../api/endpoints";
import { type NewSecondDecision, postSecondDecisions } from "../../api/team_endpoints";
import type { NewDecision } from "../../api/types";
import { Outbox } from "../../labelling/outbox";
import { waitForNetwork } from "../../labelling/outbox_start";
import { memoryStorage, openOutboxStorage } from "../../labelling/outbox_storage";

export const secondOutbox = new Outbox({
  storage:
    typeof indexedDB === "undefined"
      ? memoryStorage()
      : openOutboxStorage(indexedDB, async () => `${(await getConfiguration()).instance}-second`),
  send: async (secondReviewId, decisions) => {
    const { stored, repeated, verdicts } = await postSecondDecisions(secondReviewId, decisions.map(asSecond));
    return { stored, repeated, verdicts, status: "open", last_decision_id: 0, others: [] };
  },
  wait: waitForNetwork,
  patience: (milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds)),
});
secondOutbox.restore();

window.addEventListener("beforeunload", (event) => {
  if (secondOutbox.atRisk) event.preventDefault();
});

/** A second review knows verdicts alone: neither reasons nor suggestions. */
function asSecond({
  client_id,
  group_id,
  segment_id,
  verdict,
  kind,
  target_group_id,
  elapsed_ms,
}: NewDecision) {
  const decision: NewSecondDecision = {
    client_id,
    group_id,
    segment_id,
    verdict,
    kind: kind === "undo" || kind === "redo" ? kind : "judge",
    target_group_id: target_group_id ?? null,
    elapsed_ms: elapsed_ms ?? null,
  };
  return decision;
}
