/** Why a candidate is rejected: the hard cases that detectors mistake for straight edges. */

import type { RejectReason } from "../api/types";

/** In the order of their digits, from 1. */
export const REASONS = [
  "car",
  "lane_marking",
  "curved",
  "shadow",
  "other",
] as const satisfies readonly RejectReason[];

export const REASON_NAMES: Readonly<Record<RejectReason, string>> = {
  car: "Car",
  lane_marking: "Lane marking",
  curved: "Curved",
  shadow: "Shadow",
  other: "Other",
};

/** The digit that rejects with a reason. */
export function digitOf(reason: RejectReason): string {
  return String(REASONS.indexOf(reason) + 1);
}
