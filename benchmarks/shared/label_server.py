"""A server of its own for measuring the label page, with images whose candidates are all undecided."""

from __future__ import annotations

import json
import socket
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from uuid import uuid4

Datasets = Mapping[str, Callable[[Path], None]]


def request(address: str, body: object = None) -> Any:
    """Return the API's answer to GET, or to POST where there is a body."""
    data = None if body is None else json.dumps(body).encode()
    call = urllib.request.Request(address, data, {"Content-Type": "application/json"})
    with urllib.request.urlopen(call, timeout=60) as answer:
        return json.load(answer)


@contextmanager
def label_server(datasets: Datasets) -> Iterator[str]:
    """Serve datasets until the context is left, and give the server's address.

    Args:
        datasets: By name, what writes each in the layout that ``clearlines import`` reads.
    """
    clearlines = Path(sys.executable).with_name("clearlines")
    with socket.socket() as probe, tempfile.TemporaryDirectory() as folder:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
        probe.close()
        data = Path(folder) / "data"
        for name, write in datasets.items():
            write(Path(folder) / name)
            command = [clearlines, "import", Path(folder) / name, "--dataset", name, "--data", data]
            subprocess.run(command, check=True, capture_output=True)
        command = [clearlines, "serve", "--data", data, "--port", str(port), "--no-browser"]
        quiet = subprocess.DEVNULL
        process = subprocess.Popen(command, stdout=quiet, stderr=quiet)
        try:
            address = f"http://127.0.0.1:{port}"
            _wait_for(f"{address}/api/health")
            for name in datasets:
                for image in request(f"{address}/api/datasets/{name}/images?limit=500")["items"]:
                    _make_undecided(f"{address}/api/images/{image['id']}")
            yield address
        finally:
            process.terminate()
            process.wait()


def _wait_for(address: str) -> None:
    deadline = time.monotonic() + 60
    while True:
        try:
            request(address)
        except (urllib.error.URLError, OSError):
            if time.monotonic() > deadline:
                raise
            time.sleep(0.1)
        else:
            return


def _make_undecided(address: str) -> None:
    group = str(uuid4())
    decisions = [
        {"client_id": str(uuid4()), "group_id": group, "segment_id": entry["id"], "verdict": "undecided"}
        for entry in request(f"{address}/segments")["segments"]
    ]
    request(f"{address}/decisions", {"decisions": decisions})
