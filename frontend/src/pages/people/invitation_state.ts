import type { Invitation } from "../../api/account_types";

export type InvitationState = "open" | "used" | "taken back" | "expired";

/** @param now ms since 1970. */
export function invitationState(
  { used_at, revoked_at, expires_at }: Pick<Invitation, "used_at" | "revoked_at" | "expires_at">,
  now: number,
): InvitationState {
  if (used_at !== null) return "used";
  if (revoked_at !== null) return "taken back";
  return Date.parse(expires_at) <= now ? "expired" : "open";
}
