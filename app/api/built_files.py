"""The browser tool's scripts and styles: answered from memory, compressed once, kept by browsers for good."""

from __future__ import annotations

import gzip
import mimetypes
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from starlette.datastructures import Headers
from starlette.responses import Response
from starlette.types import ASGIApp, Receive, Scope, Send

FOLDER = "assets"
FOREVER = "public, max-age=31536000, immutable"
"""For files whose names change with their content."""


@dataclass(frozen=True)
class BuiltFile:
    """A file, plain and compressed (gzip)."""

    plain: bytes
    compressed: bytes
    media_type: str


class BuiltFiles:
    """ASGI middleware: answers for the files that the build named by their content; passes on all else.

    Args:
        app: What answers for the rest.
        static: The folder of the built browser tool.
    """

    def __init__(self, app: ASGIApp, *, static: Path) -> None:
        self.app = app
        self.paths = {f"/{FOLDER}/{path.name}": path for path in (static / FOLDER).glob("*") if path.is_file()}
        self.read = lru_cache(maxsize=None)(_read)  # as many as there are files, about 1 MB together

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer one request."""
        path = self.paths.get(scope.get("path", "")) if scope["type"] == "http" and scope["method"] == "GET" else None
        if path is None or not path.is_file():  # another build may have taken its place
            await self.app(scope, receive, send)
            return
        file = self.read(path)
        headers = {"Cache-Control": FOREVER, "Vary": "Accept-Encoding"}
        content = file.plain
        if "gzip" in Headers(scope=scope).get("accept-encoding", ""):
            content = file.compressed
            headers["Content-Encoding"] = "gzip"
        await Response(content, media_type=file.media_type, headers=headers)(scope, receive, send)


def _read(path: Path) -> BuiltFile:
    plain = path.read_bytes()
    media_type = mimetypes.guess_type(path.name)[0] or "application/octet-stream"
    return BuiltFile(plain, gzip.compress(plain, compresslevel=6, mtime=0), media_type)
