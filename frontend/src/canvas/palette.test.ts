import { expect, it } from "vitest";
import { COLOURS, type ColourName, PALETTES } from "./palette";
import { lineStyle, STYLE_ORDER } from "./style";

/** Machado, Oliveira and Fernandes (2009), severity 1, on linear RGB. */
const VISIONS = {
  normal: [1, 0, 0, 0, 1, 0, 0, 0, 1],
  protanopia: [0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116, 1.051998],
  deuteranopia: [0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.01182, 0.04294, 0.968881],
  tritanopia: [1.255528, -0.076749, -0.178779, -0.078411, 0.930809, 0.147602, 0.004733, 0.691367, 0.3039],
} as const;
const TO_XYZ = [0.4339, 0.3763, 0.1899, 0.2127, 0.7152, 0.0722, 0.0178, 0.1094, 0.8728];
/** Differences in CIELAB above this are seen at a glance, even between thin lines. */
const GLANCE = 25;

function times(matrix: readonly number[], [a, b, c]: readonly number[]): number[] {
  return [0, 3, 6].map(
    (row) =>
      (matrix[row] ?? 0) * (a ?? 0) + (matrix[row + 1] ?? 0) * (b ?? 0) + (matrix[row + 2] ?? 0) * (c ?? 0),
  );
}

function linear(colour: string): number[] {
  return [1, 3, 5].map((at) => {
    const share = Number.parseInt(colour.slice(at, at + 2), 16) / 255;
    return share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4;
  });
}

function lab(rgb: readonly number[]): [number, number, number] {
  const [x = 0, y = 0, z = 0] = times(
    TO_XYZ,
    rgb.map((share) => Math.min(1, Math.max(0, share))),
  ).map((t) => (t > 0.008856 ? Math.cbrt(t) : 7.787 * t + 16 / 116));
  return [116 * y - 16, 500 * (x - y), 200 * (y - z)];
}

function difference(vision: readonly number[], one: string, other: string): number {
  const [a, b] = [lab(times(vision, linear(one))), lab(times(vision, linear(other)))];
  return Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

it.each(Object.entries(VISIONS))("safe colours stay apart with %s", (_, vision) => {
  const names = Object.keys(COLOURS.safe) as ColourName[];
  for (const one of names) {
    for (const other of names.filter((name) => name > one)) {
      const found = difference(vision, COLOURS.safe[one], COLOURS.safe[other]);
      expect(found, `${one} and ${other}`).toBeGreaterThan(GLANCE);
    }
  }
});

it("tells verdicts apart by form alone, whatever the palette", () => {
  for (const palette of PALETTES) {
    const forms = STYLE_ORDER.map((name) => {
      const { width, dash } = lineStyle(name, palette);
      return `${width} ${dash.join(",")}`;
    });
    expect(new Set(forms).size).toBe(forms.length);
  }
});
