/** Has lines drawn in a worker; in the page itself where the browser gives none. */

import type { Drawing } from "./picture_task";
import type { DrawingGiven, PictureDrawn } from "./picture_worker";

interface Waiting {
  readonly drawing: Drawing;
  resolve(picture: ImageBitmap): void;
  reject(error: Error): void;
}

/** The part of a `Worker` that is needed. */
export interface WorkerLike {
  postMessage(message: DrawingGiven): void;
  addEventListener(type: "message", listener: (event: MessageEvent<PictureDrawn>) => void): void;
  addEventListener(type: "error", listener: () => void): void;
}

export class PictureDesk {
  private readonly drawHere: (drawing: Drawing) => ImageBitmap;
  private readonly waiting = new Map<number, Waiting>();
  private worker: WorkerLike | null;
  private tickets = 0;

  /**
   * @param open Starts the worker; may throw where there is none to have.
   * @param drawHere What the worker would do.
   */
  constructor(open: () => WorkerLike, drawHere: (drawing: Drawing) => ImageBitmap) {
    this.drawHere = drawHere;
    this.worker = started(open);
    this.worker?.addEventListener("message", ({ data }) => this.drawn(data));
    this.worker?.addEventListener("error", () => this.goOnAlone());
  }

  draw(drawing: Drawing): Promise<ImageBitmap> {
    const { worker } = this;
    const ticket = this.tickets++;
    return new Promise((resolve, reject) => {
      if (worker === null) {
        resolve(this.drawHere(drawing));
        return;
      }
      this.waiting.set(ticket, { drawing, resolve, reject });
      worker.postMessage({ ticket, drawing });
    });
  }

  private drawn({ ticket, picture, failure }: PictureDrawn): void {
    const asked = this.waiting.get(ticket);
    this.waiting.delete(ticket);
    if (picture === undefined) asked?.reject(new Error(failure));
    else if (asked === undefined) picture.close();
    else asked.resolve(picture);
  }

  /** The worker's file didn't load, or it broke: nothing that was asked of it is lost. */
  private goOnAlone(): void {
    this.worker = null;
    const left = [...this.waiting.values()];
    this.waiting.clear();
    for (const { drawing, resolve, reject } of left) this.draw(drawing).then(resolve, reject);
  }
}

function started(open: () => WorkerLike): WorkerLike | null {
  try {
    return open();
  } catch {
    return null;
  }
}
