/** One image on the screen: navigation, gestures and drawing together, without any framework. */

import type { Point } from "./geometry";
import { type ClickManner, listenToGestures } from "./gestures";
import type { LineLook } from "./layers/line_layer";
import { Navigation } from "./navigation";
import type { PointerTool } from "./pointer_tool";
import { Renderer } from "./renderer";
import { EMPTY_SCENE, type Hit, type Scene } from "./scene";
import type { StageTrace } from "./stage_trace";
import { ToolHand } from "./tool_hand";
import { type Size, toImage, type Viewport } from "./viewport";

/** How far from a line a pointer still means it (screen px). */
const MOUSE_REACH = 7;
const TOUCH_REACH = 18;
/** Two clicks this close to each other are at one place (screen px). */
const SAME_PLACE = 3;

export interface ViewListener {
  /** The line under the pointer, and where on the screen the pointer is. */
  hover(index: number | null, screen: Point | null): void;
  /**
   * Lines at the clicked place, nearest first; `again` where the click before was there too, `shift` where the key
   * was held.
   */
  click(hits: readonly Hit[], again: boolean, shift: boolean): void;
  /** The view moved, by hand or by itself, but not along with another one. */
  viewChanged(viewport: Viewport): void;
  /** Image and lines are on the screen, or aren't any more because others were opened. */
  painted(complete: boolean): void;
}

export interface ViewCanvases {
  readonly image: HTMLCanvasElement;
  readonly lines: HTMLCanvasElement;
  readonly highlights: HTMLCanvasElement;
}

export class CanvasView {
  private readonly host: HTMLElement;
  private readonly listener: ViewListener;
  private readonly renderer: Renderer;
  private readonly stopGestures: () => void;
  private readonly resizes: ResizeObserver;
  private readonly controller = new AbortController();
  private readonly navigation: Navigation;
  private scene: Scene = EMPTY_SCENE;
  private visible: (index: number) => boolean = () => true;
  private hovered: number | null = null;
  private selected: number | null = null;
  private lastClick: Point | null = null;
  private readonly watchers = new Set<() => void>();
  private readonly hand: ToolHand;

  constructor(host: HTMLElement, canvases: ViewCanvases, listener: ViewListener) {
    this.host = host;
    this.listener = listener;
    this.renderer = new Renderer(canvases.image, canvases.lines, canvases.highlights, listener.painted);
    this.navigation = new Navigation({
      departed: () => {
        this.lastClick = null;
      },
      moved: (viewport, mirrored) => this.moved(viewport, mirrored),
    });
    this.hand = new ToolHand({
      imagePoint: (screen) => this.imagePoint(screen),
      show: (tool) => {
        host.style.cursor = tool?.cursor ?? "";
        this.renderer.update({ tool }, "highlights");
      },
    });
    this.stopGestures = listenToGestures(host, {
      zoom: (position, factor) => {
        this.navigation.zoom(position, factor);
        this.hover(position);
      },
      pan: (dx, dy) => this.navigation.pan(dx, dy),
      hover: (position) => this.hover(position),
      click: (position, how) => this.click(position, how),
      beginDrag: () => this.hand.begin(),
    });
    this.resizes = new ResizeObserver(() => this.resize());
    this.resizes.observe(host);
    this.resize();
    this.watchRatio();
  }

  dispose(): void {
    this.stopGestures();
    this.resizes.disconnect();
    this.controller.abort();
    this.navigation.dispose();
    this.renderer.stop();
  }

  /** Shows another image, fitted; its bitmap may come later. */
  open(imageSize: Size): void {
    this.cancelDrag();
    this.scene = EMPTY_SCENE;
    this.hovered = null;
    this.selected = null;
    this.lastClick = null;
    this.renderer.update(
      {
        image: null,
        imageSize,
        scene: EMPTY_SCENE,
        selected: null,
        hovered: null,
        companions: [],
        stages: null,
      },
      "image",
      "scene",
    );
    this.navigation.open(imageSize);
  }

  setImage(image: CanvasImageSource | null): void {
    this.renderer.update({ image }, "image");
  }

  setScene(scene: Scene): void {
    this.scene = scene;
    this.renderer.update({ scene }, "scene");
    // What was under the pointer belonged to another scene.
    if (this.hovered !== null) this.hover(null);
  }

  /** @param changed The lines that look different now; absent where any may. */
  setLook(look: LineLook, changed?: readonly number[]): void {
    this.visible = look.visible;
    if (changed === undefined) this.renderer.update({ look }, "lines");
    else this.renderer.updateLook(look, changed);
  }

  /** @param companions Lines that belong to the selected one and are pointed out with it. */
  setSelected(selected: number | null, companions: readonly number[] = []): void {
    this.selected = selected;
    this.renderer.update({ selected, companions }, "highlights");
  }

  /** Draws how a line was found in place of its highlight, as long as it is selected; null: no longer. */
  setStages(stages: StageTrace | null, marked: number | null): void {
    this.renderer.update({ stages, markedGap: marked }, "highlights");
  }

  /** What drags do from now on; null: they move the view. A drag under way ends with the tool it began with. */
  setTool(tool: PointerTool | null): void {
    if (this.hand.take(tool) && tool !== null) this.hoverLine(null, null);
  }

  /** Ends a tool's drag as if it had never begun; false where there is none. */
  cancelDrag(): boolean {
    return this.hand.cancel();
  }

  /** Visible lines that a straight stroke between image positions touches; the radius is in screen px. */
  linesAlong(from: Point, to: Point, radius: number): number[] {
    return this.scene.along(from, to, radius / this.navigation.current.scale, this.visible);
  }

  /** Visible lines within a radius (screen px) of an image position, nearest first. */
  linesNear({ x, y }: Point, radius: number): Hit[] {
    return this.scene.near(x, y, radius / this.navigation.current.scale, this.visible);
  }

  /** Visible lines that a closed polygon of image positions goes around, by one half at least. */
  linesWithin(polygon: readonly Point[]): number[] {
    return this.scene.within(polygon, this.visible);
  }

  /** Visible lines of which at least one half is on the screen. */
  linesOnScreen(): number[] {
    return this.scene.inBox(this.navigation.seen, this.visible);
  }

  /** Draws the tool again in the next frame. */
  redrawTool(): void {
    this.renderer.update({}, "highlights");
  }

  /** Calls back whenever the view moves, until the returned function is called. */
  watchMoves(watcher: () => void): () => void {
    this.watchers.add(watcher);
    return () => this.watchers.delete(watcher);
  }

  get current(): Viewport {
    return this.navigation.current;
  }

  /** Shows the same part of the image as another view, whose movements this one goes along with. */
  mirror(viewport: Viewport): void {
    this.navigation.mirror(viewport);
  }

  fit(): void {
    this.navigation.fit();
  }

  /** Zooms at the selected line, which is what one wants to see closer, else at the middle. */
  zoomStep(direction: 1 | -1): void {
    const line = this.selected === null ? undefined : this.scene.boxes[this.selected];
    this.navigation.zoomStep(direction, line);
  }

  /** Moves by shares of the screen. */
  panStep(dx: number, dy: number): void {
    this.navigation.panStep(dx, dy);
  }

  /** Brings a line onto the screen if it isn't there, or is too small to be judged. */
  show(index: number): void {
    const box = this.scene.boxes[index];
    if (box !== undefined) this.navigation.show(box);
  }

  /** Goes close to a position for a look; the next line is shown from where the view was. */
  lookAt(position: Point): void {
    this.navigation.lookAt(position);
  }

  private moved(viewport: Viewport, mirrored: boolean): void {
    // Another line may be under the resting pointer now; it counts again once it moves.
    if (this.hovered !== null) this.hover(null);
    this.renderer.update({ viewport }, "view");
    if (!mirrored) this.listener.viewChanged(viewport);
    for (const watcher of this.watchers) watcher();
  }

  private imagePoint({ x, y }: Point): Point {
    return toImage(this.navigation.current, x, y);
  }

  private hover(position: Point | null): void {
    if (this.hand.hover(position)) return;
    this.hoverLine(position === null ? null : (this.hits(position, MOUSE_REACH)[0]?.index ?? null), position);
  }

  private hoverLine(index: number | null, position: Point | null): void {
    if (index !== this.hovered) {
      this.hovered = index;
      this.renderer.update({ hovered: index }, "highlights");
    }
    this.listener.hover(index, position);
  }

  private click(position: Point, { touch, shift }: ClickManner): void {
    const last = this.lastClick;
    const again = last !== null && Math.hypot(position.x - last.x, position.y - last.y) <= SAME_PLACE;
    this.lastClick = position;
    this.listener.click(this.hits(position, touch ? TOUCH_REACH : MOUSE_REACH), again, shift);
  }

  private hits(position: Point, reach: number): Hit[] {
    return this.linesNear(this.imagePoint(position), reach);
  }

  /** A window on another screen has other pixels in the same size. */
  private watchRatio(): void {
    const { signal } = this.controller;
    const again = () => {
      this.resize();
      this.watchRatio();
    };
    window
      .matchMedia(`(resolution: ${window.devicePixelRatio}dppx)`)
      .addEventListener("change", again, { once: true, signal });
  }

  private resize(): void {
    const box = this.host.getBoundingClientRect();
    const screen: Size = { width: Math.max(1, box.width), height: Math.max(1, box.height) };
    this.renderer.resize(screen, window.devicePixelRatio || 1);
    this.navigation.resize(screen);
  }
}
