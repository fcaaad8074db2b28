"""What a page in the browser holds: its script's objects, and the memory of the process that shows it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from playwright.sync_api import Page


@dataclass(frozen=True)
class PageMemory:
    """Memory after a collection of garbage, MB.

    Attributes:
        heap: JavaScript's objects; neither typed arrays nor bitmaps.
        process: Everything of the page's process that is in memory; ``None`` where it can't be told.
    """

    heap: float
    process: float | None


def renderer_megabytes(page: Page) -> PageMemory:
    """Measure a page of a Chromium that runs on this machine."""
    session = page.context.new_cdp_session(page)
    session.send("HeapProfiler.collectGarbage")
    heap = page.evaluate("performance.memory.usedJSHeapSize / 1e6")
    session.detach()
    browser = page.context.browser
    if browser is None:
        return PageMemory(heap, None)
    told = browser.new_browser_cdp_session()
    processes = told.send("SystemInfo.getProcessInfo")["processInfo"]
    told.detach()
    sizes = [_resident_megabytes(process["id"]) for process in processes if process["type"] == "renderer"]
    known = [size for size in sizes if size is not None]
    return PageMemory(heap, max(known) if known else None)


def _resident_megabytes(process: int) -> float | None:
    """Return the resident memory of a process, where the system has files that tell it."""
    status = Path(f"/proc/{process}/status")
    if not status.is_file():
        return None
    lines = (line.split() for line in status.read_text().splitlines() if line.startswith("VmRSS:"))
    return next((int(line[1]) / 1e3 for line in lines), None)
