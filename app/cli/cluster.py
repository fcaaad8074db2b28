"""The commands of a cluster: ``scheduler`` and ``worker``."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated

import typer

from app.cli.terminal import terminal
from app.jobs.cluster.addresses import require_cluster, require_dask

TlsCa = Annotated[Path | None, typer.Option("--tls-ca", help="Certificate of the authority; PEM.")]
TlsCert = Annotated[Path | None, typer.Option("--tls-cert", help="Certificate of this process; PEM.")]
TlsKey = Annotated[Path | None, typer.Option("--tls-key", help="Its private key; PEM.")]


def scheduler(
    host: Annotated[str, typer.Option(help="Address to listen on; one of a private network.")] = "127.0.0.1",
    port: Annotated[int, typer.Option(min=0, max=65535, help="Port to listen on; 0 takes a free one.")] = 8786,
    tls_ca: TlsCa = None,
    tls_cert: TlsCert = None,
    tls_key: TlsKey = None,
) -> None:
    """Run the scheduler that servers (`serve --cluster`) and workers meet at. Whoever reaches it can run anything."""
    require_dask()
    from app.commands.cluster import certificates_from, run_scheduler

    certificates = certificates_from(tls_ca, tls_cert, tls_key)
    if certificates is None and host not in ("127.0.0.1", "::1", "localhost"):
        terminal.print("[yellow]no TLS:[/] whoever reaches this address can run anything in servers and workers")
    run_scheduler(host, port, certificates=certificates, announce=lambda at: terminal.print(f"scheduler at {at}"))


def worker(
    address: Annotated[str, typer.Argument(help="Of the scheduler: tcp://HOST:8786, or tls://.")],
    workers: Annotated[
        int | None, typer.Option(min=1, max=1024, help="Processes; one per core if left out.", show_default=False)
    ] = None,
    memory: Annotated[
        int | None, typer.Option(min=256, help="MB of each; one that takes more is replaced.", show_default=False)
    ] = None,
    lifetime: Annotated[
        float | None, typer.Option(min=1, help="Hours after which each is replaced.", show_default=False)
    ] = None,
    tls_ca: TlsCa = None,
    tls_cert: TlsCert = None,
    tls_key: TlsKey = None,
) -> None:
    """Work for servers on other machines, without settings or a database; looks for the scheduler until stopped."""
    require_cluster(address)
    from app.commands.cluster import certificates_from, run_workers

    run_workers(
        address,
        workers or os.cpu_count() or 1,
        megabytes=memory,
        lifetime=None if lifetime is None else lifetime * 3600,
        certificates=certificates_from(tls_ca, tls_cert, tls_key),
        announce=lambda at: terminal.print(f"worker at {at}"),
    )
