"""Telling how far a long computation is, and calling it off."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from app.errors import Cancelled
from app.vision.native.library import OUT_OF_MEMORY, Report


@dataclass(frozen=True)
class Watch:
    """Who is told of progress, and whose wish to cancel is heard, in one part of a computation.

    Attributes:
        progress: Told the share of the whole computation that is done, in [0, 1]; never less than before.
        cancelled: Asked now and then; True calls the computation off.
        begin: Share of the whole that is done when this part begins.
        end: Share that is done when it ends.
    """

    progress: Callable[[float], None] | None = None
    cancelled: Callable[[], bool] | None = None
    begin: float = 0.0
    end: float = 1.0

    def part(self, begin: float, end: float) -> Watch:
        """Return the watch over a part of this one; ``begin`` and ``end`` are shares of this one."""
        size = self.end - self.begin
        return replace(self, begin=self.begin + begin * size, end=self.begin + end * size)

    def tell(self, share: float) -> None:
        """Pass on that a share of this part, in [0, 1], is done.

        Raises:
            Cancelled: If that is wished.
        """
        if self.cancelled is not None and self.cancelled():
            raise Cancelled("the detection was cancelled")
        if self.progress is not None:
            self.progress(self.begin + (self.end - self.begin) * min(max(share, 0.0), 1.0))

    def call(self, kernel: Callable[..., int], *arguments: Any) -> int:
        """Call a kernel, whose last argument is a `Report`, and return the count that it returns.

        Whatever `progress` or `cancelled` raise while it runs ends it, and is raised here as it is.

        Raises:
            Cancelled: If that is wished.
            MemoryError: If the kernel gets no memory.
        """
        if self.progress is None and self.cancelled is None:
            return counted(kernel(*arguments, Report()))
        raised: list[BaseException] = []

        def report(share: float) -> int:
            # ctypes prints what a callback raises, and goes on
            try:
                self.tell(share)
            except BaseException as error:
                raised.append(error)
                return 1
            return 0

        status = kernel(*arguments, Report(report))
        if raised:
            raise raised[0]
        return counted(status)


def counted(status: int) -> int:
    """Return the count that a kernel returned.

    Raises:
        MemoryError: If the kernel got no memory.
    """
    if status == OUT_OF_MEMORY:
        raise MemoryError("a kernel of the detector got no memory")
    if status < 0:
        raise RuntimeError(f"a kernel of the detector failed with status {status}")
    return status
