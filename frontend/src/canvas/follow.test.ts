import { describe, expect, it } from "vitest";
import { follow } from "./follow";
import { boxContains } from "./geometry";
import { visibleBox } from "./viewport";

const screen = { width: 1000, height: 800 };
const viewport = { scale: 1, offsetX: 0, offsetY: 0 };

describe("the view follows a selected candidate", () => {
  it("not at all where it is on the screen and large enough", () => {
    const box = { minX: 100, minY: 100, maxX: 300, maxY: 180 };
    expect(follow(viewport, box, screen)).toBe(viewport);
  });

  it("not for one at the very edge of the screen", () => {
    expect(follow(viewport, { minX: 900, minY: 10, maxX: 1000, maxY: 90 }, screen)).toBe(viewport);
  });

  it("without zooming where it is off the screen", () => {
    const box = { minX: 1200, minY: 100, maxX: 1400, maxY: 180 };
    const view = follow(viewport, box, screen);
    expect(view.scale).toBe(1);
    expect(boxContains(visibleBox(view, screen), box)).toBe(true);
  });

  it("and zooms in on a tiny one", () => {
    const box = { minX: 500, minY: 500, maxX: 510, maxY: 504 };
    expect(follow(viewport, box, screen).scale).toBe(12);
  });

  it("and zooms out where the candidate is larger than the screen", () => {
    const box = { minX: 0, minY: 100, maxX: 3000, maxY: 400 };
    const view = follow(viewport, box, screen);
    expect(view.scale).toBeLessThan(1);
    expect(boxContains(visibleBox(view, screen), box)).toBe(true);
  });
});
