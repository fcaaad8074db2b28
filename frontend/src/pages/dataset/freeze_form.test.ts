import { expect, it } from "vitest";
import { NEW_SPLIT, newSplit } from "./freeze_form";

it("leaves to the server what wasn't filled in", () => {
  expect(newSplit({ ...NEW_SPLIT, name: " Downtown test " })).toEqual({
    name: "Downtown test",
    min_length: 0,
    visibility: "open",
  });
});

it("sends a deadline as a moment, not as a wall clock", () => {
  const given = newSplit({
    ...NEW_SPLIT,
    name: "Test",
    minLength: "100",
    visibility: "hidden",
    closesAt: "2026-12-01T12:00",
    dailyLimit: "5",
    description: "Night drives",
  });
  expect(given.closes_at).toBe(new Date(2026, 11, 1, 12, 0).toISOString());
  expect(given).toMatchObject({
    min_length: 100,
    visibility: "hidden",
    daily_limit: 5,
    description: "Night drives",
  });
});
