import { expect, it } from "vitest";
import { deadlineText } from "./deadline";

const NOW = Date.parse("2026-05-04T12:00:00Z");
const at = (closes_at: string | null, closed = false) => deadlineText({ closes_at, closed }, NOW);

it("says how long submissions are taken, in words", () => {
  expect(at(null)).toBeNull();
  expect(at("2026-05-14T12:00:00Z")).toBe("Closes in 10 days");
  expect(at("2026-05-05T14:00:00Z")).toBe("Closes in 26 hours");
  expect(at("2026-05-04T12:01:00Z")).toBe("Closes in 1 minute");
});

it("says that it is over, by the server's word or by the clock", () => {
  expect(at(null, true)).toBe("Closed");
  expect(at("2026-05-04T11:59:00Z")).toBe("Closed");
});
