"""Every route of the OpenAPI document, asked by everybody: who may is let to it, and nobody else, before it is read."""

from __future__ import annotations

import json
import re
from collections.abc import Awaitable, Callable, Mapping
from pathlib import Path
from typing import Any

from app.api.gate import Gate
from app.api.policy import LEAST
from app.services.access import ROLES
from tests.event_loop import run

Place = Any
Asker = Any
Headers = Mapping[str, str]
Answering = Callable[..., Awaitable[None]]
Operation = tuple[str, str, str]
Asked = tuple[str, Operation]
DOCUMENT = Path(__file__).resolve().parents[3] / "frontend" / "src" / "api" / "openapi.json"
"""As it is stored: another test says so when it isn't what the server says."""
OWN_PAGE = "http://127.0.0.1:8765"
ENTERING = {
    ("POST", "/session"),
    ("DELETE", "/session"),
    ("POST", "/invitations/look"),
    ("POST", "/invitations/accept"),
}
"""Who comes in or goes out isn't asked who they are: a cookie that is no longer good isn't in their way."""

WRITTEN = {
    (address.split(" ")[0], address.split(" ")[1]): role for role, addresses in LEAST.items() for address in addresses
}

SPOT_CHECKS = {
    ("GET", "/api/datasets"): "reader",
    ("GET", "/api/me"): "reader",
    ("GET", "/api/splits"): "reader",
    ("POST", "/api/splits/nope/submissions"): "submitter",
    ("PATCH", "/api/methods/nope"): "submitter",
    ("POST", "/api/images/999999/decisions"): "annotator",
    ("PUT", "/api/images/999999/review"): "annotator",
    ("GET", "/api/datasets/nope/statistics"): "annotator",
    ("POST", "/api/datasets"): "maintainer",
    ("POST", "/api/datasets/nope/images"): "maintainer",
    ("DELETE", "/api/datasets/nope"): "maintainer",
    ("POST", "/api/datasets/nope/splits"): "maintainer",
    ("DELETE", "/api/images/999999"): "maintainer",
    ("GET", "/api/users"): "admin",
    ("PATCH", "/api/users/999999"): "admin",
    ("POST", "/api/users/999999/reset"): "admin",
    ("GET", "/api/users/tokens"): "admin",
    ("DELETE", "/api/users/tokens/999999"): "admin",
    ("GET", "/api/invitations"): "admin",
    ("POST", "/api/invitations"): "admin",
    ("GET", "/api/audit"): "admin",
    ("GET", "/api/status"): "admin",
}
"""Least roles, written down by hand and not taken from the policy."""


async def behind_the_gate(_scope: Any, _receive: Any, send: Any) -> None:
    """Stand for all that is behind it."""
    await send({"type": "http.response.start", "status": 204, "headers": []})
    await send({"type": "http.response.body", "body": b""})


def operations() -> list[Operation]:
    """Method, template and an address of nothing of every operation of the document."""
    return [
        (
            method.upper(),
            path.removeprefix("/api"),
            re.sub(r"{\w*(_id|other)}", "999999", path).replace("{", "").replace("}", ""),
        )
        for path, described in sorted(json.loads(DOCUMENT.read_text())["paths"].items())
        for method in described
    ]


def ask_all(place: Place, requests: list[tuple[str, str, Headers]], *, gate_alone: bool = False) -> list[int]:
    """Return the status of each answer; the body is one that nobody can read, and that must not be read if refused.

    Args:
        place: Where to ask.
        requests: Method, address and headers.
        gate_alone: Whether to ask the gate and nothing behind it, which is quicker.
    """
    application: Any = place.client.app
    answering: Answering = Gate(behind_the_gate) if gate_alone else application

    async def ask(method: str, address: str, headers: Headers) -> int:
        status = 0

        async def receive() -> dict[str, Any]:
            return {"type": "http.request", "body": b"\0{", "more_body": False}

        async def send(message: Any) -> None:
            nonlocal status
            if message["type"] == "http.response.start":
                status = message["status"]

        given = {"host": "127.0.0.1:8765", "content-type": "application/json", **headers}
        scope = {
            "type": "http",
            "app": application,
            "asgi": {"version": "3.0"},
            "http_version": "1.1",
            "method": method,
            "scheme": "http",
            "path": address,
            "raw_path": address.encode(),
            "root_path": "",
            "query_string": b"",
            "headers": [(name.encode(), value.encode()) for name, value in given.items()],
            "client": ("192.0.2.1", 1),
            "server": ("127.0.0.1", 8765),
        }
        await answering(scope, receive, send)
        return status

    async def one_by_one() -> list[int]:
        return [await ask(*request) for request in requests]

    return run(one_by_one())


def expected(asker: Asker, method: str, template: str, least: str) -> set[int]:
    """Statuses that mean "no" for an asker; an empty set where they are to be let through."""
    if (method, template) in ENTERING and "authorization" not in asker.headers:
        return set()
    if asker.role is None:
        return {401}
    if ROLES.index(asker.role) < ROLES.index(least):
        return {401} if asker.anonymous else {403}
    if template.split("/")[1] == "account" and not asker.has_account:
        return {401} if asker.anonymous else {404}
    return set()


def wrong(place: Place, askers: dict[str, Asker], asked: list[Asked], *, gate_alone: bool) -> list[str]:
    """Return which answers aren't what the policy says."""
    requests = [(method, address, askers[who].headers) for who, (method, _, address) in asked]
    statuses = ask_all(place, requests, gate_alone=gate_alone)
    found = []
    for (who, (method, template, _)), status in zip(asked, statuses, strict=True):
        no = expected(askers[who], method, template, WRITTEN[method, template])
        if (status not in no) if no else (status in {401, 403} or status >= 500):
            found.append(f"{who}: {method} {template}: {status}, not {no or 'let through'}")
    return found


def test_everybody_gets_as_far_as_their_role(place: Place, askers: dict[str, Asker]) -> None:
    """Everybody asks for everything; what is behind the gate doesn't answer."""
    asked = [(who, each) for who in askers for each in operations()]
    assert wrong(place, askers, asked, gate_alone=True) == []


def test_the_whole_application_answers_those_who_just_may_and_no_others(place: Place, askers: dict[str, Asker]) -> None:
    """For each route: nobody, the least role that it needs, and the one below that."""
    people = ["nobody", *(f"{role} in a browser" for role in ROLES)]
    asked = []
    for operation in operations():
        if operation[:2] != ("DELETE", "/session"):  # it would end what others ask with
            least = 1 + ROLES.index(WRITTEN[operation[:2]])
            asked += [(who, operation) for who in dict.fromkeys([people[0], people[least - 1], people[least]])]
    assert wrong(place, askers, asked, gate_alone=False) == []


def test_the_policy_is_what_was_meant(place: Place, askers: dict[str, Asker]) -> None:
    asked = [(who, check) for who in askers for check in SPOT_CHECKS if askers[who].role]
    statuses = ask_all(place, [(method, address, askers[who].headers) for who, (method, address) in asked])
    for (who, check), status in zip(asked, statuses, strict=True):
        allowed = ROLES.index(str(askers[who].role)) >= ROLES.index(SPOT_CHECKS[check])
        assert (status not in {401, 403}) == allowed, f"{who}: {check}: {status}"


def test_in_local_mode_nobody_is_refused_and_nobody_has_an_account(place: Place) -> None:
    place.change_server(settings=place.server.settings.model_copy(update={"anonymous_role": None}))
    found = operations()
    statuses = ask_all(place, [(method, address, {"origin": OWN_PAGE}) for method, _, address in found])
    for (method, template, _), status in zip(found, statuses, strict=True):
        account = template.split("/")[1] == "account"
        assert (status == 404) if account else (status not in {401, 403} and status < 500), f"{method} {template}"
