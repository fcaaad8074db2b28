"""The road of an image through the REST API: upload, pre-label, decide, finish, export.

    clearlines serve --no-browser &
    pip install httpx2
    python docs/examples/rest_road.py http://127.0.0.1:8765 IMAGE... --output labels.zip

It keeps what the pipeline is sure of and rejects the rest; a person would decide in the browser.
"""

from __future__ import annotations

import argparse
import time
import uuid
from pathlib import Path

import httpx2 as httpx

SURE = 0.5


def upload(client: httpx.Client, name: str, images: list[Path]) -> tuple[str, list[int]]:
    """Make a dataset of the images; return its slug and the ids of the images."""
    slug = client.post("/api/datasets", json={"name": name}).raise_for_status().json()["slug"]
    files = [("files", (image.name, image.read_bytes())) for image in images]
    report = client.post(f"/api/datasets/{slug}/images", files=files).raise_for_status().json()
    for failed in report["failed"]:
        print(f"{failed['name']}: {failed['error']['message']}")
    return slug, [image["id"] for image in report["added"]]


def prelabel(client: httpx.Client, slug: str) -> None:
    """Run the pipeline and wait for it."""
    run = client.post(f"/api/datasets/{slug}/runs", json={"min_length": 50}).raise_for_status().json()
    while run["status"] in ("queued", "running"):
        print(f"{run['counts']['done']} of {run['total']} images", end="\r")
        time.sleep(0.2)
        run = client.get(f"/api/runs/{run['id']}").raise_for_status().json()
    for camera in run["cameras"]:
        lens = camera["distortion"]
        print(f"{camera['name']}: k = {lens['k']}, {'accepted' if lens['accepted'] else lens['reasons']}")


def decide(client: httpx.Client, image_id: int) -> int:
    """Keep the candidates that are straight and well seen, reject the others; return how many are kept."""
    segments = client.get(f"/api/images/{image_id}/segments").raise_for_status().json()["segments"]
    key_press = str(uuid.uuid4())
    decisions = [
        {
            "client_id": str(uuid.uuid4()),  # sending it again changes nothing
            "group_id": key_press,  # one undo takes all of them back
            "segment_id": segment["id"],
            "verdict": "keep" if segment["straight"] and segment["score"] > SURE else "reject",
        }
        for segment in segments
    ]
    if decisions:
        client.post(f"/api/images/{image_id}/decisions", json={"decisions": decisions}).raise_for_status()
    client.put(f"/api/images/{image_id}/review", json={"status": "done"}).raise_for_status()
    return sum(decision["verdict"] == "keep" for decision in decisions)


def main() -> None:
    """Take the whole road."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("server")
    parser.add_argument("images", nargs="+", type=Path)
    parser.add_argument("--name", default="By REST")
    parser.add_argument("--output", type=Path, required=True)
    options = parser.parse_args()
    with httpx.Client(base_url=options.server, timeout=60) as client:
        slug, ids = upload(client, options.name, options.images)
        prelabel(client, slug)
        kept = sum(decide(client, image_id) for image_id in ids)
        export = client.get(f"/api/datasets/{slug}/export", params={"format": "clearlines"}).raise_for_status()
        options.output.write_bytes(export.content)
        print(f"{kept} lines of {len(ids)} images are in {options.output}")


if __name__ == "__main__":
    main()
