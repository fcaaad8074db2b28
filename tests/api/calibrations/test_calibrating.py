"""A camera calibrated through the REST API: from kept lines to pictures, files and a report."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import cv2
import numpy as np
import pytest
from fastapi.testclient import TestClient

from app.api.schemas.calibrations import CalibrationAnswer
from app.calibration.exports import FORMATS
from app.calibration.lens import CameraLens
from app.vision.field import field_error

LENS = CameraLens("division", 320, 240, (0.12, 0.0, 0.0, 0.0, 0.0))
Finish = Callable[[int], dict[str, Any]]
REFERENCE = b"""%YAML:1.0
---
image_width: 320
image_height: 240
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 300., 0., 159.5, 0., 300., 119.5, 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 1
   cols: 5
   dt: d
   data: [ -0.2, 0.03, 0., 0., 0. ]
"""


def test_from_kept_lines_to_a_lens_and_its_files(client: TestClient, camera: int, finish: Finish) -> None:
    before = client.get(f"/api/cameras/{camera}").json()
    assert (before["kept_lines"], before["images_labelled"], before["images"]) == (60, 3, 4)
    assert (before["latest_calibration_id"], before["active_calibration"]) == (None, None)
    assert before["dataset"] == {"slug": "street", "name": "street"}

    started = client.post(f"/api/cameras/{camera}/calibrations", json={"source": "labels", "family": None})
    assert started.status_code == 202, started.text
    number = started.json()["id"]
    found = finish(number)
    assert found["status"] == "done", found["error"]
    CalibrationAnswer.model_validate(found)  # what the document promises
    result = found["result"]
    lens = CameraLens.from_dict(result["lens"])
    assert result["accepted"]
    assert field_error(LENS, lens, 320, 240).rms < 3 * result["uncertainty"]["bound95"]
    assert field_error(LENS, lens, 320, 240).rms < 0.3
    assert found["parameters"]["segments"] == found["n_segments"] == 60
    after = client.get(f"/api/cameras/{camera}").json()
    assert (after["latest_calibration_id"], after["decisions_since"]) == (number, 0)
    assert after["latest_calibration"]["summary"]["pred"] == result["uncertainty"]["pred"]

    look_at_lines_and_images(client, number)
    look_at_files(client, camera, number)


def look_at_lines_and_images(client: TestClient, number: int) -> None:
    base = f"/api/calibrations/{number}"
    lines = client.get(f"{base}/lines?limit=10").json()
    assert len(lines["items"]) == 10
    assert lines["total"] <= 60
    residuals = [line["rms"] for line in lines["items"]]
    assert residuals == sorted(residuals, reverse=True)
    assert {line["state"] for line in lines["items"]} == {"current"}
    following = client.get(f"{base}/lines?limit=500&cursor={lines['next_cursor']}").json()
    ids = [line["segment_id"] for page in (lines, following) for line in page["items"]]
    assert len(set(ids)) == len(ids) == lines["total"]

    images = client.get(f"{base}/images").json()
    assert [image["name"] for image in images] != []
    assert all(image["is_there"] and image["inliers"] > 10 for image in images)
    image = images[0]["image_id"]
    drawn = client.get(f"{base}/images/{image}/lines").json()
    assert (drawn["width"], drawn["height"], len(drawn["lines"])) == (320, 240, images[0]["segments"])
    for line in drawn["lines"]:
        assert bend(line["undistorted"]) < 0.5
    assert max(bend(line["measured"]) for line in drawn["lines"]) > 2

    seen = client.get(f"{base}/images/{image}/undistorted")
    assert seen.headers["content-type"] == "image/jpeg"
    picture = cv2.imdecode(np.frombuffer(seen.content, np.uint8), cv2.IMREAD_COLOR)
    assert picture is not None
    assert picture.shape == (240, 320, 3)
    x, y = np.round(drawn["lines"][0]["undistorted"][16]).astype(int)
    assert picture[y - 1 : y + 2, x - 1 : x + 2].max() > 160, "the line is drawn where the picture shows it"
    held = client.get(f"{base}/images/{image}/undistorted", headers={"If-None-Match": seen.headers["etag"]})
    assert held.status_code == 304
    advice = client.get(f"{base}/advice").json()
    assert [(entry["name"], entry["gain"] > 0) for entry in advice["images"]] == [("drive/9", True)]
    assert all(cell["sigma_with"] < cell["sigma_now"] for cell in advice["cells"])
    assert 1 <= len(advice["cells"]) <= 5


def bend(points: list[list[float]]) -> float:
    """Largest distance from the chord, px."""
    away = np.array(points) - points[0]
    chord = away[-1] / np.hypot(*away[-1])
    return float(np.abs(away[:, 0] * chord[1] - away[:, 1] * chord[0]).max())


def look_at_files(client: TestClient, camera: int, number: int) -> None:
    base = f"/api/calibrations/{number}"
    missing = client.get(f"{base}/difference")
    assert missing.status_code == 404
    assert "reference-file" in missing.json()["hint"]
    sent = client.post(f"/api/cameras/{camera}/reference-file", files={"file": ("front.yaml", REFERENCE)})
    assert sent.status_code == 200, sent.text
    assert sent.json()["reference"]["D"][0] == -0.2
    difference = client.get(f"{base}/difference").json()
    assert difference["maximum"] >= difference["rms"] > 0
    assert len(difference["dx"]) == difference["rows"]

    menu = client.get(f"{base}/exports").json()
    assert menu["intrinsics"]["source"] in ("nominal", "estimated")
    assert [option["format"] for option in menu["formats"]] == list(FORMATS)
    for option in menu["formats"]:
        file = client.get(f"{base}/exports/{option['format']}")
        assert file.status_code == (200 if option["allowed"] else 422), file.text
        if option["allowed"]:
            assert (
                file.headers["x-conversion-error"]
                == f"rms={option['error']['rms']:.6g}, maximum={option['error']['maximum']:.6g}"
            )
            assert file.headers["content-disposition"] == f'attachment; filename="{option["file_name"]}"'
    given = client.get(f"{base}/exports?focal_length=250&cx=160&cy=120").json()
    assert given["intrinsics"] == {"focal_length": 250.0, "principal_point": [160.0, 120.0], "source": "given"}
    for wrong in ("exports/word", "exports?cx=3", "exports?focal_length=-1"):
        assert client.get(f"{base}/{wrong}").status_code == 422

    report = client.get(f"{base}/report")
    assert report.headers["content-type"] == "text/html; charset=utf-8"
    assert "default-src 'none'" in report.headers["content-security-policy"]
    assert "<script" not in report.text
    assert "data:image/jpeg" in report.text


def test_a_calibration_is_asked_for_once_and_can_be_taken_back(client: TestClient, camera: int, finish: Finish) -> None:
    first = client.post(f"/api/cameras/{camera}/calibrations", json={}).json()["id"]
    second = client.post(f"/api/cameras/{camera}/calibrations", json={})
    cancelled = client.post(f"/api/calibrations/{first}/cancel")
    assert (second.status_code, second.json()["details"]) == (409, {"calibration": first})
    assert (cancelled.status_code, cancelled.json()["status"]) == (200, "cancelled")
    for part in ("lines", "images", "advice", "exports", "report", "exports/ros"):
        assert client.get(f"/api/calibrations/{first}/{part}").status_code == 409, part
    assert client.delete(f"/api/calibrations/{first}").json()["deleted"] == 1
    assert client.get(f"/api/cameras/{camera}/calibrations").json()["total"] == 0
    assert [row["id"] for row in client.get(f"/api/cameras/{camera}/calibrations?deleted=true").json()["items"]] == [
        first
    ]
    assert client.post(f"/api/calibrations/{first}/restore").json()["deleted_at"] is None
    assert client.get(f"/api/cameras/{camera}/calibrations").json()["total"] == 1


@pytest.mark.parametrize(
    ("content", "expected"),
    [(b"", 422), (b"camera_matrix: 3", 422), (REFERENCE.replace(b"320", b"640"), 422), (b"x" * (2**20 + 1), 413)],
)
def test_a_file_that_is_no_reference_is_refused(client: TestClient, camera: int, content: bytes, expected: int) -> None:
    answer = client.post(f"/api/cameras/{camera}/reference-file", files={"file": ("front.yaml", content)})
    assert answer.status_code == expected, answer.text
    assert client.get(f"/api/cameras/{camera}").json()["reference"] is None


def test_what_isn_t_there(client: TestClient, camera: int) -> None:
    assert client.get("/api/cameras/99").status_code == 404
    assert client.get("/api/calibrations/99").status_code == 404
    assert client.post("/api/cameras/99/calibrations", json={}).status_code == 404
    wrong = client.post(f"/api/cameras/{camera}/calibrations", json={"source": "guesses"})
    assert wrong.status_code == 422
