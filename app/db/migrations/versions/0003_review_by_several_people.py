"""Several people: leases, second reviews, edits by hand, suggestions; reasons for rejections.

Revision ID: 0003
Revises: 0002
"""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0003"
down_revision = "0002"
branch_labels = None
depends_on = None

KINDS = "'judge', 'undo', 'redo', 'carry', 'import'"
VERDICTS = "'keep', 'reject', 'ambiguous', 'undecided'"
COLUMNS = (
    "id, image_id, segment_id, person, verdict, previous, kind, client_id, group_id, target_group_id, "
    "elapsed_ms, created_at"
)


def upgrade() -> None:
    set_decisions(f"{KINDS}, 'accept', 'take_over'", more=True)
    op.create_table(
        "suggestion_models",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("dataset_id", sa.Integer(), nullable=False),
        sa.Column("version", sa.String(length=60), nullable=False),
        sa.Column("n_decisions", sa.Integer(), nullable=False),
        sa.Column("n_images", sa.Integer(), nullable=False),
        sa.Column("last_decision_id", sa.Integer(), nullable=False),
        sa.Column("parameters", sa.JSON(none_as_null=True), nullable=False),
        sa.Column("report", sa.JSON(none_as_null=True), nullable=False),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.ForeignKeyConstraint(
            ["dataset_id"], ["datasets.id"], name="fk_suggestion_models_dataset_id_datasets", ondelete="CASCADE"
        ),
        sa.PrimaryKeyConstraint("id", name="pk_suggestion_models"),
        sqlite_autoincrement=True,
    )
    op.create_index("ix_suggestion_models_dataset_id", "suggestion_models", ["dataset_id"], unique=False)
    op.create_table(
        "suggestion_trainings",
        sa.Column("dataset_id", sa.Integer(), nullable=False),
        sa.Column("asked_at", sa.DateTime(timezone=True), nullable=True),
        sa.Column("error", sa.JSON(none_as_null=True), nullable=True),
        sa.Column("failed_decision_id", sa.Integer(), nullable=True),
        sa.ForeignKeyConstraint(
            ["dataset_id"], ["datasets.id"], name="fk_suggestion_trainings_dataset_id_datasets", ondelete="CASCADE"
        ),
        sa.PrimaryKeyConstraint("dataset_id", name="pk_suggestion_trainings"),
    )
    op.create_table(
        "edits",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("image_id", sa.Integer(), nullable=False),
        sa.Column("person", sa.String(length=200), nullable=True),
        sa.Column("kind", sa.String(length=20), nullable=False),
        sa.Column("client_id", sa.String(length=36), nullable=False),
        sa.Column("replaced", sa.JSON(none_as_null=True), nullable=False),
        sa.Column("added", sa.JSON(none_as_null=True), nullable=False),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("undone_at", sa.DateTime(timezone=True), nullable=True),
        sa.CheckConstraint("kind IN ('trace', 'cut', 'join', 'extend', 'trim')", name="ck_edits_kind"),
        sa.ForeignKeyConstraint(["image_id"], ["images.id"], name="fk_edits_image_id_images", ondelete="CASCADE"),
        sa.PrimaryKeyConstraint("id", name="pk_edits"),
        sa.UniqueConstraint("client_id", name="uq_edits_client_id"),
        sqlite_autoincrement=True,
    )
    op.create_index("ix_edits_image_id", "edits", ["image_id"], unique=False)
    op.create_table(
        "image_features",
        sa.Column("image_id", sa.Integer(), nullable=False),
        sa.Column("revision", sa.Integer(), nullable=False),
        sa.Column("version", sa.String(length=60), nullable=False),
        sa.Column("content", sa.LargeBinary(), nullable=False),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.ForeignKeyConstraint(
            ["image_id"], ["images.id"], name="fk_image_features_image_id_images", ondelete="CASCADE"
        ),
        sa.PrimaryKeyConstraint("image_id", name="pk_image_features"),
    )
    op.create_table(
        "leases",
        sa.Column("image_id", sa.Integer(), nullable=False),
        sa.Column("client_id", sa.String(length=36), nullable=False),
        sa.Column("person", sa.String(length=200), nullable=True),
        sa.Column("holds", sa.Boolean(), nullable=False),
        sa.Column("since", sa.DateTime(timezone=True), nullable=False),
        sa.Column("expires_at", sa.DateTime(timezone=True), nullable=False),
        sa.ForeignKeyConstraint(["image_id"], ["images.id"], name="fk_leases_image_id_images", ondelete="CASCADE"),
        sa.PrimaryKeyConstraint("image_id", "client_id", name="pk_leases"),
    )
    op.create_index("ix_leases_expires_at", "leases", ["expires_at"], unique=False)
    op.create_table(
        "second_reviews",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("image_id", sa.Integer(), nullable=False),
        sa.Column("person", sa.String(length=200), nullable=True),
        sa.Column("status", sa.String(length=20), nullable=False),
        sa.Column("first_decision_id", sa.Integer(), nullable=True),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("done_at", sa.DateTime(timezone=True), nullable=True),
        sa.CheckConstraint("status IN ('open', 'done')", name="ck_second_reviews_status"),
        sa.ForeignKeyConstraint(
            ["image_id"], ["images.id"], name="fk_second_reviews_image_id_images", ondelete="CASCADE"
        ),
        sa.PrimaryKeyConstraint("id", name="pk_second_reviews"),
        sa.UniqueConstraint("image_id", name="uq_second_reviews_image_id"),
        sqlite_autoincrement=True,
    )
    op.create_index("ix_second_reviews_status", "second_reviews", ["status"], unique=False)
    op.create_table(
        "adjudications",
        sa.Column("second_review_id", sa.Integer(), nullable=False),
        sa.Column("segment_id", sa.Integer(), nullable=False),
        sa.Column("first", sa.String(length=20), nullable=False),
        sa.Column("second", sa.String(length=20), nullable=False),
        sa.Column("verdict", sa.String(length=20), nullable=False),
        sa.Column("decision_id", sa.Integer(), nullable=False),
        sa.Column("person", sa.String(length=200), nullable=True),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.CheckConstraint("verdict IN ('keep', 'reject', 'ambiguous', 'undecided')", name="ck_adjudications_verdict"),
        sa.ForeignKeyConstraint(
            ["decision_id"], ["decisions.id"], name="fk_adjudications_decision_id_decisions", ondelete="CASCADE"
        ),
        sa.ForeignKeyConstraint(
            ["second_review_id"],
            ["second_reviews.id"],
            name="fk_adjudications_second_review_id_second_reviews",
            ondelete="CASCADE",
        ),
        sa.ForeignKeyConstraint(
            ["segment_id"], ["segments.id"], name="fk_adjudications_segment_id_segments", ondelete="CASCADE"
        ),
        sa.PrimaryKeyConstraint("second_review_id", "segment_id", name="pk_adjudications"),
    )
    op.create_index("ix_adjudications_decision_id", "adjudications", ["decision_id"], unique=False)
    op.create_index("ix_adjudications_segment_id", "adjudications", ["segment_id"], unique=False)
    op.create_table(
        "second_decisions",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("second_review_id", sa.Integer(), nullable=False),
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
        sa.CheckConstraint("kind IN ('judge', 'undo', 'redo', 'accept')", name="ck_second_decisions_kind"),
        sa.CheckConstraint(
            "verdict IN ('keep', 'reject', 'ambiguous', 'undecided')", name="ck_second_decisions_verdict"
        ),
        sa.ForeignKeyConstraint(
            ["second_review_id"],
            ["second_reviews.id"],
            name="fk_second_decisions_second_review_id_second_reviews",
            ondelete="CASCADE",
        ),
        sa.ForeignKeyConstraint(
            ["segment_id"], ["segments.id"], name="fk_second_decisions_segment_id_segments", ondelete="CASCADE"
        ),
        sa.PrimaryKeyConstraint("id", name="pk_second_decisions"),
        sa.UniqueConstraint("client_id", name="uq_second_decisions_client_id"),
        sqlite_autoincrement=True,
    )
    op.create_index(
        "ix_second_decisions_second_review_id_id", "second_decisions", ["second_review_id", "id"], unique=False
    )
    op.create_index("ix_second_decisions_segment_id", "second_decisions", ["segment_id"], unique=False)
    op.add_column("datasets", sa.Column("guidelines", sa.Text(), nullable=True))
    op.add_column("datasets", sa.Column("rules", sa.JSON(none_as_null=True), nullable=True))
    op.add_column("images", sa.Column("assignee", sa.String(length=200), nullable=True))
    op.create_index("ix_images_dataset_id_assignee", "images", ["dataset_id", "assignee"], unique=False)
    op.add_column("reviews", sa.Column("recall", sa.String(length=20), nullable=True))
    op.add_column("segment_states", sa.Column("reason", sa.String(length=40), nullable=True))
    op.add_column("split_images", sa.Column("rejected", sa.LargeBinary(), nullable=True))
    op.create_index("ix_segments_image_score", "segments", ["image_id", "score"], unique=False)
    given = sa.text("reason IS NOT NULL")
    op.create_index(
        "ix_segment_states_reason_given", "segment_states", ["reason"], sqlite_where=given, postgresql_where=given
    )


def downgrade() -> None:
    # a kind that the older version doesn't know is a judgement to it
    op.execute("UPDATE decisions SET kind = 'judge' WHERE kind IN ('accept', 'take_over')")
    set_decisions(KINDS, more=False)
    op.drop_index("ix_segment_states_reason_given", "segment_states")
    op.drop_index("ix_segments_image_score", "segments")
    op.drop_index("ix_images_dataset_id_assignee", "images")
    for table, column in (
        ("split_images", "rejected"),
        ("segment_states", "reason"),
        ("reviews", "recall"),
        ("images", "assignee"),
        ("datasets", "rules"),
        ("datasets", "guidelines"),
    ):
        op.drop_column(table, column)
    for table in (
        "second_decisions",
        "adjudications",
        "second_reviews",
        "leases",
        "image_features",
        "edits",
        "suggestion_trainings",
        "suggestion_models",
    ):
        op.drop_table(table)


def set_decisions(kinds: str, *, more: bool) -> None:
    """Let decisions be of these kinds, with the columns reason and suggestion or without."""
    if op.get_bind().dialect.name == "sqlite":
        copy_decisions(kinds, more=more)
        return
    if more:
        for column in new_columns():
            op.add_column("decisions", column)
    else:
        op.drop_column("decisions", "suggestion")
        op.drop_column("decisions", "reason")
    op.drop_constraint("ck_decisions_kind", "decisions", type_="check")
    op.create_check_constraint("ck_decisions_kind", "decisions", f"kind IN ({kinds})")


def new_columns() -> list[sa.Column[str] | sa.Column[float]]:
    return [
        sa.Column("reason", sa.String(length=40), nullable=True),
        sa.Column("suggestion", sa.Float(), nullable=True),
    ]


def copy_decisions(kinds: str, *, more: bool) -> None:
    """SQLite changes no constraint in place."""
    op.execute("CREATE TEMPORARY TABLE last_ids AS SELECT seq FROM sqlite_sequence WHERE name = 'decisions'")
    op.create_table(
        "new_decisions",
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
        *(new_columns() if more else []),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.CheckConstraint(f"kind IN ({kinds})", name="ck_decisions_kind"),
        sa.CheckConstraint(f"verdict IN ({VERDICTS})", name="ck_decisions_verdict"),
        sa.ForeignKeyConstraint(["image_id"], ["images.id"], name="fk_decisions_image_id_images", ondelete="CASCADE"),
        sa.ForeignKeyConstraint(
            ["segment_id"], ["segments.id"], name="fk_decisions_segment_id_segments", ondelete="CASCADE"
        ),
        sa.PrimaryKeyConstraint("id", name="pk_decisions"),
        sa.UniqueConstraint("client_id", name="uq_decisions_client_id"),
        sqlite_autoincrement=True,
    )
    op.execute(f"INSERT INTO new_decisions ({COLUMNS}) SELECT {COLUMNS} FROM decisions ORDER BY id")  # noqa: S608
    op.drop_table("decisions")
    op.rename_table("new_decisions", "decisions")
    op.create_index("ix_decisions_image_id_id", "decisions", ["image_id", "id"], unique=False)
    op.create_index("ix_decisions_segment_id", "decisions", ["segment_id"], unique=False)
    # an id that was given away stays given away, although its row may be gone
    op.execute("DELETE FROM sqlite_sequence WHERE name = 'decisions'")
    op.execute("INSERT INTO sqlite_sequence (name, seq) SELECT 'decisions', seq FROM last_ids")
    op.drop_table("last_ids")
