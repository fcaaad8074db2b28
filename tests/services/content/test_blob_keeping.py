"""Whoever copies blobs holds off whoever would remove them."""

from __future__ import annotations

from datetime import timedelta
from typing import Any

import pytest

from app.db.models import Blob
from app.db.session import open_database
from app.errors import Conflict
from app.services.blob_discarding import discard_blob
from app.services.blob_keeping import blobs_kept, blobs_may_go
from app.services.blobs import keep_bytes
from app.services.images import delete_images
from app.services.purging import purge

GRACE = timedelta(days=7)


def test_a_purge_leaves_what_is_being_copied_to_the_next(place: Any) -> None:
    slug = place.dataset()
    image = place.image(slug, "a")
    with place.database.write() as session:
        delete_images(session, place.find(session, slug), [image], place.now, grace=GRACE)
        loose = keep_bytes(session, place.blobs, b"loose", "text/plain", place.now)
    over = place.now + 2 * GRACE
    with blobs_kept(place.database):
        purged = purge(place.database, place.blobs, over, grace=GRACE)
        assert (purged.images, purged.blobs) == (1, 0)
        with place.database.write() as session:
            assert not discard_blob(session, place.blobs, loose)
    with place.database.read() as session:
        rows = set(session.query(Blob.sha256).all())
    assert len(rows) == 2
    assert all(place.blobs.exists(sha256) for (sha256,) in rows)
    assert purge(place.database, place.blobs, over, grace=GRACE).blobs == 2


def test_who_removes_is_waited_for(place: Any) -> None:
    address = place.database.engine.url.render_as_string(hide_password=False)
    other = open_database(address, busy_timeout=0.1)
    with place.database.write() as session:
        assert blobs_may_go(session)
        # on SQLite the other one waits for the transaction itself
        with pytest.raises(Exception, match=r"at work|locked"), blobs_kept(other, patience=0.1):
            raise AssertionError
    with blobs_kept(other), pytest.raises(Conflict, match="another backup"), blobs_kept(place.database, patience=0.1):
        raise AssertionError
    other.close()
