/** The page's one outbox, on the browser's storage and network. */

import { getConfiguration, postDecisions } from "../api/endpoints";
import type { DecisionsStored } from "../api/types";
import { Outbox } from "./outbox";
import { memoryStorage, openOutboxStorage } from "./outbox_storage";
import { SeenDecisions } from "./people/seen_decisions";

/** What this page knows of each image's decisions. */
export const seenDecisions = new SeenDecisions();

type StoredListener = (imageId: number, answer: DecisionsStored) => void;
const storedListeners = new Set<StoredListener>();

export const outbox = new Outbox({
  storage: typeof indexedDB === "undefined" ? memoryStorage() : openOutboxStorage(indexedDB, servedInstance),
  send: (imageId, decisions, seen) => postDecisions(imageId, decisions, seen),
  wait: waitForNetwork,
  patience: (milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds)),
  onStored: (imageId, answer) => {
    for (const listener of storedListeners) listener(imageId, answer);
  },
});

/** Hears each acknowledged batch until the returned function is called. */
export function onDecisionsStored(listener: StoredListener): () => void {
  storedListeners.add(listener);
  return () => storedListeners.delete(listener);
}

window.addEventListener("beforeunload", (event) => {
  if (outbox.atRisk) event.preventDefault();
});

async function servedInstance(): Promise<string> {
  return (await getConfiguration()).instance;
}

/** Resolves after some milliseconds, earlier when the network comes back. */
export function waitForNetwork(milliseconds: number): Promise<void> {
  return new Promise((resolve) => {
    const done = () => {
      clearTimeout(timer);
      window.removeEventListener("online", done);
      resolve();
    };
    const timer = setTimeout(done, milliseconds);
    window.addEventListener("online", done);
  });
}
