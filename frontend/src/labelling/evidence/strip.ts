/** The deviation of a candidate from its straight line, drawn as a strip. */

/** Deviations up to here (px) are those of a straight line: the least that a strip shows. */
export const STRAIGHT_WITHIN = 0.5;

export interface Strip {
  /** Half the strip's height stands for so many px. */
  readonly reach: number;
  /** How many times a deviation is enlarged against the strip's length. */
  readonly magnification: number;
  /** SVG path of the deviation. */
  readonly path: string;
  /** Height of the band within which a line counts as straight, screen px. */
  readonly band: number;
}

const ROUND = [0.5, 1, 2, 5];

/** The least round number that isn't below: strips of the same reach can be compared at a glance. */
export function roundReach(largest: number): number {
  const least = Math.max(largest, STRAIGHT_WITHIN);
  const power = 10 ** Math.floor(Math.log10(least));
  const factor = [...ROUND, 10].find((candidate) => candidate * power >= least * (1 - 1e-9)) ?? 10;
  return Math.max(STRAIGHT_WITHIN, Number((factor * power).toPrecision(2)));
}

/**
 * Lays a deviation out in a strip.
 *
 * @param along Arc length at each place, px.
 * @param deviation Deviation at each place, px.
 * @param width Of the strip, screen px.
 * @param height Of the strip, screen px.
 */
export function layOutStrip(
  along: readonly number[],
  deviation: readonly number[],
  width: number,
  height: number,
): Strip {
  const reach = roundReach(Math.max(0, ...deviation.map(Math.abs)));
  const length = along.at(-1) ?? 0;
  const across = length > 0 ? width / length : 0;
  const up = height / 2 / reach;
  const path = deviation
    .map((value, index) => {
      const x = (along[index] ?? 0) * across;
      return `${index === 0 ? "M" : "L"}${x.toFixed(1)} ${(height / 2 - value * up).toFixed(1)}`;
    })
    .join("");
  return { reach, magnification: across > 0 ? up / across : 0, path, band: 2 * STRAIGHT_WITHIN * up };
}
