"""Accounts: users, their sessions and invitations; tokens of a person's own; the role owner becomes admin.

Revision ID: 0005
Revises: 0004
"""

from __future__ import annotations

from typing import Any

import sqlalchemy as sa
from alembic import op

revision = "0005"
down_revision = "0004"
branch_labels = None
depends_on = None

ROLES = "'admin', 'maintainer', 'annotator', 'submitter', 'reader'"
ROLES_BEFORE = "'owner', 'maintainer', 'annotator', 'submitter', 'reader'"
KEPT_COLUMNS = "name, role, sha256, created_at, expires_at, revoked_at, last_used_at"


def upgrade() -> None:
    create_users()
    create_identities()
    create_web_sessions()
    create_invitations()
    change_tokens()
    op.add_column("events", sa.Column("address", sa.String(length=100), nullable=True))
    op.create_index("ix_events_created_at_id", "events", ["created_at", "id"], unique=False)
    op.create_index("ix_events_person_id", "events", ["person", "id"], unique=False)
    op.create_index("ix_events_kind_id", "events", ["kind", "id"], unique=False)


def downgrade() -> None:
    for column in ("kind_id", "person_id", "created_at_id"):
        op.drop_index(f"ix_events_{column}", "events")
    op.drop_column("events", "address")
    change_tokens_back()
    for table in ("invitations", "web_sessions", "identities", "users"):
        op.drop_table(table)


def create_users() -> None:
    op.create_table(
        "users",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("name", sa.String(length=200), nullable=False),
        sa.Column("name_key", sa.String(length=400), nullable=False),
        sa.Column("email", sa.String(length=320), nullable=True),
        sa.Column("role", sa.String(length=20), nullable=False),
        sa.Column("password_hash", sa.String(length=300), nullable=True),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("created_by", sa.String(length=200), nullable=True),
        sa.Column("disabled_at", sa.DateTime(timezone=True), nullable=True),
        sa.Column("last_seen_at", sa.DateTime(timezone=True), nullable=True),
        sa.CheckConstraint(f"role IN ({ROLES})", name="ck_users_role"),
        sa.PrimaryKeyConstraint("id", name="pk_users"),
        sa.UniqueConstraint("name_key", name="uq_users_name_key"),
        sqlite_autoincrement=True,
    )


def create_identities() -> None:
    op.create_table(
        "identities",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("user_id", sa.Integer(), nullable=False),
        sa.Column("issuer", sa.String(length=500), nullable=False),
        sa.Column("subject", sa.String(length=300), nullable=False),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.ForeignKeyConstraint(["user_id"], ["users.id"], name="fk_identities_user_id_users", ondelete="CASCADE"),
        sa.PrimaryKeyConstraint("id", name="pk_identities"),
        sa.UniqueConstraint("issuer", "subject", name="uq_identities_issuer_subject"),
    )
    op.create_index("ix_identities_user_id", "identities", ["user_id"], unique=False)


def create_web_sessions() -> None:
    op.create_table(
        "web_sessions",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("user_id", sa.Integer(), nullable=False),
        sa.Column("sha256", sa.String(length=64), nullable=False),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("expires_at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("last_used_at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("revoked_at", sa.DateTime(timezone=True), nullable=True),
        sa.Column("address", sa.String(length=100), nullable=True),
        sa.Column("agent", sa.String(length=300), nullable=True),
        sa.ForeignKeyConstraint(["user_id"], ["users.id"], name="fk_web_sessions_user_id_users", ondelete="CASCADE"),
        sa.PrimaryKeyConstraint("id", name="pk_web_sessions"),
        sa.UniqueConstraint("sha256", name="uq_web_sessions_sha256"),
        sqlite_autoincrement=True,
    )
    op.create_index("ix_web_sessions_user_id", "web_sessions", ["user_id"], unique=False)
    op.create_index("ix_web_sessions_expires_at", "web_sessions", ["expires_at"], unique=False)


def create_invitations() -> None:
    op.create_table(
        "invitations",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("sha256", sa.String(length=64), nullable=False),
        sa.Column("kind", sa.String(length=20), nullable=False),
        sa.Column("role", sa.String(length=20), nullable=True),
        sa.Column("name", sa.String(length=200), nullable=True),
        sa.Column("user_id", sa.Integer(), nullable=True),
        sa.Column("created_by", sa.String(length=200), nullable=True),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("expires_at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("used_at", sa.DateTime(timezone=True), nullable=True),
        sa.Column("revoked_at", sa.DateTime(timezone=True), nullable=True),
        sa.CheckConstraint("kind IN ('join', 'reset')", name="ck_invitations_kind"),
        sa.CheckConstraint(f"role IN ({ROLES})", name="ck_invitations_role"),
        sa.ForeignKeyConstraint(["user_id"], ["users.id"], name="fk_invitations_user_id_users", ondelete="CASCADE"),
        sa.PrimaryKeyConstraint("id", name="pk_invitations"),
        sa.UniqueConstraint("sha256", name="uq_invitations_sha256"),
        sqlite_autoincrement=True,
    )
    op.create_index("ix_invitations_user_id", "invitations", ["user_id"], unique=False)


def change_tokens() -> None:
    """Neither database changes a constraint without some copying, and there are few tokens."""
    keep_tokens("CASE role WHEN 'owner' THEN 'admin' ELSE role END")
    op.create_table(
        "tokens",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("user_id", sa.Integer(), nullable=True),
        sa.Column("name", sa.String(length=200), nullable=False),
        sa.Column("label", sa.String(length=200), nullable=True),
        *token_columns(),
        sa.CheckConstraint(f"role IN ({ROLES})", name="ck_tokens_role"),
        sa.ForeignKeyConstraint(["user_id"], ["users.id"], name="fk_tokens_user_id_users", ondelete="CASCADE"),
        sa.PrimaryKeyConstraint("id", name="pk_tokens"),
        sa.UniqueConstraint("sha256", name="uq_tokens_sha256"),
    )
    create_alive_index("uq_tokens_name_alive", ["name"], "revoked_at IS NULL AND user_id IS NULL")
    create_alive_index("uq_tokens_label_alive", ["user_id", "label"], "revoked_at IS NULL")
    bring_tokens_back()


def change_tokens_back() -> None:
    # a person's own tokens have no place there
    op.execute("DELETE FROM tokens WHERE user_id IS NOT NULL")
    keep_tokens("CASE role WHEN 'admin' THEN 'owner' ELSE role END")
    op.create_table(
        "tokens",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("name", sa.String(length=200), nullable=False),
        *token_columns(),
        sa.CheckConstraint(f"role IN ({ROLES_BEFORE})", name="ck_tokens_role"),
        sa.PrimaryKeyConstraint("id", name="pk_tokens"),
        sa.UniqueConstraint("sha256", name="uq_tokens_sha256"),
    )
    create_alive_index("uq_tokens_name_alive", ["name"], "revoked_at IS NULL")
    bring_tokens_back()


def keep_tokens(role: str) -> None:
    op.execute(
        "CREATE TEMPORARY TABLE kept_tokens AS"  # noqa: S608
        f" SELECT id AS place, {KEPT_COLUMNS.replace('role', f'{role} AS role')} FROM tokens"
    )
    op.drop_table("tokens")


def bring_tokens_back() -> None:
    op.execute(
        f"INSERT INTO tokens ({KEPT_COLUMNS}) SELECT {KEPT_COLUMNS} FROM kept_tokens ORDER BY place"  # noqa: S608
    )
    op.execute("DROP TABLE kept_tokens")


def token_columns() -> list[sa.Column[Any]]:
    return [
        sa.Column("role", sa.String(length=20), nullable=False),
        sa.Column("sha256", sa.String(length=64), nullable=False),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("expires_at", sa.DateTime(timezone=True), nullable=True),
        sa.Column("revoked_at", sa.DateTime(timezone=True), nullable=True),
        sa.Column("last_used_at", sa.DateTime(timezone=True), nullable=True),
    ]


def create_alive_index(name: str, columns: list[str], condition: str) -> None:
    alive = sa.text(condition)
    op.create_index(name, "tokens", columns, unique=True, sqlite_where=alive, postgresql_where=alive)
