"""Two people at the same moment: one holds the image, and one verdict of two is told to be stale."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from threading import Barrier
from typing import TypeVar

from sqlalchemy import func, select

from app.db.models import Lease
from app.services.assigning import assign
from app.services.leases import renew_lease
from app.services.stale_verdicts import StaleVerdict

PEOPLE: tuple[str, ...] = ("Mara", "Jon", "Lee", "Ann")
Answer = TypeVar("Answer")


def at_once(act: Callable[[str], Answer]) -> list[Answer]:
    """What each person's act gives, all begun together."""
    together = Barrier(len(PEOPLE))

    def begin(person: str) -> Answer:
        together.wait(timeout=30)
        return act(person)

    with ThreadPoolExecutor(len(PEOPLE)) as threads:
        return list(threads.map(begin, PEOPLE))


def test_of_several_who_come_at_once_one_holds_the_image(office) -> None:
    def come(person: str) -> bool:
        with office.database.write() as session:
            holder = renew_lease(session, office.first, f"{person}-page", person, office.now).holder
        return holder is not None and holder.mine

    assert sum(at_once(come)) == 1
    with office.database.read() as session:
        assert session.scalar(select(func.count()).select_from(Lease)) == len(PEOPLE)
        assert session.scalar(select(func.count()).select_from(Lease).where(Lease.holds)) == 1


def test_of_several_verdicts_at_once_none_is_overruled_unseen(office) -> None:
    segment = office.segments[office.first][0]
    verdicts = dict(zip(PEOPLE, ("keep", "reject", "ambiguous", "keep"), strict=True))

    def judge(person: str) -> str | None:
        try:
            office.decide(office.first, {segment: verdicts[person]}, person, seen=0)
        except StaleVerdict as refusal:
            return refusal.details["conflicts"][0]["theirs"]["verdict"]
        return None

    told = at_once(judge)
    stored = [verdicts[person] for person, refusal in zip(PEOPLE, told, strict=True) if refusal is None]
    assert len(set(stored)) == 1  # whoever agrees with what stands is no conflict
    assert {refusal for refusal in told if refusal is not None} == set(stored)


def test_of_several_who_share_out_at_once_each_shares_what_is_left(office) -> None:
    def share_out(person: str) -> int:
        with office.database.write() as session:
            shares = assign(session, office.dataset(session), [person], "shares", None, office.now)
        return sum(share.images for share in shares)

    assert sorted(at_once(share_out)) == [0, 0, 0, len(office.images)]
