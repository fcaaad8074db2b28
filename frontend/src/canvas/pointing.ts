/** Which line a mouse or a finger means. */

import type { Point } from "./geometry";
import type { ClickManner } from "./gestures";
import type { Hit } from "./scene";

/** How far from a line a pointer still means it (screen px). */
const MOUSE_REACH = 7;
const TOUCH_REACH = 18;
/** Two clicks this close to each other are at one place (screen px). */
const SAME_PLACE = 3;

export interface PointingListener {
  /** The line under the pointer, and where on the screen the pointer is. */
  hover(index: number | null, screen: Point | null): void;
  /**
   * Lines at the clicked place, nearest first; `again` where the click before was there too, `shift` where the key
   * was held.
   */
  click(hits: readonly Hit[], again: boolean, shift: boolean): void;
}

interface PointingParts {
  readonly listener: PointingListener;
  /** Visible lines within a radius of a place, nearest first; both in screen px. */
  readonly hits: (screen: Point, radius: number) => Hit[];
  /** Another line than before is under the pointer, or none is. */
  readonly highlight: (index: number | null) => void;
}

export class Pointing {
  private readonly parts: PointingParts;
  private hovered: number | null = null;
  private lastClick: Point | null = null;

  constructor(parts: PointingParts) {
    this.parts = parts;
  }

  hover(screen: Point | null): void {
    const index = screen === null ? null : (this.parts.hits(screen, MOUSE_REACH)[0]?.index ?? null);
    this.point(index, screen);
  }

  click(screen: Point, { touch, shift }: ClickManner): void {
    const last = this.lastClick;
    const again = last !== null && Math.hypot(screen.x - last.x, screen.y - last.y) <= SAME_PLACE;
    this.lastClick = screen;
    this.parts.listener.click(this.parts.hits(screen, touch ? TOUCH_REACH : MOUSE_REACH), again, shift);
  }

  /** No line is pointed at until the pointer moves again. */
  letGo(): void {
    this.point(null, null);
  }

  /** Something else may be under the resting pointer now. */
  moved(): void {
    if (this.hovered !== null) this.letGo();
  }

  /** The next click is at another place, wherever on the screen it is. */
  departed(): void {
    this.lastClick = null;
  }

  /** Another image begins; nobody has to be told. */
  reset(): void {
    this.hovered = null;
    this.lastClick = null;
  }

  private point(index: number | null, screen: Point | null): void {
    if (index !== this.hovered) {
      this.hovered = index;
      this.parts.highlight(index);
    }
    this.parts.listener.hover(index, screen);
  }
}
