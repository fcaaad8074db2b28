"""``clearlines serve``: a folder that comes in, and a server that ends when it is told to."""

from __future__ import annotations

import shutil
import signal
import socket
import subprocess
import time
import urllib.request
from collections.abc import Callable
from pathlib import Path

from app.commands.serve import import_and_prelabel
from app.commands.stores import opened_stores
from app.db.models import Run, RunImage
from app.settings import Settings


def runs_of(settings: Settings) -> list[tuple[str, int]]:
    """Return status and number of images of each run."""
    with opened_stores(settings) as (database, _), database.read() as session:
        return [
            (run.status, session.query(RunImage).filter_by(run_id=run.id).count())
            for run in session.query(Run).order_by(Run.id)
        ]


def test_a_folder_comes_in_once_and_what_is_new_is_queued(street: Path, tmp_path: Path) -> None:
    settings = Settings(data_dir=tmp_path / "data")
    assert import_and_prelabel(settings, street, "Street") == "street"
    assert runs_of(settings) == [("queued", 2)]
    import_and_prelabel(settings, street, "Street")
    assert runs_of(settings) == [("queued", 2)]
    shutil.copy(street / "a" / "one.png", street / "same_content.png")
    (street / "new.pgm").write_bytes(b"P5 2 2 255\n" + bytes(4))
    import_and_prelabel(settings, street, "Street")
    assert runs_of(settings) == [("queued", 2), ("queued", 1)]


def test_two_servers_of_one_data_folder_end_without_a_word_of_trouble_when_told_to(
    start: Callable[..., subprocess.Popen[str]], street: Path
) -> None:
    # whoever starts the tests in the background may have them ignore Ctrl-C, and children inherit that
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        servers = [start("serve", street, "--no-browser", "--port", port) for port in free_ports(2)]
    finally:
        signal.signal(signal.SIGINT, before)
    for server in servers:
        wait_for(server)
    for server, number in zip(servers, (signal.SIGINT, signal.SIGTERM), strict=True):
        server.send_signal(number)
        _, said = server.communicate(timeout=60)
        assert server.returncode == 128 + number
        assert "Traceback" not in said
        assert "Warning" not in said


def free_ports(count: int) -> list[int]:
    """Return ports that nobody listens on right now."""
    probes = [socket.create_server(("127.0.0.1", 0)) for _ in range(count)]
    ports = [probe.getsockname()[1] for probe in probes]
    for probe in probes:
        probe.close()
    return ports


def wait_for(server: subprocess.Popen[str]) -> None:
    """Wait until a server answers on the port that it was given last."""
    address = f"http://127.0.0.1:{server.args[-1]}/api/health"  # type: ignore[index]
    deadline = time.monotonic() + 90
    while True:
        try:
            with urllib.request.urlopen(address, timeout=30):
                return
        except OSError:
            assert server.poll() is None, server.communicate()
            assert time.monotonic() < deadline
            time.sleep(0.1)


def test_what_is_wrong_with_the_database_is_told_before_the_server_starts(clearlines, monkeypatch) -> None:
    monkeypatch.setenv("CLEARLINES_DATABASE_URL", "postgresql://nobody@127.0.0.1:1/nothing")
    said = clearlines("serve", "--no-browser", "--port", 0, status=2).stderr
    assert "the database can't answer" in said
    assert "ClearLines is at" not in said


def test_the_demo_listens_where_nobody_else_reaches_it_too(clearlines, monkeypatch) -> None:
    monkeypatch.setenv("CLEARLINES_HOST", "0.0.0.0")
    assert "no accounts" in clearlines("demo", "--no-browser", "--port", 0, status=2).stderr
    monkeypatch.delenv("CLEARLINES_HOST")
    monkeypatch.setenv("CLEARLINES_PUBLIC_URL", "https://lines.example.org")
    assert "no accounts" in clearlines("demo", "--no-browser", "--port", 0, status=2).stderr
