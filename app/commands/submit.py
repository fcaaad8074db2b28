"""``clearlines submit``: hand results in at a server, and follow them until they are scored."""

from __future__ import annotations

import json
import tempfile
import time
import zipfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO

import httpx2 as httpx

from app.errors import ClearLinesError, InvalidInput, NotFound, Unavailable
from app.formats.naming import SEGMENT_SUFFIXES, is_hidden
from app.formats.submission_problems import InvalidSubmission

FINAL = ("scored", "invalid", "failed", "withdrawn")
ENDINGS = (".zip", ".tar.gz", ".tgz", *sorted(SEGMENT_SUFFIXES))
SECONDS = 300.0
PAUSE = 0.5
LOST = 5
"""Answers in a row that may fail while the server is watched: it may be starting again."""


@dataclass(frozen=True)
class Target:
    """Where results go.

    Attributes:
        server: Address of the server, ``http://127.0.0.1:8765``.
        split: Slug of the split.
        token: Who hands in; ``None`` where the server asks for none.
    """

    server: str
    split: str
    token: str | None = None

    @contextmanager
    def client(self) -> Iterator[httpx.Client]:
        """Give a client of the server.

        Raises:
            InvalidInput: When the address is none.
            Unavailable: When nobody answers there.
        """
        headers = {} if self.token is None else {"Authorization": f"Bearer {self.token}"}
        try:
            with httpx.Client(base_url=f"{self.server.rstrip('/')}/api", timeout=SECONDS, headers=headers) as client:
                yield client
        except (httpx.UnsupportedProtocol, httpx.InvalidURL) as error:
            raise InvalidInput(
                "this is no address of a server", where=self.server, expected="http://HOST:PORT"
            ) from error
        except httpx.TransportError as error:
            raise Unavailable(
                f"the server doesn't answer: {error}", where=self.server, hint="is it running?"
            ) from error


def validate(target: Target, path: Path) -> dict[str, Any]:
    """Check results without handing them in, and return what they hold.

    Raises:
        InvalidSubmission: With everything that is wrong.
        ClearLinesError: As the server tells it.
    """
    with target.client() as client, packed(path) as (name, stream):
        answer = client.post(f"/splits/{target.split}/submissions/validate", files={"files": (name, stream)})
        return _content(answer)


def submit(
    target: Target, path: Path, fields: dict[str, str], *, progress: Callable[[int, int], None] | None = None
) -> dict[str, Any]:
    """Hand results in, wait until they are scored, and return the submission.

    Args:
        target: Where to.
        path: Folder of one file per image, or one file.
        fields: ``method``, and what else the form takes.
        progress: Called with images scored so far and their total.

    Raises:
        InvalidSubmission: With everything that is wrong.
        ClearLinesError: As the server tells it.
    """
    with target.client() as client:
        with packed(path) as (name, stream):
            answer = client.post(f"/splits/{target.split}/submissions", files={"files": (name, stream)}, data=fields)
        submission = _content(answer)
        while submission["status"] not in FINAL:
            _report(submission, progress)
            time.sleep(PAUSE)
            submission = _watch(client, submission["id"])
        _report(submission, progress)
        return submission


@contextmanager
def packed(path: Path) -> Iterator[tuple[str, BinaryIO]]:
    """Give results as one file: a folder is packed into a zip, which is gone at the end.

    Raises:
        NotFound: When there is nothing at the path.
        InvalidInput: When it is no file of results, or a folder without any.
    """
    if path.is_file():
        if not path.name.lower().endswith(ENDINGS):
            raise InvalidInput("this is no file of results", where=str(path), expected=", ".join(ENDINGS))
        with path.open("rb") as stream:
            yield path.name, stream
        return
    if not path.is_dir():
        raise NotFound("there is no such file or folder", where=str(path))
    files = sorted(found for found in path.rglob("*") if found.is_file() and _is_taken(found.relative_to(path)))
    if not files:
        expected = ", ".join(sorted(SEGMENT_SUFFIXES))
        raise InvalidInput("the folder holds no file of results", where=str(path), expected=expected)
    with tempfile.TemporaryFile() as stream:
        with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
            for file in files:
                archive.write(file, file.relative_to(path).as_posix())
        stream.seek(0)
        yield "results.zip", stream


def _is_taken(path: Path) -> bool:
    return path.suffix.lower() in SEGMENT_SUFFIXES and not is_hidden(path)


def _watch(client: httpx.Client, submission: int) -> dict[str, Any]:
    for lost in range(LOST):
        try:
            return _content(client.get(f"/submissions/{submission}"))
        except (httpx.TransportError, Unavailable):
            if lost == LOST - 1:
                raise
            time.sleep(PAUSE * 2**lost)
    raise AssertionError


def _report(submission: dict[str, Any], progress: Callable[[int, int], None] | None) -> None:
    total = submission["images"] + len(submission["missing"])
    if progress is not None and total:
        progress(round(submission["progress"] * total), total)


def _content(answer: httpx.Response) -> dict[str, Any]:
    """Return the answer's JSON, or raise the error that it tells."""
    try:
        content = answer.json()
    except (json.JSONDecodeError, UnicodeDecodeError):
        content = {}
    if answer.is_success:
        return content
    message = str(content.get("message", f"the server answered {answer.status_code}"))
    told = {name: content.get(name) for name in ("where", "expected", "hint")}
    details = content.get("details") or {}
    if content.get("code") == InvalidSubmission.code:
        raise InvalidSubmission(message, **told, details=details)
    kind = Unavailable if answer.status_code in (502, 503, 504) else ClearLinesError
    raise kind(message, **told, details=details)
