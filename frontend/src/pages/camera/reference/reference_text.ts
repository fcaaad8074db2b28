/** The numbers of a reference calibration, as far as the stored fields hold them. */

const D_NAMES = ["k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"];

/** Names and values in the order in which they are shown. */
export function readReference(reference: Readonly<Record<string, unknown>>): [string, string][] {
  const { K, D, width, height } = reference;
  const rows = Array.isArray(K) ? K.map(numbers) : [];
  const [fx, , cx] = rows[0] ?? [];
  const [, fy, cy] = rows[1] ?? [];
  const facts: [string, string][] = [];
  if (typeof width === "number" && typeof height === "number")
    facts.push(["Size", `${width} × ${height} px`]);
  if (fx !== undefined && fy !== undefined) facts.push(["Focal length", `${short(fx)}, ${short(fy)} px`]);
  if (cx !== undefined && cy !== undefined) facts.push(["Principal point", `${short(cx)}, ${short(cy)} px`]);
  numbers(D).forEach((value, place) => {
    facts.push([D_NAMES[place] ?? `D[${place}]`, value.toFixed(5).replace(/^-/, "−")]);
  });
  return facts;
}

function numbers(value: unknown): number[] {
  return Array.isArray(value) ? value.filter((entry): entry is number => typeof entry === "number") : [];
}

function short(value: number): string {
  return value.toFixed(1).replace(/^-/, "−");
}
