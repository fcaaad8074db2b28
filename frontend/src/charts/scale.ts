/** From values to places along an axis. */

export interface Scale {
  readonly domain: readonly [number, number];
  readonly range: readonly [number, number];
  at: (value: number) => number;
}

/** A linear scale; a domain without extent puts everything in the middle. */
export function linearScale(domain: readonly [number, number], range: readonly [number, number]): Scale {
  const [from, to] = domain;
  const [start, end] = range;
  const at =
    to === from
      ? () => (start + end) / 2
      : (value: number) => start + ((value - from) / (to - from)) * (end - start);
  return { domain, range, at };
}

const STEPS = [1, 2, 5, 10];

/** Round values inside the domain, about as many as wanted. */
export function ticks([from, to]: readonly [number, number], wanted: number): number[] {
  if (!(to > from)) return [from];
  const rough = (to - from) / wanted;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = (STEPS.find((factor) => factor * power >= rough * 0.999) ?? 10) * power;
  const first = Math.ceil(from / step - 1e-9);
  const last = Math.floor(to / step + 1e-9);
  // Counted in whole steps: adding up 0.1 drifts.
  return Array.from({ length: last - first + 1 }, (_, index) => Number(((first + index) * step).toFixed(10)));
}

/**
 * Where an axis begins and ends for values to fill it: on multiples of a step, at least so wide, inside the limits.
 *
 * Without any value it is the limits themselves.
 */
export function fittedDomain(
  values: readonly number[],
  { step, width, limits }: { step: number; width: number; limits: readonly [number, number] },
): [number, number] {
  const finite = values.filter(Number.isFinite);
  if (finite.length === 0) return [limits[0], limits[1]];
  // In whole steps, so that nothing drifts; a value on a step gets room beside it.
  const least = Math.round(limits[0] / step);
  const most = Math.round(limits[1] / step);
  let low = Math.max(least, Math.floor(Math.min(...finite) / step - 0.2));
  let high = Math.min(most, Math.ceil(Math.max(...finite) / step + 0.2));
  while ((high - low) * step < width - 1e-9 && (high < most || low > least)) {
    if (high < most) high += 1;
    else low -= 1;
  }
  return [Number((low * step).toFixed(10)), Number((high * step).toFixed(10))];
}
