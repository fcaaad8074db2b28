"""Put exported files into a folder, or stream them as a zip."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Iterable, Iterator
from pathlib import Path, PurePosixPath

from app.formats.naming import check_names

PACKED = frozenset({".png", ".jpg", ".jpeg", ".webp", ".npz", ".zip"})
EARLIEST = (1980, 1, 1, 0, 0, 0)


def fill_folder(members: Iterable[tuple[str, bytes]], folder: Path) -> list[Path]:
    """Write (path, content) pairs under a folder, which is made if missing; files there are replaced.

    Returns:
        The files written.

    Raises:
        InvalidFile: If a path would leave the folder.
    """
    written: list[Path] = []
    for path, content in members:
        check_names([path], where=str(folder))
        target = folder / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(content)
        written.append(target)
    return written


def stream_zip(members: Iterable[tuple[str, bytes]]) -> Iterator[bytes]:
    """Yield a zip of (path, content) pairs piece by piece; no more than one member is held in memory.

    The same members give the same bytes: entries carry no time.
    """
    sink = _Sink()
    with zipfile.ZipFile(sink, "w") as archive:
        for path, content in members:
            check_names([path], where="zip")
            info = zipfile.ZipInfo(path, EARLIEST)
            info.external_attr = 0o644 << 16
            packed = PurePosixPath(path).suffix.lower() in PACKED
            info.compress_type = zipfile.ZIP_STORED if packed else zipfile.ZIP_DEFLATED
            archive.writestr(info, content)
            yield sink.take()
    yield sink.take()


class _Sink(io.RawIOBase):
    """A file that can't seek, and gives away what was written to it."""

    def __init__(self) -> None:
        self.parts: list[bytes] = []

    def writable(self) -> bool:
        return True

    def write(self, data: bytes, /) -> int:  # type: ignore[override]
        self.parts.append(bytes(data))
        return len(data)

    def take(self) -> bytes:
        content = b"".join(self.parts)
        self.parts.clear()
        return content
