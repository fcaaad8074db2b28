"""Uploads that mean harm: a clear 422 with every reason, and nothing left behind."""

from __future__ import annotations

import gzip
import io
import stat
import tarfile
import warnings
import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fastapi.testclient import TestClient
from sqlalchemy import func, select

from app.db.models import Blob, Method, Submission
from app.settings import Settings

CANARY = Path("/tmp/clearlines-canary-of-a-pickle")


def npz_of(**arrays: Any) -> bytes:
    stream = io.BytesIO()
    np.savez_compressed(stream, **arrays)
    return stream.getvalue()


GOOD = npz_of(points=np.array([[20.0, 30], [200, 36]], np.float32), offsets=np.array([0, 2]))


def zipped(members: Mapping[str, bytes] | list[tuple[Any, bytes]]) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for path, content in members.items() if isinstance(members, Mapping) else members:
            archive.writestr(path, content)
    return stream.getvalue()


def tarred(members: Mapping[str, bytes], kind: bytes = tarfile.REGTYPE, target: str = "") -> bytes:
    stream = io.BytesIO()
    with tarfile.open(fileobj=stream, mode="w:gz") as archive:
        for path, content in members.items():
            info = tarfile.TarInfo(path)
            info.type, info.linkname, info.size = kind, target, 0 if kind != tarfile.REGTYPE else len(content)
            archive.addfile(info, io.BytesIO(content))
    return stream.getvalue()


def link() -> bytes:
    info = zipfile.ZipInfo("a/one.npz")
    info.external_attr = (stat.S_IFLNK | 0o777) << 16
    return zipped([(info, b"/etc/passwd")])


def not_utf8() -> bytes:
    return zipped({"a/XX.npz": GOOD}).replace(b"a/XX.npz", b"a/\xff\xfe.npz")


def pickled() -> bytes:
    class Evil:
        def __reduce__(self) -> tuple[Any, ...]:
            return Path.touch, (CANARY,)

    stream = io.BytesIO()
    np.save(stream, np.array([Evil()], dtype=object), allow_pickle=True)
    return stream.getvalue()


def huge_header() -> bytes:
    header = b"{'descr': '<f4', 'fortran_order': False, 'shape': (500000000000, 2), }".ljust(117) + b"\n"
    return b"\x93NUMPY\x01\x00" + len(header).to_bytes(2, "little") + header


def many() -> bytes:
    return npz_of(points=np.zeros((10**6, 2), np.uint8), offsets=np.arange(10**6 + 1))


def wild(value: float) -> bytes:
    return npz_of(points=np.array([[1.0, 2], [value, 4]]), offsets=np.array([0, 2]))


UPLOADS: dict[str, Callable[[], tuple[str, bytes]]] = {
    "zip bomb": lambda: ("a.zip", zipped({"a/one.npz": b"\0" * 60 * 2**20})),
    "tar bomb": lambda: ("a.tar.gz", tarred({"a/one.npz": b"\0" * 60 * 2**20})),
    "bomb in an npz": lambda: ("a.npz", zipped({"points.npy": b"\0" * 140 * 2**20})),
    "nested zip": lambda: ("a.zip", zipped({"inner.zip": zipped({"a/one.npz": GOOD})})),
    "nested tar": lambda: ("a.tar.gz", tarred({"inner.tar.gz": tarred({"a/one.npz": GOOD})})),
    "path traversal": lambda: ("a.zip", zipped({"../a/one.npz": GOOD})),
    "path traversal in a tar": lambda: ("a.tar.gz", tarred({"../../a/one.npz": GOOD})),
    "link": lambda: ("a.zip", link()),
    "link in a tar": lambda: ("a.tar.gz", tarred({"a/one.npz": b""}, tarfile.SYMTYPE, "/etc/passwd")),
    "hard link in a tar": lambda: ("a.tar.gz", tarred({"a/one.npz": b""}, tarfile.LNKTYPE, "a/two.npz")),
    "device in a tar": lambda: ("a.tar.gz", tarred({"a/one.npz": b""}, tarfile.CHRTYPE)),
    "10^12 elements": lambda: ("a.zip", zipped({"a/one.npy": huge_header()})),
    "pickle with code": lambda: ("a.zip", zipped({"a/one.npy": pickled()})),
    "NaN": lambda: ("a.zip", zipped({"a/one.npz": wild(float("nan"))})),
    "infinity": lambda: ("a.zip", zipped({"a/one.npz": wild(float("inf"))})),
    "10^6 segments": lambda: ("a.zip", zipped({"a/one.npz": many()})),
    "wrong names": lambda: ("a.zip", zipped({"c/none.npz": GOOD})),
    "names in other case": lambda: ("a.zip", zipped({"a/one.npz": GOOD, "A/ONE.npz": GOOD})),
    "one name twice": lambda: ("a.zip", zipped([("a/one.npz", GOOD), ("a/one.npz", GOOD)])),
    "not UTF-8": lambda: ("a.zip", not_utf8()),
    "cut off zip": lambda: ("a.zip", zipped({"a/one.npz": GOOD})[:-30]),
    "cut off tar": lambda: ("a.tar.gz", tarred({"a/one.npz": GOOD})[:-30]),
    "cut off npz": lambda: ("a.zip", zipped({"a/one.npz": GOOD[:-30]})),
    "empty zip": lambda: ("a.zip", zipped({})),
    "empty tar": lambda: ("a.tar.gz", tarred({})),
    "nothing": lambda: ("a.zip", b""),
    "gzip of rubbish": lambda: ("a.tgz", gzip.compress(b"rubbish" * 200)),
}


@pytest.fixture(scope="module")
def target(make_field: Callable[..., Any]) -> Any:
    return make_field()


@pytest.fixture
def trace(client: TestClient, settings: Settings) -> Callable[[], tuple[Any, ...]]:
    """What uploads leave behind: rows and files."""
    server = client.app.state.server  # type: ignore[attr-defined]

    def trace() -> tuple[Any, ...]:
        with server.database.read() as session:
            rows = tuple(
                session.scalar(select(func.count()).select_from(table)) for table in (Submission, Method, Blob)
            )
        return rows, sorted(path.name for path in settings.blob_dir.rglob("*") if path.is_file())

    return trace


@pytest.mark.parametrize("name", UPLOADS)
def test_a_hostile_upload_leaves_nothing_behind(name: str, target, client: TestClient, trace) -> None:
    before = trace()
    file = UPLOADS[name]()
    for address, fields in (("submissions", {"method": "Lines"}), ("submissions/validate", {})):
        answer = client.post(f"/api/splits/{target.split}/{address}", files=[("files", file)], data=fields)
        assert answer.status_code == 422, answer.text
        problem = answer.json()
        assert problem["code"] == "invalid-submission"
        errors = problem["details"]["errors"]
        assert errors
        assert all(error["message"] and error["file"] for error in errors), errors
    assert trace() == before
    assert not CANARY.exists()


def test_loose_files_of_one_name_are_refused_at_once(target, client: TestClient, trace) -> None:
    before = trace()
    files = [("files", ("a/one.npz", GOOD)), ("files", ("A/one.npz", GOOD)), ("files", ("a/two.npz", GOOD))]
    answer = client.post(f"/api/splits/{target.split}/submissions", files=files, data={"method": "Lines"})
    assert answer.status_code == 422
    assert [error["file"] for error in answer.json()["details"]["errors"]] == ["A/one.npz"]
    assert trace() == before


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("method", " "),
        ("visibility", "secret"),
        ("code_url", "javascript:alert(1)"),
        ("paper_url", "https://"),
        ("webhook_url", "file:///etc/passwd"),
        ("webhook_url", "http://user:word@example.org/"),
        ("label", "x" * 201),
    ],
)
def test_a_field_that_cannot_be_is_named(field: str, value: str, target, client: TestClient, trace) -> None:
    before = trace()
    files = [("files", ("a.zip", zipped({"a/one.npz": GOOD})))]
    data = {"method": "Other lines", field: value}
    answer = client.post(f"/api/splits/{target.split}/submissions", files=files, data=data)
    assert answer.status_code == 422, answer.text
    assert field in answer.text or field == "method"
    assert trace() == before
