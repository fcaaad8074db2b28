"""Counts kept beside what they count, and indexes for every order and filter of the lists.

Revision ID: 0006
Revises: 0005
"""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

from app.db.migrations import counters_0006 as counters

revision = "0006"
down_revision = "0005"
branch_labels = None
depends_on = None

ALIVE = "deleted_at IS NULL"
CURRENT = """
segments.image_id = images.id AND segments.retired_at IS NULL AND (
  NOT EXISTS (
    SELECT 1 FROM run_images JOIN runs ON runs.id = run_images.run_id
    WHERE run_images.id = segments.run_image_id AND runs.deleted_at IS NOT NULL
  ) OR EXISTS (
    SELECT 1 FROM segment_states
    WHERE segment_states.segment_id = segments.id AND segment_states.verdict <> 'undecided'
  )
)
"""
"""Candidates of a deleted run are out of sight unless somebody has decided on them."""
COUNTED = ("runs", "images", "reviews", "run_images", "decisions")
FILTERS = ("review_status", "prelabel", "source", "sequence", "camera_id", "assignee")
ORDERS = ("created_at", "n_candidates")
SCORES = ("lowest_score", "highest_score")


def upgrade() -> None:
    if op.get_context().dialect.name == "postgresql":
        # what another server changes between the counting and the triggers would be in no count
        op.execute(f"LOCK TABLE {', '.join(COUNTED)} IN SHARE ROW EXCLUSIVE MODE")
    add_copies()
    make_tallies()
    note_people()
    for index, table, columns, where in new_indexes():
        create_index(index, table, columns, where)
    for index, table, _ in old_indexes():
        op.drop_index(index, table)
    on_sqlite = op.get_context().dialect.name == "sqlite"
    for statement in counters.sqlite_triggers() if on_sqlite else counters.postgresql_triggers():
        op.execute(statement)


def downgrade() -> None:
    if op.get_context().dialect.name == "sqlite":
        for trigger in counters.SQLITE_TRIGGERS:
            op.execute(f"DROP TRIGGER {trigger}")
    else:
        for statement in counters.postgresql_removal():
            op.execute(statement)
    for index, table, columns in old_indexes():
        op.create_index(index, table, columns, unique=False)
    for index, table, *_ in new_indexes():
        op.drop_index(index, table)
    op.drop_table("image_people")
    op.drop_table("run_tallies")
    op.drop_table("image_tallies")
    for column in (*SCORES, "prelabel", "review_status"):
        op.drop_column("images", column)


def add_copies() -> None:
    """What lists choose images by, in the images' own rows."""
    for column, first in (("review_status", "open"), ("prelabel", "none")):
        # on neither database a column with a default is written into each row that is there
        op.add_column("images", sa.Column(column, sa.String(length=20), nullable=False, server_default=first))
    for column in SCORES:
        op.add_column("images", sa.Column(column, sa.Float(), nullable=True))
    state = counters.newest_state("images.id")
    op.execute(
        "UPDATE images SET prelabel = " + state + ","  # noqa: S608
        " review_status = coalesce((SELECT status FROM reviews WHERE reviews.image_id = images.id), 'open'),"
        f" lowest_score = (SELECT min(score) FROM segments WHERE {CURRENT}),"
        f" highest_score = (SELECT max(score) FROM segments WHERE {CURRENT})"
    )


def make_tallies() -> None:
    integers = {"image_tallies": counters.IMAGE_SUMS, "run_tallies": counters.RUN_SUMS}
    keys = {
        "image_tallies": (
            sa.Column("dataset_id", sa.Integer(), nullable=False),
            sa.Column("camera_id", sa.Integer(), nullable=False),
            sa.Column("source", sa.String(length=300), nullable=True),
            sa.Column("sequence", sa.String(length=300), nullable=True),
            sa.Column("assignee", sa.String(length=200), nullable=True),
            sa.Column("review_status", sa.String(length=20), nullable=False),
            sa.Column("prelabel", sa.String(length=20), nullable=False),
            sa.Column("deleted", sa.Boolean(), nullable=False),
        ),
        "run_tallies": (
            sa.Column("run_id", sa.Integer(), nullable=False),
            sa.Column("status", sa.String(length=20), nullable=False),
        ),
    }
    for table, columns in keys.items():
        op.create_table(
            table,
            sa.Column("id", sa.Integer(), nullable=False),
            *columns,
            *(sa.Column(name, sa.Integer(), nullable=False) for name in integers[table]),
            sa.Column("merged", sa.Boolean(), nullable=False),
            sa.PrimaryKeyConstraint("id", name=f"pk_{table}"),
        )
        key = columns[0].name
        create_index(f"ix_{table}_{key}", table, [key], None)
        create_index(f"ix_{table}_loose", table, [key], "NOT merged")
    op.execute(counters.counted_images())
    op.execute(counters.counted_runs(op.get_context().dialect.name))


def note_people() -> None:
    """Who decided on candidates of which image: one row for each, where decisions are many."""
    op.create_table(
        "image_people",
        sa.Column("image_id", sa.Integer(), nullable=False),
        sa.Column("person", sa.String(length=200), nullable=False),
        sa.ForeignKeyConstraint(
            ["image_id"], ["images.id"], name="fk_image_people_image_id_images", ondelete="CASCADE"
        ),
        sa.PrimaryKeyConstraint("image_id", "person", name="pk_image_people"),
    )
    op.create_index("ix_image_people_person_image_id", "image_people", ["person", "image_id"], unique=False)
    op.execute(counters.noted_people())


def new_indexes() -> list[tuple[str, str, list[str], str | None]]:
    """Return name, table, columns and condition of each new index."""
    return [
        *((f"ix_images_alive_{name}", "images", ["dataset_id", name, "name", "id"], ALIVE) for name in FILTERS),
        *((f"ix_images_alive_{name}", "images", ["dataset_id", name, "id"], ALIVE) for name in (*ORDERS, *SCORES)),
        ("ix_images_deleted", "images", ["dataset_id", "deleted_at"], "deleted_at IS NOT NULL"),
        ("ix_images_dataset_id_name_id", "images", ["dataset_id", "name", "id"], None),
        ("ix_images_sha256_dataset_id", "images", ["sha256", "dataset_id"], None),
        ("ix_run_images_status_run_id_id", "run_images", ["status", "run_id", "id"], None),
        ("ix_run_images_run_id_heartbeat_at", "run_images", ["run_id", "heartbeat_at"], None),
        (
            "ix_run_images_to_judge",
            "run_images",
            ["run_id", "id"],
            "status = 'done' AND camera_estimate_id IS NULL AND error IS NULL",
        ),
        ("ix_events_dataset_id_created_at_id", "events", ["dataset_id", "created_at", "id"], None),
    ]


def old_indexes() -> list[tuple[str, str, list[str]]]:
    """Return name, table and columns of the indexes that the new ones begin with."""
    return [
        ("ix_images_dataset_camera", "images", ["dataset_id", "camera_id"]),
        ("ix_images_sha256", "images", ["sha256"]),
        ("ix_images_dataset_id_assignee", "images", ["dataset_id", "assignee"]),
        ("ix_run_images_status_run", "run_images", ["status", "run_id"]),
        ("ix_events_dataset_id", "events", ["dataset_id"]),
    ]


def create_index(name: str, table: str, columns: list[str], where: str | None) -> None:
    condition = None if where is None else sa.text(where)
    op.create_index(name, table, columns, unique=False, sqlite_where=condition, postgresql_where=condition)
