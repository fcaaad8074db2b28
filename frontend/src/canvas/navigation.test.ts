import { describe, expect, it } from "vitest";
import { Navigation } from "./navigation";
import { fitted, type Viewport } from "./viewport";

const IMAGE = { width: 400, height: 200 };
const SCREEN = { width: 300, height: 300 };

function opened() {
  const log: string[] = [];
  const navigation = new Navigation({
    departed: () => log.push("departed"),
    moved: (_viewport: Viewport, mirrored: boolean) => log.push(mirrored ? "mirrored" : "moved"),
  });
  navigation.resize(SCREEN);
  navigation.open(IMAGE);
  log.length = 0;
  return { navigation, log };
}

describe("navigation", () => {
  it("keeps the whole image in view when the window changes", () => {
    const { navigation } = opened();
    const larger = { width: 800, height: 600 };
    navigation.resize(larger);
    expect(navigation.current).toEqual(fitted(IMAGE, larger));
  });

  it("stays where a person went when the window changes", () => {
    const { navigation } = opened();
    navigation.zoom({ x: 150, y: 150 }, 4);
    const { scale } = navigation.current;
    navigation.resize({ width: 310, height: 300 });
    expect(navigation.current.scale).toBe(scale);
  });

  it("zooms at a line in view, else at the middle", () => {
    const box = { minX: 90, minY: 40, maxX: 110, maxY: 60 };
    const atLine = opened().navigation;
    const atMiddle = opened().navigation;
    atLine.zoomStep(1, box);
    atMiddle.zoomStep(1, { minX: 9_000, minY: 40, maxX: 9_100, maxY: 60 });
    const byHand = opened().navigation;
    byHand.zoom({ x: 150, y: 150 }, 1.4);
    expect(atMiddle.current).toEqual(byHand.current);
    expect(atLine.current).not.toEqual(byHand.current);
  });

  it("tells its own movements from those of another view", () => {
    const { navigation, log } = opened();
    navigation.zoom({ x: 150, y: 150 }, 4);
    expect(log).toEqual(["departed", "moved"]);
    navigation.mirror(fitted(IMAGE, SCREEN));
    expect(log).toEqual(["departed", "moved", "mirrored"]);
    // Now fitted, it stays so.
    navigation.resize({ width: 800, height: 600 });
    expect(navigation.current).toEqual(fitted(IMAGE, { width: 800, height: 600 }));
  });

  it("says that it departs even where there is no way to go", () => {
    const { navigation, log } = opened();
    navigation.fit();
    expect(log).toEqual(["departed"]);
  });
});
