"""Tokens: the names and roles under which people and programs ask."""

from __future__ import annotations

from datetime import datetime

from sqlalchemy import String, UniqueConstraint
from sqlalchemy.orm import Mapped, mapped_column

from app.db.models.base import Base, alive_unique, one_of

ROLES = ("owner", "maintainer", "annotator", "submitter", "reader")


class Token(Base):
    """A name with a role; of the token itself only its SHA-256 is kept."""

    __tablename__ = "tokens"
    __table_args__ = (
        UniqueConstraint("sha256"),
        alive_unique("uq_tokens_name_alive", "name", until="revoked_at"),
        one_of("role", ROLES),
    )

    id: Mapped[int] = mapped_column(primary_key=True)
    name: Mapped[str] = mapped_column(String(200))
    role: Mapped[str] = mapped_column(String(20))
    sha256: Mapped[str] = mapped_column(String(64))
    created_at: Mapped[datetime]
    expires_at: Mapped[datetime | None]
    revoked_at: Mapped[datetime | None]
    last_used_at: Mapped[datetime | None]
