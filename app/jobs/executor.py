"""Worker processes behind ``concurrent.futures.Executor``, the one seam between dispatcher and workers.

A worker lives as long as the process that made it holds the other end of a pipe, its lifeline: whatever kills that
process, kill -9 too, cuts the lifeline and the workers end at once instead of working on for nobody.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import threading
from concurrent.futures import Executor, ProcessPoolExecutor
from multiprocessing.connection import Connection
from pathlib import Path

MEBIBYTE = 2**20
BACKGROUND = 10
"""Niceness of work in the background: on a busy machine it gets about a tenth of a processor, else all of it."""


class WorkerPool(ProcessPoolExecutor):
    """A process pool whose workers can be ended at once and end with their maker.

    Args:
        workers: Number of processes; started when there is work for them.
        niceness: By how much they step back behind whatever else wants the processor; 0 to 19.
    """

    def __init__(self, workers: int, *, niceness: int = 0) -> None:
        # spawned, not forked: the server has threads, and a fork copies their locks in whatever state they are
        context = multiprocessing.get_context("spawn")
        self._workers_end, self._lifeline = context.Pipe(duplex=False)
        arguments = (self._workers_end, niceness)
        super().__init__(workers, mp_context=context, initializer=_prepare_worker, initargs=arguments)

    def end_workers(self) -> None:
        """End the workers at once, in the middle of their work; what they worked on is lost."""
        self._lifeline.close()
        self._workers_end.close()
        self.shutdown(wait=False, cancel_futures=True)

    def megabytes(self) -> dict[int, float | None]:
        """Return the memory that each worker holds, by process id; ``None`` where the system doesn't tell."""
        processes = self._processes
        return {process_id: megabytes_of(process_id) for process_id in list(processes or ())}


def megabytes_of(process_id: int) -> float | None:
    """Return the memory that a process holds; ``None`` where the system doesn't tell, as all but Linux."""
    try:
        pages = int(Path(f"/proc/{process_id}/statm").read_text().split()[1])
    except (OSError, ValueError, IndexError):
        return None
    return pages * os.sysconf("SC_PAGE_SIZE") / MEBIBYTE


def make_executor(workers: int) -> Executor:
    """Return the default executor: processes on this machine.

    Args:
        workers: Number of processes.
    """
    return WorkerPool(workers)


def make_background_executor(workers: int) -> Executor:
    """Return an executor for work that nobody waits for: a page that is being looked at comes first.

    Args:
        workers: Number of processes.
    """
    return WorkerPool(workers, niceness=BACKGROUND)


def end_executor(executor: Executor) -> None:
    """Take an executor down without waiting for the work in it."""
    if isinstance(executor, WorkerPool):
        executor.end_workers()
    else:
        executor.shutdown(wait=False, cancel_futures=True)


def _prepare_worker(lifeline: Connection, niceness: int) -> None:
    if niceness and hasattr(os, "nice"):
        os.nice(niceness)
    # Ctrl-C reaches the whole process group; only the maker answers it
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with, args=(lifeline,), name="lifeline", daemon=True).start()
    # one process per core is enough: threads inside would only fight for them
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    import cv2

    cv2.setNumThreads(1)


def _end_with(lifeline: Connection) -> None:
    with contextlib.suppress(EOFError, OSError):
        lifeline.recv_bytes()
    os._exit(1)
