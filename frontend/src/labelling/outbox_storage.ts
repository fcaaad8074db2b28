/** Where unsent decisions survive a crash or a reload. */

import type { NewDecision } from "../api/types";

export interface OutboxEntry {
  readonly imageId: number;
  readonly decision: NewDecision;
  /** The image's last decision that was known when this one was made; null or absent where none was. */
  readonly seen?: number | null;
}

export interface OutboxStorage {
  /** Whether entries survive a reload. */
  readonly lasting: boolean;
  /** All entries in the order in which they were added. */
  all(): Promise<OutboxEntry[]>;
  add(entries: readonly OutboxEntry[]): Promise<void>;
  remove(clientIds: readonly string[]): Promise<void>;
}

const DATABASE = "clearlines-outbox";
const STORE = "decisions";
const BY_CLIENT_ID = "client_id";

/**
 * Opens the browser's storage.
 *
 * @param instance Tells which of the server's databases the decisions are for: another one may be served at the
 *   same address tomorrow, with the same ids.
 */
export function openOutboxStorage(factory: IDBFactory, instance: () => Promise<string>): OutboxStorage {
  let opened: Promise<IDBDatabase> | null = null;

  function database(): Promise<IDBDatabase> {
    opened ??= instance()
      .then((name) => open(factory, `${DATABASE}-${name}`))
      .catch((error: unknown) => {
        opened = null;
        throw error;
      });
    return opened;
  }

  async function transact(mode: IDBTransactionMode, work: (store: IDBObjectStore) => void): Promise<void> {
    const transaction = (await database()).transaction(STORE, mode, { durability: "strict" });
    work(transaction.objectStore(STORE));
    await new Promise<void>((resolve, reject) => {
      transaction.oncomplete = () => resolve();
      transaction.onabort = () => reject(transaction.error);
      transaction.onerror = () => reject(transaction.error);
    });
  }

  return {
    lasting: true,
    async all() {
      let request: IDBRequest<OutboxEntry[]> | null = null;
      await transact("readonly", (store) => {
        request = store.getAll();
      });
      return (request as IDBRequest<OutboxEntry[]> | null)?.result ?? [];
    },
    add: (entries) =>
      transact("readwrite", (store) => {
        for (const entry of entries) store.add(entry);
      }),
    remove: (clientIds) =>
      transact("readwrite", (store) => {
        const index = store.index(BY_CLIENT_ID);
        for (const clientId of clientIds) {
          const found = index.getKey(clientId);
          found.onsuccess = () => {
            if (found.result !== undefined) store.delete(found.result);
          };
        }
      }),
  };
}

function open(factory: IDBFactory, name: string): Promise<IDBDatabase> {
  return new Promise((resolve, reject) => {
    const request = factory.open(name, 1);
    request.onupgradeneeded = () => {
      const store = request.result.createObjectStore(STORE, { autoIncrement: true });
      store.createIndex(BY_CLIENT_ID, "decision.client_id", { unique: true });
    };
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error);
    request.onblocked = () => reject(new Error("The outbox is blocked by another tab."));
  });
}

/** Where the browser forbids storage: nothing survives a reload, everything else works. */
export function memoryStorage(): OutboxStorage {
  let entries: OutboxEntry[] = [];
  return {
    lasting: false,
    all: async () => entries,
    add: async (added) => {
      entries = [...entries, ...added];
    },
    remove: async (clientIds) => {
      entries = entries.filter((entry) => !clientIds.includes(entry.decision.client_id));
    },
  };
}
