"""Nothing that the API answers to anyone below maintainer tells of a hidden split's labels.

The walk follows the OpenAPI document, so an address that is new is walked too. The maintainer's walk is the control:
it must find the marks wherever they are shown, else the search would prove nothing.
"""

from __future__ import annotations

import io
import re
import struct
import zipfile
from collections.abc import Callable, Iterator
from itertools import product
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

BELOW = ("reader", "submitter", "annotator")
CONTROL = (
    "/api/images/{image_id}/segments",
    "/api/images/{image_id}/points",
    "/api/datasets/{slug}",
    "/api/datasets/{slug}/card",
    "/api/datasets/{slug}/card.png",
    "/api/datasets/{slug}/export",
    "/api/splits/{split}",
    "/api/splits/{split}/truth",
    "/api/cameras/{camera_id}",
    "/api/calibrations/{calibration_id}",
    "/api/calibrations/{calibration_id}/images",
    "/api/calibrations/{calibration_id}/images/{image_id}/lines",
    "/api/submissions/{submission_id}/images/{split_image_id}/points",
    "/api/submissions/{submission_id}/images/{split_image_id}/overlay.png",
)
LeaksIn = Callable[[Any], list[str]]
PIXELS = ("original", "display", "thumbnail")


def test_the_search_finds_what_it_looks_for(leaks_in: Any) -> None:
    mark = 412.4567

    def found(content: bytes, **headers: str) -> list[str]:
        return leaks_in(SimpleNamespace(content=content, headers=headers))

    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("points.npy", np.array([[mark, 1]], np.float32).tobytes())
    assert found(b'{"points": [[412.4567, 1]]}') == [f"{mark} as text"]
    assert found(b'{"x": 412.46}') == [f"{mark} as text"]
    assert found(b"CLP1" + struct.pack("<f", mark)) == [f"{mark} as bytes"]
    assert found(struct.pack("<d", mark)) == [f"{mark} as bytes"]
    assert found(packed.getvalue()) == [f"{mark} as bytes"]
    assert found(b'{"keep": 223}') == ["number of labels"]
    assert found(b'{"keep": 2230, "x": 412.9}') == []
    assert found(b"", box="412.4567") == [f"{mark} as text"]


def requests(world: Any, *, safe: bool) -> Iterator[tuple[str, str, str, dict[str, Any]]]:
    """Every operation with all known ids, and on hidden things with each value of each parameter.

    Yields:
        Method, template, address, and what goes with it.
    """
    for method, template, operation in world.operations():
        if (method == "GET") != safe:
            continue
        names = re.findall(r"{(\w+)}", template)
        unknown = set(names) - set(world.ids)
        assert not unknown, f"{template}: the walk knows no values for {unknown}"
        queries = list(_queries(world, operation))
        for number, values in enumerate(product(*(_values(world, name, template) for name in names))):
            address = template
            for name, value in zip(names, values, strict=True):
                address = address.replace(f"{{{name}}}", str(value))
            for query in queries if safe and number == 0 else queries[:1]:
                for body in _bodies(world, operation):
                    yield method, template, address + query, body


def _values(world: Any, name: str, template: str) -> list[Any]:
    return world.ids["method" if name == "slug" and "/methods/" in template else name]


def _queries(world: Any, operation: dict[str, Any]) -> Iterator[str]:
    yield ""
    for parameter in operation.get("parameters", []):
        if parameter["in"] == "query" and parameter["name"] != "cursor":
            for value in _query_values(world, parameter):
                yield f"?{parameter['name']}={value}"
                if parameter["name"] in ("format", "images"):
                    yield f"?{parameter['name']}={value}&allow_not_done=true"


def _query_values(world: Any, parameter: dict[str, Any]) -> list[Any]:
    kinds = [parameter["schema"], *parameter["schema"].get("anyOf", [])]
    if any(kind.get("type") == "boolean" for kind in kinds):
        return ["true", "false"]
    named = [value for kind in kinds for value in kind.get("enum", [])]
    return list(dict.fromkeys([*named, *world.ids.get(parameter["name"], [])]))


def _bodies(world: Any, operation: dict[str, Any]) -> Iterator[dict[str, Any]]:
    content = operation.get("requestBody", {}).get("content", {})
    if "multipart/form-data" in content:
        stream = io.BytesIO()
        with zipfile.ZipFile(stream, "w") as archive:
            archive.writestr("a/one.json", '{"segments": [{"points": [[20, 30], [120, 31]]}]}')
        yield {"files": [("files", ("a.zip", stream.getvalue()))], "data": {"method": "first"}}
    elif "application/json" in content:
        yield {"json": _example(world, content["application/json"]["schema"])}
        yield {"json": {}}
    else:
        yield {}


def _example(world: Any, schema: dict[str, Any]) -> Any:
    reference = next((kind["$ref"] for kind in [schema, *schema.get("anyOf", [])] if "$ref" in kind), None)
    if reference is None:
        return {}
    return _with_hidden_ids(
        world, world.document["components"]["schemas"][reference.rpartition("/")[2]].get("example", {})
    )


def _with_hidden_ids(world: Any, value: Any) -> Any:
    """Put ids of hidden things where an example has ids."""
    if isinstance(value, list):
        return [_with_hidden_ids(world, each) for each in value]
    if not isinstance(value, dict):
        return value
    known = {"ids": world.ids["image_id"][:1], "image_ids": world.ids["image_id"][:1]}
    known["segment_id"] = world.ids["segment_id"][0]
    return {key: known.get(key, _with_hidden_ids(world, each)) for key, each in value.items()}


def walk(world: Any, role: str, leaks_in: LeaksIn, *, safe: bool) -> int:
    """Ask everything, fail on any leak, and return how much was asked."""
    leaks: list[str] = []
    failures: list[str] = []
    walked = 0
    for method, _, address, body in requests(world, safe=safe):
        answer = world.ask(role, method, address, **body)
        walked += 1
        leaks += [f"{method} {address} ({answer.status_code}): {leak}" for leak in leaks_in(answer)]
        if answer.status_code >= 500:
            failures.append(f"{method} {address}: {answer.status_code} {answer.text[:200]}")
    assert leaks == []
    assert failures == []
    return walked


@pytest.mark.parametrize("role", BELOW)
def test_nobody_below_maintainer_reads_hidden_labels(role: str, world: Any, leaks_in: LeaksIn) -> None:
    assert walk(world, role, leaks_in, safe=True) > 100


def test_a_maintainer_s_walk_finds_them(world: Any, leaks_in: LeaksIn) -> None:
    found = {
        template
        for method, template, address, body in requests(world, safe=True)
        if leaks_in(world.ask("maintainer", method, address, **body))
    }
    assert set(CONTROL) <= found, sorted(found)


@pytest.mark.parametrize("role", BELOW)
def test_what_is_concealed_is_not_there(role: str, world: Any) -> None:
    """Every address that names a concealed thing answers 404, but for its pixels."""
    concealed = {
        "slug": ["secret", "copy"],
        "image_id": world.ids["image_id"][:3],
        **{name: world.ids[name] for name in ("segment_id", "run_id")},
        "camera_id": world.ids["camera_id"][:1],
        "calibration_id": world.ids["calibration_id"][:1],
        "second_review_id": world.ids["second_review_id"][:1],
    }
    wrong: list[str] = []
    for method, template, operation in world.operations():
        names = re.findall(r"{(\w+)}", template)
        if "/methods/" in template or names[:1] not in [[name] for name in concealed]:
            continue
        if template.endswith(PIXELS):
            continue
        for value in concealed[names[0]]:
            address = template.replace(f"{{{names[0]}}}", str(value))
            body = next(_bodies(world, operation))
            status = world.ask(role, method, address, **body).status_code
            if status not in (401, 403, 404) or (method == "GET" and status not in (403, 401, 404)):
                wrong.append(f"{method} {address}: {status}")
    assert wrong == []


@pytest.mark.parametrize("role", BELOW)
def test_a_submission_to_a_hidden_split_has_no_details(role: str, world: Any) -> None:
    hidden, other = world.ids["submission_id"][:2]
    shown = {"", "/events", "/file", "/withdraw", "/restore", "/rescore"}
    details = 0
    for method, template, operation in world.operations():
        if not template.startswith("/api/submissions/") or template.partition("}")[2] in shown:
            continue
        parts = {"submission_id": hidden, "other": other, "split_image_id": world.ids["split_image_id"][0]}
        for named in (parts, {**parts, "submission_id": world.ids["submission_id"][2]}):
            if named["submission_id"] != hidden and "{other}" not in template:
                continue
            answer = world.ask(role, method, template.format(**named), **next(_bodies(world, operation)))
            assert answer.status_code in (401, 403, 404), template
            details += 1
    assert details >= 7


def test_lists_leave_concealed_datasets_out(world: Any) -> None:
    for role in BELOW:
        assert [dataset["slug"] for dataset in world.ask(role, "GET", "/api/datasets").json()] == ["street"]
        splits = {split["slug"]: split for split in world.ask(role, "GET", "/api/splits").json()}
        assert splits["hidden"]["dataset"] is None
        assert splits["hidden"]["version"]["labels"] is None
        assert splits["open"]["dataset"] == {"slug": "street", "name": "street"}
        assert splits["open"]["version"]["labels"] == 3
    assert len(world.ask("maintainer", "GET", "/api/datasets").json()) == 3


def test_the_pixels_of_a_hidden_split_are_there_for_detectors(world: Any) -> None:
    for image in world.ask("reader", "GET", "/api/splits/hidden/images").json()["items"]:
        for kind in PIXELS:
            assert world.ask("reader", "GET", image[kind]).status_code == 200
    for kind in PIXELS:
        assert world.ask("reader", "GET", f"/api/images/{world.ids['image_id'][0]}/{kind}").status_code == 200


@pytest.mark.parametrize("role", BELOW)
def test_the_lens_of_a_hidden_image_is_not_in_its_pixels(role: str, world: Any) -> None:
    for image_id in world.ids["image_id"][:3]:
        display = f"/api/images/{image_id}/display"
        assert world.ask(role, "GET", f"{display}?view=clahe").status_code == 200
        assert world.ask(role, "GET", f"{display}?view=undistorted").status_code == 404
        assert world.ask("maintainer", "GET", f"{display}?view=undistorted").status_code in (200, 409)


@pytest.mark.parametrize("written", ["{}%0A", "%20{}", "+{}", "0{}", "{}.0", "１"])
def test_an_id_in_another_writing_is_no_way_round(written: str, world: Any) -> None:
    address = f"/api/images/{written.format(world.ids['image_id'][0])}/points"
    assert world.ask("annotator", "GET", address).status_code in (404, 422)


def test_a_deleted_split_conceals_as_before(world: Any) -> None:
    world.made("DELETE", "/api/splits/hidden")
    try:
        for address in ("/api/datasets/secret", f"/api/images/{world.ids['image_id'][0]}/points", "/api/splits/hidden"):
            assert world.ask("annotator", "GET", address).status_code == 404
        assert world.ask("annotator", "GET", "/api/splits?deleted=true").json() == []
    finally:
        world.made("POST", "/api/splits/hidden/restore")


@pytest.mark.parametrize("role", BELOW)
def test_a_hidden_split_shows_rounded_totals_alone(role: str, world: Any) -> None:
    shown: list[dict[str, Any]] = []
    board = world.ask(role, "GET", "/api/splits/hidden/board").json()
    shown += [row["totals"] for row in board["rows"]]
    submissions = world.ask(role, "GET", "/api/splits/hidden/submissions").json()["items"]
    submissions.append(world.ask(role, "GET", f"/api/submissions/{world.ids['submission_id'][0]}").json())
    for submission in submissions:
        shown += [score["totals"] for score in submission["scores"]]
        assert submission["strata"] is None
        assert submission["error_types"] is None
        assert not submission["can"]["see_details"]
    assert len(shown) >= 5
    values = [value for totals in shown for total in totals.values() for value in total.values() if value is not None]
    assert any(0 < value < 1 for value in values)
    assert [value for value in values if round(value, 3) != value] == []
    assert {name for totals in shown for name in totals} == {"f1", "precision", "recall"}


@pytest.mark.parametrize("role", BELOW)
def test_nobody_below_maintainer_is_told_by_changing_things(role: str, world: Any, leaks_in: LeaksIn) -> None:
    """The last test of the file: it withdraws, hides and renames what it may."""
    assert walk(world, role, leaks_in, safe=False) > 20
