"""Errors as problem documents (RFC 9457): one form for every status."""

from __future__ import annotations

import errno
from http import HTTPStatus
from typing import Any, cast

from fastapi import FastAPI, Request
from fastapi.encoders import jsonable_encoder
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from pydantic import BaseModel, ConfigDict, Field
from starlette.exceptions import HTTPException

from app.api.throttle import RETRY_AFTER
from app.errors import ClearLinesError, NoRoom, Unauthenticated

TOO_MANY_FILES = "Too many files"
"""How the framework begins its words on a form with more files than it takes."""
MEDIA_TYPE = "application/problem+json"
FULL = frozenset({errno.ENOSPC, errno.EDQUOT})
MAKE_ROOM = "try again when whoever runs the server has made room"


class Problem(BaseModel):
    """What went wrong, where, what was expected and what would help."""

    model_config = ConfigDict(
        json_schema_extra={
            "example": {
                "type": "about:blank",
                "title": "Not Found",
                "status": 404,
                "code": "not-found",
                "message": "there is no dataset of this name",
                "where": "kitti-odometry",
                "hint": "GET /api/datasets lists them",
            }
        }
    )

    type: str = "about:blank"
    title: str
    status: int
    code: str
    message: str
    where: str | None = None
    expected: str | None = None
    hint: str | None = None
    details: dict[str, Any] = Field(default_factory=dict)


def problem_response(status: int, code: str, message: str, **fields: Any) -> JSONResponse:
    """Return a problem document; fields that are empty are left out."""
    body = {
        "type": "about:blank",
        "title": HTTPStatus(status).phrase,
        "status": status,
        "code": code,
        "message": message,
    }
    body.update({key: value for key, value in fields.items() if value})
    return JSONResponse(jsonable_encoder(body), status_code=status, media_type=MEDIA_TYPE)


def problem_of(error: ClearLinesError) -> JSONResponse:
    """Return the problem document of an error of the tree."""
    fields = error.as_dict()
    response = problem_response(error.status, fields.pop("code"), fields.pop("message"), **fields)
    if isinstance(error, Unauthenticated):
        response.headers["WWW-Authenticate"] = "Bearer"
    if RETRY_AFTER in error.details:
        response.headers["Retry-After"] = str(error.details[RETRY_AFTER])
    return response


def answers(*statuses: int) -> dict[int | str, dict[str, Any]]:
    """Return the ``responses`` of a route for the OpenAPI document."""
    return {
        status: {"model": Problem, "content": {MEDIA_TYPE: {}}, "description": HTTPStatus(status).phrase}
        for status in statuses
    }


async def _own_error(request: Request, error: Exception) -> JSONResponse:
    del request
    return problem_of(cast(ClearLinesError, error))


async def _validation_error(request: Request, error: Exception) -> JSONResponse:
    del request
    error = cast(RequestValidationError, error)
    errors = [
        {"where": ".".join(str(part) for part in item["loc"]), "message": item["msg"], "kind": item["type"]}
        for item in error.errors()
    ]
    first = errors[0] if errors else {"where": "", "message": "the request is not valid"}
    return problem_response(
        422,
        "invalid-request",
        first["message"],
        where=first["where"],
        hint="/api/docs shows what each request takes",
        details={"errors": errors},
    )


async def _http_error(request: Request, error: Exception) -> JSONResponse:
    error = cast(HTTPException, error)
    if isinstance(error.__cause__, ClearLinesError):  # raised while the body was read, and wrapped by the framework
        return problem_of(error.__cause__)
    status = HTTPStatus(error.status_code)
    messages = {
        HTTPStatus.NOT_FOUND: "there is nothing at this address",
        HTTPStatus.METHOD_NOT_ALLOWED: f"{request.method} is not possible here",
    }
    message = messages.get(status, str(error.detail))
    code = status.phrase.lower().replace(" ", "-")
    hint = "/api/docs lists the addresses" if status in messages else None
    if message.startswith(TOO_MANY_FILES):
        hint = "pack them into one zip or tar.gz"
    response = problem_response(status, code, message, where=request.url.path, hint=hint)
    response.headers.update(error.headers or {})
    return response


async def _system_error(request: Request, error: Exception) -> JSONResponse:
    del request
    if getattr(error, "errno", None) not in FULL:
        raise error
    return problem_of(NoRoom("there is no room left on the server's disk; nothing was changed", hint=MAKE_ROOM))


def mistake_of(request_id: str) -> JSONResponse:
    """Return the problem document of an error that nobody foresaw.

    Args:
        request_id: What the server's log has the details under.
    """
    return problem_response(
        500,
        "internal-error",
        "the server made a mistake; nothing was changed",
        hint=f"the server's log has the details under request {request_id}; please report it with them",
        details={"request_id": request_id},
    )


def install_problem_handlers(application: FastAPI) -> None:
    """Give every error that routes raise the one form; for those that nobody foresaw see `app.api.observing`."""
    application.add_exception_handler(ClearLinesError, _own_error)
    application.add_exception_handler(RequestValidationError, _validation_error)
    application.add_exception_handler(HTTPException, _http_error)
    application.add_exception_handler(OSError, _system_error)
