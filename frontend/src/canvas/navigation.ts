/** Where the view is and where it goes: by hand, along to a line, or with another view. */

import { follow } from "./follow";
import { type Box, boxCentre, type Point } from "./geometry";
import { between, glide } from "./glide";
import {
  centreOn,
  fitScale,
  fitted,
  keepInReach,
  pan,
  type Size,
  sameViewport,
  toScreen,
  type Viewport,
  visibleBox,
  zoomAt,
} from "./viewport";

/** One press of a zoom key. */
const ZOOM_STEP = 1.4;
/** Screen px per image px at which single pixels can be told apart. */
const CLOSE_SCALE = 6;

export interface NavigationListener {
  /** A movement of this view's own begins, even one that leads nowhere. */
  departed(): void;
  /** The view is elsewhere; `mirrored` where it only went along with another one. */
  moved(viewport: Viewport, mirrored: boolean): void;
}

export class Navigation {
  private readonly listener: NavigationListener;
  private viewport: Viewport = { scale: 1, offsetX: 0, offsetY: 0 };
  private screen: Size = { width: 1, height: 1 };
  private imageSize: Size = { width: 1, height: 1 };
  /** The whole image is shown, and stays so when the window changes. */
  private fitted = true;
  /** Where the view was before it zoomed for a tiny or huge line; it goes back there for the next one. */
  private beforeZoom: Viewport | null = null;
  /** Where a gliding view is going. */
  private goal: Viewport | null = null;
  private stopGlide: () => void = () => undefined;

  constructor(listener: NavigationListener) {
    this.listener = listener;
  }

  dispose(): void {
    this.stopGlide();
  }

  get current(): Viewport {
    return this.viewport;
  }

  /** The part of the image plane that is seen, or will be once a glide has come to its end. */
  get seen(): Box {
    return visibleBox(this.goal ?? this.viewport, this.screen);
  }

  /** Goes to another image, all of it. */
  open(imageSize: Size): void {
    this.imageSize = imageSize;
    this.fit();
  }

  resize(screen: Size): void {
    this.screen = screen;
    if (this.fitted) this.fit();
    else this.moveTo(this.goal ?? this.viewport);
  }

  fit(): void {
    this.moveTo(fitted(this.imageSize, this.screen));
    this.fitted = true;
  }

  pan(dx: number, dy: number): void {
    this.moveTo(pan(this.viewport, dx, dy));
  }

  /** Moves by shares of the screen. */
  panStep(dx: number, dy: number): void {
    this.pan(dx * this.screen.width, dy * this.screen.height);
  }

  zoom(position: Point, factor: number): void {
    const minScale = Math.min(1, fitScale(this.imageSize, this.screen)) / 2;
    this.moveTo(zoomAt(this.viewport, position, factor, minScale));
  }

  /** Zooms at what one wants to see closer if it is in view, else at the middle. */
  zoomStep(direction: 1 | -1, wanted: Box | undefined): void {
    this.zoom(this.zoomCentre(wanted), ZOOM_STEP ** direction);
  }

  /** Brings a box onto the screen if it isn't there, or is too small to be judged. */
  show(box: Box): void {
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

  /** Shows the same part of the image as another view, whose movements this one goes along with. */
  mirror(viewport: Viewport): void {
    this.stopGlide();
    this.goal = null;
    this.beforeZoom = null;
    this.setViewport(viewport, true);
    this.fitted = sameViewport(this.viewport, fitted(this.imageSize, this.screen));
  }

  /** A movement that the person made: the view stays there. */
  private moveTo(viewport: Viewport): void {
    this.stopGlide();
    this.goal = null;
    this.beforeZoom = null;
    this.listener.departed();
    this.setViewport(viewport);
  }

  private glideTo(wanted: Viewport): void {
    const goal = keepInReach(wanted, this.imageSize, this.screen);
    this.stopGlide();
    this.goal = null;
    if (sameViewport(goal, this.viewport)) return;
    const start = this.viewport;
    this.goal = goal;
    this.listener.departed();
    this.stopGlide = glide((share) => {
      this.setViewport(between(start, goal, share, this.screen));
      if (share >= 1) this.goal = null;
    });
  }

  private zoomCentre(wanted: Box | undefined): Point {
    const { width, height } = this.screen;
    const centre = wanted === undefined ? null : boxCentre(wanted);
    const place = centre === null ? null : toScreen(this.viewport, centre.x, centre.y);
    const seen = place !== null && place.x >= 0 && place.y >= 0 && place.x <= width && place.y <= height;
    return seen ? place : { x: width / 2, y: height / 2 };
  }

  private setViewport(wanted: Viewport, mirrored = false): void {
    const viewport = keepInReach(wanted, this.imageSize, this.screen);
    if (sameViewport(viewport, this.viewport)) return;
    this.viewport = viewport;
    this.fitted = false;
    this.listener.moved(viewport, mirrored);
  }
}
