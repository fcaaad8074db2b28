"""``clearlines backup``, ``restore`` and ``migrate``, while others write."""

from __future__ import annotations

import hashlib
import shutil
import sqlite3
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from datetime import datetime, timedelta
from itertools import count
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy import func, select

from app.commands.backup import back_up
from app.commands.backup_manifest import read_manifest
from app.commands.restore import restore
from app.db.models import Blob, Camera, Dataset, Image
from app.db.session import open_database
from app.db.sqlite_files import open_saved
from app.errors import InvalidFile
from app.services.blobs import keep_bytes
from app.services.purging import purge
from app.settings import Settings
from app.storage import LocalBlobs

Run = Callable[..., Any]


def silent(_name: str, _done: int, _total: int) -> None:
    """Nobody looks on."""


def blobs_in(folder: Path) -> dict[str, Path]:
    return {path.name: path for path in (folder / "blobs").glob("??/??/*")}


def test_an_installation_is_saved_and_restored(clearlines: Run, street: Path, tmp_path: Path) -> None:
    clearlines("import", street, "--dataset", "Street")
    clearlines("backup", "backups/one")
    one, live = blobs_in(tmp_path / "backups/one"), blobs_in(tmp_path / "data")
    assert len(one) == 2
    assert all(path.samefile(live[name]) for name, path in one.items()), "on one disk they take no room again"

    said = clearlines("restore", "backups/one", "--data", "other").stderr
    assert "and 2 files" in said
    assert not any(path.samefile(live[name]) for name, path in blobs_in(tmp_path / "other").items())
    clearlines("export", "street", "--output", "out", "--allow-not-done", "--data", "other")
    originals = sorted(path.read_bytes() for path in street.rglob("*.png"))
    assert sorted(path.read_bytes() for path in (tmp_path / "out/images").rglob("*.png")) == originals
    for folder in ("data", "other"):
        assert "isn't empty" in clearlines("restore", "backups/one", "--data", folder, status=2).stderr
    assert "something already" in clearlines("backup", "backups/one", status=2).stderr
    assert "no backup" in clearlines("restore", street, "--data", "third", status=2).stderr

    shutil.rmtree(tmp_path / "data/blobs")  # so that there is one place left to take them from
    clearlines("backup", "backups/two")
    two = blobs_in(tmp_path / "backups/two")
    assert one.keys() == two.keys()
    assert all(path.samefile(one[name]) for name, path in two.items()), "a backup shares files with the one before"

    said = clearlines("backup", "elsewhere/three", status=1).stderr
    assert "2 files that rows name are missing at the source" in said
    assert read_manifest(tmp_path / "elsewhere/three").blobs.missing == sorted(one)


def test_a_damaged_backup_is_told_and_not_served(clearlines: Run, street: Path, tmp_path: Path) -> None:
    clearlines("import", street, "--dataset", "Street")
    clearlines("backup", "saved")
    place = tmp_path / "saved"

    def name_it(name: str) -> None:
        with closing(sqlite3.connect(place / "clearlines.sqlite3")) as connection, connection:
            connection.execute("UPDATE datasets SET name = ?", [name])

    name_it("Another")
    assert "error: datasets: the backup is damaged" in clearlines("restore", place, "--data", "new", status=2).stderr
    assert "isn't whole" in clearlines("token", "list", "--data", "new", status=2).stderr
    name_it("Street")
    file = next(iter(blobs_in(place).values()))
    file.unlink()  # which is that of the installation too
    file.write_bytes(b"x")
    assert "isn't what its name says" in clearlines("restore", place, "--data", "new", status=2).stderr
    clearlines("restore", place / "clearlines.sqlite3", "--data", "new")
    assert "there are no tokens" in clearlines("token", "list", "--data", "new").stdout


@pytest.mark.parametrize(
    ("content", "message"), [("{", "can't be read"), ('{"format": 2}', "a later version"), ('{"format": 1}', "version")]
)
def test_a_list_that_can_not_be_read_is_told(tmp_path: Path, content: str, message: str) -> None:
    (tmp_path / "manifest.json").write_text(content)
    with pytest.raises(InvalidFile, match=message):
        read_manifest(tmp_path)


def test_an_installation_moves_with_its_files(clearlines: Run, street: Path, tmp_path: Path) -> None:
    clearlines("import", street, "--dataset", "Street")
    to = f"sqlite:///{tmp_path}/new/clearlines.sqlite3"
    assert "no installation here" in clearlines("migrate", "--to", to, "--data", "nothing", status=2).stderr
    assert not (tmp_path / "nothing").exists()
    said = clearlines("migrate", "--to", to, "--blobs-to", "new/blobs").stderr
    assert "compared and equal" in said
    clearlines("export", "street", "--output", "out", "--allow-not-done", "--data", "new")
    assert "isn't empty" in clearlines("migrate", "--to", to, status=2).stderr
    assert (
        "the installation itself"
        in clearlines("migrate", "--to", f"sqlite:///{tmp_path}/data/clearlines.sqlite3", status=2).stderr
    )
    assert "mysql" in clearlines("migrate", "--to", "mysql://x/y", status=2).stderr


@contextmanager
def writer(address: str, blobs: LocalBlobs, now: datetime) -> Iterator[Callable[[], int]]:
    """Add datasets of one camera and one image each, and purge every second one, until the block ends."""
    database = open_database(address)
    stopping = threading.Event()
    written = 0
    failed: list[BaseException] = []

    def write_one(number: int) -> None:
        with database.write() as session:
            dataset = Dataset(slug=f"d{number}", name=f"D{number}", created_at=now)
            session.add(dataset)
            session.flush()
            camera = Camera(dataset_id=dataset.id, name="c", width=4, height=3, created_at=now)
            session.add(camera)
            session.flush()
            sha256 = keep_bytes(session, blobs, f"{number}".encode() * 50, "image/png", now)
            deleted = now - timedelta(days=30) if number % 2 else None
            size = {"width": 4, "height": 3, "bits": 8}
            names = {"name": "i", "file_name": "i.png", "sha256": sha256}
            keys = {"dataset_id": dataset.id, "camera_id": camera.id}
            session.add(Image(**keys, **names, **size, created_at=now, deleted_at=deleted))

    def work() -> None:
        nonlocal written
        try:
            for number in count():
                if stopping.is_set():
                    return
                write_one(number)
                written = number
                if number % 2:
                    purge(database, blobs, now, grace=timedelta(days=7))
        except BaseException as error:
            failed.append(error)

    thread = threading.Thread(target=work)
    thread.start()
    try:
        yield lambda: written
    finally:
        stopping.set()
        thread.join()
        database.close()
    assert not failed


def test_a_backup_taken_while_others_write_is_of_one_moment(database_url: str, tmp_path: Path, now: datetime) -> None:
    settings = Settings(data_dir=tmp_path / "data", database_url=database_url)
    blobs = LocalBlobs(settings.blob_dir)
    with writer(database_url, blobs, now) as written:
        for name in ("one", "two"):
            before = written()
            deadline = time.monotonic() + 60
            while written() < before + 3:
                assert time.monotonic() < deadline
                time.sleep(0.01)
            back_up(settings, tmp_path / name, now, progress=silent)
    for name in ("one", "two"):
        require_consistent(tmp_path / name)
    listed = read_manifest(tmp_path / "two")
    restored = restore(Settings(data_dir=tmp_path / "restored"), tmp_path / "two", progress=silent)
    assert restored.database.rows == sum(table.rows for table in listed.tables.values())


def require_consistent(folder: Path) -> None:
    """A dataset, its camera and its image were stored at once; the image's file is there."""
    assert read_manifest(folder).blobs.missing == []
    saved = open_saved(folder / "clearlines.sqlite3")
    with saved.read() as session:
        datasets, cameras, images = (
            session.scalar(select(func.count()).select_from(table)) or 0 for table in (Dataset, Camera, Image)
        )
        assert datasets == cameras > 0
        assert datasets / 2 <= images <= datasets
        named = set(session.scalars(select(Blob.sha256)))
        assert named >= set(session.scalars(select(Image.sha256)))
    saved.close()
    files = blobs_in(folder)
    assert files.keys() == named
    assert all(hashlib.sha256(path.read_bytes()).hexdigest() == name for name, path in files.items())
