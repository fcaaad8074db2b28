/** One image on the screen: navigation, gestures and drawing together, without any framework. */

import type { Point } from "./geometry";
import { listenToGestures } from "./gestures";
import type { LineLook } from "./layers/line_layer";
import { Navigation } from "./navigation";
import type { PointerTool } from "./pointer_tool";
import { Pointing, type PointingListener } from "./pointing";
import { Renderer } from "./renderer";
import { EMPTY_SCENE, type Hit, type Scene } from "./scene";
import type { StageTrace } from "./stage_trace";
import { ToolHand } from "./tool_hand";
import { type Size, toImage, type Viewport } from "./viewport";
import { watchSize } from "./watch_size";

export interface ViewListener extends PointingListener {
  /** The view moved, by hand or by itself, but not along with another one. */
  viewChanged(viewport: Viewport): void;
  /** Image and lines are on the screen, or aren't any more because others were opened. */
  painted(complete: boolean): void;
}

export interface ViewCanvases {
  readonly image: HTMLCanvasElement;
  /** Above the image. */
  readonly lines: HTMLCanvasElement;
}

export class CanvasView {
  private readonly listener: ViewListener;
  private readonly renderer: Renderer;
  private readonly stopGestures: () => void;
  private readonly stopWatching: () => void;
  private readonly navigation: Navigation;
  private scene: Scene = EMPTY_SCENE;
  private visible: (index: number) => boolean = () => true;
  private selected: number | null = null;
  private readonly watchers = new Set<() => void>();
  private readonly hand: ToolHand;
  private readonly pointing: Pointing;

  constructor(host: HTMLElement, canvases: ViewCanvases, listener: ViewListener) {
    this.listener = listener;
    this.renderer = new Renderer(canvases.image, canvases.lines, listener.painted);
    this.navigation = new Navigation({
      departed: () => this.pointing.departed(),
      moved: (viewport, mirrored) => this.moved(viewport, mirrored),
    });
    this.hand = new ToolHand({
      imagePoint: (screen) => this.imagePoint(screen),
      show: (tool) => {
        host.style.cursor = tool?.cursor ?? "";
        this.renderer.update({ tool }, "highlights");
      },
    });
    this.pointing = new Pointing({
      listener,
      hits: (screen, radius) => this.linesNear(this.imagePoint(screen), radius),
      highlight: (hovered) => this.renderer.update({ hovered }, "highlights"),
    });
    this.stopGestures = listenToGestures(host, {
      zoom: (position, factor) => {
        this.navigation.zoom(position, factor);
        this.hover(position);
      },
      pan: (dx, dy) => this.navigation.pan(dx, dy),
      hover: (position) => this.hover(position),
      click: (position, how) => this.pointing.click(position, how),
      beginDrag: () => this.hand.begin(),
    });
    this.stopWatching = watchSize(host, (screen, ratio) => {
      this.renderer.resize(screen, ratio);
      this.navigation.resize(screen);
    });
  }

  dispose(): void {
    this.stopGestures();
    this.stopWatching();
    this.navigation.dispose();
    this.renderer.stop();
  }

  /** Shows another image, fitted; its bitmap may come later. */
  open(imageSize: Size): void {
    this.cancelDrag();
    this.scene = EMPTY_SCENE;
    this.selected = null;
    this.pointing.reset();
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
    this.pointing.moved();
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
    if (this.hand.take(tool) && tool !== null) this.pointing.letGo();
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
    this.pointing.moved();
    this.renderer.update({ viewport }, "view");
    if (!mirrored) this.listener.viewChanged(viewport);
    for (const watcher of this.watchers) watcher();
  }

  private imagePoint({ x, y }: Point): Point {
    return toImage(this.navigation.current, x, y);
  }

  private hover(position: Point | null): void {
    if (!this.hand.hover(position)) this.pointing.hover(position);
  }
}
