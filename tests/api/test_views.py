"""Other views of an image, and what speaks for a candidate, asked over HTTP."""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import Any

import cv2
import numpy as np
import pytest
from fastapi.testclient import TestClient
from numpy.typing import NDArray
from sqlalchemy import select

from app.db.models import CameraEstimate, Image, RunImage
from app.vision.brown import Brown
from app.vision.conversion import FieldError
from app.vision.distortion import DistortionEstimate
from app.vision.division import Division
from app.vision.lens_uncertainty import LensUncertainty

SIZE = (200, 150)


def points_of(client: TestClient, address: str) -> tuple[bytes, NDArray[np.float32]]:
    content = client.get(address).content
    magic, _, segments, points = struct.unpack_from("<4sIII", content)
    assert magic == b"CLP1"
    start = 16 + 4 * (2 * segments + 1)
    return content[16:start], np.frombuffer(content, "<f4", 2 * points, start).reshape(-1, 2)


def decoded(content: bytes) -> NDArray[np.uint8]:
    return np.asarray(cv2.imdecode(np.frombuffer(content, np.uint8), cv2.IMREAD_UNCHANGED), np.uint8)


@pytest.fixture
def give_lens(client: TestClient, prelabelled: list[int]) -> Callable[..., None]:
    """Put a lens in the place of what the run estimated."""

    def give_lens(k1: float, *, accepted: bool = True) -> None:
        estimate = DistortionEstimate(
            brown=Brown(*SIZE, (99.5, 74.5), 125.0, (k1, 0.0, 0.0)),
            division=Division(*SIZE),
            refit_error=FieldError(0.0, 0.0),
            uncertainty=LensUncertainty(0.5, 0.5, 0.0),
            accepted=accepted,
            reasons=() if accepted else ("too few lines",),
            counts={},
        )
        with client.app.state.server.database.write() as session:  # type: ignore[attr-defined]
            for work in session.scalars(select(RunImage)):
                work.distortion = estimate.as_dict()
            assert session.scalars(select(CameraEstimate)).all()
            assert session.get_one(Image, prelabelled[0]).current_run_image_id is not None

    return give_lens


def test_the_equalised_view_has_more_contrast(client: TestClient, upload: Callable[..., dict[str, Any]]) -> None:
    dark = np.tile(np.linspace(15, 45, 200).astype(np.uint8), (150, 1))
    image = upload("dark", {"one.png": cv2.imencode(".png", dark)[1].tobytes()})["added"][0]["id"]
    answer = client.get(f"/api/images/{image}/display?view=clahe")
    assert (answer.status_code, answer.headers["content-type"]) == (200, "image/jpeg")
    seen = decoded(answer.content)
    assert seen.shape == dark.shape
    assert seen.std() > 1.4 * dark.std()
    again = client.get(f"/api/images/{image}/display?view=clahe", headers={"If-None-Match": answer.headers["etag"]})
    assert again.status_code == 304
    assert client.get(f"/api/images/{image}/display").headers["etag"] != answer.headers["etag"]
    assert client.get(f"/api/images/{image}/display?view=rotated").status_code == 422


def test_without_a_lens_there_is_no_undistorted_view(
    client: TestClient, prelabelled: list[int], give_lens: Callable[..., None]
) -> None:
    give_lens(0.2, accepted=False)
    for address in ("display", "points"):
        answer = client.get(f"/api/images/{prelabelled[0]}/{address}?view=undistorted")
        assert answer.status_code == 409
        assert "lens" in answer.json()["message"]
        assert answer.json()["hint"]


def test_points_lie_where_the_undistorted_view_shows_them(
    client: TestClient, prelabelled: list[int], give_lens: Callable[..., None]
) -> None:
    give_lens(0.25)
    address = f"/api/images/{prelabelled[0]}"
    places, stored = points_of(client, f"{address}/points")
    same_places, seen = points_of(client, f"{address}/points?view=undistorted")
    assert same_places == places
    assert seen.shape == stored.shape
    assert np.abs(seen - stored).max() > 2
    assert (seen.min(axis=0) >= 0).all()
    assert (seen.max(axis=0) <= np.array(SIZE)).all()
    # an edge is where brightness changes, in either picture
    shown = decoded(client.get(f"{address}/display?view=undistorted").content)
    assert shown.shape[:2] == SIZE[::-1]
    gray = cv2.GaussianBlur(shown if shown.ndim == 2 else cv2.cvtColor(shown, cv2.COLOR_BGR2GRAY), (0, 0), 1)
    slope = np.hypot(cv2.Sobel(gray, cv2.CV_32F, 1, 0), cv2.Sobel(gray, cv2.CV_32F, 0, 1))
    x, y = np.rint(seen).astype(int).T
    assert np.median(slope[y, x]) > 5 * np.median(slope)


def test_evidence_along_a_candidate(client: TestClient, prelabelled: list[int], give_lens: Callable[..., None]) -> None:
    give_lens(0.0)
    candidates = client.get(f"/api/images/{prelabelled[0]}/segments").json()["segments"]
    longest = max(candidates, key=lambda candidate: candidate["length"])
    evidence = client.get(f"/api/segments/{longest['id']}/evidence").json()
    assert evidence["lens"] == "accepted"
    assert evidence["length"] == pytest.approx(longest["length"])
    assert evidence["residual"] < 0.3
    assert evidence["maximum"] >= evidence["residual"]
    assert evidence["contrast"] > 20
    assert evidence["polarity"] > 0.95
    assert len(evidence["along"]) == len(evidence["deviation"]) == len(evidence["step"])
    assert evidence["along"] == sorted(evidence["along"])
    assert evidence["along"][-1] == pytest.approx(longest["length"], rel=0.01)

    def residuals() -> list[float]:
        return [client.get(f"/api/segments/{entry['id']}/evidence").json()["residual"] for entry in candidates]

    straight = residuals()
    give_lens(0.3)
    assert max(residuals()) > 3 * max(straight), "what is straight in the image is bent under a lens"
    give_lens(0.3, accepted=False)
    refused = client.get(f"/api/segments/{longest['id']}/evidence").json()
    assert (refused["lens"], refused["residual"]) == ("refused", pytest.approx(evidence["residual"], abs=1e-6))
    assert client.get("/api/segments/999999/evidence").status_code == 404
