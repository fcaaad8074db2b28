"""One task on its way to one worker and back, and the little that is asked of a scheduler."""

from __future__ import annotations

import asyncio
from concurrent.futures import CancelledError
from contextlib import suppress
from typing import Any
from urllib.parse import urlsplit

from distributed import Client, KilledWorker
from distributed.comm.core import CommClosedError

from app.jobs.cluster.members import Member, Order
from app.jobs.cluster.tasks import Answer, run_task
from app.jobs.losses import WorkerDied, WorkerLeft

CONNECT_SECONDS = 10.0


async def carry(client: Client, member: Member, order: Order) -> None:
    """Send a task to its worker, wait for the answer, or for the worker's end, and tell whoever submitted it.

    Args:
        client: Connected to the scheduler.
        member: The worker; how much memory it holds is known afterwards.
        order: The task; its future is done afterwards, unless nobody wants it any more.
    """
    sent = client.submit(
        run_task, order.key, order.call, key=order.key, workers=[member.address], retries=0, pure=False
    )
    answer, let_go = asyncio.ensure_future(_answer(sent)), asyncio.ensure_future(member.let_go.wait())
    await asyncio.wait({answer, member.gone, let_go}, return_when=asyncio.FIRST_COMPLETED)
    let_go.cancel()
    try:
        if answer.done():
            found = answer.result()
            member.megabytes = found.megabytes
            _succeed(order, found.result)
        elif member.gone.done():
            fail(order, member.gone.exception() or WorkerLeft("it left"))
        else:
            order.future.cancel()
    except KilledWorker:
        # it may have said a moment before that it was told to stop
        known = member.gone.exception() if member.gone.done() else None
        fail(order, known or WorkerDied("the worker died"))
    except (CancelledError, asyncio.CancelledError, CommClosedError):
        fail(order, WorkerLeft("the scheduler is out of reach"))
    except Exception as error:  # what the task raised
        fail(order, error)
    finally:
        if not answer.done():
            answer.cancel()
            with suppress(Exception):
                await client.cancel([sent], force=True)
        sent.release()


def fail(order: Order, error: BaseException) -> None:
    """Tell whoever submitted a task that it failed, unless they know already what came of it."""
    if not order.future.done():
        order.future.set_exception(error)


async def knock(address: str) -> None:
    """Raise at once where nobody listens: Dask would go on trying for long, and fill the log.

    Raises:
        OSError: When nobody answers there.
    """
    parts = urlsplit(address)
    async with asyncio.timeout(CONNECT_SECONDS):
        _, writer = await asyncio.open_connection(parts.hostname, parts.port)
    writer.close()


async def workers_of(client: Any) -> list[str]:
    """Return the addresses of a scheduler's workers."""
    return list((await client.scheduler.identity(n_workers=-1))["workers"])


async def _answer(sent: Any) -> Answer:
    """Wait for a task; of any type, as Dask's own don't know that its client may be asynchronous."""
    return await sent


def _succeed(order: Order, result: Any) -> None:
    if not order.future.done():
        order.future.set_result(result)
