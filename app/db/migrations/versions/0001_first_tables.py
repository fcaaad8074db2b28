"""The first tables.

Revision ID: 0001
Revises:
"""

from __future__ import annotations

from uuid import uuid4

import sqlalchemy as sa
from alembic import op

revision = "0001"
down_revision = None
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "blobs",
        sa.Column("sha256", sa.String(length=64), nullable=False),
        sa.Column("size", sa.Integer(), nullable=False),
        sa.Column("media_type", sa.String(length=100), nullable=False),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.PrimaryKeyConstraint("sha256", name="pk_blobs"),
    )
    op.create_table(
        "datasets",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("slug", sa.String(length=120), nullable=False),
        sa.Column("name", sa.String(length=200), nullable=False),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("deleted_at", sa.DateTime(timezone=True), nullable=True),
        sa.PrimaryKeyConstraint("id", name="pk_datasets"),
        sa.UniqueConstraint("slug", name="uq_datasets_slug"),
        sqlite_autoincrement=True,
    )
    op.create_index(
        "uq_datasets_name_alive",
        "datasets",
        ["name"],
        unique=True,
        sqlite_where=sa.text("deleted_at IS NULL"),
        postgresql_where=sa.text("deleted_at IS NULL"),
    )

    installations = op.create_table(
        "installations",
        sa.Column("instance", sa.String(length=36), nullable=False),
        sa.PrimaryKeyConstraint("instance", name="pk_installations"),
    )
    op.bulk_insert(installations, [{"instance": str(uuid4())}])
    op.create_table(
        "cameras",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("dataset_id", sa.Integer(), nullable=False),
        sa.Column("name", sa.String(length=300), nullable=False),
        sa.Column("width", sa.Integer(), nullable=False),
        sa.Column("height", sa.Integer(), nullable=False),
        sa.Column("reference", sa.JSON(none_as_null=True), nullable=True),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.ForeignKeyConstraint(
            ["dataset_id"], ["datasets.id"], name="fk_cameras_dataset_id_datasets", ondelete="CASCADE"
        ),
        sa.PrimaryKeyConstraint("id", name="pk_cameras"),
        sa.UniqueConstraint("dataset_id", "name", name="uq_cameras_dataset_id_name"),
        sqlite_autoincrement=True,
    )
    op.create_table(
        "events",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("dataset_id", sa.Integer(), nullable=True),
        sa.Column("kind", sa.String(length=60), nullable=False),
        sa.Column("person", sa.String(length=200), nullable=True),
        sa.Column("details", sa.JSON(none_as_null=True), nullable=False),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.ForeignKeyConstraint(
            ["dataset_id"], ["datasets.id"], name="fk_events_dataset_id_datasets", ondelete="SET NULL"
        ),
        sa.PrimaryKeyConstraint("id", name="pk_events"),
    )
    op.create_index("ix_events_dataset_id", "events", ["dataset_id"], unique=False)

    op.create_table(
        "runs",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("dataset_id", sa.Integer(), nullable=False),
        sa.Column("parameters", sa.JSON(none_as_null=True), nullable=False),
        sa.Column("code_version", sa.String(length=60), nullable=False),
        sa.Column("status", sa.String(length=20), nullable=False),
        sa.Column("error", sa.JSON(none_as_null=True), nullable=True),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("started_at", sa.DateTime(timezone=True), nullable=True),
        sa.Column("finished_at", sa.DateTime(timezone=True), nullable=True),
        sa.Column("deleted_at", sa.DateTime(timezone=True), nullable=True),
        sa.CheckConstraint("status IN ('queued', 'running', 'done', 'failed', 'cancelled')", name="ck_runs_status"),
        sa.ForeignKeyConstraint(
            ["dataset_id"], ["datasets.id"], name="fk_runs_dataset_id_datasets", ondelete="CASCADE"
        ),
        sa.PrimaryKeyConstraint("id", name="pk_runs"),
        sqlite_autoincrement=True,
    )
    op.create_index("ix_runs_dataset_id", "runs", ["dataset_id"], unique=False)
    op.create_index("ix_runs_status", "runs", ["status"], unique=False)

    op.create_table(
        "camera_estimates",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("run_id", sa.Integer(), nullable=False),
        sa.Column("camera_id", sa.Integer(), nullable=False),
        sa.Column("distortion", sa.JSON(none_as_null=True), nullable=False),
        sa.Column("accepted", sa.Boolean(), nullable=False),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.ForeignKeyConstraint(
            ["camera_id"], ["cameras.id"], name="fk_camera_estimates_camera_id_cameras", ondelete="CASCADE"
        ),
        sa.ForeignKeyConstraint(["run_id"], ["runs.id"], name="fk_camera_estimates_run_id_runs", ondelete="CASCADE"),
        sa.PrimaryKeyConstraint("id", name="pk_camera_estimates"),
        sa.UniqueConstraint("run_id", "camera_id", name="uq_camera_estimates_run_id_camera_id"),
    )
    op.create_index("ix_camera_estimates_camera_id", "camera_estimates", ["camera_id"], unique=False)

    op.create_table(
        "images",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("dataset_id", sa.Integer(), nullable=False),
        sa.Column(
            "name",
            sa.String(length=500).with_variant(sa.String(length=500, collation="C"), "postgresql"),
            nullable=False,
        ),
        sa.Column("file_name", sa.String(length=500), nullable=False),
        sa.Column("sha256", sa.String(length=64), nullable=False),
        sa.Column("width", sa.Integer(), nullable=False),
        sa.Column("height", sa.Integer(), nullable=False),
        sa.Column("bits", sa.Integer(), nullable=False),
        sa.Column("camera_id", sa.Integer(), nullable=False),
        sa.Column("source", sa.String(length=300), nullable=True),
        sa.Column("sequence", sa.String(length=300), nullable=True),
        sa.Column("revision", sa.Integer(), nullable=False),
        sa.Column("n_candidates", sa.Integer(), nullable=False),
        sa.Column("n_keep", sa.Integer(), nullable=False),
        sa.Column("n_reject", sa.Integer(), nullable=False),
        sa.Column("n_ambiguous", sa.Integer(), nullable=False),
        sa.Column("current_run_image_id", sa.Integer(), nullable=True),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("deleted_at", sa.DateTime(timezone=True), nullable=True),
        sa.ForeignKeyConstraint(["camera_id"], ["cameras.id"], name="fk_images_camera_id_cameras"),
        sa.ForeignKeyConstraint(
            ["current_run_image_id"],
            ["run_images.id"],
            name="fk_images_current_run_image_id_run_images",
            ondelete="SET NULL",
            use_alter=True,
        ),
        sa.ForeignKeyConstraint(
            ["dataset_id"], ["datasets.id"], name="fk_images_dataset_id_datasets", ondelete="CASCADE"
        ),
        sa.ForeignKeyConstraint(["sha256"], ["blobs.sha256"], name="fk_images_sha256_blobs"),
        sa.PrimaryKeyConstraint("id", name="pk_images"),
        sqlite_autoincrement=True,
    )
    op.create_index("ix_images_camera_id", "images", ["camera_id"], unique=False)
    op.create_index("ix_images_current_run_image_id", "images", ["current_run_image_id"], unique=False)
    op.create_index("ix_images_dataset_camera", "images", ["dataset_id", "camera_id"], unique=False)
    op.create_index("ix_images_sha256", "images", ["sha256"], unique=False)
    op.create_index(
        "uq_images_dataset_content_alive",
        "images",
        ["dataset_id", "sha256"],
        unique=True,
        sqlite_where=sa.text("deleted_at IS NULL"),
        postgresql_where=sa.text("deleted_at IS NULL"),
    )
    op.create_index(
        "uq_images_dataset_name_alive",
        "images",
        ["dataset_id", "name"],
        unique=True,
        sqlite_where=sa.text("deleted_at IS NULL"),
        postgresql_where=sa.text("deleted_at IS NULL"),
    )

    op.create_table(
        "reviews",
        sa.Column("image_id", sa.Integer(), nullable=False),
        sa.Column("status", sa.String(length=20), nullable=False),
        sa.Column("reason", sa.Text(), nullable=True),
        sa.Column("person", sa.String(length=200), nullable=True),
        sa.Column("updated_at", sa.DateTime(timezone=True), nullable=False),
        sa.CheckConstraint("status IN ('open', 'done', 'discarded')", name="ck_reviews_status"),
        sa.ForeignKeyConstraint(["image_id"], ["images.id"], name="fk_reviews_image_id_images", ondelete="CASCADE"),
        sa.PrimaryKeyConstraint("image_id", name="pk_reviews"),
    )
    op.create_index("ix_reviews_status", "reviews", ["status"], unique=False)

    op.create_table(
        "run_images",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("run_id", sa.Integer(), nullable=False),
        sa.Column("image_id", sa.Integer(), nullable=False),
        sa.Column("status", sa.String(length=20), nullable=False),
        sa.Column("attempts", sa.Integer(), nullable=False),
        sa.Column("heartbeat_at", sa.DateTime(timezone=True), nullable=True),
        sa.Column("error", sa.JSON(none_as_null=True), nullable=True),
        sa.Column("milliseconds", sa.Float(), nullable=True),
        sa.Column("changes", sa.JSON(none_as_null=True), nullable=True),
        sa.Column("distortion", sa.JSON(none_as_null=True), nullable=True),
        sa.Column("camera_estimate_id", sa.Integer(), nullable=True),
        sa.Column("lens_segments", sa.LargeBinary(), nullable=True),
        sa.CheckConstraint(
            "status IN ('queued', 'running', 'done', 'failed', 'cancelled')", name="ck_run_images_status"
        ),
        sa.ForeignKeyConstraint(
            ["camera_estimate_id"],
            ["camera_estimates.id"],
            name="fk_run_images_camera_estimate_id_camera_estimates",
            ondelete="SET NULL",
        ),
        sa.ForeignKeyConstraint(["image_id"], ["images.id"], name="fk_run_images_image_id_images", ondelete="CASCADE"),
        sa.ForeignKeyConstraint(["run_id"], ["runs.id"], name="fk_run_images_run_id_runs", ondelete="CASCADE"),
        sa.PrimaryKeyConstraint("id", name="pk_run_images"),
        sa.UniqueConstraint("run_id", "image_id", name="uq_run_images_run_id_image_id"),
        sqlite_autoincrement=True,
    )
    op.create_index("ix_run_images_camera_estimate_id", "run_images", ["camera_estimate_id"], unique=False)
    op.create_index("ix_run_images_image_id", "run_images", ["image_id"], unique=False)
    op.create_index("ix_run_images_status_run", "run_images", ["status", "run_id"], unique=False)

    op.create_table(
        "segments",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("image_id", sa.Integer(), nullable=False),
        sa.Column("run_image_id", sa.Integer(), nullable=True),
        sa.Column("ordinal", sa.Integer(), nullable=False),
        sa.Column("n_points", sa.Integer(), nullable=False),
        sa.Column("points", sa.LargeBinary(), nullable=False),
        sa.Column("x0", sa.Float(), nullable=False),
        sa.Column("y0", sa.Float(), nullable=False),
        sa.Column("x1", sa.Float(), nullable=False),
        sa.Column("y1", sa.Float(), nullable=False),
        sa.Column("length", sa.Float(), nullable=False),
        sa.Column("residual", sa.Float(), nullable=True),
        sa.Column("score", sa.Float(), nullable=True),
        sa.Column("straightness", sa.Float(), nullable=True),
        sa.Column("origin", sa.String(length=20), nullable=False),
        sa.Column("retired_at", sa.DateTime(timezone=True), nullable=True),
        sa.Column("replaced_by_id", sa.Integer(), nullable=True),
        sa.CheckConstraint("origin IN ('pipeline', 'manual', 'import')", name="ck_segments_origin"),
        sa.ForeignKeyConstraint(["image_id"], ["images.id"], name="fk_segments_image_id_images", ondelete="CASCADE"),
        sa.ForeignKeyConstraint(
            ["replaced_by_id"], ["segments.id"], name="fk_segments_replaced_by_id_segments", ondelete="SET NULL"
        ),
        sa.ForeignKeyConstraint(
            ["run_image_id"], ["run_images.id"], name="fk_segments_run_image_id_run_images", ondelete="SET NULL"
        ),
        sa.PrimaryKeyConstraint("id", name="pk_segments"),
        sqlite_autoincrement=True,
    )
    op.create_index("ix_segments_image_retired", "segments", ["image_id", "retired_at"], unique=False)
    op.create_index("ix_segments_replaced_by_id", "segments", ["replaced_by_id"], unique=False)
    op.create_index("ix_segments_run_image_id", "segments", ["run_image_id"], unique=False)

    op.create_table(
        "decisions",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("image_id", sa.Integer(), nullable=False),
        sa.Column("segment_id", sa.Integer(), nullable=False),
        sa.Column("person", sa.String(length=200), nullable=True),
        sa.Column("verdict", sa.String(length=20), nullable=False),
        sa.Column("previous", sa.String(length=20), nullable=False),
        sa.Column("kind", sa.String(length=20), nullable=False),
        sa.Column("client_id", sa.String(length=36), nullable=False),
        sa.Column("group_id", sa.String(length=36), nullable=False),
        sa.Column("target_group_id", sa.String(length=36), nullable=True),
        sa.Column("elapsed_ms", sa.Integer(), nullable=True),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.CheckConstraint("kind IN ('judge', 'undo', 'redo', 'carry', 'import')", name="ck_decisions_kind"),
        sa.CheckConstraint("verdict IN ('keep', 'reject', 'ambiguous', 'undecided')", name="ck_decisions_verdict"),
        sa.ForeignKeyConstraint(["image_id"], ["images.id"], name="fk_decisions_image_id_images", ondelete="CASCADE"),
        sa.ForeignKeyConstraint(
            ["segment_id"], ["segments.id"], name="fk_decisions_segment_id_segments", ondelete="CASCADE"
        ),
        sa.PrimaryKeyConstraint("id", name="pk_decisions"),
        sa.UniqueConstraint("client_id", name="uq_decisions_client_id"),
        sqlite_autoincrement=True,
    )
    op.create_index("ix_decisions_image_id_id", "decisions", ["image_id", "id"], unique=False)
    op.create_index("ix_decisions_segment_id", "decisions", ["segment_id"], unique=False)

    op.create_table(
        "segment_states",
        sa.Column("segment_id", sa.Integer(), nullable=False),
        sa.Column("verdict", sa.String(length=20), nullable=False),
        sa.Column("decision_id", sa.Integer(), nullable=False),
        sa.CheckConstraint("verdict IN ('keep', 'reject', 'ambiguous', 'undecided')", name="ck_segment_states_verdict"),
        sa.ForeignKeyConstraint(
            ["decision_id"], ["decisions.id"], name="fk_segment_states_decision_id_decisions", ondelete="CASCADE"
        ),
        sa.ForeignKeyConstraint(
            ["segment_id"], ["segments.id"], name="fk_segment_states_segment_id_segments", ondelete="CASCADE"
        ),
        sa.PrimaryKeyConstraint("segment_id", name="pk_segment_states"),
    )
    op.create_index("ix_segment_states_decision_id", "segment_states", ["decision_id"], unique=False)
    if op.get_bind().dialect.name == "postgresql":  # images and run_images name each other; SQLite takes it inline
        op.create_foreign_key(
            "fk_images_current_run_image_id_run_images",
            "images",
            "run_images",
            ["current_run_image_id"],
            ["id"],
            ondelete="SET NULL",
        )


def downgrade() -> None:
    if op.get_bind().dialect.name == "postgresql":
        op.drop_constraint("fk_images_current_run_image_id_run_images", "images")
    for table in (
        "segment_states",
        "decisions",
        "segments",
        "run_images",
        "reviews",
        "images",
        "camera_estimates",
        "runs",
        "events",
        "cameras",
        "installations",
        "datasets",
        "blobs",
    ):
        op.drop_table(table)
