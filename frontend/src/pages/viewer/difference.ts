/** What two submissions do differently on one image. */

import { at, type Box, distanceToPolyline, growBox } from "../../canvas/geometry";
import type { Scene } from "../../canvas/scene";
import type { MatchedImage, MatchedLine } from "./matched_image";

export type Side = "a" | "b";

export interface Difference {
  /** Names of labels that one submission found and the other one missed. */
  readonly found: Readonly<Record<Side, ReadonlySet<string>>>;
  /** Indices in each scene of false positives that the other submission doesn't have. */
  readonly alarms: Readonly<Record<Side, ReadonlySet<number>>>;
  /** Indices in each scene of all lines that tell of a difference. */
  readonly lines: Readonly<Record<Side, ReadonlySet<number>>>;
}

/** Points of a line that are looked at. */
const SAMPLES = 24;
/** As near as clearlines-v2 lets a prediction lie to its label (px). */
const TOLERANCE = 3;
/** Scale whose simplification is exact enough: to less than a tenth of a px. */
const FINE = 4;
/** Two false positives of which this share lies together are the same one. */
const SAME = 0.5;

export function differenceOf(a: MatchedImage, b: MatchedImage): Difference {
  const found = { a: foundAlone(a, b), b: foundAlone(b, a) };
  const alarms = { a: alarmsAlone(a, b), b: alarmsAlone(b, a) };
  const differing = new Set([...found.a, ...found.b]);
  const lines = {
    a: linesOf(a, differing, alarms.a),
    b: linesOf(b, differing, alarms.b),
  };
  return { found, alarms, lines };
}

function foundAlone(one: MatchedImage, other: MatchedImage): Set<string> {
  const missed = new Set(other.lines.filter(({ layer }) => layer === "fn").map(({ name }) => name));
  const names = one.lines.filter(({ layer }) => layer === "found").map(({ name }) => name);
  return new Set(names.filter((name) => missed.has(name)));
}

function alarmsAlone(one: MatchedImage, other: MatchedImage): Set<number> {
  const isAlarm = (index: number) => other.lines[index]?.layer === "fp";
  const alarms = one.lines.filter(({ layer }) => layer === "fp").map(({ index }) => index);
  return new Set(alarms.filter((index) => !liesOn(one.scene, index, other.scene, isAlarm)));
}

/** Whether at least half of a line lies on lines of another scene. */
export function liesOn(
  scene: Scene,
  index: number,
  other: Scene,
  accept: (index: number) => boolean,
): boolean {
  const box = scene.boxes[index];
  const near = box === undefined ? [] : other.places.touching(growBox(box, TOLERANCE), accept);
  const boxes = near.map((line) => growBox(other.boxes[line] as Box, TOLERANCE));
  const isNear = (x: number, y: number) =>
    near.some((line, place) => {
      const { minX, minY, maxX, maxY } = boxes[place] as Box;
      if (x < minX || x > maxX || y < minY || y > maxY) return false;
      const simple = other.line(line, FINE);
      return distanceToPolyline(simple, 0, simple.length / 2, x, y) <= TOLERANCE;
    });
  const { coordinates, offsets } = scene.polylines;
  const first = at(offsets, index);
  const last = at(offsets, index + 1) - 1;
  let needed = near.length === 0 ? SAMPLES + 1 : Math.ceil(SAME * SAMPLES);
  // Ends as soon as it is decided: there may be thousands of lines.
  for (let sample = 0; needed > 0 && needed <= SAMPLES - sample; sample++) {
    const point = first + Math.round((sample / (SAMPLES - 1)) * (last - first));
    if (isNear(at(coordinates, 2 * point), at(coordinates, 2 * point + 1))) needed--;
  }
  return needed === 0;
}

/** Labels that only one found, the predictions on them, and false positives of one alone. */
function linesOf(image: MatchedImage, labels: ReadonlySet<string>, alarms: ReadonlySet<number>): Set<number> {
  const tells = (line: MatchedLine): boolean => {
    if (line.kind === "label") return labels.has(line.name);
    if (line.layer === "fp") return alarms.has(line.index);
    const partner = line.partner === null ? undefined : image.lines[line.partner];
    return line.layer === "tp" && partner !== undefined && labels.has(partner.name);
  };
  return new Set(image.lines.filter(tells).map(({ index }) => index));
}
