"""What an opened page will need, named with the very first answer: files and data are on their way before any script.

The browser fetches what a ``Link`` header with ``rel=preload`` names at once (RFC 8288; HTML, "link type preload"), and
hands it to the page when the page asks for the same address in the same manner: ``crossorigin``, as fetch() and the
start page's own links do.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from starlette.datastructures import MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

START = "index.html"
LABEL_PAGE = "src/pages/label/label_page.tsx"
LABEL_ADDRESS = re.compile(r"/datasets/[^/]+/images/([1-9][0-9]{0,9})")
LABEL_DATA = ("images/{}", "images/{}/segments", "images/{}/points", "images/{}/display", "configuration", "me")
"""What the page is laid out by first, then what takes longest."""


class Opening:
    """ASGI middleware: adds the header to the answer that opens the label page.

    Args:
        app: What answers.
        static: The folder of the built browser tool.
    """

    def __init__(self, app: ASGIApp, *, static: Path) -> None:
        self.app = app
        self.files = tuple(links_of_page(static, LABEL_PAGE))

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer one request."""
        opened = LABEL_ADDRESS.fullmatch(scope["path"]) if scope["type"] == "http" else None
        if opened is None:
            await self.app(scope, receive, send)
            return

        async def send_with_links(message: Message) -> None:
            if message["type"] == "http.response.start" and message["status"] in {200, 304}:
                links = [*self.files, *links_of_image(opened[1])]
                MutableHeaders(scope=message)["Link"] = ", ".join(links)
            await send(message)

        await self.app(scope, receive, send_with_links)


def links_of_image(image_id: str) -> list[str]:
    """Return the links to what the label page asks of the API as soon as it is there."""
    addresses = [f"/api/{part.format(image_id)}" for part in LABEL_DATA]
    return [f"<{address}>; rel=preload; as=fetch; crossorigin" for address in addresses]


def links_of_page(static: Path, page: str) -> list[str]:
    """Return the links to the files of a page: scripts first, for a browser opens few connections at once.

    Args:
        static: The folder of the built browser tool; one that was built without a manifest gives nothing.
        page: The page's module in the sources.
    """
    try:
        manifest: dict[str, Any] = json.loads((static / "manifest.json").read_bytes())
    except FileNotFoundError:
        return []
    chunks = [manifest[name] for name in _with_imports(manifest, [START, page])]
    scripts = [f"</{chunk['file']}>; rel=modulepreload" for chunk in chunks]
    # a worker's script is kept in the cache: later the browser would ask for it behind all data
    workers = [asset for chunk in chunks for asset in chunk.get("assets", ()) if asset.endswith(".js")]
    scripts += [f"</{worker}>; rel=modulepreload" for worker in workers]
    return scripts + [
        f"</{style}>; rel=preload; as=style; crossorigin" for chunk in chunks for style in chunk.get("css", ())
    ]


def _with_imports(manifest: dict[str, Any], names: list[str]) -> Iterator[str]:
    """Give modules and all that they import, each once."""
    waiting, seen = list(names), set[str]()
    while waiting:
        name = waiting.pop(0)
        if name in seen or name not in manifest:
            continue
        seen.add(name)
        yield name
        waiting += manifest[name].get("imports", ())
