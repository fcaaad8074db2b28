"""``clearlines serve``: the browser tool, the API and the workers, in one process."""

from __future__ import annotations

import ipaddress
import socket
import threading
import webbrowser
from collections.abc import Callable
from pathlib import Path

import uvicorn

from app.api.application import create_application, utc_now
from app.commands.exchange import import_images
from app.db.session import open_database, upgrade
from app.errors import Forbidden, Unavailable
from app.services import runs
from app.services.datasets import get_dataset
from app.services.image_lists import ImageFilter, list_images
from app.settings import Settings

Progress = Callable[[int, int], None]
LOOPBACK_NAMES = frozenset({"localhost"})


def require_loopback(host: str) -> None:
    """Refuse addresses that others could reach: there are no accounts yet, and the one owner may do everything.

    Raises:
        Forbidden: When the address isn't a loopback one.
    """
    try:
        loopback = ipaddress.ip_address(host.strip("[]")).is_loopback
    except ValueError:
        loopback = host.lower() in LOOPBACK_NAMES
    if not loopback:
        raise Forbidden(
            "this address could be reached from outside, and there are no accounts yet",
            where=f"--host {host}",
            expected="127.0.0.1, ::1 or localhost",
            hint="from another machine, use an SSH tunnel: ssh -L 8765:127.0.0.1:8765 HOST",
        )


def listen(host: str, port: int) -> socket.socket:
    """Return a socket that listens on the address.

    Raises:
        Unavailable: When it can't be had; most often because the port is taken.
    """
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    server = socket.socket(family, socket.SOCK_STREAM)
    server.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        server.bind((host.strip("[]"), port))
        server.listen()
    except OSError as error:
        server.close()
        raise Unavailable(
            f"can't listen there: {error.strerror or error}",
            where=f"{host}:{port}",
            hint="is ClearLines running already? Another port: --port 0 takes a free one",
        ) from error
    return server


def address_of(server: socket.socket) -> str:
    """Return the address to open in a browser."""
    host, port = server.getsockname()[:2]
    return f"http://[{host}]:{port}" if ":" in host else f"http://{host}:{port}"


def import_and_prelabel(settings: Settings, folder: Path, name: str, *, progress: Progress | None = None) -> str:
    """Bring a folder of images into the tool and queue a run for those that have no candidates yet.

    The same folder again changes nothing, and goes on where it was.

    Returns:
        The dataset's slug.
    """
    imported = import_images(settings, folder, name, progress=progress)
    database = open_database(settings.database_address)
    upgrade(database)
    try:
        with database.write() as session:
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
    finally:
        database.close()
    return imported.slug


def run_server(settings: Settings, server: socket.socket, *, open_at: str | None = None) -> None:
    """Serve until stopped.

    Args:
        settings: Of the server.
        server: From `listen`; closed at the end.
        open_at: Path to open in a browser once the server answers; ``None`` opens none.
    """
    config = uvicorn.Config(
        create_application(settings), log_level="warning", access_log=False, timeout_graceful_shutdown=5, lifespan="on"
    )
    if open_at is not None:
        # the socket listens already: the browser's request waits until the server takes it
        threading.Timer(0.3, webbrowser.open, [address_of(server) + open_at]).start()
    with server:
        uvicorn.Server(config).run(sockets=[server])
