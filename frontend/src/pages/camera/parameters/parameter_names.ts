const NAMES: Readonly<Record<string, string>> = {
  k1: "radial, second power",
  k2: "radial, fourth power",
  k3: "radial, sixth power",
  p1: "tangential",
  p2: "tangential",
  cx: "centre, to the right",
  cy: "centre, downwards",
};

/** What a parameter of a lens does, in words; empty for one that isn't known here. */
export function parameterName(name: string): string {
  return NAMES[name] ?? "";
}
