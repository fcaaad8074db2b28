/** What suggestions spare: keys per image, with them and without. */

import type { DatasetSuggestions } from "../../api/types";

export type GainEntry = DatasetSuggestions["gain"][number];

export interface Saving {
  readonly images: number;
  readonly keys: number;
  readonly byHand: number;
  /** Of the keys without suggestions, 0 to 1; below 0 where suggestions cost more than they spare. */
  readonly share: number;
}

/** Images at the end of the list that tell how good suggestions are by now. */
const LATEST = 10;

/** What the latest images spared, of those that a model of this dataset suggested for; null where there is none. */
export function latestSaving(gain: readonly GainEntry[], latest = LATEST): Saving | null {
  const shown = gain.filter(({ images }) => images > 0).slice(-latest);
  const keys = sum(shown.map((entry) => entry.keys));
  const byHand = sum(shown.map((entry) => entry.keys_by_hand));
  return byHand === 0 ? null : { images: shown.length, keys, byHand, share: 1 - keys / byHand };
}

/** "12 of 109 keys". */
export function gainText({ keys, keys_by_hand, images }: GainEntry): string {
  const by = images === 0 ? "by the general model" : `learnt from ${images} before`;
  return `${keys} keys instead of ${keys_by_hand}, ${by}`;
}

function sum(values: readonly number[]): number {
  return values.reduce((total, value) => total + value, 0);
}
