"""One camera with all that its page shows around its calibrations."""

from __future__ import annotations

from dataclasses import dataclass, fields
from datetime import timedelta
from typing import Any

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import Calibration, Camera, Dataset, ImageTally
from app.services.calibration_scope import kept_lines_changed
from app.services.calibration_summaries import CalibrationBrief, calibration_brief, newest_with
from app.services.cameras import CameraEntry, camera_entry
from app.services.image_details import DatasetName
from app.services.run_queue import UNFINISHED
from app.services.tallies import of_dataset, summed


@dataclass(frozen=True)
class CameraDetail(CameraEntry):
    """A camera with its calibrations.

    Attributes:
        kept_lines: Segments of its images that are kept.
        candidates: Current segments of its images, whatever was decided on them.
        images_labelled: Its images with kept lines.
        latest_calibration: Its newest finished one; ``estimate`` is what the newest run estimated from raw candidates.
        active_calibration: The one at work.
        decisions_since: Segments that are kept now and weren't for the latest calibration, or the other way round;
            all kept lines where there is none.
    """

    dataset: DatasetName
    kept_lines: int
    candidates: int
    images_labelled: int
    latest_calibration: CalibrationBrief | None
    active_calibration: CalibrationBrief | None
    decisions_since: int

    @property
    def latest_calibration_id(self) -> int | None:
        """Id of the newest finished calibration."""
        return None if self.latest_calibration is None else self.latest_calibration.id


def camera_detail(session: Session, camera: Camera, *, grace: timedelta) -> CameraDetail:
    """Return one camera with its calibrations.

    Args:
        session: Any session.
        camera: The camera.
        grace: How long what was deleted can be restored.
    """
    entry = camera_entry(session, camera)
    dataset = session.get_one(Dataset, camera.dataset_id)
    kept, candidates, labelled = session.execute(
        select(summed(ImageTally.keep), summed(ImageTally.candidates), summed(ImageTally.labelled)).where(
            of_dataset(dataset), ImageTally.camera_id == camera.id
        )
    ).one()
    latest, active = (newest_with(session, camera.id, states) for states in (("done",), UNFINISHED))
    return CameraDetail(
        **_entry_fields(entry),
        dataset=DatasetName(dataset.slug, dataset.name),
        kept_lines=kept,
        candidates=candidates,
        images_labelled=labelled,
        latest_calibration=None if latest is None else calibration_brief(latest, grace=grace),
        active_calibration=None if active is None else calibration_brief(active, grace=grace),
        decisions_since=kept if latest is None else _changed(session, camera, latest),
    )


def _changed(session: Session, camera: Camera, latest: Calibration) -> int:
    return kept_lines_changed(session, camera, latest.parameters.get("newest_decision", 0))


def _entry_fields(entry: CameraEntry) -> dict[str, Any]:
    return {field.name: getattr(entry, field.name) for field in fields(entry)}
