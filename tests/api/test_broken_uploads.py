"""Broken, odd and hostile images as they are uploaded: refused with a reason, or shown; the server answers on."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from fastapi.testclient import TestClient

from tools.fuzzing.broken_images import broken_images

CODES = {"invalid": "invalid-image", "too large": "too-large"}


@pytest.mark.filterwarnings("ignore:Corrupt EXIF data", "ignore:Truncated File Read")
def test_a_broken_image_is_refused_or_shown(client: TestClient, upload: Callable[..., dict[str, Any]]) -> None:
    images = {f"{number}/{image.name}": image for number, image in enumerate(broken_images())}
    report = upload("street", {path: image.data for path, image in images.items()})
    failed = {file["name"]: file["error"]["code"] for file in report["failed"]}
    assert failed == {path: CODES[images[path].fate] for path in failed}
    added = {image["name"]: image["id"] for image in report["added"]}
    paths = {path.rpartition(".")[0]: image for path, image in images.items() if path not in failed}
    assert added.keys() == paths.keys()
    for name, image in paths.items():
        answers = [client.get(f"/api/images/{added[name]}/{kind}") for kind in ("display", "thumbnail")]
        if image.fate == "shown":
            assert [answer.status_code for answer in answers] == [200, 200], name
        else:  # what browsers don't get as it is, is decoded when it is shown
            assert image.name.endswith((".tif", ".ppm", ".pgm")), name
            assert [answer.json()["code"] for answer in answers] == ["invalid-image"] * 2, name
    assert sum(image.fate == "shown" for image in paths.values()) > 20
    assert client.get("/api/health").status_code == 200
