/** Where the view goes when a line is selected by key. */

import { type Box, boxCentre, boxContains, boxExtent, clamp, growBox } from "./geometry";
import { centreOn, MAX_SCALE, type Size, type Viewport, visibleBox } from "./viewport";

/** Shorter than this on the screen, a line can't be judged (px). */
const READABLE = 14;
/** What a line is enlarged to when it is too small (px). */
const COMFORTABLE = 120;
/** Free space around a line that is brought onto the screen, as a share of the screen. */
const EDGE = 0.04;
/** A line that sticks out by less still counts as seen (px). */
const SLACK = 2;

/**
 * The viewport that shows a box: the same one where the box is on the screen and large enough, else moved,
 * and scaled only as far as needed.
 */
export function follow(viewport: Viewport, box: Box, screen: Size): Viewport {
  const extent = Math.max(boxExtent(box), 1);
  const onScreen = extent * viewport.scale;
  const roomX = screen.width * (1 - 2 * EDGE);
  const roomY = screen.height * (1 - 2 * EDGE);
  const largest = Math.min(
    roomX / Math.max(box.maxX - box.minX, 1),
    roomY / Math.max(box.maxY - box.minY, 1),
    MAX_SCALE,
  );
  const tiny = onScreen < READABLE;
  const seen = growBox(visibleBox(viewport, screen), SLACK / viewport.scale);
  if (!tiny && boxContains(seen, box)) return viewport;
  const wanted = tiny ? COMFORTABLE / extent : viewport.scale;
  return centreOn(boxCentre(box), clamp(wanted, 1e-3, largest), screen);
}
