"""Accounts: people who sign in, their browsers' sessions, invitations, tokens, and who a provider says they are."""

from __future__ import annotations

from datetime import datetime

from sqlalchemy import ForeignKey, Index, String, UniqueConstraint, text
from sqlalchemy.orm import Mapped, mapped_column

from app.db.models.base import NEVER_REUSED, Base, one_of

ROLES = ("admin", "maintainer", "annotator", "submitter", "reader")
INVITATION_KINDS = ("join", "reset")


class User(Base):
    """A person with an account. What they do is stored under the name, which nobody else ever gets.

    ``name_key`` is the name casefolded, so that no two accounts differ by case alone. Without ``password_hash`` they
    sign in through a provider, or not yet.
    """

    __tablename__ = "users"
    __table_args__ = (UniqueConstraint("name_key"), one_of("role", ROLES), NEVER_REUSED)

    id: Mapped[int] = mapped_column(primary_key=True)
    name: Mapped[str] = mapped_column(String(200))
    name_key: Mapped[str] = mapped_column(String(400))
    email: Mapped[str | None] = mapped_column(String(320))
    role: Mapped[str] = mapped_column(String(20))
    password_hash: Mapped[str | None] = mapped_column(String(300))
    created_at: Mapped[datetime]
    created_by: Mapped[str | None] = mapped_column(String(200))
    disabled_at: Mapped[datetime | None]
    last_seen_at: Mapped[datetime | None]

    @property
    def has_password(self) -> bool:
        """Whether it can be signed in to with a name and a password."""
        return self.password_hash is not None


class Identity(Base):
    """Under which subject an OpenID Connect provider knows a person."""

    __tablename__ = "identities"
    __table_args__ = (UniqueConstraint("issuer", "subject"),)

    id: Mapped[int] = mapped_column(primary_key=True)
    user_id: Mapped[int] = mapped_column(ForeignKey("users.id", ondelete="CASCADE"), index=True)
    issuer: Mapped[str] = mapped_column(String(500))
    subject: Mapped[str] = mapped_column(String(300))
    created_at: Mapped[datetime]


class WebSession(Base):
    """A browser that is signed in; of what it sends only the SHA-256 is kept."""

    __tablename__ = "web_sessions"
    __table_args__ = (UniqueConstraint("sha256"), NEVER_REUSED)

    id: Mapped[int] = mapped_column(primary_key=True)
    user_id: Mapped[int] = mapped_column(ForeignKey("users.id", ondelete="CASCADE"), index=True)
    sha256: Mapped[str] = mapped_column(String(64))
    created_at: Mapped[datetime]
    expires_at: Mapped[datetime] = mapped_column(index=True)
    last_used_at: Mapped[datetime]
    revoked_at: Mapped[datetime | None]
    address: Mapped[str | None] = mapped_column(String(100))
    agent: Mapped[str | None] = mapped_column(String(300))


class Invitation(Base):
    """A link that makes an account (``join``), or lets the holder of one choose a new password (``reset``)."""

    __tablename__ = "invitations"
    __table_args__ = (
        UniqueConstraint("sha256"),
        one_of("kind", INVITATION_KINDS),
        one_of("role", ROLES),
        NEVER_REUSED,
    )

    id: Mapped[int] = mapped_column(primary_key=True)
    sha256: Mapped[str] = mapped_column(String(64))
    kind: Mapped[str] = mapped_column(String(20))
    role: Mapped[str | None] = mapped_column(String(20))
    name: Mapped[str | None] = mapped_column(String(200))  # which it is for, where it was said
    # whose password is to be chosen anew; once used, whose account came of it
    user_id: Mapped[int | None] = mapped_column(ForeignKey("users.id", ondelete="CASCADE"), index=True)
    created_by: Mapped[str | None] = mapped_column(String(200))
    created_at: Mapped[datetime]
    expires_at: Mapped[datetime]
    used_at: Mapped[datetime | None]
    revoked_at: Mapped[datetime | None]


class Token(Base):
    """What a program sends to say who asks; of the token itself only its SHA-256 is kept.

    A service token stands for itself, with a name that no other living one has. A person's own token has a label, and
    what it is used for is stored under the person's name, with the lesser of both roles.
    """

    __tablename__ = "tokens"
    __table_args__ = (
        UniqueConstraint("sha256"),
        Index(
            "uq_tokens_name_alive",
            "name",
            unique=True,
            sqlite_where=text("revoked_at IS NULL AND user_id IS NULL"),
            postgresql_where=text("revoked_at IS NULL AND user_id IS NULL"),
        ),
        Index(
            "uq_tokens_label_alive",
            "user_id",
            "label",
            unique=True,
            sqlite_where=text("revoked_at IS NULL"),
            postgresql_where=text("revoked_at IS NULL"),
        ),
        one_of("role", ROLES),
    )

    id: Mapped[int] = mapped_column(primary_key=True)
    user_id: Mapped[int | None] = mapped_column(ForeignKey("users.id", ondelete="CASCADE"))
    name: Mapped[str] = mapped_column(String(200))  # of the service, or of the person
    label: Mapped[str | None] = mapped_column(String(200))
    role: Mapped[str] = mapped_column(String(20))
    sha256: Mapped[str] = mapped_column(String(64))
    created_at: Mapped[datetime]
    expires_at: Mapped[datetime | None]
    revoked_at: Mapped[datetime | None]
    last_used_at: Mapped[datetime | None]
