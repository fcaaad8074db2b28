/** One image on the screen: viewport, gestures and drawing together, without any framework. */

import { follow } from "./follow";
import type { Point } from "./geometry";
import { listenToGestures } from "./gestures";
import type { CandidateLook } from "./layers/candidate_layer";
import { Renderer } from "./renderer";
import { EMPTY_SCENE, type Hit, type Scene } from "./scene";
import {
  fitScale,
  fitted,
  keepInReach,
  pan,
  type Size,
  sameViewport,
  toImage,
  type Viewport,
  zoomAt,
} from "./viewport";

/** How far from a line a pointer still means it (screen px). */
const MOUSE_REACH = 7;
const TOUCH_REACH = 18;
/** One press of a zoom key. */
const ZOOM_STEP = 1.4;

export interface ViewListener {
  /** The candidate under the pointer, and where the pointer is on the screen and in the image. */
  hover(index: number | null, screen: Point | null, image: Point | null): void;
  /** Candidates at the clicked place, nearest first. */
  click(hits: readonly Hit[]): void;
  viewChanged(viewport: Viewport): void;
}

export interface ViewCanvases {
  readonly image: HTMLCanvasElement;
  readonly candidates: HTMLCanvasElement;
  readonly highlights: HTMLCanvasElement;
}

export class CanvasView {
  private readonly host: HTMLElement;
  private readonly listener: ViewListener;
  private readonly renderer: Renderer;
  private readonly stopGestures: () => void;
  private readonly resizes: ResizeObserver;
  private viewport: Viewport = { scale: 1, offsetX: 0, offsetY: 0 };
  private screen: Size = { width: 1, height: 1 };
  private imageSize: Size = { width: 1, height: 1 };
  private scene: Scene = EMPTY_SCENE;
  private visible: (index: number) => boolean = () => true;
  /** The whole image is shown, and stays so when the window changes. */
  private fitted = true;
  private hovered: number | null = null;
  /** Where the view was before it zoomed in on a tiny candidate; it goes back there for the next one. */
  private beforeCloseUp: Viewport | null = null;

  constructor(host: HTMLElement, canvases: ViewCanvases, listener: ViewListener) {
    this.host = host;
    this.listener = listener;
    this.renderer = new Renderer(canvases.image, canvases.candidates, canvases.highlights);
    this.stopGestures = listenToGestures(host, {
      zoom: (position, factor) => this.moveTo(zoomAt(this.viewport, position, factor, this.minScale())),
      pan: (dx, dy) => this.moveTo(pan(this.viewport, dx, dy)),
      hover: (position) => this.hover(position),
      click: (position, touch) => listener.click(this.hits(position, touch ? TOUCH_REACH : MOUSE_REACH)),
    });
    this.resizes = new ResizeObserver(() => this.resize());
    this.resizes.observe(host);
    this.resize();
  }

  dispose(): void {
    this.stopGestures();
    this.resizes.disconnect();
    this.renderer.stop();
  }

  /** Shows another image, fitted; its bitmap may come later. */
  open(imageSize: Size): void {
    this.imageSize = imageSize;
    this.scene = EMPTY_SCENE;
    this.hovered = null;
    this.renderer.update(
      { image: null, imageSize, scene: EMPTY_SCENE, selected: null, hovered: null },
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
  }

  /** @param changed The candidates that look different now; absent where any may. */
  setLook(look: CandidateLook, changed?: readonly number[]): void {
    this.visible = look.visible;
    if (changed === undefined) this.renderer.update({ look }, "candidates");
    else this.renderer.updateLook(look, changed);
  }

  setSelected(selected: number | null): void {
    this.renderer.update({ selected }, "highlights");
  }

  fit(): void {
    this.moveTo(fitted(this.imageSize, this.screen));
    this.fitted = true;
  }

  zoomStep(direction: 1 | -1): void {
    const middle = { x: this.screen.width / 2, y: this.screen.height / 2 };
    this.moveTo(zoomAt(this.viewport, middle, ZOOM_STEP ** direction, this.minScale()));
  }

  /** Moves by shares of the screen. */
  panStep(dx: number, dy: number): void {
    this.moveTo(pan(this.viewport, dx * this.screen.width, dy * this.screen.height));
  }

  /** Brings a candidate onto the screen if it isn't there, or is too small to be judged. */
  show(index: number): void {
    const box = this.scene.boxes[index];
    if (box === undefined) return;
    const from = this.beforeCloseUp ?? this.viewport;
    const wasFitted = this.fitted;
    const to = follow(from, box, this.screen);
    this.beforeCloseUp = to.scale > from.scale ? from : null;
    this.setViewport(to);
    this.fitted = wasFitted && to === from;
  }

  /** A movement that the person made: the view stays there. */
  private moveTo(viewport: Viewport): void {
    this.beforeCloseUp = null;
    this.setViewport(viewport);
  }

  private minScale(): number {
    return Math.min(1, fitScale(this.imageSize, this.screen)) / 2;
  }

  private setViewport(wanted: Viewport): void {
    const viewport = keepInReach(wanted, this.imageSize, this.screen);
    if (sameViewport(viewport, this.viewport)) return;
    this.viewport = viewport;
    this.fitted = false;
    this.renderer.update({ viewport }, "view");
    this.listener.viewChanged(viewport);
  }

  private hover(position: Point | null): void {
    const hit = position === null ? undefined : this.hits(position, MOUSE_REACH)[0];
    const index = hit?.index ?? null;
    if (index !== this.hovered) {
      this.hovered = index;
      this.renderer.update({ hovered: index }, "highlights");
    }
    const image = position === null ? null : toImage(this.viewport, position.x, position.y);
    this.listener.hover(index, position, image);
  }

  private hits(position: Point, reach: number): Hit[] {
    const { x, y } = toImage(this.viewport, position.x, position.y);
    return this.scene.near(x, y, reach / this.viewport.scale, this.visible);
  }

  private resize(): void {
    const box = this.host.getBoundingClientRect();
    this.screen = { width: Math.max(1, box.width), height: Math.max(1, box.height) };
    this.renderer.resize(this.screen, window.devicePixelRatio || 1);
    if (this.fitted) this.fit();
    else this.setViewport(this.viewport);
  }
}
