"""What became of work: told with kind, ids and attempt, in the log and to whoever counts."""

from __future__ import annotations

import logging
from dataclasses import dataclass
from typing import Any

import pytest
from structlog.contextvars import get_contextvars

from app.jobs.journal import Journal, job_of, kind_of


@dataclass(frozen=True)
class SomeWork:
    key: Any
    attempts: int = 2


@pytest.mark.parametrize(
    ("key", "job"),
    [
        (("detect", 12), "detect 12"),
        (("estimate", 3, 4), "estimate 3/4"),
        (("score", 7, (1, 2, 3)), "score 7/1,2,3"),
    ],
)
def test_a_job_is_called_by_its_kind_and_rows(key: Any, job: str) -> None:
    assert job_of(SomeWork(key)) == job  # type: ignore[arg-type]
    assert kind_of(SomeWork(key)) == key[0]  # type: ignore[arg-type]


def test_each_end_is_told_once_with_its_time(caplog: pytest.LogCaptureFixture) -> None:
    seconds = [100.0]
    told: list[tuple[str, str, float]] = []
    journal = Journal(lambda *facts: told.append(facts), seconds=lambda: seconds[0])
    first: Any = SomeWork(("detect", 1))
    second: Any = SomeWork(("score", 2, (5,)))
    caplog.set_level(logging.DEBUG, "app.jobs.journal")
    journal.begun(first)
    seconds[0] += 1.5
    journal.begun(second)
    seconds[0] += 1.0
    with journal.about(second):
        assert get_contextvars() == {"job": "score 2/5", "attempt": 2}
    journal.ended(second, "failed", {"code": "invalid-image", "message": "it is no image"})
    journal.ended(first, "lost", {"message": "the process died"})
    journal.ended(first, "done")  # begun again by a dispatcher that nobody noted: no time is made up
    assert told == [("score", "failed", 1.0), ("detect", "lost", 2.5), ("detect", "done", 0.0)]
    assert [(record.message, record.levelname) for record in caplog.records[2:]] == [
        ("work failed", "INFO"),
        ("work lost", "WARNING"),
        ("work done", "INFO"),
    ]
    assert getattr(caplog.records[2], "error") == "it is no image"  # noqa: B009 - a fact that the log was given
    assert get_contextvars() == {}
