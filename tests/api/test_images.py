"""Images through the REST API: uploads, lists, changes, and pixels as they are stored."""

from __future__ import annotations

import io
import uuid
from collections.abc import Callable
from typing import Any

import cv2
import numpy as np
import pytest
from fastapi.testclient import TestClient
from PIL import Image

Upload = Callable[..., dict[str, Any]]
Picture = Callable[[int], bytes]


def test_one_bad_file_fails_alone_with_its_reason(client: TestClient, upload: Upload, picture: Picture) -> None:
    report = upload("street", {"good.png": picture(1), "bad.png": b"no image", "notes.txt": b"hello"})
    assert [image["name"] for image in report["added"]] == ["good"]
    assert {failed["name"] for failed in report["failed"]} == {"bad.png", "notes.txt"}
    assert all(failed["error"]["message"] for failed in report["failed"])


def test_a_broken_image_says_so_where_it_is_shown_and_in_its_run(
    client: TestClient, upload: Upload, picture: Picture, finish_run: Callable[[int], dict[str, Any]]
) -> None:
    # a PGM is told to be whole when it is decoded, other kinds when they are uploaded
    report = upload("street", {"cut.pgm": b"P5 200 150 255\n" + bytes(300), "whole.png": picture(1)})
    cut = report["added"][0]["id"]
    shown = client.get(f"/api/images/{cut}/thumbnail")
    assert shown.status_code == 422
    assert shown.json()["code"] == "invalid-image"

    run = client.post("/api/datasets/street/runs", json={"min_length": 30}).json()["id"]
    assert finish_run(run)["counts"] == {"queued": 0, "running": 0, "done": 1, "failed": 1, "cancelled": 0}
    failed = client.get(f"/api/runs/{run}/images", params={"status": "failed"}).json()["items"]
    assert [row["image"]["name"] for row in failed] == ["cut"]
    assert failed[0]["error"]["code"] == "invalid-image"
    assert client.get(f"/api/images/{cut}").json()["prelabel"] == "failed"
    assert client.post(f"/api/runs/{run}/retry").json() == {"queued": 1}
    assert finish_run(run)["counts"]["failed"] == 1


def test_an_image_that_is_cut_off_is_refused_when_it_is_uploaded(client: TestClient, upload: Upload, picture) -> None:
    report = upload("street", {"cut.png": picture(2)[:300], "whole.png": picture(1)})
    assert [image["name"] for image in report["added"]] == ["whole"]
    assert report["failed"][0]["error"]["message"] == "the PNG is cut off"


def test_nothing_usable_is_an_error_that_names_each_file(client: TestClient, upload: Upload) -> None:
    problem = upload("street", {"bad.png": b"no image at all"}, status=422)
    assert [failed["name"] for failed in problem["details"]["failed"]] == ["bad.png"]


def test_the_same_content_again_is_existing_and_the_same_name_again_a_conflict(
    client: TestClient, upload: Upload, picture: Picture
) -> None:
    first = upload("street", {"one.png": picture(1)})["added"][0]["id"]
    again = upload("street", {"other_name.png": picture(1)})
    assert again["added"] == []
    assert again["existing"] == [{"name": "other_name", "image_id": first}]
    conflict = upload("street", {"one.png": picture(2)}, status=422)
    assert conflict["details"]["failed"][0]["error"]["code"] == "conflict"


def test_a_list_is_paged_filtered_and_counted(client: TestClient, upload: Upload, picture: Picture) -> None:
    files = [(folder, number) for folder in ("a", "bb") for number in range(4)]
    upload("street", {f"{folder}/{number:02d}.png": picture(10 * len(folder) + number) for folder, number in files})
    seen: list[str] = []
    asked: dict[str, Any] = {"limit": 3}
    while True:
        page = client.get("/api/datasets/street/images", params=asked).json()
        assert page["total"] == 8
        seen += [image["name"] for image in page["items"]]
        if page["next_cursor"] is None:
            break
        asked["cursor"] = page["next_cursor"]
    assert seen == sorted(seen)
    assert len(set(seen)) == 8
    only = client.get("/api/datasets/street/images", params={"source": "bb", "search": "03"}).json()
    assert [image["name"] for image in only["items"]] == ["bb/03"]
    facets = client.get("/api/datasets/street/facets").json()
    assert {facet["value"]: facet["count"] for facet in facets["sources"]} == {"a": 4, "bb": 4}
    assert client.get("/api/datasets/street/images", params={"cursor": "nonsense"}).status_code == 422


def test_camera_source_and_sequence_are_edited_in_bulk(client: TestClient, upload: Upload, picture: Picture) -> None:
    ids = [image["id"] for image in upload("street", {f"{n}.png": picture(n) for n in range(3)})["added"]]
    change = {"ids": ids[:2], "camera": "left", "sequence": "drive 1"}
    assert client.patch("/api/datasets/street/images", json=change).json() == {"updated": 2}
    images = client.get("/api/datasets/street/images").json()["items"]
    assert [image["camera"]["name"] for image in images] == ["left", "left", images[2]["camera"]["name"]]
    assert images[2]["camera"]["name"] != "left"
    assert client.patch("/api/datasets/street/images", json={"ids": ids, "sequence": None}).status_code == 200
    assert client.get(f"/api/images/{ids[0]}").json()["sequence"] is None


def test_images_are_deleted_and_restored(client: TestClient, upload: Upload, picture: Picture) -> None:
    ids = [image["id"] for image in upload("street", {f"{n}.png": picture(n) for n in range(3)})["added"]]
    assert client.post("/api/datasets/street/images/delete", json={"ids": ids[:2]}).json()["deleted"] == 2
    assert client.get("/api/datasets/street/images").json()["total"] == 1
    assert client.get(f"/api/images/{ids[0]}").status_code == 404
    assert client.post("/api/datasets/street/images/restore", json={"ids": ids[:2]}).json() == {"restored": 2}
    assert client.get("/api/datasets/street/images").json()["total"] == 3


def rotated_jpeg() -> bytes:
    """A 40 x 20 picture whose EXIF says that it should be turned by 90 degrees."""
    exif = Image.Exif()
    exif[0x0112] = 6
    stream = io.BytesIO()
    Image.fromarray(np.arange(800, dtype=np.uint8).reshape(20, 40)).save(stream, "JPEG", exif=exif)
    return stream.getvalue()


def test_exif_orientation_is_applied_nowhere(client: TestClient, upload: Upload) -> None:
    image = upload("street", {"turned.jpg": rotated_jpeg()})["added"][0]
    assert (image["width"], image["height"]) == (40, 20)
    shown = client.get(f"/api/images/{image['id']}/display")
    decoded = Image.open(io.BytesIO(shown.content))
    assert decoded.size == (40, 20)
    assert decoded.getexif().get(0x0112, 1) == 1
    small = Image.open(io.BytesIO(client.get(f"/api/images/{image['id']}/thumbnail", params={"size": 160}).content))
    assert small.size[0] > small.size[1]
    assert client.get(f"/api/images/{image['id']}/thumbnail", params={"size": 161}).status_code == 422
    assert client.get(f"/api/images/{image['id']}/original").content == rotated_jpeg()


@pytest.mark.parametrize("shape", [(30, 50), (30, 50, 3), (30, 50, 4)])
def test_sixteen_bit_is_shown_in_eight(client: TestClient, upload: Upload, shape: tuple[int, ...]) -> None:
    pixels = np.linspace(1000, 3000, int(np.prod(shape))).astype(np.uint16).reshape(shape)
    content = cv2.imencode(".png", pixels)[1].tobytes()
    image = upload("street", {"deep.png": content})["added"][0]
    assert image["bits"] == 16
    shown = client.get(f"/api/images/{image['id']}/display")
    decoded = np.asarray(Image.open(io.BytesIO(shown.content)).convert("L"))
    assert decoded.shape == (30, 50)
    assert decoded.min() == 0
    assert decoded.max() == 255


def test_pixels_are_asked_after_again_and_not_sent_twice(client: TestClient, upload: Upload, picture: Picture) -> None:
    image = upload("street", {"one.png": picture(1)})["added"][0]["id"]
    for kind in ("display", "thumbnail"):
        answer = client.get(f"/api/images/{image}/{kind}")
        assert "no-cache" in answer.headers["cache-control"]
        again = client.get(f"/api/images/{image}/{kind}", headers={"if-none-match": answer.headers["etag"]})
        assert again.status_code == 304
        assert again.content == b""


def test_a_dataset_zip_brings_labels_and_cameras(client: TestClient, prelabelled: list[int], upload: Upload) -> None:
    segments = client.get(f"/api/images/{prelabelled[0]}/segments").json()["segments"]
    decisions = [
        {
            "client_id": str(uuid.uuid4()),
            "group_id": str(uuid.uuid4()),
            "segment_id": segment["id"],
            "verdict": "keep" if index == 0 else "reject",
        }
        for index, segment in enumerate(segments)
    ]
    client.post(f"/api/images/{prelabelled[0]}/decisions", json={"decisions": decisions})
    client.put(f"/api/images/{prelabelled[0]}/review", json={"status": "done"})
    client.put(f"/api/images/{prelabelled[1]}/review", json={"status": "discarded"})
    archive = client.get("/api/datasets/street/export").content
    report = upload("copy", {"street.zip": archive})
    assert [image["name"] for image in report["added"]] == ["a/one"]
    assert report["labels"] == 1
    assert report["added"][0]["status"] == "done"
    copied = client.get(f"/api/images/{report['added'][0]['id']}/segments").json()["segments"]
    assert [(segment["verdict"], segment["origin"], segment["n_points"]) for segment in copied] == [
        ("keep", "import", segments[0]["n_points"])
    ]
