import { expect, it } from "vitest";
import { placeLabels } from "./place_labels";

it("writes a name to the right, or to the left where the right end is near", () => {
  const placed = placeLabels(
    [
      { id: "a", x: 20, y: 20, text: "LSD" },
      { id: "b", x: 195, y: 60, text: "Pipeline" },
    ],
    [0, 200],
  );
  expect(placed.map(({ id, anchor }) => [id, anchor])).toEqual([
    ["a", "start"],
    ["b", "end"],
  ]);
});

it("never writes over another name or point", () => {
  const placed = placeLabels(
    [
      { id: "first", x: 100, y: 50, text: "a name of some length" },
      { id: "second", x: 120, y: 54, text: "another" },
      { id: "third", x: 110, y: 90, text: "third" },
    ],
    [0, 400],
  );
  expect(placed.map(({ id }) => id)).toEqual(["second", "third"]);
  const [second, third] = placed;
  expect(second?.anchor).toBe("start");
  expect(third?.y).toBe(90);
});

it("gives points on one place one name only", () => {
  const twins = [
    { id: "a", x: 50, y: 50, text: "one" },
    { id: "b", x: 50, y: 50, text: "two" },
  ];
  expect(placeLabels(twins, [0, 300]).map(({ id }) => id)).toEqual(["a", "b"]);
});

it("keeps off the axis at the left", () => {
  const near = [{ id: "a", x: 90, y: 20, text: "a long name" }];
  expect(placeLabels(near, [0, 120])[0]?.anchor).toBe("end");
  expect(placeLabels(near, [40, 120])).toEqual([]);
});
