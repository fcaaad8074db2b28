/** Two calibrations of one camera, number by number. */

import type { CalibrationResult } from "../../../api/camera_types";

/** What of a result is compared. */
type LensNumbers = Pick<CalibrationResult, "released" | "sigma"> & {
  lens: Pick<CalibrationResult["lens"], "family" | "names" | "parameters">;
};

interface Known {
  readonly value: number;
  readonly sigma: number | undefined;
}

interface ComparedParameter {
  readonly name: string;
  /** null where it was held. */
  readonly first: Known | null;
  readonly second: Known | null;
  /** How many of their common sigmas they are apart; null where one wasn't estimated. */
  readonly sigmas: number | null;
}

/** Parameters that either of them estimated; those of another model mean something else, so none then. */
export function comparedParameters(a: LensNumbers, b: LensNumbers): ComparedParameter[] {
  if (a.lens.family !== b.lens.family) return [];
  return a.lens.names
    .filter((name) => a.released.includes(name) || b.released.includes(name))
    .map((name) => {
      const first = known(a, name);
      const second = known(b, name);
      return { name, first, second, sigmas: apart(first, second) };
    });
}

function known({ lens, released, sigma }: LensNumbers, name: string): Known | null {
  if (!released.includes(name)) return null;
  return { value: lens.parameters[lens.names.indexOf(name)] ?? 0, sigma: sigma[name] };
}

function apart(first: Known | null, second: Known | null): number | null {
  if (first?.sigma === undefined || second?.sigma === undefined) return null;
  const common = Math.hypot(first.sigma, second.sigma);
  return common > 0 ? Math.abs(first.value - second.value) / common : null;
}
