"""The commands that open the tool: ``demo`` and ``serve``."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import typer

from app.cli.options import DataDir, NoBrowser, Port, settings_from
from app.cli.terminal import announce
from app.commands.paths import require_there
from app.commands.progress import progress_bar
from app.jobs.cluster.addresses import require_cluster


def demo(data: DataDir = None, port: Port = None, no_browser: NoBrowser = False) -> None:
    """Make a small synthetic street dataset, pre-label it, and open the tool."""
    from app.commands.address import address_of, listen, require_no_proxy
    from app.commands.demo_settings import demo_settings

    settings = demo_settings(settings_from(data_dir=data, port=port))
    require_no_proxy(settings.public_url)
    with listen(settings.host, settings.port) as server:
        with _nothing_collected():
            from app.commands.demo import prepare_demo
            from app.commands.demo_board import prepare_board
            from app.commands.serve import run_server

        with progress_bar("Drawing streets") as report:
            slug = prepare_demo(settings, progress=report)
        with progress_bar("Making a leaderboard") as report:
            prepare_board(settings, progress=report)
        announce(address_of(server), settings.data_dir)
        run_server(settings, server, open_at=None if no_browser else f"/datasets/{slug}")


def serve(
    image_dir: Annotated[Path | None, typer.Argument(help="Images to bring in and pre-label.")] = None,
    data: DataDir = None,
    host: Annotated[
        str | None, typer.Option(help="Address to listen on; others reach one that isn't a loopback address.")
    ] = None,
    port: Port = None,
    public_url: Annotated[
        str | None, typer.Option(help="https://NAME under which a proxy serves it to others.", show_default=False)
    ] = None,
    no_browser: NoBrowser = False,
    cluster: Annotated[
        str | None, typer.Option(help="Dask scheduler whose workers do the work: tcp://HOST:8786.", show_default=False)
    ] = None,
) -> None:
    """Serve the browser tool and the API; with IMAGE_DIR its images come in and are pre-labelled.

    Alone on this machine whoever asks is its owner. Where others can reach it (--host, --public-url) accounts decide.
    """
    from app.commands.address import address_of, listen

    if image_dir is not None:
        require_there([image_dir])
    settings = settings_from(data_dir=data, host=host, port=port, public_url=public_url, cluster=cluster)
    if settings.cluster is not None:
        require_cluster(settings.cluster)
    if settings.hosted:
        from app.commands.hosting import require_admin

        require_admin(settings)
    with listen(settings.host, settings.port, has_accounts=settings.hosted) as server:
        with _nothing_collected():
            from app.commands.serve import import_and_prelabel, prepare_data, run_server

        prepare_data(settings)
        start = "/"
        if image_dir is not None:
            with progress_bar("Importing") as report:
                slug = import_and_prelabel(settings, image_dir, _folder_name(image_dir), progress=report)
            start = f"/datasets/{slug}"
        announce((settings.public_url or address_of(server)).rstrip("/") + start, settings.data_dir)
        run_server(settings, server, open_at=None if no_browser or settings.hosted else start)


@contextmanager
def _nothing_collected() -> Iterator[None]:
    """Import faster by a sixth: what modules make stays, and looking through it for what doesn't finds nothing."""
    gc.disable()
    try:
        yield
    finally:
        gc.enable()


def _folder_name(folder: Path) -> str:
    """Name a dataset after its folder; one called ``images`` after the folder above."""
    resolved = folder.resolve()
    return resolved.parent.name if resolved.name == "images" and resolved.parent.name else resolved.name
