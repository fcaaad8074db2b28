/**
 * Draws whole pictures of lines, where it can ahead of time: the picture of an image that may be opened next is ready
 * before anybody asks for it.
 */

import { frameOf, sameFrame } from "./frame";
import type { LineLook } from "./layers/line_layer";
import { packLines, sameLines } from "./layers/packed_lines";
import { imageBox } from "./layers/regions";
import type { Drawing } from "./picture_task";
import type { Scene } from "./scene";
import { fitted, type Size, type Viewport } from "./viewport";

/** Prepared pictures together, 4 bytes each: 64 MB. */
const MOST_PIXELS = 16e6;

interface Prepared extends Drawing {
  readonly picture: Promise<ImageBitmap>;
  /** Once it is drawn. */
  bitmap: ImageBitmap | null;
}

export class LinePainter {
  private readonly draw: (drawing: Drawing) => Promise<ImageBitmap>;
  /** The latest is the last. */
  private readonly prepared = new Map<Scene, Prepared>();
  private screen: { readonly size: Size; readonly ratio: number } | null = null;

  constructor(draw: (drawing: Drawing) => Promise<ImageBitmap>) {
    this.draw = draw;
  }

  /** Tells how large the pictures are that will be asked for. */
  setScreen(size: Size, ratio: number): void {
    this.screen = { size, ratio };
  }

  /** All that a picture of a scene consists of. */
  drawingOf(scene: Scene, look: LineLook, viewport: Viewport, size: Size, ratio: number): Drawing {
    const frame = frameOf(viewport, size, ratio);
    const whole = { minX: 0, minY: 0, maxX: frame.width, maxY: frame.height };
    const seen = scene.places.touching(imageBox(whole, viewport, ratio, frame.margin));
    return { lines: packLines(scene, look, viewport.scale, seen), styles: look.styles, frame };
  }

  /** The picture, at once where it is ready. Whoever gets it closes it. */
  paint(scene: Scene, drawing: Drawing): ImageBitmap | Promise<ImageBitmap> {
    const prepared = this.prepared.get(scene);
    if (prepared !== undefined) {
      this.prepared.delete(scene);
      if (sameDrawing(prepared, drawing)) return prepared.bitmap ?? prepared.picture;
      discard(prepared);
    }
    return this.draw(drawing);
  }

  /** Draws the picture that opening an image will ask for, once it is known how large that is. */
  prepare(scene: Scene, look: LineLook, image: Size): void {
    if (this.screen === null) return;
    const { size, ratio } = this.screen;
    const drawing = this.drawingOf(scene, look, fitted(image, size), size, ratio);
    const before = this.prepared.get(scene);
    if (before !== undefined && sameDrawing(before, drawing)) return;
    const picture = this.draw(drawing);
    const prepared: Prepared = { ...drawing, picture, bitmap: null };
    picture.then(
      (bitmap) => {
        prepared.bitmap = bitmap;
      },
      () => this.forget(scene, prepared),
    );
    if (before !== undefined) this.forget(scene, before);
    this.prepared.set(scene, prepared);
    this.forgetOldest();
  }

  private forget(scene: Scene, prepared: Prepared): void {
    if (this.prepared.get(scene) !== prepared) return;
    this.prepared.delete(scene);
    discard(prepared);
  }

  private forgetOldest(): void {
    let pixels = 0;
    for (const [scene, prepared] of [...this.prepared].reverse()) {
      pixels += prepared.frame.width * prepared.frame.height;
      if (pixels > MOST_PIXELS) this.forget(scene, prepared);
    }
  }
}

function discard({ picture }: Prepared): void {
  picture.then(
    (bitmap) => bitmap.close(),
    () => undefined,
  );
}

function sameDrawing(a: Drawing, b: Drawing): boolean {
  const sameStyles =
    a.styles.length === b.styles.length && a.styles.every((style, i) => style === b.styles[i]);
  return sameStyles && sameFrame(a.frame, b.frame) && sameLines(a.lines, b.lines);
}
