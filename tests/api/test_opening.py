"""What goes along with the first answer of a page, and the files that it is made of."""

from __future__ import annotations

import gzip
import json
import re

import pytest
from starlette.applications import Starlette
from starlette.responses import PlainTextResponse
from starlette.routing import Route
from starlette.testclient import TestClient

from app.api.built_files import BuiltFiles
from app.api.opening import Opening, links_of_page
from app.api.schemas.labelling import SegmentsAnswer

SCRIPT = b"export const long = 1;\n" * 100
MANIFEST = {
    "index.html": {"file": "assets/index-1.js", "imports": ["_framework"], "css": ["assets/index-1.css"]},
    "_framework": {"file": "assets/framework-1.js"},
    "src/pages/label/label_page.tsx": {
        "file": "assets/label_page-1.js",
        "imports": ["_framework", "index.html", "_image"],
    },
    "_image": {
        "file": "assets/image-1.js",
        "imports": ["_framework"],
        "css": ["assets/image-1.css"],
        "assets": [
            "assets/picture_worker-1.js",
            "assets/grain-1.png",
        ],
    },
    "src/pages/board/board_page.tsx": {"file": "assets/board_page-1.js"},
}


@pytest.fixture
def static(tmp_path):
    (tmp_path / "assets").mkdir()
    (tmp_path / "assets" / "index-1.js").write_bytes(SCRIPT)
    (tmp_path / "manifest.json").write_text(json.dumps(MANIFEST))
    (tmp_path / "secret.txt").write_text("not to be served")
    return tmp_path


@pytest.fixture
def site(static):
    async def answer(request):
        return PlainTextResponse("another", status_code=404 if "gone" in request.url.path else 200)

    application = Starlette(routes=[Route("/{path:path}", answer, methods=["GET", "POST"])])
    application.add_middleware(Opening, static=static)
    application.add_middleware(BuiltFiles, static=static)
    return TestClient(application)


def test_the_label_page_is_told_its_files_and_its_data(site) -> None:
    links = site.get("/datasets/street/images/17").headers["link"].split(", ")
    scripts = [link for link in links if "modulepreload" in link]
    assert re.findall("assets/([a-z_]+)", " ".join(scripts)) == [
        "index",
        "label_page",
        "framework",
        "image",
        "picture_worker",
    ]
    assert links[: len(scripts)] == scripts
    assert "</assets/image-1.css>; rel=preload; as=style; crossorigin" in links
    assert "</api/images/17/points>; rel=preload; as=fetch; crossorigin" in links
    assert "</api/images/17/display>; rel=preload; as=fetch; crossorigin" in links
    assert not any("board" in link for link in links)


@pytest.mark.parametrize("path", ["/", "/datasets/street", "/datasets/gone/images/17", "/datasets/a/images/017"])
def test_other_answers_have_no_links(site, path) -> None:
    assert "link" not in site.get(path).headers


def test_a_page_without_a_manifest_names_its_data_only(tmp_path) -> None:
    assert links_of_page(tmp_path, "src/pages/label/label_page.tsx") == []


@pytest.mark.parametrize("encoding", ["gzip", "identity"])
def test_built_files_are_kept_for_good(site, encoding) -> None:
    answer = site.get("/assets/index-1.js", headers={"Accept-Encoding": encoding})
    assert answer.content == SCRIPT
    assert answer.headers["cache-control"] == "public, max-age=31536000, immutable"
    assert answer.headers["vary"] == "Accept-Encoding"
    assert answer.headers["content-type"].startswith("text/javascript")
    assert answer.headers.get("content-encoding", "identity") == encoding
    sent = int(answer.headers["content-length"])
    assert sent == (len(gzip.compress(SCRIPT, 6, mtime=0)) if encoding == "gzip" else len(SCRIPT))


@pytest.mark.parametrize("path", ["/assets/index-2.js", "/assets/../secret.txt", "/secret.txt", "/assets/"])
def test_whatever_was_not_built_is_left_to_others(site, path) -> None:
    assert site.get(path).text == "another"


def test_a_file_that_a_newer_build_took_away_is_left_to_others(site, static) -> None:
    (static / "assets" / "index-1.js").unlink()
    assert site.get("/assets/index-1.js").text == "another"


def test_candidates_are_answered_as_their_schema_says(client, prelabelled) -> None:
    content = client.get(f"/api/images/{prelabelled[0]}/segments").content
    checked = SegmentsAnswer.model_validate_json(content, extra="forbid")
    assert checked.segments
    assert json.loads(checked.model_dump_json()) == json.loads(content)
