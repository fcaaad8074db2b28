"""The audit, as admins read it."""

from __future__ import annotations

from datetime import datetime, timedelta

import pytest

from app.db.session import Database
from app.errors import InvalidInput, NotFound
from app.services.audit import AuditFilter, read_audit
from app.services.datasets import create_dataset, delete_dataset, rename_dataset
from app.services.events import Actor, record_account_event, record_event

HOUR = timedelta(hours=1)


@pytest.fixture
def told(database: Database, now: datetime) -> Database:
    """Seven lines, the oldest first."""
    with database.write() as session:
        street = create_dataset(session, "Street", now, person="ada")
        rename_dataset(session, street.slug, "Streets", now + HOUR, person="ada")
        create_dataset(session, "Road", now + 2 * HOUR, person="bob")
        record_account_event(session, "user.created", now + 3 * HOUR, Actor("rita", "192.0.2.7"), name="ada")
        record_account_event(session, "user_100%", now + 3 * HOUR, Actor("rita", "192.0.2.7"))
        record_account_event(session, "session.failed", now + 3 * HOUR, Actor(None, "192.0.2.8"))
        record_event(session, "run.started", now + 4 * HOUR, dataset_id=street.id, person="bob")
    return database


def kinds(database: Database, wanted: AuditFilter) -> list[str]:
    with database.read() as session:
        return [entry.kind for entry in read_audit(session, wanted).items]


def test_the_newest_come_first_and_pages_join(told: Database) -> None:
    whole = kinds(told, AuditFilter())
    assert whole[0] == "run.started"
    assert whole[-1] == "dataset.created"
    assert len(whole) == 7
    paged, cursor = [], None
    while True:
        with told.read() as session:
            page = read_audit(session, AuditFilter(), limit=2, cursor=cursor)
        paged += [entry.kind for entry in page.items]
        assert len(page.items) <= 2
        cursor = page.next_cursor
        if cursor is None:
            break
    assert paged == whole


def test_each_filter_leaves_what_it_says(told: Database, now: datetime) -> None:
    assert kinds(told, AuditFilter(person="ada")) == ["dataset.renamed", "dataset.created"]
    assert kinds(told, AuditFilter(kind="user.")) == ["user.created"]
    assert kinds(told, AuditFilter(kind="user_")) == ["user_100%"]
    assert kinds(told, AuditFilter(kind="%")) == []
    assert kinds(told, AuditFilter(dataset="street")) == ["run.started", "dataset.renamed", "dataset.created"]
    assert kinds(told, AuditFilter(since=now + HOUR, until=now + 3 * HOUR)) == ["dataset.created", "dataset.renamed"]
    assert kinds(told, AuditFilter(dataset="street", person="bob", since=now)) == ["run.started"]


def test_a_line_says_who_from_where_and_about_which_dataset(told: Database, now: datetime) -> None:
    with told.read() as session:
        renamed = read_audit(session, AuditFilter(kind="dataset.renamed")).items[0]
        made = read_audit(session, AuditFilter(kind="user.created")).items[0]
    assert (renamed.person, renamed.dataset, renamed.address, renamed.created_at) == ("ada", "street", None, now + HOUR)
    assert (made.person, made.dataset, made.address, made.details) == ("rita", None, "192.0.2.7", {"name": "ada"})


def test_a_deleted_dataset_s_lines_are_found_and_an_unknown_one_is_told(told: Database, now: datetime) -> None:
    with told.write() as session:
        delete_dataset(session, "street", now + 5 * HOUR, grace=7 * 24 * HOUR, person="ada")
    assert kinds(told, AuditFilter(dataset="street"))[0] == "dataset.deleted"
    for slug in ("nope", "straße"):
        with pytest.raises(NotFound):
            kinds(told, AuditFilter(dataset=slug))


def test_a_time_without_a_zone_and_a_foreign_cursor_are_refused(told: Database, now: datetime) -> None:
    with pytest.raises(InvalidInput):
        kinds(told, AuditFilter(since=now.replace(tzinfo=None)))
    with told.read() as session, pytest.raises(InvalidInput):
        read_audit(session, AuditFilter(), cursor="x")
    with told.read() as session, pytest.raises(InvalidInput):
        read_audit(session, AuditFilter(), limit=0)
