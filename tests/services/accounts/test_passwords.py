"""Passwords: which can be, and how they are kept."""

from __future__ import annotations

import threading
from typing import Literal

import pytest
from argon2 import PasswordHasher
from argon2.low_level import Type

from app.errors import InvalidInput, Unauthenticated, Unavailable
from app.services.common_passwords import COMMON_PASSWORDS
from app.services.passwords import LONGEST, SHORTEST, Passwords, checked_password


class Counting(PasswordHasher):
    """Counts how often a hash is worked out."""

    def __init__(self) -> None:
        super().__init__(time_cost=1, memory_cost=8, parallelism=1)
        self.times = 0

    def hash(self, password: str | bytes, *, salt: bytes | None = None) -> str:
        self.times += 1
        return super().hash(password, salt=salt)

    def verify(self, hash: str | bytes, password: str | bytes) -> Literal[True]:  # noqa: A002
        self.times += 1
        return super().verify(hash, password)


def test_a_password_is_kept_as_a_salted_hash_of_argon2id(cheap: Passwords) -> None:
    one, other = cheap.hash_of("seven grey herons"), cheap.hash_of("seven grey herons")
    assert one != other
    assert one.startswith("$argon2id$")
    assert "herons" not in one
    assert cheap.is_right("seven grey herons", one)
    assert not cheap.is_right("seven grey heron", one)
    assert not cheap.is_right("seven grey herons", "no hash")


def test_the_usual_cost_is_that_of_the_standard() -> None:
    usual = PasswordHasher()
    assert (usual.type, usual.time_cost, usual.memory_cost, usual.parallelism) == (Type.ID, 3, 65_536, 4)


def test_a_keyboard_that_composes_letters_otherwise_types_the_same_password(cheap: Passwords) -> None:
    composed, apart = "sieben M\u00f6wen 12", "sieben Mo\u0308wen 12"
    assert composed != apart
    assert cheap.is_right(apart, cheap.hash_of(composed))


def test_a_hash_of_another_cost_is_outdated(cheap: Passwords) -> None:
    dearer = Passwords(PasswordHasher(time_cost=2, memory_cost=16, parallelism=1))
    assert dearer.is_outdated(cheap.hash_of("seven grey herons"))
    assert not cheap.is_outdated(cheap.hash_of("seven grey herons"))


def test_nobody_s_password_costs_as_much_as_a_wrong_one() -> None:
    hasher = Counting()
    passwords = Passwords(hasher)
    stored = passwords.hash_of("seven grey herons")
    spent = []
    for kept in (stored, None):
        before = hasher.times
        with pytest.raises(Unauthenticated):
            passwords.require_right("x" * 999, kept)
        spent.append(hasher.times - before)
    assert spent == [1, 1]


def test_only_a_few_hashes_are_worked_out_at_once() -> None:
    entered, leave = threading.Semaphore(0), threading.Event()

    class Slow(Counting):
        def hash(self, password: str | bytes, *, salt: bytes | None = None) -> str:
            entered.release()
            assert leave.wait(20)
            return super().hash(password, salt=salt)

    passwords = Passwords(Slow(), at_once=2, patience=0.01)
    threads = [threading.Thread(target=passwords.hash_of, args=("seven grey herons",)) for _ in range(2)]
    for thread in threads:
        thread.start()
    assert all(entered.acquire(timeout=20) for _ in threads)
    with pytest.raises(Unavailable):
        passwords.hash_of("a third one")
    leave.set()
    for thread in threads:
        thread.join(20)
    assert passwords.hash_of("a third one")


@pytest.mark.parametrize(
    "password",
    [
        "",
        "a" * (SHORTEST - 1),
        "ab" * LONGEST,
        "Ada Lovelace",
        "ADA LOVELACE",
        "Password123",
        "aaaaaaabbbbbbc",
        "１２３４５６７８９０",
    ],
)
def test_what_can_t_be_a_password(password: str) -> None:
    with pytest.raises(InvalidInput) as caught:
        checked_password(password, "ada lovelace", "new")
    assert caught.value.where == "new"
    assert password not in str(caught.value) or not password


@pytest.mark.parametrize("password", ["seven grey herons", " two  spaces ", "abcde" * (LONGEST // 5)])
def test_what_can_be_a_password_stays_as_it_is(password: str) -> None:
    assert checked_password(password, "ada") == password


def test_those_that_are_listed_are_long_enough_to_be_worth_it() -> None:
    assert all(password == password.casefold() and len(password) >= 9 for password in COMMON_PASSWORDS)
