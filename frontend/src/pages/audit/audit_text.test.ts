import { expect, test } from "vitest";
import { detailText, kindText } from "./audit_text";

test("a kind is told in words", () => {
  expect(kindText("user.role_changed")).toBe("User: role changed");
  expect(kindText("second_review.adjudicated")).toBe("Second review: adjudicated");
  expect(kindText("purged")).toBe("Purged");
});

test("details are told in words, absent ones left out", () => {
  expect(detailText({ name: "ada", old_role: "reader", reason: null, ids: [1, 2] })).toBe(
    "name: ada, old role: reader, ids: 1 2",
  );
  expect(detailText({})).toBe("");
  expect(detailText({ shares: { ada: 3 } })).toBe('shares: {"ada":3}');
});

test("long details are cut", () => {
  const text = detailText({ names: "x".repeat(400) });
  expect(text).toHaveLength(160);
  expect(text.endsWith("…")).toBe(true);
});
