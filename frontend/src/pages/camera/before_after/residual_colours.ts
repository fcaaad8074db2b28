/**
 * Colours of lines on an image by how far their points lie off a straight line.
 *
 * From light blue over white and yellow to a dark orange: told apart by every kind of colour vision, by hue and by
 * lightness, on bright and on dark pixels.
 */

export const RESIDUAL_COLOURS = ["#5cc3ff", "#c8ecff", "#fff3b0", "#ffb53d", "#ff6a2b"] as const;

/** Where a colour ends, in noises of a point: a line that fits well lies off by about one. */
const NOISES = [1, 1.5, 2.5, 4] as const;

export interface ResidualScale {
  /** Ascending, px. */
  readonly limits: readonly number[];
  readonly colourOf: (rms: number) => string;
}

/** The same for all images of a camera, so that they can be compared. @param noise Of a point across its line, px. */
export function residualScale(noise: number): ResidualScale {
  const limits = NOISES.map((factor) => Number((factor * noise).toPrecision(2)));
  return {
    limits,
    colourOf: (rms) => RESIDUAL_COLOURS[limits.filter((limit) => rms >= limit).length] ?? RESIDUAL_COLOURS[0],
  };
}
