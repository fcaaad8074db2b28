"""``clearlines scheduler`` and ``clearlines worker``: Dask's own processes, set up for one kind of work.

Neither needs settings or a database. What they are sent is unpickled, so whoever reaches them can run anything in them:
they belong on a private network, or behind TLS with a certificate authority of their own.
"""

from __future__ import annotations

import asyncio
import logging
import signal
import socket
import uuid
from collections.abc import Callable, Coroutine
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import dask.config
from distributed import Nanny, Scheduler, Security

from app.errors import InvalidInput, Unavailable
from app.jobs.cluster.carrying import knock
from app.jobs.cluster.tasks import LEAVING

logger = logging.getLogger(__name__)

AGAIN_PAUSE = 2.0
"""Seconds before a worker whose scheduler went away looks for it again."""
START_SECONDS = 60.0
"""Seconds that a worker process may take to start and register, on a busy machine; then another one is started."""
SCHEDULER_CONFIG = {
    # the dispatcher charges work that kills its worker, and decides whether it is tried again
    "distributed.scheduler.allowed-failures": 0,
    "distributed.scheduler.work-stealing": False,
    "distributed.scheduler.worker-ttl": "60s",
    "distributed.scheduler.active-memory-manager.start": False,
    "distributed.scheduler.http.routes": [],
}
WORKER_CONFIG = {
    "distributed.worker.profile.enabled": False,
    "distributed.worker.http.routes": [],
    # results are fetched at once: a worker holds nothing that could be spilled, and one that is paused never goes on
    "distributed.worker.memory.target": False,
    "distributed.worker.memory.spill": False,
    "distributed.worker.memory.pause": False,
    "distributed.worker.lifetime.restart": True,
}


@dataclass(frozen=True)
class Certificates:
    """Files for TLS, in PEM form; each peer shows one that the authority signed.

    Attributes:
        authority: Certificate of the authority.
        certificate: Of this process.
        key: Its private key.
    """

    authority: Path
    certificate: Path
    key: Path

    def security(self) -> Security:
        """Return Dask's form of it: nothing unencrypted is accepted."""
        pair = {"cert": str(self.certificate), "key": str(self.key)}
        roles = {
            f"tls_{role}_{part}": file for role in ("scheduler", "worker", "client") for part, file in pair.items()
        }
        return Security(tls_ca_file=str(self.authority), require_encryption=True, **roles)


def run_scheduler(
    host: str, port: int, *, certificates: Certificates | None = None, announce: Callable[[str], None]
) -> None:
    """Run a scheduler until told to stop.

    Args:
        host: Address to listen on.
        port: Port to listen on; 0 takes a free one.
        certificates: For TLS.
        announce: Called with its address once it listens.

    Raises:
        Unavailable: When it can't listen there.
    """

    async def run() -> None:
        stop = _stop_signal()
        try:
            scheduler = await Scheduler(
                host=host,
                port=port,
                protocol="tcp" if certificates is None else "tls",
                security=None if certificates is None else certificates.security(),
                dashboard=False,
                dashboard_address="127.0.0.1:0",
            )
        except (OSError, RuntimeError) as error:
            raise Unavailable(
                f"can't listen on {host}:{port}: {error.__cause__ or error}", where="scheduler"
            ) from error
        announce(scheduler.address)
        await _first(stop.wait(), scheduler.finished())
        await scheduler.close()

    with dask.config.set(SCHEDULER_CONFIG):
        asyncio.run(run())


def run_workers(
    address: str,
    workers: int,
    *,
    megabytes: int | None,
    lifetime: float | None = None,
    certificates: Certificates | None = None,
    announce: Callable[[str], None],
) -> None:
    """Run workers of a scheduler until told to stop; they look for it again whenever it goes away.

    Args:
        address: Of the scheduler.
        workers: Number of processes; each has one thread and does one task at a time.
        megabytes: Memory of each; one that takes more is ended and replaced. Unbounded if left out.
        lifetime: Seconds after which a worker is replaced, and its work given to another; never if left out.
        certificates: For TLS.
        announce: Called with the address of each worker as it begins.
    """

    async def keep(stop: asyncio.Event) -> None:
        said = None
        while not stop.is_set():
            try:
                await knock(address)
                await work(stop)
                said = None
            except Exception as error:  # whatever it is, the scheduler may be back in a moment
                slow = f"it took more than {START_SECONDS:g} s to start"
                problem = slow if isinstance(error, TimeoutError) else str(error) or type(error).__name__
                if problem != said:
                    logger.warning("a worker can't work, and tries again every %g s: %s", AGAIN_PAUSE, problem)
                said = problem
            await _first(stop.wait(), asyncio.sleep(AGAIN_PAUSE))

    async def work(stop: asyncio.Event) -> None:
        nanny = Nanny(
            address,
            # a scheduler refuses a name that it knows, of one that was killed a moment ago too
            name=f"{socket.gethostname()}-{uuid.uuid4().hex[:6]}",
            nthreads=1,
            memory_limit="0" if megabytes is None else f"{megabytes}MiB",
            security=None if certificates is None else certificates.security(),
            preload=["app.jobs.cluster.preload"],
            lifetime=lifetime,
            lifetime_stagger=0 if lifetime is None else lifetime / 10,
            dashboard=False,
            dashboard_address="127.0.0.1:0",
        )
        beginning = asyncio.ensure_future(_begin(nanny))
        try:
            await asyncio.wait_for(_first(stop.wait(), _done(beginning)), START_SECONDS)
            if beginning.done():
                beginning.result()
                announce(nanny.worker_address or nanny.address)
                await _first(stop.wait(), nanny.finished())
                if stop.is_set():
                    # else its work would look as if it had killed it
                    await nanny.scheduler.log_event(topic=LEAVING, msg={"worker": nanny.worker_address})
        finally:
            await _end(nanny, beginning)

    async def run() -> None:
        stop = _stop_signal()
        await asyncio.gather(*(keep(stop) for _ in range(workers)))

    with dask.config.set(WORKER_CONFIG):
        asyncio.run(run())


def certificates_from(authority: Path | None, certificate: Path | None, key: Path | None) -> Certificates | None:
    """Return what TLS needs; ``None`` without any.

    Raises:
        InvalidInput: When one of the three is missing.
    """
    if authority is None and certificate is None and key is None:
        return None
    if authority is None or certificate is None or key is None:
        raise InvalidInput("TLS needs three files", expected="--tls-ca, --tls-cert and --tls-key")
    for file in (authority, certificate, key):
        if not file.is_file():
            raise InvalidInput("there is no such file", where=str(file))
    return Certificates(authority, certificate, key)


def _stop_signal() -> asyncio.Event:
    """Return what is set by Ctrl-C and by SIGTERM."""
    stop = asyncio.Event()
    loop = asyncio.get_running_loop()
    for number in (signal.SIGINT, signal.SIGTERM):
        loop.add_signal_handler(number, stop.set)
    return stop


async def _begin(nanny: Nanny) -> None:
    await nanny


async def _done(task: asyncio.Future[None]) -> None:
    await asyncio.wait({task})


async def _end(nanny: Nanny, beginning: asyncio.Future[None]) -> None:
    """End a nanny and its worker, one that is still starting too: Dask would leave that behind, to work unseen."""
    worker = nanny.process
    beginning.cancel()
    await asyncio.gather(beginning, return_exceptions=True)
    with suppress(Exception):  # it knows no way to end what is starting
        await nanny.close()
    process = worker and worker.process
    if process is not None:
        with suppress(ValueError):  # it has ended meanwhile
            await process.kill()
            await process.join()


async def _first(*waits: Coroutine[Any, Any, Any]) -> None:
    """Wait until one of these is over."""
    tasks = [asyncio.ensure_future(wait) for wait in waits]
    try:
        await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for task in tasks:
            task.cancel()
