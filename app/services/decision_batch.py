"""Decisions as a client sends them: what can be wrong with them, and which of them are known already."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Protocol
from uuid import UUID

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import Decision, SecondDecision, Segment
from app.errors import Conflict, InvalidInput, TooLarge
from app.services.batches import in_batches
from app.verdicts import REASONS, VERDICTS

MOST_DECISIONS = 5_000
KINDS = ("judge", "accept", "take_over", "undo", "redo")
REPLAYS = ("undo", "redo")


class DecisionGiven(Protocol):
    """One verdict on one segment; what one key press does shares a ``group_id``."""

    @property
    def client_id(self) -> UUID | str:
        """Made by the client; the same one again is the same decision."""
        ...

    @property
    def group_id(self) -> UUID | str:
        """What one key press did."""
        ...

    @property
    def segment_id(self) -> int:
        """The segment."""
        ...

    @property
    def verdict(self) -> str:
        """The verdict that it has from now on."""
        ...

    @property
    def kind(self) -> str:
        """``judge``; ``accept`` of a suggestion; ``take_over`` from a neighbouring frame; ``undo`` or ``redo``."""
        ...

    @property
    def target_group_id(self) -> UUID | str | None:
        """The group that an undo or redo is about."""
        ...

    @property
    def elapsed_ms(self) -> int | None:
        """How long the person took."""
        ...

    @property
    def reason(self) -> str | None:
        """Why it is rejected; for no other verdict."""
        ...

    @property
    def suggestion(self) -> float | None:
        """The probability of being kept that the person saw."""
        ...


@dataclass(frozen=True)
class Wish:
    """A decision that can be: ids in one form, kind and verdict known."""

    client_id: str
    group_id: str
    segment_id: int
    verdict: str
    kind: str = "judge"
    target_group_id: str | None = None
    elapsed_ms: int | None = None
    reason: str | None = None
    suggestion: float | None = None

    def same_as(self, other: Wish | Decision | SecondDecision) -> bool:
        """Whether the other one, of the same client id, says the same; a second review's have no reason."""
        return all(getattr(self, name) == getattr(other, name, None) for name in SAID)


SAID = tuple(field.name for field in fields(Wish) if field.name != "client_id")


@dataclass(frozen=True)
class Ledger:
    """The append-only rows that decisions become: those of an image, or those of its second review.

    Attributes:
        rows: Their table.
        owner: Its column that says which image or second review a row is of.
        owner_id: Which one.
        kinds: Kinds of decisions that a client may send.
    """

    rows: type[Decision] | type[SecondDecision]
    owner: str
    owner_id: int
    kinds: tuple[str, ...]

    def owns(self, row: Decision | SecondDecision) -> bool:
        """Whether a row is of this image or second review."""
        return getattr(row, self.owner) == self.owner_id


def image_ledger(image_id: int) -> Ledger:
    """Return where decisions on an image are written."""
    return Ledger(Decision, "image_id", image_id, KINDS)


def second_ledger(second_review_id: int) -> Ledger:
    """Return where decisions of a second review are written."""
    return Ledger(SecondDecision, "second_review_id", second_review_id, ("judge", *REPLAYS))


def new_wishes(session: Session, ledger: Ledger, given: Sequence[DecisionGiven]) -> list[Wish]:
    """Return the decisions that aren't stored yet, in order, each once.

    Raises:
        InvalidInput: Naming the first decision that can't be.
        TooLarge: When there are too many.
        Conflict: When a client id is known with another content.
    """
    if not given:
        raise InvalidInput("no decisions", where="decisions", expected=f"1 to {MOST_DECISIONS}")
    if len(given) > MOST_DECISIONS:
        raise TooLarge(f"{len(given)} decisions at once", where="decisions", expected=f"at most {MOST_DECISIONS}")
    ids = [_uuid(entry.client_id, 0) for entry in given]
    known: dict[str, Wish | Decision | SecondDecision] = dict(_stored(session, ledger, ids))
    wishes: list[Wish] = []
    for number, entry in enumerate(given):
        wish = _checked(entry, number, ledger.kinds)
        other = known.get(wish.client_id)
        if other is None:
            known[wish.client_id] = wish
            wishes.append(wish)
        elif not wish.same_as(other) or not (isinstance(other, Wish) or ledger.owns(other)):
            raise Conflict(
                "another decision has this client_id",
                where=f"decisions[{number}].client_id",
                expected="a new UUID for each decision",
                details={"client_id": wish.client_id},
            )
    return wishes


def segments_named(session: Session, image_id: int, wishes: Sequence[Wish]) -> Mapping[int, Segment]:
    """Return the segments that decisions are about, retired ones too.

    Raises:
        InvalidInput: Naming a segment that isn't of this image.
    """
    found: dict[int, Segment] = {}
    for batch in in_batches(sorted({wish.segment_id for wish in wishes})):
        rows = session.scalars(select(Segment).where(Segment.id.in_(batch), Segment.image_id == image_id))
        found.update({row.id: row for row in rows})
    foreign = sorted({wish.segment_id for wish in wishes} - set(found))
    if foreign:
        raise InvalidInput(
            f"segment {foreign[0]} isn't of image {image_id}",
            where="segment_id",
            expected="segments of this image",
            details={"segments": foreign[:100]},
        )
    return found


def require_known_groups(session: Session, ledger: Ledger, wishes: Sequence[Wish]) -> None:
    """Check that what is undone or redone was done on this image, or in this second review of it.

    Raises:
        InvalidInput: Naming the group that doesn't exist.
    """
    targets = {wish.target_group_id for wish in wishes if wish.target_group_id} - {wish.group_id for wish in wishes}
    for batch in in_batches(sorted(targets)):
        of_owner = getattr(ledger.rows, ledger.owner) == ledger.owner_id
        query = select(ledger.rows.group_id).where(of_owner, ledger.rows.group_id.in_(batch)).distinct()
        targets = targets.difference(session.scalars(query))
    if targets:
        raise InvalidInput(
            "nothing on this image was done under this group",
            where="target_group_id",
            expected="the group_id of an earlier decision",
            details={"groups": sorted(targets)[:100]},
        )


def _checked(given: DecisionGiven, number: int, kinds: Sequence[str]) -> Wish:
    where = f"decisions[{number}]"
    if given.verdict not in VERDICTS:
        raise InvalidInput(f"{given.verdict!r} is no verdict", where=f"{where}.verdict", expected=", ".join(VERDICTS))
    if given.kind not in kinds:
        raise InvalidInput(f"{given.kind!r} can't be decided", where=f"{where}.kind", expected=", ".join(kinds))
    if (given.kind in REPLAYS) != (given.target_group_id is not None):
        raise InvalidInput(
            "undo and redo name the group they are about, and nothing else does", where=f"{where}.target_group_id"
        )
    if given.reason is not None and (given.verdict != "reject" or given.reason not in REASONS):
        raise InvalidInput(
            f"{given.reason!r:.60} can't be the reason of the verdict {given.verdict}",
            where=f"{where}.reason",
            expected=f"{', '.join(REASONS)}, with the verdict reject",
        )
    target = None if given.target_group_id is None else _uuid(given.target_group_id, number, "target_group_id")
    return Wish(
        client_id=_uuid(given.client_id, number),
        group_id=_uuid(given.group_id, number, "group_id"),
        segment_id=given.segment_id,
        verdict=given.verdict,
        kind=given.kind,
        target_group_id=target,
        elapsed_ms=given.elapsed_ms,
        reason=given.reason,
        suggestion=given.suggestion,
    )


def _stored(session: Session, ledger: Ledger, client_ids: Sequence[str]) -> dict[str, Decision | SecondDecision]:
    rows: dict[str, Decision | SecondDecision] = {}
    for batch in in_batches(client_ids):
        found = session.scalars(select(ledger.rows).where(ledger.rows.client_id.in_(batch)))
        rows.update({row.client_id: row for row in found})
    return rows


def _uuid(value: UUID | str, number: int, field: str = "client_id") -> str:
    try:
        return str(value if isinstance(value, UUID) else UUID(value))
    except ValueError as error:
        raise InvalidInput(
            f"{value!r:.60} is no UUID", where=f"decisions[{number}].{field}", expected="a UUID"
        ) from error
