"""Tokens, splits, methods, submissions and their scores; what a dataset's card says.

Revision ID: 0002
Revises: 0001
"""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0002"
down_revision = "0001"
branch_labels = None
depends_on = None


def upgrade() -> None:
    for column in ("description", "licence", "citation"):
        op.add_column("datasets", sa.Column(column, sa.Text(), nullable=True))

    op.create_table(
        "methods",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("slug", sa.String(length=120), nullable=False),
        sa.Column("name", sa.String(length=200), nullable=False),
        sa.Column("description", sa.Text(), nullable=True),
        sa.Column("code_url", sa.String(length=2000), nullable=True),
        sa.Column("paper_url", sa.String(length=2000), nullable=True),
        sa.Column("owner", sa.String(length=200), nullable=True),
        sa.Column("anonymous", sa.Boolean(), nullable=False),
        sa.Column("kind", sa.String(length=20), nullable=False),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.CheckConstraint("kind IN ('method', 'baseline', 'ceiling')", name="ck_methods_kind"),
        sa.PrimaryKeyConstraint("id", name="pk_methods"),
        sa.UniqueConstraint("slug", name="uq_methods_slug"),
        sqlite_autoincrement=True,
    )
    op.create_index("ix_methods_owner", "methods", ["owner"], unique=False)

    op.create_table(
        "tokens",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("name", sa.String(length=200), nullable=False),
        sa.Column("role", sa.String(length=20), nullable=False),
        sa.Column("sha256", sa.String(length=64), nullable=False),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("expires_at", sa.DateTime(timezone=True), nullable=True),
        sa.Column("revoked_at", sa.DateTime(timezone=True), nullable=True),
        sa.Column("last_used_at", sa.DateTime(timezone=True), nullable=True),
        sa.CheckConstraint(
            "role IN ('owner', 'maintainer', 'annotator', 'submitter', 'reader')", name="ck_tokens_role"
        ),
        sa.PrimaryKeyConstraint("id", name="pk_tokens"),
        sa.UniqueConstraint("sha256", name="uq_tokens_sha256"),
    )
    op.create_index(
        "uq_tokens_name_alive",
        "tokens",
        ["name"],
        unique=True,
        sqlite_where=sa.text("revoked_at IS NULL"),
        postgresql_where=sa.text("revoked_at IS NULL"),
    )

    op.create_table(
        "splits",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("dataset_id", sa.Integer(), nullable=True),
        sa.Column("slug", sa.String(length=120), nullable=False),
        sa.Column("name", sa.String(length=200), nullable=False),
        sa.Column("description", sa.Text(), nullable=True),
        sa.Column("min_length", sa.Float(), nullable=False),
        sa.Column("visibility", sa.String(length=20), nullable=False),
        sa.Column("closes_at", sa.DateTime(timezone=True), nullable=True),
        sa.Column("daily_limit", sa.Integer(), nullable=False),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("created_by", sa.String(length=200), nullable=True),
        sa.Column("deleted_at", sa.DateTime(timezone=True), nullable=True),
        sa.CheckConstraint("visibility IN ('open', 'hidden')", name="ck_splits_visibility"),
        sa.ForeignKeyConstraint(
            ["dataset_id"], ["datasets.id"], name="fk_splits_dataset_id_datasets", ondelete="SET NULL"
        ),
        sa.PrimaryKeyConstraint("id", name="pk_splits"),
        sa.UniqueConstraint("slug", name="uq_splits_slug"),
        sqlite_autoincrement=True,
    )
    op.create_index("ix_splits_dataset_id", "splits", ["dataset_id"], unique=False)

    op.create_table(
        "split_versions",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("split_id", sa.Integer(), nullable=False),
        sa.Column("number", sa.Integer(), nullable=False),
        sa.Column("truth_sha256", sa.String(length=64), nullable=False),
        sa.Column("truth_hash", sa.String(length=64), nullable=False),
        sa.Column("n_images", sa.Integer(), nullable=False),
        sa.Column("n_labels", sa.Integer(), nullable=False),
        sa.Column("n_ambiguous", sa.Integer(), nullable=False),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("created_by", sa.String(length=200), nullable=True),
        sa.ForeignKeyConstraint(
            ["split_id"], ["splits.id"], name="fk_split_versions_split_id_splits", ondelete="CASCADE"
        ),
        sa.ForeignKeyConstraint(["truth_sha256"], ["blobs.sha256"], name="fk_split_versions_truth_sha256_blobs"),
        sa.PrimaryKeyConstraint("id", name="pk_split_versions"),
        sa.UniqueConstraint("split_id", "number", name="uq_split_versions_split_id_number"),
        sqlite_autoincrement=True,
    )
    op.create_index("ix_split_versions_truth_sha256", "split_versions", ["truth_sha256"], unique=False)

    op.create_table(
        "split_images",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("version_id", sa.Integer(), nullable=False),
        sa.Column("ordinal", sa.Integer(), nullable=False),
        sa.Column("image_id", sa.Integer(), nullable=True),
        sa.Column(
            "name",
            sa.String(length=500).with_variant(sa.String(length=500, collation="C"), "postgresql"),
            nullable=False,
        ),
        sa.Column("image_sha256", sa.String(length=64), nullable=False),
        sa.Column("width", sa.Integer(), nullable=False),
        sa.Column("height", sa.Integer(), nullable=False),
        sa.Column("source", sa.String(length=300), nullable=True),
        sa.Column("sequence", sa.String(length=300), nullable=True),
        sa.Column("camera", sa.String(length=300), nullable=True),
        sa.Column("reference", sa.JSON(none_as_null=True), nullable=True),
        sa.Column("n_labels", sa.Integer(), nullable=False),
        sa.ForeignKeyConstraint(
            ["image_id"], ["images.id"], name="fk_split_images_image_id_images", ondelete="SET NULL"
        ),
        sa.ForeignKeyConstraint(["image_sha256"], ["blobs.sha256"], name="fk_split_images_image_sha256_blobs"),
        sa.ForeignKeyConstraint(
            ["version_id"], ["split_versions.id"], name="fk_split_images_version_id_split_versions", ondelete="CASCADE"
        ),
        sa.PrimaryKeyConstraint("id", name="pk_split_images"),
        sa.UniqueConstraint("version_id", "name", name="uq_split_images_version_id_name"),
        sqlite_autoincrement=True,
    )
    op.create_index("ix_split_images_image_id", "split_images", ["image_id"], unique=False)
    op.create_index("ix_split_images_image_sha256", "split_images", ["image_sha256"], unique=False)
    op.create_index("ix_split_images_version_ordinal", "split_images", ["version_id", "ordinal"], unique=False)

    op.create_table(
        "submissions",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("split_version_id", sa.Integer(), nullable=False),
        sa.Column("method_id", sa.Integer(), nullable=False),
        sa.Column("label", sa.String(length=200), nullable=True),
        sa.Column("person", sa.String(length=200), nullable=True),
        sa.Column("status", sa.String(length=20), nullable=False),
        sa.Column("visibility", sa.String(length=20), nullable=False),
        sa.Column("upload_sha256", sa.String(length=64), nullable=True),
        sa.Column("upload_name", sa.String(length=500), nullable=True),
        sa.Column("segments_sha256", sa.String(length=64), nullable=True),
        sa.Column("submission_hash", sa.String(length=64), nullable=True),
        sa.Column("n_images", sa.Integer(), nullable=False),
        sa.Column("n_segments", sa.Integer(), nullable=False),
        sa.Column("n_points", sa.Integer(), nullable=False),
        sa.Column("has_scores", sa.Boolean(), nullable=False),
        sa.Column("missing", sa.JSON(none_as_null=True), nullable=True),
        sa.Column("attempts", sa.Integer(), nullable=False),
        sa.Column("heartbeat_at", sa.DateTime(timezone=True), nullable=True),
        sa.Column("error", sa.JSON(none_as_null=True), nullable=True),
        sa.Column("log", sa.JSON(none_as_null=True), nullable=True),
        sa.Column("webhook_url", sa.String(length=2000), nullable=True),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("queued_at", sa.DateTime(timezone=True), nullable=True),
        sa.Column("scored_at", sa.DateTime(timezone=True), nullable=True),
        sa.Column("withdrawn_at", sa.DateTime(timezone=True), nullable=True),
        sa.CheckConstraint(
            "status IN ('received', 'validating', 'queued', 'scoring', 'scored', 'invalid', 'failed', 'withdrawn')",
            name="ck_submissions_status",
        ),
        sa.CheckConstraint("visibility IN ('public', 'private')", name="ck_submissions_visibility"),
        sa.ForeignKeyConstraint(
            ["method_id"], ["methods.id"], name="fk_submissions_method_id_methods", ondelete="CASCADE"
        ),
        sa.ForeignKeyConstraint(["segments_sha256"], ["blobs.sha256"], name="fk_submissions_segments_sha256_blobs"),
        sa.ForeignKeyConstraint(
            ["split_version_id"],
            ["split_versions.id"],
            name="fk_submissions_split_version_id_split_versions",
            ondelete="CASCADE",
        ),
        sa.ForeignKeyConstraint(["upload_sha256"], ["blobs.sha256"], name="fk_submissions_upload_sha256_blobs"),
        sa.PrimaryKeyConstraint("id", name="pk_submissions"),
        sqlite_autoincrement=True,
    )
    op.create_index("ix_submissions_method_id", "submissions", ["method_id"], unique=False)
    op.create_index("ix_submissions_person_created", "submissions", ["person", "created_at"], unique=False)
    op.create_index("ix_submissions_segments_sha256", "submissions", ["segments_sha256"], unique=False)
    op.create_index("ix_submissions_status", "submissions", ["status"], unique=False)
    op.create_index("ix_submissions_upload_sha256", "submissions", ["upload_sha256"], unique=False)
    op.create_index("ix_submissions_version_status", "submissions", ["split_version_id", "status"], unique=False)

    op.create_table(
        "scores",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("submission_id", sa.Integer(), nullable=False),
        sa.Column("split_version_id", sa.Integer(), nullable=False),
        sa.Column("protocol", sa.String(length=40), nullable=False),
        sa.Column("protocol_version", sa.String(length=20), nullable=False),
        sa.Column("scorer_version", sa.String(length=60), nullable=False),
        sa.Column("truth_hash", sa.String(length=64), nullable=False),
        sa.Column("submission_hash", sa.String(length=64), nullable=False),
        sa.Column("status", sa.String(length=20), nullable=False),
        sa.Column("f1", sa.Float(), nullable=True),
        sa.Column("f1_low", sa.Float(), nullable=True),
        sa.Column("f1_high", sa.Float(), nullable=True),
        sa.Column("totals", sa.JSON(none_as_null=True), nullable=True),
        sa.Column("milliseconds", sa.Float(), nullable=True),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("done_at", sa.DateTime(timezone=True), nullable=True),
        sa.CheckConstraint("status IN ('queued', 'running', 'done', 'failed')", name="ck_scores_status"),
        sa.ForeignKeyConstraint(
            ["split_version_id"],
            ["split_versions.id"],
            name="fk_scores_split_version_id_split_versions",
            ondelete="CASCADE",
        ),
        sa.ForeignKeyConstraint(
            ["submission_id"], ["submissions.id"], name="fk_scores_submission_id_submissions", ondelete="CASCADE"
        ),
        sa.PrimaryKeyConstraint("id", name="pk_scores"),
        sa.UniqueConstraint(
            "submission_id",
            "split_version_id",
            "protocol",
            "protocol_version",
            name="uq_scores_submission_version_protocol",
        ),
        sqlite_autoincrement=True,
    )
    op.create_index("ix_scores_status", "scores", ["status"], unique=False)
    op.create_index("ix_scores_version_protocol", "scores", ["split_version_id", "protocol"], unique=False)

    op.create_table(
        "image_scores",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("score_id", sa.Integer(), nullable=False),
        sa.Column("split_image_id", sa.Integer(), nullable=False),
        sa.Column("f1", sa.Float(), nullable=True),
        sa.Column("precision", sa.Float(), nullable=True),
        sa.Column("recall", sa.Float(), nullable=True),
        sa.Column("tp", sa.Integer(), nullable=False),
        sa.Column("fp", sa.Integer(), nullable=False),
        sa.Column("fn", sa.Integer(), nullable=False),
        sa.Column("metrics", sa.JSON(none_as_null=True), nullable=True),
        sa.Column("record", sa.LargeBinary(), nullable=True),
        sa.ForeignKeyConstraint(
            ["score_id"], ["scores.id"], name="fk_image_scores_score_id_scores", ondelete="CASCADE"
        ),
        sa.ForeignKeyConstraint(
            ["split_image_id"],
            ["split_images.id"],
            name="fk_image_scores_split_image_id_split_images",
            ondelete="CASCADE",
        ),
        sa.PrimaryKeyConstraint("id", name="pk_image_scores"),
        sa.UniqueConstraint("score_id", "split_image_id", name="uq_image_scores_score_id_split_image_id"),
    )
    op.create_index("ix_image_scores_split_image_id", "image_scores", ["split_image_id"], unique=False)


def downgrade() -> None:
    for table in (
        "image_scores",
        "scores",
        "submissions",
        "split_images",
        "split_versions",
        "splits",
        "tokens",
        "methods",
    ):
        op.drop_table(table)
    for column in ("citation", "licence", "description"):
        op.drop_column("datasets", column)
