"""The leaderboard that ``clearlines demo`` prepares."""

from __future__ import annotations

import shutil
from dataclasses import dataclass
from pathlib import Path

import pytest
from sqlalchemy import func, select

from app.commands import demo
from app.commands.demo_board import prepare_board
from app.commands.stores import opened_stores
from app.db.models import Method, SplitVersion, Submission
from app.services.splits import current_version, delete_split, get_split
from app.settings import Settings


@dataclass(frozen=True)
class Prepared:
    """A data folder with the demo and its board."""

    folder: Path
    slug: str
    steps: tuple[tuple[int, int], ...]


@pytest.fixture(scope="module")
def prepared(tmp_path_factory: pytest.TempPathFactory) -> Prepared:
    """Made of two images: drawing them takes seconds."""
    folder = tmp_path_factory.mktemp("board") / "data"
    settings = Settings(data_dir=folder)
    steps: list[tuple[int, int]] = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(demo, "IMAGES", 2)
        demo.prepare_demo(settings)
        slug = prepare_board(settings, progress=lambda done, total: steps.append((done, total)))
    return Prepared(folder, slug, tuple(steps))


@pytest.fixture
def settings(prepared: Prepared, tmp_path: Path) -> Settings:
    """Of a copy of the prepared folder."""
    shutil.copytree(prepared.folder, tmp_path / "data")
    return Settings(data_dir=tmp_path / "data")


def test_the_board_has_exact_labels_and_the_baselines_and_is_made_once(prepared: Prepared, settings: Settings) -> None:
    assert prepared.steps == ((1, 2), (2, 2))
    slug = prepared.slug
    assert prepare_board(settings) == slug == "demo-streets"

    with opened_stores(settings) as (database, _), database.read() as session:
        version = current_version(session, get_split(session, slug))
        assert version.n_images == 2
        assert version.n_labels > 10
        assert session.scalar(select(func.count(SplitVersion.id))) == 1
        queued = session.execute(select(Method.name, Method.kind, Submission.status).join(Submission)).all()
        assert sorted(tuple(row) for row in queued) == [
            ("OpenCV LSD", "baseline", "queued"),
            ("Pre-labelling pipeline", "baseline", "queued"),
        ]


def test_a_board_that_was_deleted_stays_so(prepared: Prepared, settings: Settings) -> None:
    slug = prepared.slug
    with opened_stores(settings) as (database, _), database.write() as session:
        split = get_split(session, slug)
        delete_split(session, slug, split.created_at)
    assert prepare_board(settings) == slug
    with opened_stores(settings) as (database, _), database.read() as session:
        assert get_split(session, slug, deleted=True).deleted_at is not None
