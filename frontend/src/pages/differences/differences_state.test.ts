import { describe, expect, test } from "vitest";
import type { Difference } from "../../api/team_endpoints";
import { decided, openCount, opened, stepped, steppedImage, takenBack } from "./differences_state";

function difference(
  segment: number,
  image: number,
  adjudicated: Difference["adjudicated"] = null,
): Difference {
  return {
    second_review_id: image,
    image_id: image,
    image: `image ${image}`,
    segment_id: segment,
    length: 100,
    box: [0, 0, 1, 1],
    first: { verdict: "keep", person: "Mara" },
    second: { verdict: "reject", person: "Jon" },
    adjudicated,
  };
}

const KEEP: Difference["adjudicated"] = {
  verdict: "keep",
  person: "Ada",
  created_at: "2025-01-01T00:00:00Z",
};

describe("going through differences", () => {
  const state = opened([difference(1, 1, KEEP), difference(2, 1), difference(3, 2), difference(4, 2)]);

  test("begins where nobody has decided yet", () => {
    expect(state.current).toBe(1);
    expect(openCount(state)).toBe(3);
    expect(opened([]).current).toBeNull();
    expect(opened([difference(1, 1, KEEP)]).current).toBe(0);
  });

  test("a decision goes on to the next open one, past the end to the beginning", () => {
    const last = stepped(stepped(state, 1), 1);
    expect(last.current).toBe(3);
    const next = decided(last, difference(4, 2, KEEP));
    expect(next.current).toBe(1);
    expect(next.done).toEqual(["2/4"]);
  });

  test("with all decided it stays", () => {
    const two = opened([difference(1, 1, KEEP), difference(2, 1)]);
    const done = decided(two, difference(2, 1, KEEP));
    expect(done.current).toBe(1);
    expect(openCount(done)).toBe(0);
  });

  test("an answer that comes late moves nobody", () => {
    const moved = stepped(state, 1);
    const answered = decided(moved, difference(2, 1, KEEP));
    expect(answered.current).toBe(2);
    expect(openCount(answered)).toBe(2);
  });

  test("what is taken back is gone to", () => {
    const next = decided(state, difference(2, 1, KEEP));
    const back = takenBack(next, difference(2, 1));
    expect(back.current).toBe(1);
    expect(back.done).toEqual([]);
    expect(openCount(back)).toBe(3);
  });

  test("images in turn", () => {
    expect(steppedImage(state, 1).current).toBe(2);
    expect(steppedImage(steppedImage(state, 1), 1).current).toBe(0);
    expect(steppedImage(state, -1).current).toBe(2);
  });
});
