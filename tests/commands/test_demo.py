"""What ``clearlines demo`` prepares."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.commands import demo
from app.db.session import open_database
from app.services.cameras import list_cameras
from app.services.dataset_overviews import dataset_overview
from app.services.datasets import get_dataset
from app.services.run_progress import list_runs
from app.settings import Settings


def test_the_demo_is_one_camera_without_labels_and_a_queued_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(demo, "IMAGES", 2)
    settings = Settings(data_dir=tmp_path)
    slug = demo.prepare_demo(settings)
    drawn = {path: path.stat().st_mtime_ns for path in (tmp_path / "streets" / "images").rglob("*.png")}
    assert len(drawn) == 2
    assert demo.prepare_demo(settings) == slug
    assert {path: path.stat().st_mtime_ns for path in drawn} == drawn

    database = open_database(settings.database_address)
    with database.read() as session:
        overview = dataset_overview(session, slug, grace=settings.grace)
        dataset = get_dataset(session, slug)
        cameras = list_cameras(session, dataset)
        assert overview.latest_run is not None
        runs = list_runs(session, dataset, overview.created_at, grace=settings.grace)
    database.close()
    assert (overview.name, overview.images, overview.candidates) == ("Demo streets", 2, 0)
    assert [(camera.name, camera.images) for camera in cameras] == [("synthetic", 2)]
    assert [run.total for run in runs] == [2]
