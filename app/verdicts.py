"""What a person can say of a candidate: the verdicts, and the reasons of a rejection."""

from __future__ import annotations

VERDICTS = ("keep", "reject", "ambiguous", "undecided")
REASONS = ("car", "lane_marking", "curved", "shadow", "other")
"""Why a candidate is rejected: the hard cases of the paper. Files store places in it: what is added comes last."""
