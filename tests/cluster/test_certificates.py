"""A cluster whose parts show each other certificates, made by the commands of docs/operations.md."""

from __future__ import annotations

import re
import socket
import ssl
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import dask.config
import pytest

from app.jobs.cluster.crew import ClusterCrew

PAGE = (Path(__file__).parents[2] / "docs" / "operations.md").read_text()
INSTALLED = str(Path(sys.executable).with_name("clearlines"))
Eventually = Callable[[Callable[[], Any], str], Any]


@pytest.fixture
def certificates(tmp_path: Path) -> Path:
    """A folder with an authority and what it signed, made as the page does it."""
    found = re.search(r"    openssl req -x509(?:.*\n    )*done\n", PAGE)
    assert found is not None
    subprocess.run(["bash", "-e", "-c", found[0]], cwd=tmp_path, check=True, capture_output=True)
    return tmp_path


@pytest.fixture
def scheduler(certificates: Path) -> Iterator[int]:
    """Run a scheduler and a worker; return the scheduler's port."""
    with socket.create_server(("127.0.0.1", 0)) as probe:
        port = probe.getsockname()[1]
    commands = {"scheduler": ["--port", str(port)], "worker": [f"tls://127.0.0.1:{port}", "--workers", "1"]}
    running: list[subprocess.Popen[bytes]] = []
    for name, arguments in commands.items():
        shown = ["--tls-ca", "ca.pem", "--tls-cert", f"{name}.pem", "--tls-key", f"{name}.key"]
        with (certificates / f"{name}.log").open("wb") as log:
            command = [INSTALLED, name, *arguments, *shown]
            running.append(subprocess.Popen(command, cwd=certificates, stdout=log, stderr=log))
    yield port
    for process in reversed(running):
        process.terminate()
        process.wait(60)


def test_who_shows_a_certificate_is_let_in_and_nobody_else(
    scheduler: int, certificates: Path, eventually: Eventually
) -> None:
    names = sorted(set(re.findall(r"DASK_\w+", PAGE)))
    assert len(names) == 3
    files = {"CA_FILE": "ca.pem", "CLIENT__CERT": "server.pem", "CLIENT__KEY": "server.key"}
    given = {name: str(certificates / files[name.partition("TLS__")[2]]) for name in names}
    with dask.config.set(dask.config.merge(dask.config.config, dask.config.collect_env(given))):
        crew = ClusterCrew(f"tls://127.0.0.1:{scheduler}", megabytes=None, task_seconds=60.0, pause=0.2)
        crew.start(lambda: None)
        try:
            eventually(lambda: crew.size == 1, "the worker has joined")
            assert crew.submit(divmod, 17, 5).result(60) == (3, 2)
        finally:
            crew.stop()
    context = ssl.create_default_context(cafile=str(certificates / "ca.pem"))
    context.check_hostname = False
    with (
        socket.create_connection(("127.0.0.1", scheduler)) as plain,
        context.wrap_socket(plain) as stranger,
        pytest.raises(ssl.SSLError, match=r"(?i)certificate.required"),
    ):
        stranger.recv(1)
