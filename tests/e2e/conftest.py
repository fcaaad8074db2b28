"""The product as a person meets it: the command in a process of its own, a real browser in front of it."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
import urllib.error
import urllib.request
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, Page, sync_playwright

from app.commands.exchange import import_images
from app.commands.token import make_token
from app.settings import Settings

ROOT = Path(__file__).resolve().parent.parent.parent
CLEARLINES = Path(sys.executable).with_name("clearlines")


@dataclass
class RunningServer:
    """A server in a process of its own."""

    address: str
    data: Path
    process: subprocess.Popen[bytes]

    def ask(self, path: str, body: object = None) -> Any:
        """Return what the API answers to GET, or to POST where there is a body."""
        content = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(f"{self.address}/api{path}", content, {"Content-Type": "application/json"})
        with urllib.request.urlopen(request, timeout=30) as answer:
            return json.load(answer)

    def kill(self) -> None:
        """Kill it as a crash would."""
        self.process.send_signal(signal.SIGKILL)
        self.process.wait()

    def stop(self) -> None:
        """Stop it as Ctrl-C would."""
        self.process.send_signal(signal.SIGINT)
        try:
            self.process.wait(timeout=20)
        except subprocess.TimeoutExpired:
            self.kill()


def free_port() -> int:
    """Return a port that nobody listens on right now."""
    import socket

    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def launch(data: Path, *arguments: str, command: str = "serve", port: int | None = None) -> RunningServer:
    """Start the command and wait until it answers."""
    port = port or free_port()
    log = (data.parent / f"{data.name}.log").open("ab")
    process = subprocess.Popen(
        [CLEARLINES, command, *arguments, "--data", data, "--port", str(port), "--no-browser"],
        stdout=log,
        stderr=log,
        env={**os.environ, "CLEARLINES_WORKERS": "1"},
    )
    log.close()
    server = RunningServer(f"http://127.0.0.1:{port}", data, process)
    deadline = time.monotonic() + 90
    while True:
        try:
            with urllib.request.urlopen(f"{server.address}/api/health", timeout=5):
                return server
        except (urllib.error.URLError, OSError):
            if process.poll() is not None or time.monotonic() > deadline:
                server.kill()
                pytest.fail(f"the server didn't start: {Path(log.name).read_text()}")
            time.sleep(0.1)


@pytest.fixture
def serve(tmp_path: Path) -> Iterator[Callable[..., RunningServer]]:
    """Start servers on one data folder; all are stopped at the end."""
    running: list[RunningServer] = []

    def serve(*arguments: str, **options: object) -> RunningServer:
        server = launch(tmp_path / "data", *arguments, **options)  # type: ignore[arg-type]
        running.append(server)
        return server

    yield serve
    for server in running:
        if server.process.poll() is None:
            server.stop()


@pytest.fixture(scope="session")
def start_server() -> Callable[..., RunningServer]:
    """Return what starts a server; for fixtures that outlive a test. Whoever starts one stops it."""
    return launch


@pytest.fixture(scope="session")
def unused_port() -> Callable[[], int]:
    """Return what finds a port; for servers that must know their address before they start."""
    return free_port


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    found = subprocess.run(
        [sys.executable, ROOT / "tools" / "browser.py"], check=True, capture_output=True, text=True
    ).stdout.strip()
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=found, args=["--no-sandbox", "--disable-gpu", "--disable-background-networking"]
        )
        yield browser
        browser.close()


@pytest.fixture
def page(browser: Browser) -> Iterator[Page]:
    """A page that fails the test when a script in it fails."""
    context = browser.new_context(viewport={"width": 1440, "height": 900}, accept_downloads=True)
    page = context.new_page()
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    yield page
    context.close()
    assert errors == []


@pytest.fixture(scope="session")
def shared_server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RunningServer]:
    """A server for all tests that need none of their own; each file works in datasets of names that no other has."""
    server = launch(tmp_path_factory.mktemp("shared") / "data")
    yield server
    server.stop()


@pytest.fixture(scope="session")
def label_server(shared_server: RunningServer) -> RunningServer:
    """The same, by the name that the tests of the label page know."""
    return shared_server


@pytest.fixture(scope="session")
def server(shared_server: RunningServer) -> RunningServer:
    """The same; a file may put a server with its own datasets in its place."""
    return shared_server


@pytest.fixture(scope="session")
def import_dataset() -> Callable[[RunningServer, Path, str], None]:
    """Return what brings a folder into a running server's database, as ``clearlines import`` does beside it."""

    def import_dataset(server: RunningServer, folder: Path, name: str) -> None:
        import_images(Settings(data_dir=server.data), folder, name)

    return import_dataset


@pytest.fixture(scope="session")
def create_token() -> Callable[[RunningServer, str, str], str]:
    """Return what makes a token for a running server, as ``clearlines token create`` does beside it."""

    def create_token(server: RunningServer, name: str, role: str) -> str:
        return make_token(Settings(data_dir=server.data), name, role).text

    return create_token
