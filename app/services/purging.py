"""Remove for good what was deleted, once the grace period is over, and the files that no row names any more."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from datetime import datetime, timedelta

from sqlalchemy import delete, exists, or_, select, text, update
from sqlalchemy.orm import Session

from app.db.models import (
    Blob,
    Calibration,
    Dataset,
    Decision,
    Image,
    ImageTally,
    Run,
    RunImage,
    RunTally,
    SecondDecision,
    Segment,
    Submission,
)
from app.db.session import Database
from app.services.batches import batches_of, in_batches
from app.services.blob_discarding import NAMED_BY
from app.services.blob_keeping import blobs_may_go
from app.services.candidates import refresh_counts, verdict_of_segment
from app.storage import BlobStore

IMAGES_AT_ONCE = 100
BLOBS_AT_ONCE = 1_000

# a file without a row may belong to an upload that is still on its way to its row
YOUNG = timedelta(hours=1)


@dataclass(frozen=True)
class Purged:
    """How much is gone for good.

    Attributes:
        blobs: Files removed from the store.
    """

    datasets: int
    images: int
    runs: int
    blobs: int
    calibrations: int = 0


def purge(database: Database, blobs: BlobStore, now: datetime, *, grace: timedelta) -> Purged:
    """Remove what was deleted longer than the grace period ago; in short transactions, so that nobody waits long.

    Args:
        database: The database.
        blobs: The store.
        now: When.
        grace: How long what was deleted can be restored.
    """
    deadline = now - grace
    images = _purge_images(database, deadline)
    runs = _purge_runs(database, deadline, now)
    calibrations = _purge_calibrations(database, deadline)
    datasets = _purge_datasets(database, deadline)
    _purge_invalid(database, deadline)
    files = _purge_blobs(database, blobs) + _purge_orphans(database, blobs, now)
    blobs.discard_incoming(before=(now - YOUNG).timestamp())
    return Purged(datasets, images, runs, files, calibrations)


def _purge_images(database: Database, deadline: datetime) -> int:
    """Images deleted by themselves, and all images of deleted datasets."""
    with database.read() as session:
        # two questions, each of an index: one with "or" in it would read all images
        gone = select(Dataset.id).where(Dataset.deleted_at <= deadline)
        ids = sorted(
            {
                *session.scalars(select(Image.id).where(Image.deleted_at.is_not(None), Image.deleted_at <= deadline)),
                *session.scalars(select(Image.id).where(Image.dataset_id.in_(gone))),
            }
        )
    for batch in in_batches(ids, IMAGES_AT_ONCE):
        with database.write() as session:
            still_over = (
                select(Image.id)
                .join(Dataset)
                .where(Image.id.in_(batch), (Image.deleted_at <= deadline) | (Dataset.deleted_at <= deadline))
            )
            session.execute(delete(Image).where(Image.id.in_(still_over)).execution_options(synchronize_session=False))
    return len(ids)


def _purge_runs(database: Database, deadline: datetime, now: datetime) -> int:
    """A run takes its undecided candidates along; those with a history of decisions stay, retired."""
    with database.read() as session:
        ids = session.scalars(select(Run.id).where(Run.deleted_at <= deadline)).all()
    for run_id in ids:
        with database.write() as session:
            run = session.scalars(select(Run).where(Run.id == run_id, Run.deleted_at <= deadline)).one_or_none()
            if run is not None:
                _purge_run(session, run, now)
    return len(ids)


def _purge_run(session: Session, run: Run, now: datetime) -> None:
    of_run = Segment.run_image_id.in_(select(RunImage.id).where(RunImage.run_id == run.id))
    decided_ever = or_(
        exists().where(Decision.segment_id == Segment.id), exists().where(SecondDecision.segment_id == Segment.id)
    )
    images = list(session.scalars(select(RunImage.image_id).where(RunImage.run_id == run.id)))
    never = delete(Segment).where(of_run, ~decided_ever)
    session.execute(never.execution_options(synchronize_session=False))
    undecided = (
        select(Segment.id)
        .outerjoin(Segment.state)
        .where(of_run, Segment.retired_at.is_(None), verdict_of_segment() == "undecided")
    )
    retire = update(Segment).where(Segment.id.in_(undecided)).values(retired_at=now)
    session.execute(retire.execution_options(synchronize_session=False))
    session.execute(delete(Run).where(Run.id == run.id))
    session.execute(delete(RunTally).where(RunTally.run_id == run.id))
    for batch in in_batches(images):
        refresh_counts(session, batch)


def _purge_calibrations(database: Database, deadline: datetime) -> int:
    with database.write() as session:
        ids = session.scalars(select(Calibration.id).where(Calibration.deleted_at <= deadline)).all()
        session.execute(delete(Calibration).where(Calibration.id.in_(ids)))
    return len(ids)


def _purge_datasets(database: Database, deadline: datetime) -> int:
    with database.write() as session:
        ids = session.scalars(select(Dataset.id).where(Dataset.deleted_at <= deadline)).all()
        runs = session.scalars(select(Run.id).where(Run.dataset_id.in_(ids))).all()
        session.execute(delete(Dataset).where(Dataset.id.in_(ids)))
        session.execute(delete(ImageTally).where(ImageTally.dataset_id.in_(ids)))  # they add up to nothing
        session.execute(delete(RunTally).where(RunTally.run_id.in_(runs)))
    return len(ids)


def _purge_invalid(database: Database, deadline: datetime) -> None:
    """Submissions that were found invalid when nobody waited any more: their author had the time to read why."""
    with database.write() as session:
        over = (Submission.status == "invalid") & (Submission.created_at <= deadline)
        session.execute(delete(Submission).where(over).execution_options(synchronize_session=False))


def _purge_blobs(database: Database, blobs: BlobStore) -> int:
    """Blobs that no row names, unless a backup copies them now; what was frozen or submitted outlives its dataset."""
    unused = select(Blob.sha256).where(*(~exists().where(column == Blob.sha256) for column in NAMED_BY))
    with database.read() as session:  # all blobs are looked at, which takes a while: nobody waits for that
        found = session.scalars(unused).all()
    removed = 0
    for batch in in_batches(found, BLOBS_AT_ONCE):
        with database.write() as session:
            if not blobs_may_go(session):
                return removed
            _keep_others_from_adding(session)
            still = session.scalars(unused.where(Blob.sha256.in_(batch))).all()
            session.execute(delete(Blob).where(Blob.sha256.in_(still)))
            removed += blobs.delete_all(still)
    return removed


def _purge_orphans(database: Database, blobs: BlobStore, now: datetime) -> int:
    """Files without a row: what was received and then refused, as a second image of one name is."""
    removed = 0
    for batch in batches_of(_old_files(blobs, now), BLOBS_AT_ONCE):
        with database.write() as session:
            if not blobs_may_go(session):
                return removed
            _keep_others_from_adding(session)
            known = set(session.scalars(select(Blob.sha256).where(Blob.sha256.in_(batch))))
            removed += blobs.delete_all([sha256 for sha256 in batch if sha256 not in known])
    return removed


def _old_files(blobs: BlobStore, now: datetime) -> Iterator[str]:
    limit = (now - YOUNG).timestamp()
    for blob in blobs.iterate():
        if blob.modified is not None and blob.modified < limit:
            yield blob.sha256


def _keep_others_from_adding(session: Session) -> None:
    """Hold off whoever adds an image, from looking at the rows until the files are gone."""
    if session.get_bind().dialect.name == "postgresql":  # SQLite lets only one write anyway
        session.execute(text("LOCK TABLE blobs IN SHARE ROW EXCLUSIVE MODE"))
