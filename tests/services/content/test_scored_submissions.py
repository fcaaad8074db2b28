"""Boards, lists and comparisons from rows, on both databases."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from sqlalchemy.orm import Session

from app.db.models import Blob, Method, Score, Split, SplitImage, SplitVersion, Submission
from app.db.session import Database
from app.evaluation.ground_truth import GroundTruth
from app.evaluation.submission_scoring import ScoredImage, score_part, score_totals
from app.services.access import Viewer
from app.services.blob_discarding import discard_blob
from app.services.boards import BoardCache, board_csv, board_of
from app.services.comparisons import compare_submissions
from app.services.paging import Page
from app.services.purging import purge
from app.services.score_storing import store_images, store_totals
from app.services.scoring_attempts import release_lost_submissions
from app.services.scoring_claims import InHand, PartClaim, TotalsClaim
from app.services.scoring_inputs import info_of
from app.services.scoring_queue import claim_scoring
from app.services.submission_access import get_submission
from app.services.submission_images import SORTS, ImageEntry, list_image_scores, neighbours, newest_score
from app.services.submission_lists import list_submissions
from app.services.submission_receiving import used_today
from app.services.submission_states import SubmissionClaim, add_score, fail_or_retry, open_score
from app.services.submission_views import submission_view
from app.services.submissions import restore, withdraw
from app.storage import LocalBlobs
from app.vision.segments import Segments

OWNER = Viewer("owner", "admin")
READER = Viewer(None, "reader", anonymous=True)
LINES = [[[10, 20], [150, 25]], [[20, 60], [150, 90]], [[30, 100], [140, 40]]]
IMAGES = 6


@dataclass(frozen=True)
class Yard:
    """A split of a few images in a database."""

    database: Database
    version: int
    now: datetime

    def add(self, method: str, found: list[int], *, person: str = "ann", minutes: int = 0, **fields: object) -> int:
        """A submission that finds so many of the three labels in each image; scored unless told otherwise."""
        when = self.now + timedelta(minutes=minutes)
        status = str(fields.pop("status", "scored"))
        with self.database.write() as session:
            row = session.query(Method).filter(Method.slug == method).one_or_none()
            row = row or Method(slug=method, name=method, owner=person, kind="method", created_at=when)
            session.add(row)
            session.flush()
            submission = Submission(
                split_version_id=self.version,
                method_id=row.id,
                person=person,
                status="queued",
                segments_sha256="1" * 64,
                submission_hash="2" * 64,
                n_images=IMAGES,
                created_at=when,
                queued_at=when,
                **fields,
            )
            session.add(submission)
            session.flush()
            version = session.get_one(SplitVersion, self.version)
            score = add_score(session, submission, version, when)
            if status != "scored":
                submission.status = status
                return submission.id
            submission.status, submission.attempts, score.status = "scoring", 1, "running"
            images = session.query(SplitImage).order_by(SplitImage.ordinal).all()
            scored = [self._image(image, count) for image, count in zip(images, found, strict=True)]
            records = score_part(scored)
            for _ in range(2):  # what comes twice is stored once
                by_image = {image.id: record for image, record in zip(images, records, strict=True)}
                store_images(session, score.id, by_image, when)
                session.flush()
            totals = score_totals([image.info for image in scored], records, draws=50)
            store_totals(session, score.id, totals, when)
            return submission.id

    def _image(self, image: SplitImage, found: int) -> ScoredImage:
        truth = GroundTruth(Segments.from_list(LINES), np.zeros(3, bool))
        return ScoredImage(info_of(image), truth, Segments.from_list(LINES[:found]))


@pytest.fixture
def yard(database: Database, now: datetime) -> Yard:
    with database.write() as session:
        for digit in "012":
            session.add(Blob(sha256=digit * 64, size=1, media_type="x/x", created_at=now))
        split = Split(slug="s", name="S", min_length=0, visibility="open", daily_limit=2, created_at=now)
        session.add(split)
        session.flush()
        version = SplitVersion(
            split_id=split.id,
            number=1,
            truth_sha256="0" * 64,
            truth_hash="0" * 64,
            n_images=IMAGES,
            n_labels=3 * IMAGES,
            n_ambiguous=0,
            created_at=now,
        )
        session.add(version)
        session.flush()
        for ordinal in range(IMAGES):
            optional = {"labels_hash": "0" * 64} if hasattr(SplitImage, "labels_hash") else {}
            session.add(
                SplitImage(
                    version_id=version.id,
                    ordinal=ordinal,
                    name=f"image {ordinal}",
                    image_sha256="0" * 64,
                    width=160,
                    height=120,
                    n_labels=3,
                    **optional,
                )
            )
        return Yard(database, version.id, now)


def board(session: Session, viewer: Viewer = READER):
    return board_of(session, viewer, session.get_one(Split, 1), BoardCache())


def test_a_board_from_rows(yard: Yard) -> None:
    yard.add("good", [3, 3, 3, 2, 3, 3], minutes=1)
    yard.add("bad", [1, 0, 1, 1, 0, 1], minutes=2)
    yard.add("good", [2, 2, 2, 2, 2, 2], minutes=3, label="later and worse")
    yard.add("secret", [3] * IMAGES, visibility="private")
    yard.add("waiting", [3] * IMAGES, status="queued")
    with yard.database.read() as session:
        found = board(session)
        assert [(row.method.slug, row.rank_low, row.rank_high) for row in found.rows] == [("good", 1, 1), ("bad", 2, 2)]
        assert found.rows[0].label is None
        assert found.rows[0].totals["f1"]["value"] == pytest.approx(34 / 35)
        lines = board_csv(found).splitlines()
        assert len(lines) == 3
        assert lines[0].startswith("rank_low,rank_high,method")


def test_a_board_of_equals_is_one_tie_and_a_formula_stays_a_word(yard: Yard) -> None:
    yard.add("a", [2, 3, 2, 3, 2, 3], label="=HYPERLINK(1)")
    yard.add("b", [2, 3, 2, 3, 2, 3])
    with yard.database.read() as session:
        rows = board(session).rows
        assert [(row.rank_low, row.rank_high, row.tied_with) for row in rows] == [(1, 2, ("b",)), (1, 2, ("a",))]
        assert ",'=HYPERLINK(1)," in board_csv(board(session))


def test_a_standing_is_remembered_until_something_changes(yard: Yard, count_queries: Callable) -> None:
    yard.add("a", [2, 3, 2, 3, 2, 3])
    cache = BoardCache()

    def rows() -> tuple[int, int]:
        with count_queries(yard.database) as queries, yard.database.read() as session:
            found = board_of(session, READER, session.get_one(Split, 1), cache)
            return len(found.rows), sum("image_scores" in query for query in queries)

    assert [rows(), rows()] == [(1, 1), (1, 0)]
    yard.add("b", [3] * IMAGES)
    assert [rows(), rows()] == [(2, 1), (2, 0)]


@pytest.mark.parametrize("sort", SORTS)
def test_images_are_sorted_by_any_metric_page_by_page(yard: Yard, sort: str) -> None:
    submission_id = yard.add("a", [0, 3, 1, 2, 3, 1])
    with yard.database.read() as session:
        split, submission = session.get_one(Split, 1), session.get_one(Submission, submission_id)
        score = newest_score(session, submission)
        for order in (sort, f"-{sort}"):
            seen: list[ImageEntry] = []
            page: Page[ImageEntry] | None = None
            while page is None or page.next_cursor:
                cursor = None if page is None else page.next_cursor
                page = list_image_scores(session, split, score, sort=order, limit=4, cursor=cursor)
                seen += page.items
            assert len({entry.image_id for entry in seen}) == len(seen) == IMAGES
            if sort in ("f1", "recall", "tp", "fn"):
                values = [getattr(entry, sort) for entry in seen]
                assert values == sorted(values, reverse=order.startswith("-"))
            second = neighbours(session, score, seen[1].image_id, sort=order)
            assert (second.previous, second.next, second.position) == (seen[0].image_id, seen[2].image_id, 2)


def test_lists_and_views_keep_private_ones_private(yard: Yard) -> None:
    public = yard.add("a", [3] * IMAGES, minutes=1)
    private = yard.add("b", [3] * IMAGES, minutes=2, visibility="private")
    first = yard.add("c", [3] * IMAGES, minutes=3, status="queued")
    second = yard.add("c", [3] * IMAGES, minutes=4, status="queued", person="bob")
    ann = Viewer("ann", "submitter")
    with yard.database.read() as session:
        split = session.get_one(Split, 1)

        def ids(viewer: Viewer, **chosen: Any) -> list[int]:
            return [item.id for item in list_submissions(session, viewer, split, **chosen).items]

        assert ids(READER) == [public]
        assert ids(ann) == [first, private, public]
        assert ids(OWNER) == [second, first, private, public]
        assert ids(OWNER, status="queued") == [second, first]
        assert ids(ann, mine=True, status="scored") == [private, public]
        view = submission_view(session, ann, get_submission(session, ann, first))
        assert (view.position, view.progress) == (1, 0.0)
        assert submission_view(session, OWNER, get_submission(session, OWNER, second)).position == 2
        assert used_today(session, split, "ann", yard.now + timedelta(hours=1)) == 3
        assert used_today(session, split, "ann", yard.now + timedelta(days=2)) == 0


def test_a_comparison_is_paired(yard: Yard) -> None:
    a, b = yard.add("a", [2, 2, 1, 2, 1, 2]), yard.add("b", [3, 3, 2, 2, 2, 3])
    with yard.database.read() as session:
        found = compare_submissions(session, session.get_one(Submission, a), session.get_one(Submission, b))
        assert (found.images.better, found.images.worse, found.images.equal) == (5, 0, 1)
        assert not found.metrics["f1"].tied
        assert found.metrics["recall"].difference == pytest.approx(5 / 18)


def test_work_is_claimed_once_lost_work_again_and_given_up_at_last(yard: Yard) -> None:
    submission = yard.add("a", [], status="queued")
    with yard.database.write() as session:
        first = claim_scoring(session, 9, InHand(), yard.now)
        assert [len(claim.images) for claim in first if isinstance(claim, PartClaim)] == [4, 2]
        score = first[0].score_id if isinstance(first[0], PartClaim) else 0
        in_hand = InHand({(score, image) for claim in first if isinstance(claim, PartClaim) for image in claim.images})
        assert claim_scoring(session, 9, in_hand, yard.now) == []
    with yard.database.write() as session:
        assert release_lost_submissions(session, 2, yard.now) == 1
    with yard.database.write() as session:
        again = claim_scoring(session, 1, InHand(), yard.now)
        assert [claim.claim.attempts for claim in again] == [2]
        stale = SubmissionClaim(submission, 1)
        assert not fail_or_retry(session, stale, {"message": "late"}, yard.now, max_attempts=2)
        assert session.get_one(Submission, submission).status == "scoring"
    with yard.database.write() as session:
        release_lost_submissions(session, 2, yard.now)
        row = session.get_one(Submission, submission)
        assert (row.status, (row.error or {})["code"]) == ("failed", "worker-died")
        assert session.get_one(Score, score).status == "failed"


def test_totals_come_when_every_image_is_done(yard: Yard) -> None:
    yard.add("a", [3] * IMAGES, status="queued")
    with yard.database.write() as session:
        score = session.query(Score).one()
        image = yard._image(session.query(SplitImage).order_by(SplitImage.ordinal).limit(1).one(), 3)
        record = score_part([image])[0]
        score.status = "running"
        store_images(session, score.id, {row.id: record for row in session.query(SplitImage)}, yard.now)
        claims = claim_scoring(session, 9, InHand(), yard.now)
        assert [type(claim) for claim in claims] == [TotalsClaim]
        assert claim_scoring(session, 9, InHand(totals={score.id}), yard.now) == []


def test_a_blob_goes_with_its_last_name(yard: Yard, tmp_path: Path) -> None:
    blobs = LocalBlobs(tmp_path)
    kept, free = blobs.put(b"kept"), blobs.put(b"free")
    with yard.database.write() as session:
        for sha256 in (kept, free):
            session.add(Blob(sha256=sha256, size=4, media_type="x/x", created_at=yard.now))
        session.flush()
        session.get_one(SplitVersion, yard.version).truth_sha256 = kept
        assert [discard_blob(session, blobs, sha256) for sha256 in (kept, free, None)] == [False, True, False]
    assert (blobs.exists(kept), blobs.exists(free)) == (True, False)


def test_what_is_withdrawn_before_it_is_scored_is_charged(yard: Yard) -> None:
    ann = Viewer("ann", "submitter")
    later = yard.now + timedelta(hours=1)
    ids = [yard.add("a", [3] * IMAGES, minutes=minute, status="queued") for minute in (1, 2)]
    with yard.database.write() as session:
        for submission_id in ids:
            withdraw(session, ann, submission_id, later)
    with yard.database.write() as session:  # else both could be restored after two more were handed in
        split = session.get_one(Split, 1)
        assert used_today(session, split, "ann", later) == 2
        first = restore(session, ann, ids[0], later)
        score = open_score(session, first.id)
        assert score is not None
        first.status, score.status = "failed", "failed"
        session.flush()
        assert used_today(session, split, "ann", later) == 1
        withdraw(session, ann, first.id, later)
        session.flush()
        assert used_today(session, split, "ann", later) == 1


def test_what_was_scored_while_it_was_withdrawn_is_charged_and_comes_back_as_scored(yard: Yard) -> None:
    ann = Viewer("ann", "submitter")
    later = yard.now + timedelta(hours=1)
    submission_id = yard.add("a", [3] * IMAGES, minutes=1, status="queued")
    with yard.database.write() as session:
        withdraw(session, ann, submission_id, later)
        score = open_score(session, submission_id)
        assert score is not None
        score.status = "done"
    with yard.database.write() as session:
        assert used_today(session, session.get_one(Split, 1), "ann", later) == 1
        restored = restore(session, ann, submission_id, later)
        assert (restored.status, restored.scored_at) == ("scored", later)


def test_invalid_ones_that_nobody_waited_for_go_after_the_grace_period(yard: Yard, tmp_path: Path) -> None:
    yard.add("a", [3] * IMAGES)
    invalid = yard.add("b", [3] * IMAGES, status="invalid", minutes=1)
    grace, blobs = timedelta(days=7), LocalBlobs(tmp_path)

    def left(later: timedelta) -> int:
        purge(yard.database, blobs, yard.now + later, grace=grace)
        with yard.database.read() as session:
            return session.query(Submission).filter(Submission.id == invalid).count()

    assert [left(grace), left(grace + timedelta(minutes=1))] == [1, 0]
    with yard.database.read() as session:
        assert session.query(Submission).count() == 1
