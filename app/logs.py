"""Structured logs: one event a line, as text or as JSON, with the ids of the request or of the work that it is about.

Modules log through the standard library (``logging.getLogger(__name__)``), as the libraries do; what is bound with
``structlog.contextvars`` goes along with each event. No secret gets through: see `Redaction`.
"""

from __future__ import annotations

import logging
import re
import sys
from collections.abc import Collection, MutableMapping
from dataclasses import dataclass
from typing import Any, Literal, TextIO

import structlog
from structlog.processors import JSONRenderer, TimeStamper
from structlog.stdlib import ProcessorFormatter

LogFormat = Literal["text", "json"]
Event = MutableMapping[str, Any]

OWN = "app"
"""Whose loggers follow the level that is set; libraries tell warnings alone: below, some of them tell secrets."""

PATTERNS = (
    (re.compile(r"(\w+://[^\s/:@]*):[^\s/@]+@"), r"\1:***@"),  # the password in an address
    (re.compile(r"\bcl_[\w-]{20,}"), "cl_***"),  # a token
    (re.compile(r"(?i)\b(bearer|basic)\s+[\w.~+/=-]{8,}"), r"\1 ***"),
    (re.compile(r"(?i)(clearlines_(?:session|token|openid)=)[^;\s,\"']+"), r"\1***"),  # a cookie
    (re.compile(r"\[parameters: [^\n]*"), "[parameters: ***]"),  # what SQLAlchemy tells of a statement that failed
)
ESCAPED = {code: repr(chr(code))[1:-1] for code in (*range(32), 127, 0x85, 0x2028, 0x2029)}


@dataclass(frozen=True)
class Redaction:
    """Keeps secrets out of what is written.

    Attributes:
        known: Secrets of the settings; the text of an event that holds one is written without it.
    """

    known: Collection[str] = ()

    def __call__(self, text: str) -> str:
        """Return a line as it may be written."""
        for secret in self.known:
            text = text.replace(secret, "***")
        for pattern, instead in PATTERNS:
            text = pattern.sub(instead, text)
        return text


class RedactingFormatter(ProcessorFormatter):
    """Renders events, then takes secrets out of the whole of each, tracebacks too."""

    def __init__(self, *arguments: Any, redaction: Redaction, **named: Any) -> None:
        super().__init__(*arguments, **named)
        self._redaction = redaction

    def format(self, record: logging.LogRecord) -> str:
        """See ``logging.Formatter``."""
        return self._redaction(super().format(record))


def configure_logs(
    log_format: LogFormat, level: str, *, redaction: Redaction | None = None, stream: TextIO | None = None
) -> logging.Handler:
    """Have everything that is logged in this process written.

    Args:
        log_format: Lines of text, or JSON.
        level: What ClearLines itself tells: ``debug`` to ``error``.
        redaction: Keeps secrets out.
        stream: Where to; standard error if left out.

    Returns:
        What writes; tests take it off the root logger again.
    """
    shared: list[Any] = [
        structlog.contextvars.merge_contextvars,
        structlog.stdlib.add_logger_name,
        structlog.stdlib.add_log_level,
        structlog.stdlib.ExtraAdder(),
        TimeStamper(fmt="iso", utc=True),
        _on_one_line,
    ]
    rendering: list[Any] = (
        [structlog.processors.format_exc_info, JSONRenderer(sort_keys=True, ensure_ascii=False, default=str)]
        if log_format == "json"
        else [
            structlog.dev.ConsoleRenderer(
                colors=False, pad_event_to=0, exception_formatter=structlog.dev.plain_traceback
            )
        ]
    )
    handler = logging.StreamHandler(stream or sys.stderr)
    handler.setFormatter(
        RedactingFormatter(
            foreign_pre_chain=shared,
            processors=[ProcessorFormatter.remove_processors_meta, *rendering],
            redaction=redaction or Redaction(),
        )
    )
    root = logging.getLogger()
    root.addHandler(handler)
    root.setLevel(logging.WARNING)
    logging.getLogger(OWN).setLevel(level.upper())
    return handler


def _on_one_line(_logger: Any, _name: str, event: Event) -> Event:
    """Escape what would begin a new line: a name that somebody chose mustn't be able to look like another event."""
    event["event"] = str(event["event"]).translate(ESCAPED)
    return event
