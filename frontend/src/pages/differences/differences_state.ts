/** The differences of first and second reviews that somebody goes through. */

import type { Difference } from "../../api/team_endpoints";

export type Judged = Difference["first"]["verdict"];

export interface DifferencesState {
  readonly differences: readonly Difference[];
  /** Which one is looked at; null where there is none. */
  readonly current: number | null;
  /** What was decided here, the latest last: keys of differences. */
  readonly done: readonly string[];
}

export function keyOf({ second_review_id, segment_id }: Difference): string {
  return `${second_review_id}/${segment_id}`;
}

export function opened(differences: readonly Difference[]): DifferencesState {
  const first = differences.findIndex((difference) => difference.adjudicated === null);
  return { differences, current: differences.length === 0 ? null : Math.max(first, 0), done: [] };
}

export function stepped(state: DifferencesState, direction: 1 | -1): DifferencesState {
  const { differences, current } = state;
  if (current === null) return state;
  const count = differences.length;
  return { ...state, current: (current + direction + count) % count };
}

export function chosen(state: DifferencesState, index: number): DifferencesState {
  return index in state.differences ? { ...state, current: index } : state;
}

/** Goes to the first difference of the next (or previous) image. */
export function steppedImage(state: DifferencesState, direction: 1 | -1): DifferencesState {
  const { differences, current } = state;
  const here = current === null ? undefined : differences[current];
  if (current === null || here === undefined) return state;
  const images = [...new Set(differences.map((difference) => difference.image_id))];
  const place = images.indexOf(here.image_id);
  const wanted = images[(place + direction + images.length) % images.length];
  const first = differences.findIndex((difference) => difference.image_id === wanted);
  return first < 0 ? state : { ...state, current: first };
}

/** Takes the server's answer in, and goes on to the next that nobody has decided on. */
export function decided(state: DifferencesState, answer: Difference): DifferencesState {
  const replaced = replacedBy(state, answer);
  const { differences, current } = replaced;
  const key = keyOf(answer);
  const done = [...state.done.filter((other) => other !== key), key];
  if (current === null || keyOf(differences[current] as Difference) !== key) return { ...replaced, done };
  const count = differences.length;
  for (let step = 1; step < count; step++) {
    const index = (current + step) % count;
    if (differences[index]?.adjudicated === null) return { differences, current: index, done };
  }
  return { ...replaced, done };
}

/** Takes the server's answer to something taken back in, and goes there. */
export function takenBack(state: DifferencesState, answer: Difference): DifferencesState {
  const { differences } = replacedBy(state, answer);
  const key = keyOf(answer);
  const current = differences.findIndex((difference) => keyOf(difference) === key);
  return { differences, current, done: state.done.filter((other) => other !== key) };
}

export function openCount({ differences }: DifferencesState): number {
  return differences.filter((difference) => difference.adjudicated === null).length;
}

function replacedBy(state: DifferencesState, answer: Difference): DifferencesState {
  const key = keyOf(answer);
  const differences = state.differences.map((known) => (keyOf(known) === key ? answer : known));
  return { ...state, differences };
}
