"""``clearlines serve``: the browser tool, the API and the workers, in one process."""

from __future__ import annotations

import gc
import socket
import threading
import webbrowser
from collections.abc import Callable
from pathlib import Path
from types import FrameType

import uvicorn

from app.api.application import create_application
from app.clock import utc_now
from app.commands.address import address_of
from app.commands.exchange import import_images
from app.commands.logs import start_log
from app.commands.stores import opened_stores
from app.services import runs
from app.services.datasets import get_dataset
from app.services.image_lists import ImageFilter, list_images
from app.settings import Settings

Progress = Callable[[int, int], None]
GRACE = 5  # s; for answers under way when the server is to end
HOSTED_GRACE = 15  # s; uploads through a proxy take longer


def import_and_prelabel(settings: Settings, folder: Path, name: str, *, progress: Progress | None = None) -> str:
    """Bring a folder of images into the tool and queue a run for those that have no candidates yet.

    The same folder again changes nothing, and goes on where it was.

    Returns:
        The dataset's slug.
    """
    imported = import_images(settings, folder, name, progress=progress)
    with opened_stores(settings) as (database, _), database.write() as session:
        dataset = get_dataset(session, imported.slug)
        chosen = ImageFilter(prelabel="none", status="open")
        fresh: list[int] = []
        cursor = None
        while True:
            page = list_images(session, dataset, chosen, limit=500, cursor=cursor)
            fresh += [image.id for image in page.items if image.candidates == 0]
            cursor = page.next_cursor
            if cursor is None:
                break
        if fresh:
            runs.start_run(session, dataset, {}, fresh, utc_now(), person=settings.person)
    return imported.slug


def prepare_data(settings: Settings) -> None:
    """Make the data folder and the tables if missing, so that what is wrong is told before the server starts.

    Raises:
        ClearLinesError: As `app.commands.stores.opened_stores`.
    """
    with opened_stores(settings) as (_, blobs):
        blobs.check()


def run_server(settings: Settings, server: socket.socket, *, open_at: str | None = None) -> None:
    """Serve until stopped.

    Args:
        settings: Of the server.
        server: From `listen`; closed at the end.
        open_at: Path to open in a browser once the server answers; ``None`` opens none.
    """
    start_log(settings)
    application = create_application(settings)
    config = uvicorn.Config(
        application,
        lifespan="on",
        log_config=None,
        access_log=False,
        server_header=False,
        # where there are no accounts nobody may stand in front
        proxy_headers=settings.anonymous != "admin",
        forwarded_allow_ips=settings.trusted_proxies,
        timeout_graceful_shutdown=HOSTED_GRACE if settings.hosted else GRACE,
    )
    if open_at is not None:
        # the socket listens already: the browser's request waits until the server takes it
        threading.Timer(0.3, webbrowser.open, [address_of(server) + open_at]).start()
    with server:
        EndingServer(config, application.state.stopping).run(sockets=[server])


class EndingServer(uvicorn.Server):
    """A server that tells the application as soon as it is to end: answers that go on for long hold it up else."""

    def __init__(self, config: uvicorn.Config, stopping: threading.Event) -> None:
        super().__init__(config)
        self._stopping = stopping

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """See ``uvicorn.Server``."""
        await super().startup(sockets)
        # what was imported stays: looking through it again at each full collection would stop requests for 150 ms
        gc.collect()
        gc.freeze()

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:
        """See ``uvicorn.Server``."""
        self._stopping.set()
        super().handle_exit(sig, frame)
