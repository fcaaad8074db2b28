"""What each request passes on its way to a route, and each answer on its way back."""

from __future__ import annotations

import logging
from pathlib import Path

from fastapi import FastAPI
from starlette.middleware.cors import CORSMiddleware
from starlette.middleware.gzip import DEFAULT_EXCLUDED_CONTENT_TYPES, GZipMiddleware

from app.api.built_files import BuiltFiles
from app.api.gate import Gate
from app.api.guard import Guard
from app.api.head import HeadAsGet
from app.api.metrics import Metrics
from app.api.observing import REQUEST_ID, Mishaps, Observed
from app.api.opening import Opening
from app.api.origins import own_names
from app.api.scraping import Scraping
from app.api.throttling import Throttled, ThrottledRefusals
from app.settings import Settings

TOLD_ELSEWHERE = (REQUEST_ID, "RateLimit", "RateLimit-Policy", "Retry-After", "Content-Disposition", "ETag")
"""Headers that pages of other sites may read, where they may ask at all."""


def add_layers(application: FastAPI, settings: Settings, metrics: Metrics, static: Path | None) -> None:
    """Put the layers around an application, the innermost first.

    Args:
        application: The application.
        settings: Of the server.
        metrics: Where requests are counted.
        static: Folder of the built browser tool, where there is one.
    """
    if static is not None:
        application.add_middleware(Opening, static=static)
        application.add_middleware(BuiltFiles, static=static)
    application.add_middleware(Throttled)
    application.add_middleware(Gate)
    application.add_middleware(ThrottledRefusals)
    token = settings.metrics_token
    application.add_middleware(Scraping, metrics=metrics, token=token.get_secret_value() if token else None)
    application.add_middleware(
        GZipMiddleware,
        minimum_size=2000,
        compresslevel=5,
        exclude_content_types=(*DEFAULT_EXCLUDED_CONTENT_TYPES, "application/octet-stream"),
    )
    application.add_middleware(HeadAsGet)
    application.add_middleware(Mishaps)
    own = own_names(settings)
    if own.elsewhere:
        application.add_middleware(
            CORSMiddleware,
            allow_origins=sorted(own.elsewhere),
            allow_methods=["GET", "POST", "PUT", "PATCH", "DELETE"],
            allow_headers=["Authorization", "Content-Type", "If-None-Match", REQUEST_ID],
            allow_credentials=False,
            expose_headers=TOLD_ELSEWHERE,
        )
    application.add_middleware(Guard, own=own, max_body_bytes=settings.max_upload_bytes)
    # in local mode nobody wants to read of each request
    level = logging.INFO if settings.hosted else logging.DEBUG
    application.add_middleware(Observed, metrics=metrics, level=level)
