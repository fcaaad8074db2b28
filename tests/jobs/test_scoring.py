"""Submissions in real workers, really killed: what is scored stays, the rest runs again, nothing comes twice."""

from __future__ import annotations

import importlib
import io
import os
import signal
import subprocess
import sys
import zipfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import psutil
import pytest
from sqlalchemy import select

from app.db.models import Blob, ImageScore, Method, Score, Split, SplitImage, SplitVersion, Submission
from app.formats.labelled import LabelledSegments
from app.formats.npz import write_npz, write_npz_set
from app.jobs.work import Tasks
from app.vision.segments import Segments

HERE = Path(__file__).parent
PROJECT = HERE.parents[1]
LINES = Segments.from_list([[[10, 20], [150, 25]], [[20, 60], [150, 90]]])


def now() -> datetime:
    return datetime.now(UTC)


def task(name: str) -> Any:
    return getattr(importlib.import_module("gated_scoring"), name)


def is_alive(process_id: int) -> bool:
    try:
        return psutil.Process(process_id).status() != psutil.STATUS_ZOMBIE
    except psutil.NoSuchProcess:
        return False


@dataclass(frozen=True)
class Board:
    """A split in a yard, whose images are known by name alone."""

    yard: Any
    version: int
    method: int

    def blob(self, data: bytes) -> str:
        sha256 = self.yard.blobs.put(data)
        with self.yard.database.write() as session:
            if session.get(Blob, sha256) is None:
                session.add(Blob(sha256=sha256, size=len(data), media_type="x/x", created_at=now()))
        return sha256

    def receive(self, upload: bytes, name: str = "results.zip") -> int:
        sha256 = self.blob(upload)
        with self.yard.database.write() as session:
            row = Submission(
                split_version_id=self.version,
                method_id=self.method,
                upload_sha256=sha256,
                upload_name=name,
                status="received",
                created_at=now(),
            )
            session.add(row)
            session.flush()
            return row.id

    def state(self, submission: int) -> Submission:
        with self.yard.database.read() as session:
            return session.get_one(Submission, submission)

    def score(self, submission: int) -> Score:
        with self.yard.database.read() as session:
            return session.scalars(select(Score).where(Score.submission_id == submission)).one()

    def scored_images(self, submission: int) -> list[tuple[int, int]]:
        """Id and split image of each row, in the order of their coming."""
        with self.yard.database.read() as session:
            query = select(ImageScore.id, ImageScore.split_image_id).join(Score).order_by(ImageScore.id)
            return [tuple(row) for row in session.execute(query.where(Score.submission_id == submission))]


def results(names: Sequence[str]) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for name in names:
            archive.writestr(f"{name}.npz", write_npz(LabelledSegments(LINES)))
    return stream.getvalue()


@pytest.fixture
def make_board() -> Callable[..., Board]:
    def make(yard: Any, names: Sequence[str]) -> Board:
        verdicts = ("keep", "keep")
        truth = write_npz_set((name, LabelledSegments(LINES, verdicts=verdicts)) for name in names)
        board = Board(yard, 0, 0)
        truth_sha256, image_sha256 = board.blob(truth), board.blob(b"an image")
        with yard.database.write() as session:
            split = Split(slug="s", name="S", min_length=0, visibility="open", daily_limit=9, created_at=now())
            method = Method(slug="m", name="M", kind="method", created_at=now())
            session.add_all([split, method])
            session.flush()
            version = SplitVersion(
                split_id=split.id,
                number=1,
                truth_sha256=truth_sha256,
                truth_hash="0" * 64,
                n_images=len(names),
                n_labels=2 * len(names),
                n_ambiguous=0,
                created_at=now(),
            )
            session.add(version)
            session.flush()
            session.add_all(
                SplitImage(
                    version_id=version.id,
                    ordinal=ordinal,
                    name=name,
                    image_sha256=image_sha256,
                    width=160,
                    height=120,
                    n_labels=2,
                    **({"labels_hash": "0" * 64} if hasattr(SplitImage, "labels_hash") else {}),
                )
                for ordinal, name in enumerate(names)
            )
            return Board(yard, version.id, method.id)

    return make


def names_of(*first: str) -> list[str]:
    """Three parts of four images each; the first image of a part says how it behaves."""
    return [name for part in first for name in (part, *(f"{part}-{number}" for number in range(3)))]


def test_a_killed_worker_costs_a_submission_nothing(small_yard, eventually, make_board) -> None:
    names = names_of("a", "held-b", "c")
    board = make_board(small_yard, names)
    submission = board.receive(results(names))
    dispatcher = small_yard.dispatcher(Tasks(score=task("gated_score")))
    dispatcher.start()
    try:
        worker = eventually(lambda: small_yard.begun().get("held-b"), "a part is being scored")
        os.kill(worker, signal.SIGKILL)
        eventually(lambda: not is_alive(worker), "the worker is gone")
        small_yard.open_gate()
        eventually(lambda: board.state(submission).status == "scored", "the submission is scored")
    finally:
        dispatcher.stop()
    assert board.score(submission).f1 == 1.0
    images = [image for _, image in board.scored_images(submission)]
    assert len(images) == len(set(images)) == len(names)


def test_what_kills_its_worker_again_and_again_fails_and_says_why(small_yard, make_board) -> None:
    names = names_of("a", "deadly-b", "c")
    board = make_board(small_yard, names)
    submission = board.receive(results(names))
    small_yard.dispatcher(Tasks(score=task("deadly_score")), max_attempts=2).run_until_idle()
    row = board.state(submission)
    assert (row.status, row.attempts) == ("failed", 2)
    assert row.error is not None
    assert row.error["code"] == "worker-died"
    assert any("attempt 1 failed" in line["text"] for line in row.log or [])
    assert board.score(submission).status == "failed"


def test_what_takes_too_long_fails_and_says_why(small_yard, make_board) -> None:
    board = make_board(small_yard, ["a"])
    submission = board.receive(results(["a"]))
    small_yard.dispatcher(Tasks(score=task("slow_score")), max_attempts=2).run_until_idle()
    row = board.state(submission)
    assert (row.status, row.attempts, (row.error or {})["code"]) == ("failed", 2, "took-too-long")
    assert "longer than 0.2 s" in (row.error or {})["message"]


def run_server(yard: Any, address: str) -> subprocess.Popen[bytes]:
    environment = {**os.environ, "PYTHONPATH": f"{PROJECT}{os.pathsep}{HERE}"}
    return subprocess.Popen(
        [sys.executable, str(HERE / "scoring_process.py"), address, str(yard.settings.data_dir)], env=environment
    )


def test_a_killed_server_goes_on_with_the_images_that_are_left(yard, database_url: str, eventually, make_board) -> None:
    names = names_of("a", "held-b", "c")
    board = make_board(yard, names)
    submission = board.receive(results(names))
    server = run_server(yard, database_url)
    try:
        worker = eventually(lambda: yard.begun().get("held-b"), "the second part is being scored")
        eventually(lambda: len(board.scored_images(submission)) == 4, "the first part is stored")
        held = board.receive(results(names), "held.zip")
    finally:
        server.kill()
        server.wait()
    before = board.scored_images(submission)
    assert board.state(submission).status == "scoring"
    assert board.state(held).status in ("received", "validating")
    eventually(lambda: not is_alive(worker), "the worker ends with its server")
    yard.open_gate()
    server = run_server(yard, database_url)
    try:
        eventually(lambda: board.state(held).status == "scored", "both are scored")
    finally:
        server.send_signal(signal.SIGTERM)
        assert server.wait(60) == 0
    assert board.state(submission).attempts == 2
    assert (board.state(submission).status, board.score(submission).f1) == ("scored", 1.0)
    after = board.scored_images(submission)
    assert after[:4] == before
    assert len({image for _, image in after}) == len(after) == len(names)


def test_an_upload_that_a_dead_server_left_is_refused_and_stays_visible(small_yard, make_board) -> None:
    board = make_board(small_yard, ["a"])
    submission = board.receive(results(["nothing of the split"]))
    with small_yard.database.write() as session:
        row = session.get_one(Submission, submission)
        row.status, row.attempts = "validating", 1
    small_yard.dispatcher(Tasks()).run_until_idle()
    row = board.state(submission)
    assert row.status == "invalid"
    assert (row.error or {})["details"]["errors"][0]["message"] == "there is no image of this name"


def test_a_submission_overtakes_a_run(small_yard, eventually, make_board) -> None:
    others = ["i" * number for number in range(1, 31)]
    small_yard.add("held-a", "held-b", *others)
    run = small_yard.start()
    board = make_board(small_yard, ["a"])
    detect = importlib.import_module("gated_tasks").gated_detect
    dispatcher = small_yard.dispatcher(Tasks(detect=detect))
    dispatcher.start()
    try:
        eventually(lambda: len(small_yard.begun()) == 2, "both workers are busy with the run")
        submission = board.receive(results(["a"]))
        dispatcher.wake()
        small_yard.open_gate("held-a")  # one worker for what waits; the other stays where it is
        eventually(lambda: board.state(submission).status == "scored", "the submission is scored")
        # what is in the workers' hands already comes first, at each of the three steps: that is some twelve images
        assert small_yard.done(run) < len(others)
        small_yard.open_gate()
        eventually(lambda: small_yard.finished(run), "the run is finished too")
    finally:
        dispatcher.stop()


def test_a_stopped_dispatcher_puts_a_submission_back_uncharged(small_yard, eventually, make_board) -> None:
    board = make_board(small_yard, names_of("held-a", "held-b"))
    submission = board.receive(results(["held-a"]))
    dispatcher = small_yard.dispatcher(Tasks(score=task("gated_score")))
    dispatcher.start()
    eventually(lambda: len(small_yard.begun()) == 2, "both parts are being scored")
    dispatcher.stop()
    row = board.state(submission)
    assert (row.status, row.attempts) == ("queued", 0)
