/** One image before and after its lens was taken out, on the two sides of an upright edge. Without any framework. */

import type { Point } from "../../../canvas/geometry";
import { listenToGestures } from "../../../canvas/gestures";
import {
  clearSurface,
  makeSurface,
  resizeSurface,
  type Surface,
  setScreenUnits,
} from "../../../canvas/layers/surface";
import { Navigation } from "../../../canvas/navigation";
import { EMPTY_SCENE, type Hit, type Scene } from "../../../canvas/scene";
import { type Size, toImage, type Viewport } from "../../../canvas/viewport";
import { watchSize } from "../../../canvas/watch_size";
import { drawLines, drawPicture, drawRuler } from "./split_drawing";

/** How far from a line the pointer still means it (screen px). */
const REACH = 7;

export interface SplitListener {
  viewChanged(viewport: Viewport): void;
  /** The line under the pointer and the side that the pointer is on. */
  hover(index: number | null, screen: Point | null, after: boolean): void;
  click(index: number | null): void;
}

export interface Side {
  readonly picture: CanvasImageSource | null;
  readonly lines: Scene;
}

interface State {
  readonly size: Size;
  readonly before: Side;
  readonly after: Side;
  /** Colour of each line. */
  readonly colours: readonly string[];
  /** Where the edge is, as a share of the screen's width. */
  readonly share: number;
  readonly ruler: boolean;
  readonly shown: boolean;
  readonly marked: number | null;
}

const EMPTY: Side = { picture: null, lines: EMPTY_SCENE };

export class SplitView {
  private readonly surface: Surface;
  private readonly navigation: Navigation;
  private readonly listener: SplitListener;
  private readonly stops: readonly (() => void)[];
  private screen: Size = { width: 1, height: 1 };
  private ratio = 1;
  private frame: number | null = null;
  private state: State = {
    size: { width: 1, height: 1 },
    before: EMPTY,
    after: EMPTY,
    colours: [],
    share: 0.5,
    ruler: false,
    shown: true,
    marked: null,
  };

  constructor(host: HTMLElement, canvas: HTMLCanvasElement, listener: SplitListener) {
    this.listener = listener;
    this.surface = makeSurface(canvas);
    this.navigation = new Navigation({
      departed: () => undefined,
      moved: (viewport) => {
        listener.viewChanged(viewport);
        this.hover(null);
        this.schedule();
      },
    });
    const stopGestures = listenToGestures(host, {
      zoom: (at, factor) => this.navigation.zoom(at, factor),
      pan: (dx, dy) => this.navigation.pan(dx, dy),
      hover: (at) => this.hover(at),
      click: (at) => listener.click(this.hitAt(at)?.index ?? null),
      beginDrag: () => null,
    });
    const stopWatching = watchSize(host, (screen, ratio) => {
      this.screen = screen;
      this.ratio = ratio;
      resizeSurface(this.surface, screen, ratio);
      this.navigation.resize(screen);
      this.draw();
    });
    this.stops = [stopGestures, stopWatching, () => this.navigation.dispose()];
  }

  dispose(): void {
    for (const stop of this.stops) stop();
    if (this.frame !== null) cancelAnimationFrame(this.frame);
  }

  /** Another image, of which nothing is there yet; the view stays where it is if its size is the same. */
  open(size: Size): void {
    const same = size.width === this.state.size.width && size.height === this.state.size.height;
    this.set({ size, before: EMPTY, after: EMPTY, marked: null });
    if (!same) this.navigation.open(size);
  }

  set(part: Partial<State>): void {
    this.state = { ...this.state, ...part };
    this.schedule();
  }

  fit(): void {
    this.navigation.fit();
  }

  zoomStep(direction: 1 | -1): void {
    this.navigation.zoomStep(direction, undefined);
  }

  panStep(dx: number, dy: number): void {
    this.navigation.panStep(dx, dy);
  }

  private hover(at: Point | null): void {
    const index = at === null ? null : (this.hitAt(at)?.index ?? null);
    if (index !== this.state.marked) this.set({ marked: index });
    this.listener.hover(index, at, at !== null && this.isAfter(at));
  }

  private isAfter({ x }: Point): boolean {
    return x >= this.state.share * this.screen.width;
  }

  private hitAt(at: Point): Hit | null {
    if (!this.state.shown) return null;
    const viewport = this.navigation.current;
    const { x, y } = toImage(viewport, at.x, at.y);
    const { lines } = this.isAfter(at) ? this.state.after : this.state.before;
    return lines.near(x, y, REACH / viewport.scale, () => true)[0] ?? null;
  }

  private schedule(): void {
    this.frame ??= requestAnimationFrame(() => this.draw());
  }

  private draw(): void {
    if (this.frame !== null) cancelAnimationFrame(this.frame);
    this.frame = null;
    const { width, height } = this.screen;
    const edge = this.state.share * width;
    clearSurface(this.surface);
    setScreenUnits(this.surface, this.ratio);
    this.drawSide(this.state.before, 0, edge, height);
    this.drawSide(this.state.after, edge, width, height);
  }

  private drawSide(side: Side, left: number, right: number, height: number): void {
    if (right <= left) return;
    const { context } = this.surface;
    const { size, colours, ruler, shown, marked } = this.state;
    const viewport = this.navigation.current;
    context.save();
    context.beginPath();
    context.rect(left, 0, right - left, height);
    context.clip();
    drawPicture(context, side.picture, size, viewport);
    if (ruler) drawRuler(context, size, viewport);
    if (shown) drawLines(context, side.lines, colours, viewport, marked);
    context.restore();
  }
}
