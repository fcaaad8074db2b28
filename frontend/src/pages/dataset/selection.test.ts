import { expect, it } from "vitest";
import { all, extended, NOTHING_SELECTED, toggled } from "./selection";

const order = [10, 20, 30, 40, 50];
const ids = (selection: { ids: ReadonlySet<number> }) => [...selection.ids].sort((a, b) => a - b);

it("toggles one", () => {
  const one = toggled(NOTHING_SELECTED, 20);
  expect(ids(one)).toEqual([20]);
  expect(ids(toggled(one, 20))).toEqual([]);
  expect(ids(NOTHING_SELECTED)).toEqual([]);
});

it("extends from the last one toggled, in both directions, and adds to what is there", () => {
  const anchored = toggled(toggled(NOTHING_SELECTED, 10), 30);
  expect(ids(extended(anchored, order, 50))).toEqual([10, 30, 40, 50]);
  expect(ids(extended(anchored, order, 20))).toEqual([10, 20, 30]);
});

it("extends to one alone where the anchor is gone or never was", () => {
  expect(ids(extended(NOTHING_SELECTED, order, 30))).toEqual([30]);
  expect(ids(extended({ ids: new Set([7]), anchor: 7 }, order, 30))).toEqual([7, 30]);
  expect(ids(extended(NOTHING_SELECTED, order, 99))).toEqual([]);
});

it("takes all", () => {
  expect(ids(all(order))).toEqual(order);
  expect(all([]).anchor).toBeNull();
});
