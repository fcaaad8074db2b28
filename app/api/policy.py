"""Which role each address of the API needs at least. An address that isn't listed here is an admin's alone.

What hidden splits conceal goes by what an address names, not by its role: see `Rule.conceals` and `Rule.details`.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field

from app.services.access import Role

PREFIX = "/api"

LEAST: Mapping[Role, tuple[str, ...]] = {
    "reader": (
        "GET /openapi.json",
        "GET /docs",
        "GET /health",
        "GET /configuration",
        "GET /ready",
        "GET /me",
        "POST /session",
        "DELETE /session",
        "GET /session/providers",
        "GET /session/openid/start",
        "POST /session/openid/start",
        "GET /session/openid/callback",
        "GET /account",
        "PATCH /account",
        "POST /account/password",
        "DELETE /account/identities/{identity_id}",
        "GET /account/sessions",
        "DELETE /account/sessions/{session_id}",
        "GET /account/tokens",
        "POST /account/tokens",
        "DELETE /account/tokens/{token_id}",
        "POST /invitations/look",
        "POST /invitations/accept",
        "GET /datasets",
        "GET /datasets/{slug}",
        "GET /datasets/{slug}/images",
        "GET /datasets/{slug}/facets",
        "GET /datasets/{slug}/runs",
        "GET /datasets/{slug}/cameras",
        "GET /datasets/{slug}/export",
        "GET /datasets/{slug}/card",
        "GET /datasets/{slug}/card.png",
        "GET /datasets/{slug}/guidelines",
        "GET /images/{image_id}",
        "GET /images/{image_id}/original",
        "GET /images/{image_id}/display",
        "GET /images/{image_id}/thumbnail",
        "GET /images/{image_id}/segments",
        "GET /images/{image_id}/points",
        "GET /images/{image_id}/decisions",
        "GET /images/{image_id}/edits",
        "GET /segments/{segment_id}/evidence",
        "GET /runs/{run_id}",
        "GET /runs/{run_id}/images",
        "GET /cameras/{camera_id}",
        "GET /cameras/{camera_id}/calibrations",
        "GET /calibrations/{calibration_id}",
        "GET /calibrations/{calibration_id}/lines",
        "GET /calibrations/{calibration_id}/images",
        "GET /calibrations/{calibration_id}/images/{image_id}/undistorted",
        "GET /calibrations/{calibration_id}/images/{image_id}/lines",
        "GET /calibrations/{calibration_id}/difference",
        "GET /calibrations/{calibration_id}/advice",
        "GET /calibrations/{calibration_id}/exports",
        "GET /calibrations/{calibration_id}/exports/{format}",
        "GET /calibrations/{calibration_id}/report",
        "GET /splits",
        "GET /splits/{split}",
        "GET /splits/{split}/images",
        "GET /splits/{split}/images/{split_image_id}/original",
        "GET /splits/{split}/images/{split_image_id}/display",
        "GET /splits/{split}/images/{split_image_id}/thumbnail",
        "GET /splits/{split}/truth",
        "GET /splits/{split}/submissions",
        "GET /splits/{split}/board",
        "GET /splits/{split}/board.csv",
        "GET /submissions/{submission_id}",
        "GET /submissions/{submission_id}/events",
        "GET /submissions/{submission_id}/file",
        "GET /submissions/{submission_id}/matches",
        "GET /submissions/{submission_id}/images",
        "GET /submissions/{submission_id}/images/{split_image_id}",
        "GET /submissions/{submission_id}/images/{split_image_id}/points",
        "GET /submissions/{submission_id}/images/{split_image_id}/overlay.png",
        "GET /submissions/{submission_id}/compare/{other}",
        "GET /methods/{method}",
    ),
    "submitter": (
        "POST /splits/{split}/submissions",
        "POST /splits/{split}/submissions/validate",
        "PATCH /submissions/{submission_id}",
        "POST /submissions/{submission_id}/withdraw",
        "POST /submissions/{submission_id}/restore",
        "PATCH /methods/{method}",
    ),
    "annotator": (
        "GET /segments/{segment_id}/history",  # runs the detector
        "GET /images/{image_id}/neighbour_verdicts",  # matches whole frames
        "GET /images/{image_id}/suggestions",  # may look at all candidates
        "GET /datasets/{slug}/suggestions",  # counts all that was judged
        "POST /datasets/{slug}/suggestions/train",
        "POST /images/{image_id}/decisions",
        "POST /images/{image_id}/edits",
        "POST /images/{image_id}/trace",  # reads the image's pixels
        "PUT /images/{image_id}/review",
        "PUT /images/{image_id}/lease",
        "DELETE /images/{image_id}/lease",
        "POST /images/{image_id}/second-review",
        "GET /second-reviews/{second_review_id}/segments",
        "GET /second-reviews/{second_review_id}/decisions",
        "POST /second-reviews/{second_review_id}/decisions",
        "PUT /second-reviews/{second_review_id}/review",
        "POST /second-reviews/{second_review_id}/adjudications",
        "DELETE /second-reviews/{second_review_id}/adjudications/{segment_id}",
        "GET /datasets/{slug}/people",
        "GET /datasets/{slug}/second-reviews",
        "GET /datasets/{slug}/agreement",
        "GET /datasets/{slug}/differences",
        "GET /datasets/{slug}/statistics",
        "POST /submissions/{submission_id}/images/{split_image_id}/review",
    ),
    "maintainer": (
        "POST /datasets",
        "PATCH /datasets/{slug}",
        "DELETE /datasets/{slug}",
        "POST /datasets/{slug}/restore",
        "POST /datasets/{slug}/images",
        "PATCH /datasets/{slug}/images",
        "POST /datasets/{slug}/images/delete",
        "POST /datasets/{slug}/images/restore",
        "POST /datasets/{slug}/assign",
        "POST /datasets/{slug}/candidates",
        "POST /datasets/{slug}/runs",
        "POST /datasets/{slug}/splits",
        "PATCH /images/{image_id}",
        "DELETE /images/{image_id}",
        "PATCH /cameras/{camera_id}",
        "POST /cameras/{camera_id}/reference-file",
        "POST /cameras/{camera_id}/calibrations",
        "POST /calibrations/{calibration_id}/cancel",
        "DELETE /calibrations/{calibration_id}",
        "POST /calibrations/{calibration_id}/restore",
        "POST /runs/{run_id}/retry",
        "POST /runs/{run_id}/cancel",
        "DELETE /runs/{run_id}",
        "POST /runs/{run_id}/restore",
        "PATCH /splits/{split}",
        "DELETE /splits/{split}",
        "POST /splits/{split}/restore",
        "POST /splits/{split}/versions",
        "POST /splits/{split}/ceiling",
        "POST /splits/{split}/rescore",
        "POST /submissions/{submission_id}/rescore",
    ),
    "admin": (
        "GET /users",
        "PATCH /users/{user_id}",
        "POST /users/{user_id}/reset",
        "GET /users/tokens",
        "DELETE /users/tokens/{token_id}",
        "GET /invitations",
        "POST /invitations",
        "DELETE /invitations/{invitation_id}",
        "GET /audit",
        "GET /status",
        "GET /metrics",
    ),
}

PIXELS = frozenset({"original", "display", "thumbnail"})
"""Ends of addresses that show an image and nothing else, which detectors need of hidden splits too."""

DETAILS = frozenset({"matches", "images", "points", "overlay.png", "review", "compare"})
"""Words of a submission's addresses that tell more than its totals."""


@dataclass(frozen=True)
class Rule:
    """What an address needs.

    Attributes:
        role: The least role.
        pattern: Matches the whole path after the prefix and names its parts.
        conceals: Whether what it names may be concealed; pixels aren't.
        details: Whether it tells of a submission what labels could be learnt from.
        account: Whether it is about the account of whoever asks, so that there must be one.
    """

    method: str
    template: str
    role: Role
    pattern: re.Pattern[str] = field(repr=False)
    conceals: bool
    details: bool
    account: bool


@dataclass(frozen=True)
class Request:
    """A request that a rule is there for.

    Attributes:
        named: What the address names: ``dataset`` (its slug), ``image_id``, ``segment_id``, ``run_id``, ``camera_id``,
            ``calibration_id``, ``second_review_id``.
        submissions: Ids of submissions whose details it tells.
    """

    rule: Rule
    named: Mapping[str, str]
    submissions: tuple[str, ...]


def rule_of(method: str, path: str) -> Request | None:
    """Return what a request needs; ``None`` for addresses that no rule is there for.

    Args:
        method: ``HEAD`` counts as ``GET``.
        path: As the server sees it, percent signs decoded: ``/api/datasets/street``.
    """
    if not path.startswith(PREFIX + "/"):
        return None
    method = "GET" if method == "HEAD" else method
    rest = path.removeprefix(PREFIX)
    for rule in RULES:
        if rule.method == method and (match := rule.pattern.fullmatch(rest)):
            return _request(rule, match.groupdict())
    return None


def _request(rule: Rule, parts: dict[str, str]) -> Request:
    named = {"dataset" if name == "slug" else name: value for name, value in parts.items()} if rule.conceals else {}
    told = [parts[name] for name in ("submission_id", "other") if name in parts] if rule.details else []
    return Request(rule, named, tuple(told))


def _rules() -> tuple[Rule, ...]:
    rules: list[Rule] = []
    for role, addresses in LEAST.items():
        for address in addresses:
            method, template = address.split(" ")
            words = template.split("/")
            rules.append(
                Rule(
                    method,
                    template,
                    role,
                    _pattern(template),
                    conceals=words[-1] not in PIXELS,
                    details=words[1] == "submissions" and not DETAILS.isdisjoint(words),
                    account=words[1] == "account",
                )
            )
    # addresses whose words are all fixed come before those that take any word
    return tuple(sorted(rules, key=lambda rule: rule.template.count("{")))


def _pattern(template: str) -> re.Pattern[str]:
    parts = re.split(r"\{(\w+)\}", template)
    named = [f"(?P<{part}>[^/]+)" if index % 2 else re.escape(part) for index, part in enumerate(parts)]
    return re.compile("".join(named), re.DOTALL)


RULES = _rules()
