import { describe, expect, it } from "vitest";
import { frameOf } from "./frame";
import { PictureDesk, type WorkerLike } from "./picture_desk";
import type { Drawing } from "./picture_task";
import type { DrawingGiven, PictureDrawn } from "./picture_worker";

const picture = (name: string) => ({ name, close: () => undefined }) as unknown as ImageBitmap;
const HERE = picture("drawn in the page");

const drawing: Drawing = {
  lines: {
    indices: new Uint32Array(0),
    styles: new Uint8Array(0),
    offsets: new Uint32Array(1),
    coordinates: new Float32Array(0),
  },
  styles: [],
  frame: frameOf({ scale: 1, offsetX: 0, offsetY: 0 }, { width: 10, height: 10 }, 1),
};

/** A worker that answers when it is told to. */
class Worker implements WorkerLike {
  readonly given: DrawingGiven[] = [];
  private readonly answers: ((event: MessageEvent<PictureDrawn>) => void)[] = [];
  private readonly failures: (() => void)[] = [];

  postMessage(message: DrawingGiven): void {
    this.given.push(message);
  }

  addEventListener(type: "message" | "error", listener: (event: MessageEvent<PictureDrawn>) => void): void {
    if (type === "message") this.answers.push(listener);
    else this.failures.push(listener as () => void);
  }

  answer(data: PictureDrawn): void {
    for (const listen of this.answers) listen({ data } as MessageEvent<PictureDrawn>);
  }

  fail(): void {
    for (const listen of this.failures) listen();
  }
}

describe("drawing in a worker", () => {
  it("gives each its own picture, in whichever order they come", async () => {
    const worker = new Worker();
    const desk = new PictureDesk(
      () => worker,
      () => HERE,
    );
    const [first, second] = [desk.draw(drawing), desk.draw(drawing)];
    const [one, two] = [picture("one"), picture("two")];
    worker.answer({ ticket: 1, picture: two });
    worker.answer({ ticket: 0, picture: one });
    expect(await first).toBe(one);
    expect(await second).toBe(two);
  });

  it("tells what went wrong", async () => {
    const worker = new Worker();
    const desk = new PictureDesk(
      () => worker,
      () => HERE,
    );
    const asked = desk.draw(drawing);
    worker.answer({ ticket: 0, failure: "out of memory" });
    await expect(asked).rejects.toThrow("out of memory");
  });

  it("goes on in the page when the worker breaks, with what was asked for too", async () => {
    const worker = new Worker();
    const desk = new PictureDesk(
      () => worker,
      () => HERE,
    );
    const asked = desk.draw(drawing);
    worker.fail();
    expect(await asked).toBe(HERE);
    expect(await desk.draw(drawing)).toBe(HERE);
    expect(worker.given).toHaveLength(1);
  });

  it("is done in the page where there is no worker to have", async () => {
    const desk = new PictureDesk(
      () => {
        throw new Error("forbidden");
      },
      () => HERE,
    );
    expect(await desk.draw(drawing)).toBe(HERE);
  });
});
