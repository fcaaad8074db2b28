"""Whatever is asked, of every operation of the OpenAPI document: no mistake of the server, and answers as documented.

A few requests of each operation are asked here, always the same ones. By hand, for other ones and more of them:

    CLEARLINES_ANY_REQUESTS=500 .venv/bin/pytest tests/api/any_request
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import schemathesis
from hypothesis import HealthCheck, Phase, given, settings
from schemathesis import GenerationMode
from schemathesis.checks import not_a_server_error
from schemathesis.specs.openapi.checks import (
    content_type_conformance,
    response_headers_conformance,
    response_schema_conformance,
    status_code_conformance,
)

CHECKS = [
    not_a_server_error,
    status_code_conformance,
    content_type_conformance,
    response_headers_conformance,
    response_schema_conformance,
]
ADDRESS = "http://127.0.0.1:8765"
REQUESTS = int(os.environ.get("CLEARLINES_ANY_REQUESTS", "0"))
DOCUMENT = Path(__file__).resolve().parents[3] / "frontend" / "src" / "api" / "openapi.json"


def operations() -> Iterator[tuple[str, str]]:
    """Method and path of every operation; another test says so when the stored document is an old one."""
    for path, described in sorted(json.loads(DOCUMENT.read_text())["paths"].items()):
        yield from ((method.upper(), path) for method in described)


@pytest.fixture(scope="module")
def api(world: Any) -> Any:
    async def without_lifespan(scope: Any, receive: Any, send: Any) -> None:
        if scope["type"] == "lifespan":
            raise NotImplementedError  # the world's own client has started the application already
        await world.application(scope, receive, send)

    schema = schemathesis.openapi.from_dict(world.document)
    schema.app = without_lifespan
    schema.config.update(base_url=ADDRESS, request_timeout=120)
    return schema


def can_be_wrong(operation: dict[str, Any]) -> bool:
    """Whether there is a request that doesn't fit the document: any word fits a path that takes words."""
    kinds = [parameter["schema"] for parameter in operation.get("parameters", ())]
    given = [kind["anyOf"][-1] if "anyOf" in kind else kind for kind in kinds]
    return "requestBody" in operation or any(kind.get("type") != "string" or "enum" in kind for kind in given)


@pytest.mark.parametrize(("method", "path"), list(operations()))
def test_any_request_is_answered_as_documented(api: Any, world: Any, method: str, path: str) -> None:
    operation = api[path][method]
    wrong = can_be_wrong(world.document["paths"][path][method.lower()])
    for mode in (GenerationMode.POSITIVE, *([GenerationMode.NEGATIVE] if wrong else [])):
        world.restore()

        @settings(
            max_examples=REQUESTS or 4,
            derandomize=not REQUESTS,
            database=None,
            phases=[Phase.generate],
            suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much, HealthCheck.data_too_large],
            report_multiple_bugs=bool(REQUESTS),
        )
        @given(case=operation.as_strategy(generation_mode=mode))
        def ask(case: Any) -> None:
            case.call_and_validate(checks=CHECKS)

        ask()
