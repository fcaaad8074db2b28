import { expect, it } from "vitest";
import { calibrateText, expectedErrorText, progressText, reasonText, releasedText } from "./calibration_text";

it("says how good a calibration is in one line", () => {
  expect(expectedErrorText({ pred: 0.4213, bound95: 0.9 })).toBe(
    "Expected error 0.42 px, below 0.90 px with 95 %",
  );
});

it("says what goes on, and what it waits for", () => {
  expect(progressText(null)).toBe("Waiting to start");
  expect(progressText({ stage: "leaving images out", done: 3, total: 1200 })).toBe(
    "Leaving images out, one by one, 3 of 1,200",
  );
  expect(progressText({ stage: "fitting", done: 0, total: 1 })).toBe("Fitting the lens");
  expect(progressText({ stage: "something new", done: 0, total: 0 })).toBe("something new");
});

it("counts the lines that would be used", () => {
  expect([0, 1, 3120].map(calibrateText)).toEqual([
    "Calibrate",
    "Calibrate from 1 kept line",
    "Calibrate from 3,120 kept lines",
  ]);
});

it("names what a model was free in", () => {
  expect(releasedText([])).toBe("nothing: no distortion");
  expect(releasedText(["k1"])).toBe("k1");
  expect(releasedText(["k1", "k2", "cx", "cy"])).toBe("k1, k2 and the centre");
});

it("writes reasons as sentences that leave parameters their names", () => {
  expect(reasonText("k2 explains lines better")).toBe("k2 explains lines better.");
  expect(reasonText("the likelihood gains -2.2 where 2 is asked")).toBe(
    "The likelihood gains −2.2 where 2 is asked.",
  );
});
