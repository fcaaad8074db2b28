/** Wheel, drag, pinch, hover and click on an element, as what they mean for a view. */

import { clamp, type Point } from "./geometry";

export interface GestureTarget {
  zoom(at: Point, factor: number): void;
  pan(dx: number, dy: number): void;
  /** The pointer rests or moves above the element without a button; null when it leaves. */
  hover(at: Point | null): void;
  click(at: Point, how: ClickManner): void;
  /** What gets the drag that begins now instead of the view; null where nothing does. */
  beginDrag(): DragTarget | null;
}

export interface ClickManner {
  readonly touch: boolean;
  readonly shift: boolean;
}

/** Gets one drag, from its press on. */
export interface DragTarget {
  down(at: Point, shift: boolean): void;
  move(at: Point): void;
  up(at: Point): void;
  cancel(): void;
}

/** Movement below this is a click with an unsteady hand (px). */
const CLICK_SLACK = 4;
/** Zoom per wheel px; a notch of a mouse is about 100. */
const WHEEL_SPEED = 0.0016;
/** Trackpads send a pinch as a wheel with Ctrl, in much smaller steps. */
const PINCH_SPEED = 0.01;
/** A wheel delta above this comes from a notch, with Ctrl held by hand, not from a pinch (px). */
const NOTCH = 50;
/** A wheel that spins freely sends huge deltas; one event zooms by a factor of e at most. */
const LARGEST_STEP = 1;
const LINE_HEIGHT = 16;
const PAGE_HEIGHT = 400;

interface Finger {
  start: Point;
  last: Point;
  moved: boolean;
}

function wheelUnit({ deltaMode }: WheelEvent): number {
  if (deltaMode === WheelEvent.DOM_DELTA_LINE) return LINE_HEIGHT;
  return deltaMode === WheelEvent.DOM_DELTA_PAGE ? PAGE_HEIGHT : 1;
}

function pinchSpeed({ deltaY }: WheelEvent): number {
  return Math.abs(deltaY) < NOTCH ? PINCH_SPEED : WHEEL_SPEED;
}

/** Listens on the element until the returned function is called. */
export function listenToGestures(element: HTMLElement, target: GestureTarget): () => void {
  const fingers = new Map<number, Finger>();
  let drag: { readonly pointerId: number; readonly target: DragTarget } | null = null;
  const controller = new AbortController();
  const options = { signal: controller.signal };

  function place(event: MouseEvent): Point {
    const box = element.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  }

  function onWheel(event: WheelEvent): void {
    event.preventDefault();
    const unit = wheelUnit(event);
    const sideways = event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY);
    if (event.ctrlKey || event.metaKey) zoom(event, event.deltaY * unit * pinchSpeed(event));
    else if (sideways) target.pan(-(event.deltaX + (event.shiftKey ? event.deltaY : 0)) * unit, 0);
    else zoom(event, event.deltaY * unit * WHEEL_SPEED);
  }

  function zoom(event: WheelEvent, amount: number): void {
    target.zoom(place(event), Math.exp(-clamp(amount, -LARGEST_STEP, LARGEST_STEP)));
  }

  function onDown(event: PointerEvent): void {
    if (event.button !== 0 && event.button !== 1) return;
    element.setPointerCapture(event.pointerId);
    const at = place(event);
    fingers.set(event.pointerId, { start: at, last: at, moved: false });
    // Two fingers mean the view, whatever the first one began.
    if (fingers.size > 1) endDrag();
    else if (event.button === 0) beginDrag(event, at);
  }

  function beginDrag(event: PointerEvent, at: Point): void {
    const begun = target.beginDrag();
    if (begun === null) return;
    drag = { pointerId: event.pointerId, target: begun };
    begun.down(at, event.shiftKey);
  }

  function endDrag(): void {
    drag?.target.cancel();
    drag = null;
  }

  function onMove(event: PointerEvent): void {
    const at = place(event);
    const finger = fingers.get(event.pointerId);
    if (finger === undefined) {
      if (event.pointerType !== "touch") target.hover(at);
      return;
    }
    if (drag?.pointerId === event.pointerId) {
      finger.last = at;
      drag.target.move(at);
      return;
    }
    if (!finger.moved && Math.hypot(at.x - finger.start.x, at.y - finger.start.y) < CLICK_SLACK) return;
    finger.moved = true;
    const other = [...fingers.values()].find((candidate) => candidate !== finger);
    if (other === undefined) target.pan(at.x - finger.last.x, at.y - finger.last.y);
    else pinch(finger.last, at, other.last);
    finger.last = at;
    element.classList.add("is-dragging");
  }

  function pinch(from: Point, to: Point, fixed: Point): void {
    const before = Math.hypot(from.x - fixed.x, from.y - fixed.y);
    const after = Math.hypot(to.x - fixed.x, to.y - fixed.y);
    target.pan((to.x - from.x) / 2, (to.y - from.y) / 2);
    if (before > 0) target.zoom({ x: (to.x + fixed.x) / 2, y: (to.y + fixed.y) / 2 }, after / before);
  }

  function onUp(event: PointerEvent): void {
    const finger = fingers.get(event.pointerId);
    fingers.delete(event.pointerId);
    if (fingers.size === 0) element.classList.remove("is-dragging");
    if (drag?.pointerId === event.pointerId) {
      if (event.type === "pointerup") drag.target.up(place(event));
      else drag.target.cancel();
      drag = null;
      return;
    }
    if (finger && !finger.moved && event.type === "pointerup" && event.button === 0) {
      target.click(place(event), { touch: event.pointerType === "touch", shift: event.shiftKey });
    }
  }

  element.addEventListener("wheel", onWheel, { ...options, passive: false });
  element.addEventListener("pointerdown", onDown, options);
  element.addEventListener("pointermove", onMove, options);
  element.addEventListener("pointerup", onUp, options);
  element.addEventListener("pointercancel", onUp, options);
  element.addEventListener("pointerleave", () => target.hover(null), options);
  return () => controller.abort();
}
