"""The real application on loopback, over a database that was filled.

python benchmarks/shared/scale_app.py DATABASE_URL DATA_DIR PORT
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from subprocess import Popen, TimeoutExpired

import httpx2 as httpx
import uvicorn

from app.api.application import create_application
from app.commands.serve import EndingServer
from app.settings import Settings

READY = 120.0  # s


def scale_settings(address: str, folder: Path) -> Settings:
    """Return settings of a server that limits nobody: one client asks as fast as it can."""
    return Settings(
        database_url=address,
        data_dir=folder,
        workers=1,
        request_limit="1000000/second",
        upload_limit="1000000/second",
    )


@contextmanager
def served(address: str, folder: Path, port: int) -> Iterator[tuple[str, int]]:
    """Serve a database in a process of its own; give the address of its API and the number of the process."""
    folder.mkdir(parents=True, exist_ok=True)
    with (
        (folder / "server.log").open("w") as log,
        Popen([sys.executable, __file__, address, str(folder), str(port)], stdout=log, stderr=log) as process,
    ):
        try:
            base = f"http://127.0.0.1:{port}/api"
            with httpx.Client() as client:
                _wait_for(client, f"{base}/health", process, folder / "server.log")
            yield base, process.pid
        finally:
            process.terminate()


def _wait_for(client: httpx.Client, address: str, process: Popen[bytes], log: Path) -> None:
    for _ in range(int(READY / 0.2)):
        try:
            if client.get(address).status_code == httpx.codes.OK:
                return
        except httpx.TransportError:
            pass
        if process.poll() is not None:
            raise RuntimeError(f"the server ended: {log.read_text()[-2000:]}")
        with suppress(TimeoutExpired):
            process.wait(0.2)
    raise RuntimeError("the server didn't answer")


def main() -> None:
    address, folder, port = sys.argv[1:]
    application = create_application(scale_settings(address, Path(folder)))
    config = uvicorn.Config(application, host="127.0.0.1", port=int(port), log_level="warning", access_log=False)
    EndingServer(config, application.state.stopping).run()  # as `clearlines serve` does


if __name__ == "__main__":
    main()
