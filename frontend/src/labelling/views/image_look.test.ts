import { describe, expect, test } from "vitest";
import { cssFilter, describeStep, isPlain, MOST_STEPS, PLAIN_LOOK, stepped, toggledView } from "./image_look";

describe("how the image is shown", () => {
  test("a view's key shows it, and shows the plain image again", () => {
    const clahe = toggledView(PLAIN_LOOK, "clahe");
    expect(clahe.view).toBe("clahe");
    expect(toggledView(clahe, "undistorted").view).toBe("undistorted");
    expect(toggledView(clahe, "clahe")).toEqual(PLAIN_LOOK);
  });

  test("brightness has ends", () => {
    const brightest = stepped(PLAIN_LOOK, "brightness", 100);
    expect(brightest.brightness).toBe(MOST_STEPS);
    expect(stepped(brightest, "brightness", 1)).toBe(brightest);
    expect(stepped(PLAIN_LOOK, "contrast", -100).contrast).toBe(-MOST_STEPS);
  });

  test("as stored there is no filter", () => {
    expect(cssFilter(PLAIN_LOOK)).toBe("none");
    expect(cssFilter(stepped(PLAIN_LOOK, "brightness", 1))).toBe("brightness(1.300)");
    expect(cssFilter(stepped(stepped(PLAIN_LOOK, "brightness", -1), "contrast", 2))).toBe(
      "brightness(0.769) contrast(1.440)",
    );
  });

  test("up and down again is plain", () => {
    const there = stepped(PLAIN_LOOK, "brightness", 2);
    expect(isPlain(there)).toBe(false);
    expect(isPlain(stepped(there, "brightness", -2))).toBe(true);
    expect(isPlain(toggledView(PLAIN_LOOK, "undistorted"))).toBe(false);
  });

  test("what a step is called", () => {
    expect(describeStep("brightness", stepped(PLAIN_LOOK, "brightness", 2))).toBe("Brightness +2");
    expect(describeStep("contrast", stepped(PLAIN_LOOK, "contrast", -1))).toBe("Contrast −1");
    expect(describeStep("contrast", PLAIN_LOOK)).toBe("Contrast as stored");
  });
});
