"""Bounds on what one task may take of a worker: memory and time.

Memory is bounded by the system, where it can be: what asks for more gets a `MemoryError`. Time is bounded twice: an
alarm raises in Python code; code that doesn't come back to Python is ended with its process a while later.
"""

from __future__ import annotations

import ctypes
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import FrameType
from typing import NoReturn

from app.errors import TooLarge

MEBIBYTE = 2**20


@dataclass(frozen=True)
class TaskLimits:
    """What one task may take.

    Attributes:
        seconds: Wall clock.
        megabytes: Memory on top of what the worker has when the task begins.
        grace: How many seconds longer than the alarm it may take before its process is ended.
    """

    seconds: float = 300.0
    megabytes: int = 2048
    grace: float = 30.0


TASK_LIMITS = TaskLimits()


class TookTooLong(TooLarge):
    """A task took longer than it may."""

    code = "took-too-long"


@contextmanager
def bounded(limits: TaskLimits, what: str) -> Iterator[None]:
    """Bound the block; to be used by a worker that does nothing else, in its main thread or another one.

    Args:
        limits: How much it may take.
        what: What is being done, for messages.

    Raises:
        TookTooLong: Where it takes too long.
        MemoryError: Where it asks for too much.
    """
    with _bounded_time(limits.seconds, limits.grace, what), _bounded_memory(limits.megabytes * MEBIBYTE):
        yield


@contextmanager
def _bounded_time(seconds: float, grace: float, what: str) -> Iterator[None]:
    if not hasattr(signal, "setitimer"):  # no alarms on Windows
        yield
        return

    def too_long() -> TookTooLong:
        return TookTooLong(f"{what} took longer than {seconds:g} s", hint="are there far more segments than lines?")

    if threading.current_thread() is not threading.main_thread():  # a cluster's worker keeps that one for itself
        with _bounded_time_of_thread(seconds, grace, too_long):
            yield
        return

    def ring(number: int, frame: FrameType | None) -> NoReturn:
        del number, frame
        raise too_long()

    before = signal.signal(signal.SIGALRM, ring)
    last_resort = threading.Timer(seconds + grace, os.kill, (os.getpid(), signal.SIGKILL))
    last_resort.daemon = True
    last_resort.start()
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
        last_resort.cancel()


class _Alarm(BaseException):
    """Raised in a thread whose time is over; not an ``Exception``, so that no task takes it for one of its own."""


@contextmanager
def _bounded_time_of_thread(seconds: float, grace: float, error: Callable[[], TookTooLong]) -> Iterator[None]:
    """Bound the time of a thread other than the main one, which alone can have alarms."""
    thread, lock, over = ctypes.c_ulong(threading.get_ident()), threading.Lock(), threading.Event()

    def ring() -> None:
        with lock:
            if not over.is_set():
                ctypes.pythonapi.PyThreadState_SetAsyncExc(thread, ctypes.py_object(_Alarm))

    last_resort = (os.getpid(), signal.SIGKILL)
    timers = [threading.Timer(seconds, ring), threading.Timer(seconds + grace, os.kill, last_resort)]
    for timer in timers:
        timer.daemon = True
        timer.start()
    try:
        yield
    except _Alarm:
        raise error() from None
    finally:
        with lock:
            over.set()
            ctypes.pythonapi.PyThreadState_SetAsyncExc(thread, None)  # one that rang but wasn't heard yet
        for timer in timers:
            timer.cancel()


@contextmanager
def _bounded_memory(size: int) -> Iterator[None]:
    if not sys.platform.startswith("linux"):  # elsewhere the bound is missing, or isn't kept
        yield
        return
    import resource

    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    wanted = _address_space() + size
    resource.setrlimit(resource.RLIMIT_AS, (wanted if hard == resource.RLIM_INFINITY else min(wanted, hard), hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, (soft, hard))


def _address_space() -> int:
    """Return the bytes of address space that this process has taken."""
    return int(Path("/proc/self/statm").read_text().split()[0]) * os.sysconf("SC_PAGE_SIZE")
