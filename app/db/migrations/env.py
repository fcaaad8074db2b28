"""Alembic's entry point: the connection comes from ``run_upgrade``."""

from __future__ import annotations

from typing import Any, Literal

from alembic import context
from sqlalchemy import Connection

from app.db.models import Base, UtcDateTime


def render(kind: str, item: Any, _context: Any) -> str | Literal[False]:
    # a migration must still run when models.py has moved on
    return "sa.DateTime(timezone=True)" if kind == "type" and isinstance(item, UtcDateTime) else False


def migrate(connection: Connection) -> None:
    context.configure(
        connection=connection,
        target_metadata=Base.metadata,
        render_as_batch=connection.dialect.name == "sqlite",
        render_item=render,
        compare_server_default=True,
    )
    with context.begin_transaction():
        context.run_migrations()


given = context.config.attributes.get("connection")
if given is None:
    raise RuntimeError("migrations run through app.db.session.upgrade or the command clearlines migrate")
migrate(given)
