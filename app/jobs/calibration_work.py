"""The work of a calibration: what it sends to a worker, how it is watched and stored."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from concurrent.futures import Executor, Future
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from app.calibration.work_order import CalibrationFound
from app.db.session import Database
from app.errors import Conflict
from app.jobs.flight import Flight
from app.jobs.notes import Notes
from app.jobs.stores import Stores
from app.jobs.work import Tasks, Work
from app.services.calibration_inputs import calibration_inputs
from app.services.calibration_queue import (
    CalibrationClaim,
    beat_calibration,
    charge_calibration,
    claim_calibration,
    fail_calibration,
    has_waiting_calibration,
    holds,
    put_calibration_back,
    store_calibration,
)


@dataclass(frozen=True)
class CalibrationWork:
    """Estimate a camera's lens."""

    claim: CalibrationClaim

    @property
    def key(self) -> Hashable:
        """See ``Work``."""
        return ("calibrate", self.claim.calibration_id)

    @property
    def attempts(self) -> int:
        """See ``Work``."""
        return self.claim.attempts

    def begin(self, stores: Stores, tasks: Tasks, executor: Executor) -> Future[Any]:
        """See ``Work``."""
        with stores.database.read() as session:
            inputs = calibration_inputs(session, self.claim)
        if not inputs.images:
            raise Conflict("the lines are gone by now", where=self.claim.camera_name, hint="keep some, and start again")
        notes = self.notes(stores)
        notes.prepare()
        return executor.submit(
            tasks.calibrate,
            inputs,
            (self.claim.width, self.claim.height),
            self.claim.camera_name,
            family=self.claim.family,
            notes=notes.for_worker(),
        )

    def store(self, stores: Stores, result: CalibrationFound, now: datetime) -> None:
        """See ``Work``."""
        with stores.database.write() as session:
            store_calibration(session, self.claim, result, now)
        self._discard_notes(stores)

    def fail(self, stores: Stores, error: dict[str, Any], now: datetime) -> None:
        """See ``Work``."""
        with stores.database.write() as session:
            fail_calibration(session, self.claim, error, now)
        self._discard_notes(stores)

    def again(self, stores: Stores, now: datetime) -> Work | None:
        """See ``Work``."""
        self.notes(stores).discard()
        with stores.database.write() as session:
            claim = charge_calibration(session, self.claim, now)
        return None if claim is None else CalibrationWork(claim)

    def put_back(self, stores: Stores) -> None:
        """See ``Work``."""
        with stores.database.write() as session:
            put_calibration_back(session, self.claim)
        self.notes(stores).discard()

    def notes(self, stores: Stores) -> Notes:
        """Return the notes of this attempt."""
        return self._notes_of(stores, self.attempts)

    def _discard_notes(self, stores: Stores) -> None:
        """Remove this attempt's notes, and those of attempts that ended with the server."""
        for attempt in range(1, self.attempts + 1):
            self._notes_of(stores, attempt).discard()

    def _notes_of(self, stores: Stores, attempt: int) -> Notes:
        return stores.notes.of(f"calibration-{self.claim.calibration_id}-{attempt}")


def take_calibration(flight: Flight, database: Database, now: datetime) -> None:
    """Take the calibration that waits longest in hand, unless one is: each keeps a worker busy for long."""
    if not flight.room or has_calibrations(flight.work):
        return
    with database.read() as session:
        waits = has_waiting_calibration(session)
    if not waits:
        return
    with database.write() as session:
        claim = claim_calibration(session, now)
    if claim is not None:
        # what was lost before may be what killed the server
        flight.add(CalibrationWork(claim), suspect=claim.attempts > 1)


def has_calibrations(work: Sequence[Work]) -> bool:
    """Whether any of the work is a calibration."""
    return any(isinstance(each, CalibrationWork) for each in work)


def look_after_calibrations(work: Sequence[Work], stores: Stores, now: datetime) -> None:
    """Bring the progress of calibrations into their rows, and call off those that nobody wants any more."""
    for each in work:
        if isinstance(each, CalibrationWork):
            _look_after(each, stores, now)


def _look_after(work: CalibrationWork, stores: Stores, now: datetime) -> None:
    notes = work.notes(stores)
    with stores.database.read() as session:
        wanted = holds(session, work.claim)
    if not wanted:
        notes.call_off()
        return
    progress = notes.progress()
    with stores.database.write() as session:
        beat_calibration(session, work.claim, progress, now)
