import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { ImageLoader, requireStoredSize } from "./image_loader";

const LARGE = { width: 6000, height: 4000 };
let asked: string[] = [];
let working = true;
/** What the next requests end in, before any is answered. */
let breaks: ("before" | "within" | "silent")[] = [];

beforeEach(() => {
  asked = [];
  working = true;
  breaks = [];
  vi.stubGlobal("fetch", async (url: string, { signal }: { signal: AbortSignal }) => {
    asked.push(url);
    const broken = breaks.shift();
    if (broken === "before") throw new TypeError("Failed to fetch");
    if (broken === "silent") return new Response(silent(signal));
    if (broken === "within") return new Response(brokenOff());
    return working ? new Response(url) : new Response(null, { status: 500 });
  });
  vi.stubGlobal("createImageBitmap", async () => LARGE);
});

afterEach(() => vi.unstubAllGlobals());

function silent(signal: AbortSignal): ReadableStream {
  return new ReadableStream({
    start: (controller) => {
      controller.enqueue(new Uint8Array(3));
      signal.addEventListener("abort", () => controller.error(signal.reason));
    },
  });
}

function brokenOff(): ReadableStream {
  return new ReadableStream({ pull: (controller) => controller.error(new TypeError("network error")) });
}

describe("images", () => {
  it("are fetched once, whatever their address says of the view", async () => {
    const loader = new ImageLoader();
    const [first, again] = [loader.load("/display?view=clahe"), loader.load("/display?view=clahe")];
    expect(again).toBe(first);
    await loader.load("/display");
    expect(asked).toEqual(["/display?view=clahe", "/display"]);
  });

  it("can be looked at without waiting once they are there", async () => {
    const loader = new ImageLoader();
    const loading = loader.load("a");
    expect(loader.peek("a")).toBe(null);
    expect(loader.peek("b")).toBe(null);
    const bitmap = await loading;
    expect(loader.peek("a")).toBe(bitmap);
  });

  it("are forgotten, the longest unused first, when they are too many", async () => {
    const loader = new ImageLoader();
    await loader.load("a");
    await loader.load("b");
    await loader.load("a");
    await loader.load("c");
    expect(["a", "b", "c"].map((url) => loader.peek(url) !== null)).toEqual([true, false, true]);
  });

  it("aren't loaded ahead when the shown one would have to go", async () => {
    const loader = new ImageLoader();
    await loader.prefetch("huge", { width: 8000, height: 5000 });
    expect(asked).toEqual([]);
    await loader.prefetch("large", LARGE);
    expect(asked).toEqual(["large"]);
  });

  it("are asked for again after a failure", async () => {
    const loader = new ImageLoader();
    working = false;
    await expect(loader.load("a")).rejects.toThrow();
    working = true;
    await loader.load("a");
    expect(asked).toEqual(["a", "a"]);
  });

  it.each(["before", "within"] as const)(
    "are asked for once more when the network breaks off %s the answer",
    async (broken) => {
      const loader = new ImageLoader();
      breaks = [broken];
      expect(await loader.load("a")).toBe(LARGE);
      expect(asked).toEqual(["a", "a"]);
    },
  );

  it("are asked for once more when nothing comes any longer", async () => {
    vi.useFakeTimers();
    const loader = new ImageLoader();
    breaks = ["silent"];
    const loading = loader.load("a");
    await vi.advanceTimersByTimeAsync(9_000);
    expect(asked).toEqual(["a"]);
    await vi.advanceTimersByTimeAsync(2_000);
    expect(await loading).toBe(LARGE);
    expect(asked).toEqual(["a", "a"]);
    expect(vi.getTimerCount()).toBe(0);
    vi.useRealTimers();
  });

  it("aren't asked for a third time", async () => {
    const loader = new ImageLoader();
    breaks = ["before", "within"];
    await expect(loader.load("a")).rejects.toMatchObject({ problem: { code: "unreachable" } });
    expect(asked).toEqual(["a", "a"]);
  });

  it("aren't asked for again when the server says no", async () => {
    const loader = new ImageLoader();
    working = false;
    await expect(loader.load("a")).rejects.toMatchObject({ problem: { status: 500 } });
    expect(asked).toEqual(["a"]);
  });

  it("are refused in another size than they are stored in", () => {
    const bitmap = LARGE as ImageBitmap;
    expect(() => requireStoredSize(bitmap, LARGE)).not.toThrow();
    expect(() => requireStoredSize(bitmap, { width: 4000, height: 6000 })).toThrow("6000 × 4000");
  });
});
