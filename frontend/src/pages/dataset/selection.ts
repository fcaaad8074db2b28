/** Which images are chosen, and the one that a range starts from. */

export interface Selection {
  readonly ids: ReadonlySet<number>;
  readonly anchor: number | null;
}

export const NOTHING_SELECTED: Selection = { ids: new Set(), anchor: null };

export function toggled({ ids }: Selection, id: number): Selection {
  const next = new Set(ids);
  if (!next.delete(id)) next.add(id);
  return { ids: next, anchor: id };
}

/** Adds everything from the anchor to `id`, both included; without an anchor in the order, `id` alone. */
export function extended({ ids, anchor }: Selection, order: readonly number[], id: number): Selection {
  const end = order.indexOf(id);
  const start = anchor === null ? end : order.indexOf(anchor);
  if (end < 0) return { ids, anchor };
  const from = start < 0 ? end : start;
  const range = order.slice(Math.min(from, end), Math.max(from, end) + 1);
  return { ids: new Set([...ids, ...range]), anchor: anchor ?? id };
}

export function all(order: readonly number[]): Selection {
  return { ids: new Set(order), anchor: order[0] ?? null };
}
