/** One image on the screen: viewport, gestures and drawing together, without any framework. */

import { follow } from "./follow";
import { boxCentre, type Point } from "./geometry";
import { listenToGestures } from "./gestures";
import { between, glide } from "./glide";
import type { LineLook } from "./layers/line_layer";
import { Renderer } from "./renderer";
import { EMPTY_SCENE, type Hit, type Scene } from "./scene";
import type { StageTrace } from "./stage_trace";
import {
  centreOn,
  fitScale,
  fitted,
  keepInReach,
  pan,
  type Size,
  sameViewport,
  toImage,
  toScreen,
  type Viewport,
  zoomAt,
} from "./viewport";

/** How far from a line a pointer still means it (screen px). */
const MOUSE_REACH = 7;
const TOUCH_REACH = 18;
/** One press of a zoom key. */
const ZOOM_STEP = 1.4;
/** Screen px per image px at which single pixels can be told apart. */
const CLOSE_SCALE = 6;
/** Two clicks this close to each other are at one place (screen px). */
const SAME_PLACE = 3;

export interface ViewListener {
  /** The line under the pointer, and where on the screen the pointer is. */
  hover(index: number | null, screen: Point | null): void;
  /** Lines at the clicked place, nearest first; `again` where the click before was there too. */
  click(hits: readonly Hit[], again: boolean): void;
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
  private viewport: Viewport = { scale: 1, offsetX: 0, offsetY: 0 };
  private screen: Size = { width: 1, height: 1 };
  private imageSize: Size = { width: 1, height: 1 };
  private scene: Scene = EMPTY_SCENE;
  private visible: (index: number) => boolean = () => true;
  /** The whole image is shown, and stays so when the window changes. */
  private fitted = true;
  private hovered: number | null = null;
  private selected: number | null = null;
  /** Where the view was before it zoomed for a tiny or huge line; it goes back there for the next one. */
  private beforeZoom: Viewport | null = null;
  /** Where a gliding view is going. */
  private goal: Viewport | null = null;
  private stopGlide: () => void = () => undefined;
  private lastClick: Point | null = null;

  constructor(host: HTMLElement, canvases: ViewCanvases, listener: ViewListener) {
    this.host = host;
    this.listener = listener;
    this.renderer = new Renderer(canvases.image, canvases.lines, canvases.highlights, listener.painted);
    this.stopGestures = listenToGestures(host, {
      zoom: (position, factor) => {
        this.moveTo(zoomAt(this.viewport, position, factor, this.minScale()));
        this.hover(position);
      },
      pan: (dx, dy) => this.moveTo(pan(this.viewport, dx, dy)),
      hover: (position) => this.hover(position),
      click: (position, touch) => this.click(position, touch ? TOUCH_REACH : MOUSE_REACH),
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
    this.stopGlide();
    this.renderer.stop();
  }

  /** Shows another image, fitted; its bitmap may come later. */
  open(imageSize: Size): void {
    this.imageSize = imageSize;
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
    this.fit();
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

  get current(): Viewport {
    return this.viewport;
  }

  /** Shows the same part of the image as another view, whose movements this one goes along with. */
  mirror(viewport: Viewport): void {
    this.stopGlide();
    this.goal = null;
    this.beforeZoom = null;
    this.setViewport(viewport, false);
    this.fitted = sameViewport(this.viewport, fitted(this.imageSize, this.screen));
  }

  fit(): void {
    this.moveTo(fitted(this.imageSize, this.screen));
    this.fitted = true;
  }

  /** Zooms at the selected line, which is what one wants to see closer, else at the middle. */
  zoomStep(direction: 1 | -1): void {
    this.moveTo(zoomAt(this.viewport, this.zoomCentre(), ZOOM_STEP ** direction, this.minScale()));
  }

  /** Moves by shares of the screen. */
  panStep(dx: number, dy: number): void {
    this.moveTo(pan(this.viewport, dx * this.screen.width, dy * this.screen.height));
  }

  /** Brings a line onto the screen if it isn't there, or is too small to be judged. */
  show(index: number): void {
    const box = this.scene.boxes[index];
    if (box === undefined) return;
    const from = this.beforeZoom ?? this.goal ?? this.viewport;
    const wasFitted = this.fitted;
    const to = follow(from, box, this.screen);
    this.beforeZoom = to.scale === from.scale ? null : from;
    this.glideTo(to);
    this.fitted = wasFitted && to === from;
  }

  /** Goes close to a position for a look; the next line is shown from where the view was. */
  lookAt(position: Point): void {
    const from = this.beforeZoom ?? this.goal ?? this.viewport;
    this.glideTo(centreOn(position, Math.max(from.scale, CLOSE_SCALE), this.screen));
    this.beforeZoom = from;
    this.fitted = false;
  }

  /** A movement that the person made: the view stays there. */
  private moveTo(viewport: Viewport): void {
    this.stopGlide();
    this.goal = null;
    this.beforeZoom = null;
    this.lastClick = null;
    this.setViewport(viewport);
  }

  private glideTo(wanted: Viewport): void {
    const goal = keepInReach(wanted, this.imageSize, this.screen);
    this.stopGlide();
    this.goal = null;
    if (sameViewport(goal, this.viewport)) return;
    const start = this.viewport;
    this.goal = goal;
    this.lastClick = null;
    this.stopGlide = glide((share) => {
      this.setViewport(between(start, goal, share, this.screen));
      if (share >= 1) this.goal = null;
    });
  }

  private zoomCentre(): Point {
    const { width, height } = this.screen;
    const box = this.selected === null ? undefined : this.scene.boxes[this.selected];
    const centre = box === undefined ? null : boxCentre(box);
    const place = centre === null ? null : toScreen(this.viewport, centre.x, centre.y);
    const seen = place !== null && place.x >= 0 && place.y >= 0 && place.x <= width && place.y <= height;
    return seen ? place : { x: width / 2, y: height / 2 };
  }

  private minScale(): number {
    return Math.min(1, fitScale(this.imageSize, this.screen)) / 2;
  }

  private setViewport(wanted: Viewport, aloud = true): void {
    const viewport = keepInReach(wanted, this.imageSize, this.screen);
    if (sameViewport(viewport, this.viewport)) return;
    this.viewport = viewport;
    this.fitted = false;
    // Another line may be under the resting pointer now; it counts again once it moves.
    if (this.hovered !== null) this.hover(null);
    this.renderer.update({ viewport }, "view");
    if (aloud) this.listener.viewChanged(viewport);
  }

  private hover(position: Point | null): void {
    const hit = position === null ? undefined : this.hits(position, MOUSE_REACH)[0];
    const index = hit?.index ?? null;
    if (index !== this.hovered) {
      this.hovered = index;
      this.renderer.update({ hovered: index }, "highlights");
    }
    this.listener.hover(index, position);
  }

  private click(position: Point, reach: number): void {
    const last = this.lastClick;
    const again = last !== null && Math.hypot(position.x - last.x, position.y - last.y) <= SAME_PLACE;
    this.lastClick = position;
    this.listener.click(this.hits(position, reach), again);
  }

  private hits(position: Point, reach: number): Hit[] {
    const { x, y } = toImage(this.viewport, position.x, position.y);
    return this.scene.near(x, y, reach / this.viewport.scale, this.visible);
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
    this.screen = { width: Math.max(1, box.width), height: Math.max(1, box.height) };
    this.renderer.resize(this.screen, window.devicePixelRatio || 1);
    if (this.fitted) this.fit();
    else this.moveTo(this.goal ?? this.viewport);
  }
}
