"""Hand results in and read their score through the REST API.

    pip install httpx2
    python docs/examples/submit.py http://127.0.0.1:8765 SPLIT RESULTS.zip --method "My lines"

RESULTS is a zip or tar.gz of one file per image, or one npz or JSON for all of them. A token goes into the variable
CLEARLINES_TOKEN.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
from pathlib import Path
from typing import Any

import httpx2 as httpx


def hand_in(client: httpx.Client, split: str, results: Path, method: str) -> dict[str, Any]:
    """Send the results; the answer comes once they are validated."""
    with results.open("rb") as stream:
        answer = client.post(
            f"/api/splits/{split}/submissions", files={"files": (results.name, stream)}, data={"method": method}
        )
    if answer.status_code == 422:  # everything that is wrong, at once
        for error in answer.json()["details"].get("errors", []):
            print(f"{error['file']}, segment {error['segment']}, point {error['point']}: {error['message']}")
        sys.exit(1)
    return answer.raise_for_status().json()


def follow(client: httpx.Client, submission: dict[str, Any]) -> dict[str, Any]:
    """Read the events of a submission until it is in a final state. (GET /api/submissions/ID can be asked, too.)"""
    with client.stream("GET", f"/api/submissions/{submission['id']}/events") as events:
        for line in events.iter_lines():
            if line.startswith("data: "):
                submission = json.loads(line.removeprefix("data: "))
                print(f"{submission['status']}, {submission['progress']:.0%} of the images")
    return submission


def main() -> None:
    """Take the whole road."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("server")
    parser.add_argument("split")
    parser.add_argument("results", type=Path)
    parser.add_argument("--method", required=True)
    options = parser.parse_args()
    token = os.environ.get("CLEARLINES_TOKEN")
    headers = {"Authorization": f"Bearer {token}"} if token else {}
    with httpx.Client(base_url=options.server, headers=headers, timeout=300) as client:
        submission = follow(client, hand_in(client, options.split, options.results, options.method))
        if submission["status"] != "scored":
            sys.exit(f"{submission['status']}: {submission['error']}")
        f1 = submission["scores"][0]["totals"]["f1"]
        interval = "" if f1["low"] is None else f", 95 % interval {f1['low']:.3f} to {f1['high']:.3f}"
        print(f"F1 {f1['value']:.3f}{interval}")
        images = client.get(f"/api/submissions/{submission['id']}/images", params={"sort": "f1", "limit": 3})
        if images.is_success:  # a hidden split shows totals alone
            for image in images.json()["items"]:
                print(f"{image['name']}: {image['tp']} found, {image['fp']} false, {image['fn']} missed")


if __name__ == "__main__":
    main()
