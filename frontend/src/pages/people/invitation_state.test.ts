import { expect, test } from "vitest";
import { invitationState } from "./invitation_state";

const EXPIRES = "2026-01-08T00:00:00Z";
const BEFORE = Date.parse("2026-01-07T23:59:59Z");
const fresh = { used_at: null, revoked_at: null, expires_at: EXPIRES };

test("an invitation is open until its time is over", () => {
  expect(invitationState(fresh, BEFORE)).toBe("open");
  expect(invitationState(fresh, Date.parse(EXPIRES))).toBe("expired");
});

test("what happened to it counts more than the time", () => {
  const at = "2026-01-02T00:00:00Z";
  expect(invitationState({ ...fresh, used_at: at }, Date.parse(EXPIRES))).toBe("used");
  expect(invitationState({ ...fresh, revoked_at: at }, BEFORE)).toBe("taken back");
});
