import { expect, test } from "vitest";
import { intervalText, kappaText, kappaWord } from "./kappa_text";

test("agreement in numbers", () => {
  expect(kappaText({ value: 0.8249 })).toBe("0.82");
  expect(kappaText({ value: null })).toBe("–");
  expect(intervalText({ low: 0.7, high: 0.9 })).toBe("0.70 to 0.90");
  expect(intervalText({ low: null, high: 0.9 })).toBe("");
});

test("agreement in the words of Landis and Koch", () => {
  expect(kappaWord({ value: 0.9 })).toBe("almost perfect");
  expect(kappaWord({ value: 0.7 })).toBe("substantial");
  expect(kappaWord({ value: 0 })).toBe("slight");
  expect(kappaWord({ value: -0.1 })).toBe("worse than chance");
  expect(kappaWord({ value: null })).toBe("not defined");
});
