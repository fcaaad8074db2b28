"""The whole application with its files in a bucket of an S3-compatible server."""

from __future__ import annotations

import io
import shutil
import time
import zipfile
from collections.abc import Callable
from datetime import timedelta
from pathlib import Path
from typing import Any

import pytest
from fastapi.testclient import TestClient
from sqlalchemy import make_url

from app.clock import utc_now
from app.services.purging import purge
from app.settings import Settings
from app.storage import RemoteBlobs


def wait_until(condition: Callable[[], bool]) -> None:
    deadline = time.monotonic() + 60
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.02)


@pytest.fixture
def settings(tmp_path: Path, sqlite_template: Path, object_server: Any) -> Settings:
    bucket = object_server.make_bucket()
    options = {**object_server.options, "config_kwargs": {"retries": {"mode": "standard", "max_attempts": 1}}}
    settings = Settings(
        data_dir=tmp_path / "data", workers=1, blob_url=f"s3://{bucket}/lines", blob_options=options, grace_days=0
    )
    settings.data_dir.mkdir()
    shutil.copy(sqlite_template, str(make_url(settings.database_address).database))
    return settings


def test_from_upload_to_purge(
    client: TestClient,
    upload: Callable[..., Any],
    picture: Callable[[int], bytes],
    finish_run: Callable[[int], Any],
    settings: Settings,
    object_server: Any,
    caplog: pytest.LogCaptureFixture,
) -> None:
    """On the way the bucket is gone for a while: a run waits for it."""
    server = client.app.state.server  # type: ignore[attr-defined]
    assert isinstance(server.blobs, RemoteBlobs)
    one = upload("street", {"a/one.png": picture(1)})["added"][0]["id"]
    assert not settings.blob_dir.exists()

    (blob,) = server.blobs.iterate()
    bucket = server.blobs.address.split("/")[2]
    server.blobs.delete_all([blob.sha256])
    object_server.remove_bucket(bucket)
    run = client.post("/api/datasets/street/runs", json={"min_length": 30}).json()["id"]
    wait_until(lambda: f"s3://{bucket}" in caplog.text)
    assert client.get(f"/api/runs/{run}").json()["status"] in ("queued", "running")
    object_server.make_bucket(bucket)
    server.blobs.put(picture(1))
    assert finish_run(run)["status"] == "done"
    assert client.get(f"/api/images/{one}").json()["prelabel"] == "done"

    original = client.get(f"/api/images/{one}/original", headers={"range": "bytes=10-20"})
    assert (original.status_code, original.content) == (200, picture(1))  # as RFC 9110, 14.2 allows
    assert original.headers["content-length"] == str(len(picture(1)))
    assert original.headers["content-disposition"] == 'attachment; filename="one.png"'
    assert original.headers["content-type"] == "application/octet-stream"
    held = {"if-none-match": original.headers["etag"]}
    assert client.get(f"/api/images/{one}/original", headers=held).status_code == 304
    thumbnail = client.get(f"/api/images/{one}/thumbnail")
    assert (thumbnail.status_code, thumbnail.headers["content-type"][:6]) == (200, "image/")
    assert client.get(f"/api/images/{one}/display").content == picture(1)

    exported = client.get("/api/datasets/street/export", params={"allow_not_done": True})
    assert exported.status_code == 200, exported.text
    with zipfile.ZipFile(io.BytesIO(exported.content)) as archive:
        assert picture(1) in [archive.read(name) for name in archive.namelist()]

    assert client.delete("/api/datasets/street").status_code in (200, 204)
    purged = purge(server.database, server.blobs, utc_now() + timedelta(seconds=1), grace=timedelta())
    assert (purged.images, purged.blobs) == (1, 1)
    assert list(server.blobs.iterate()) == []
    for kind in ("original", "thumbnail"):
        assert client.get(f"/api/images/{one}/{kind}").status_code == 404


def test_without_its_bucket_uploads_are_refused(
    client: TestClient, upload: Callable[..., Any], picture: Callable[[int], bytes], object_server: Any
) -> None:
    """Nothing is stored, and the answer says what is wrong and shows no secret."""
    store = client.app.state.server.blobs  # type: ignore[attr-defined]
    bucket = store.address.split("/")[2]
    object_server.remove_bucket(bucket)
    refused = upload("street", {"one.png": picture(1)}, status=503)
    assert refused["code"] == "unavailable"
    assert refused["where"] == f"s3://{bucket}/lines"
    assert object_server.options["secret"] not in str(refused)
    assert client.get("/api/datasets/street/images").json()["items"] == []
    object_server.make_bucket(bucket)
    assert len(upload("street", {"one.png": picture(1)})["added"]) == 1
