import { gridLines, type Lens, type Point, undistort } from "./lens";

/** An even grid of the image, and where it comes to lie once the lens is taken out. */
export function LensPlot({ lens, accepted }: { lens: Lens; accepted: boolean }) {
  const lines = gridLines(lens, 10);
  const corrected = lines.map((line) => line.map((point) => undistort(lens, point)));
  const box = boundingBox([...lines.flat(), ...corrected.flat()]);
  const margin = 0.01 * lens.width;
  return (
    <svg
      className={`lens-plot${accepted ? "" : " lens-plot--refused"}`}
      viewBox={`${box.left - margin} ${box.top - margin} ${box.width + 2 * margin} ${box.height + 2 * margin}`}
      role="img"
      aria-label="The image's pixel grid, and the same grid after the correction"
    >
      <path className="lens-plot__measured" d={pathOf(lines)} vectorEffect="non-scaling-stroke" />
      <path className="lens-plot__corrected" d={pathOf(corrected)} vectorEffect="non-scaling-stroke" />
    </svg>
  );
}

function pathOf(lines: readonly Point[][]): string {
  return lines
    .map((line) => `M${line.map(([x, y]) => `${x.toFixed(1)} ${y.toFixed(1)}`).join("L")}`)
    .join("");
}

function boundingBox(points: readonly Point[]) {
  const xs = points.map(([x]) => x);
  const ys = points.map(([, y]) => y);
  const left = Math.min(...xs);
  const top = Math.min(...ys);
  return { left, top, width: Math.max(...xs) - left, height: Math.max(...ys) - top };
}
