"""The triggers that migration 0006 makes: they keep copies and differences of what lists and overviews count.

Five things are kept, each in the transaction of its change:

- ``images.review_status``, a copy of the status of its review;
- ``images.prelabel``, the state of the newest work on it: deleted runs and cancelled work don't count;
- ``image_tallies``, from changes of images;
- ``run_tallies``, from changes of the work of runs;
- ``image_people``, from decisions that people made.

PostgreSQL's triggers run once for each statement and add its differences up; SQLite's run once for each row.
"""

from __future__ import annotations

STATES = ("dataset_id", "camera_id", "source", "sequence", "assignee", "review_status", "prelabel")
WATCHED = (*STATES, "deleted_at", "n_candidates", "n_keep", "n_reject", "n_ambiguous", "current_run_image_id")
IMAGE_SUMS = ("images", "prelabelled", "labelled", "candidates", "keep", "reject", "ambiguous")
CHANGES = ("candidates", "carried", "kept_unmatched", "already_there", "retired", "discarded", "reopened")
RUN_SUMS = ("images", *CHANGES)
WORK = "kind IN ('judge', 'accept', 'take_over', 'undo', 'redo') AND person IS NOT NULL"

SQLITE_TRIGGERS = (
    "reviews_added",
    "reviews_changed",
    "images_added",
    "images_changed",
    "images_removed",
    "run_images_added",
    "run_images_changed",
    "run_images_removed",
    "run_images_newest_added",
    "run_images_newest_changed",
    "run_images_newest_removed",
    "runs_deleted",
    "decisions_noted",
)


def sqlite_triggers() -> list[str]:
    """Return the statements that make SQLite's triggers."""
    state = "UPDATE images SET review_status = new.status WHERE id = new.image_id AND review_status <> new.status;"
    changed = " OR ".join(f"new.{column} IS NOT old.{column}" for column in WATCHED)
    return [
        _trigger("reviews_added", "AFTER INSERT ON reviews", state),
        _trigger("reviews_changed", "AFTER UPDATE OF status ON reviews", state),
        _trigger("images_added", "AFTER INSERT ON images", _image_row("new", 1)),
        _trigger(
            "images_changed",
            f"AFTER UPDATE OF {', '.join(WATCHED)} ON images WHEN {changed}",
            _image_row("old", -1) + _image_row("new", 1),
        ),
        _trigger("images_removed", "AFTER DELETE ON images", _image_row("old", -1)),
        _trigger("run_images_added", "AFTER INSERT ON run_images", _run_row("new", 1)),
        _trigger(
            "run_images_changed",
            "AFTER UPDATE OF status, changes ON run_images"
            " WHEN new.status IS NOT old.status OR new.changes IS NOT old.changes",
            _run_row("old", -1) + _run_row("new", 1),
        ),
        _trigger("run_images_removed", "AFTER DELETE ON run_images", _run_row("old", -1)),
        _trigger("run_images_newest_added", "AFTER INSERT ON run_images", _newest("new.image_id")),
        _trigger(
            "run_images_newest_changed",
            "AFTER UPDATE OF status ON run_images WHEN new.status IS NOT old.status",
            _newest("new.image_id"),
        ),
        _trigger("run_images_newest_removed", "AFTER DELETE ON run_images", _newest("old.image_id")),
        _trigger(
            "runs_deleted",
            "AFTER UPDATE OF deleted_at ON runs WHEN new.deleted_at IS NOT old.deleted_at",
            _newest("(SELECT image_id FROM run_images WHERE run_id = new.id)", among=True),
        ),
        _trigger(
            "decisions_noted",
            f"AFTER INSERT ON decisions WHEN {WORK.replace('kind', 'new.kind').replace('person', 'new.person')}",
            "INSERT OR IGNORE INTO image_people (image_id, person) VALUES (new.image_id, new.person);",
        ),
    ]


def postgresql_triggers() -> list[str]:
    """Return the statements that make PostgreSQL's functions and triggers."""
    both = "REFERENCING OLD TABLE AS old_rows NEW TABLE AS new_rows"
    events = {
        "INSERT": "REFERENCING NEW TABLE AS new_rows",
        "UPDATE": both,
        "DELETE": "REFERENCING OLD TABLE AS old_rows",
    }
    statements = []
    for event, tables in events.items():
        statements += [
            _function(f"tally_images_{event.lower()}", _image_differences(event)),
            _statement_trigger(
                f"images_tallied_{event.lower()}", event, "images", tables, f"tally_images_{event.lower()}"
            ),
            _function(f"tally_run_images_{event.lower()}", _run_differences(event) + _newest_of(event)),
            _statement_trigger(
                f"run_images_tallied_{event.lower()}", event, "run_images", tables, f"tally_run_images_{event.lower()}"
            ),
        ]
    reviewed = (
        "UPDATE images SET review_status = new_rows.status FROM new_rows"
        " WHERE images.id = new_rows.image_id AND images.review_status <> new_rows.status;"
    )
    deleted = """
        UPDATE images SET prelabel = {state} WHERE id IN (
          SELECT image_id FROM run_images JOIN new_rows ON new_rows.id = run_images.run_id
          JOIN old_rows ON old_rows.id = new_rows.id AND old_rows.deleted_at IS DISTINCT FROM new_rows.deleted_at
        ) AND prelabel <> {state};""".format(state=newest_state("images.id"))  # noqa: S608
    return [
        *statements,
        _function("copy_review_status", reviewed),
        *(
            _statement_trigger(f"reviews_copied_{event.lower()}", event, "reviews", events[event], "copy_review_status")
            for event in ("INSERT", "UPDATE")
        ),
        _function("note_people", f"{_noted('new_rows')} ON CONFLICT DO NOTHING;"),
        _statement_trigger("decisions_noted", "INSERT", "decisions", events["INSERT"], "note_people"),
        _function("copy_newest_state", deleted),
        _statement_trigger("runs_newest_update", "UPDATE", "runs", both, "copy_newest_state"),
    ]


def postgresql_removal() -> list[str]:
    """Return the statements that remove PostgreSQL's functions, and with them the triggers."""
    names = [f"tally_{table}_{event}" for table in ("images", "run_images") for event in ("insert", "update", "delete")]
    return [
        f"DROP FUNCTION {name} CASCADE" for name in (*names, "copy_review_status", "copy_newest_state", "note_people")
    ]


def newest_state(image_id: str) -> str:
    """Return the state of the newest work on an image as an expression."""
    return (
        "coalesce((SELECT run_images.status FROM run_images JOIN runs ON runs.id = run_images.run_id"  # noqa: S608
        f" WHERE run_images.image_id = {image_id} AND runs.deleted_at IS NULL AND run_images.status <> 'cancelled'"
        " ORDER BY run_images.id DESC LIMIT 1), 'none')"
    )


def counted_images() -> str:
    """Return the statement that counts all images there are."""
    keys = ", ".join((*STATES, "deleted_at IS NOT NULL"))
    sums = ", ".join(f"sum({value})" for value in _image_values("images").values())
    return f"INSERT INTO image_tallies ({_image_columns()}) SELECT {keys}, {sums}, true FROM images GROUP BY {keys}"  # noqa: S608


def counted_runs(dialect: str) -> str:
    """Return the statement that counts all work of runs there is."""
    sums = ", ".join(f"coalesce(sum({value}), 0)" for value in _run_values("run_images", dialect).values())
    return (
        f"INSERT INTO run_tallies (run_id, status, {', '.join(RUN_SUMS)}, merged)"  # noqa: S608
        f" SELECT run_id, status, {sums}, true FROM run_images GROUP BY run_id, status"
    )


def noted_people() -> str:
    """Return the statement that notes who made the decisions there are."""
    return _noted("decisions")


def _noted(rows: str) -> str:
    return f"INSERT INTO image_people (image_id, person) SELECT DISTINCT image_id, person FROM {rows} WHERE {WORK}"  # noqa: S608


def _image_columns() -> str:
    return ", ".join((*STATES, "deleted", *IMAGE_SUMS, "merged"))


def _image_values(row: str) -> dict[str, str]:
    """Return what an image adds to each sum."""
    prelabelled = f"{row}.current_run_image_id IS NOT NULL OR {row}.n_candidates > 0"
    return {
        "images": "1",
        "prelabelled": f"CASE WHEN {prelabelled} THEN 1 ELSE 0 END",
        "labelled": f"CASE WHEN {row}.n_keep > 0 THEN 1 ELSE 0 END",
        **{name: f"{row}.n_{name}" for name in IMAGE_SUMS[3:]},
    }


def _run_values(row: str, dialect: str) -> dict[str, str]:
    """Return what the work on an image adds to each sum; only work that is done counts for more than itself."""

    def change(name: str) -> str:
        if dialect == "sqlite":
            return f"coalesce(json_extract({row}.changes, '$.{name}'), 0)"
        if name == "reopened":
            return f"coalesce(({row}.changes ->> 'reopened')::boolean::integer, 0)"
        return f"coalesce(({row}.changes ->> '{name}')::integer, 0)"

    changes = {name: f"CASE WHEN {row}.status = 'done' THEN {change(name)} ELSE 0 END" for name in CHANGES}
    return {"images": "1", **changes}


def _trigger(name: str, when: str, body: str) -> str:
    return f"CREATE TRIGGER {name} {when} BEGIN {body} END"


def _image_row(row: str, sign: int) -> str:
    values = [f"{row}.{column}" for column in STATES]
    values.append(f"{row}.deleted_at IS NOT NULL")
    values += [f"{sign} * ({value})" for value in _image_values(row).values()]
    return f"INSERT INTO image_tallies ({_image_columns()}) VALUES ({', '.join(values)}, 0);"  # noqa: S608


def _run_row(row: str, sign: int) -> str:
    values = [
        f"{row}.run_id",
        f"{row}.status",
        *(f"{sign} * ({value})" for value in _run_values(row, "sqlite").values()),
    ]
    return f"INSERT INTO run_tallies (run_id, status, {', '.join(RUN_SUMS)}, merged) VALUES ({', '.join(values)}, 0);"  # noqa: S608


def _newest(image_id: str, *, among: bool = False) -> str:
    state = newest_state("images.id")
    return f"UPDATE images SET prelabel = {state} WHERE id {'IN' if among else '='} {image_id} AND prelabel <> {state};"  # noqa: S608


def _function(name: str, body: str) -> str:
    return f"CREATE FUNCTION {name}() RETURNS trigger LANGUAGE plpgsql AS $body$ BEGIN {body} RETURN NULL; END $body$"


def _statement_trigger(name: str, event: str, table: str, transition: str, function: str) -> str:
    return (
        f"CREATE TRIGGER {name} AFTER {event} ON {table} {transition} FOR EACH STATEMENT EXECUTE FUNCTION {function}()"
    )


def _signed(event: str, select: str) -> str:
    """Return the rows of a statement before it with the sign -1, and after it with 1."""
    parts = {"INSERT": [("new_rows", 1)], "DELETE": [("old_rows", -1)], "UPDATE": [("old_rows", -1), ("new_rows", 1)]}
    return " UNION ALL ".join(select.format(row=row, sign=sign) for row, sign in parts[event])


def _image_differences(event: str) -> str:
    keys = ", ".join((*STATES, "deleted"))
    sums = ", ".join(f"sum({name})" for name in IMAGE_SUMS)
    values = ", ".join(f"{{sign}} * ({value}) AS {name}" for name, value in _image_values("{row}").items())
    rows = _signed(event, f"SELECT {', '.join(STATES)}, deleted_at IS NOT NULL AS deleted, {values} FROM {{row}}")  # noqa: S608
    any_left = " OR ".join(f"sum({name}) <> 0" for name in IMAGE_SUMS)
    return (
        f"INSERT INTO image_tallies ({_image_columns()}) SELECT {keys}, {sums}, false FROM ({rows}) AS differences"  # noqa: S608
        f" GROUP BY {keys} HAVING {any_left};"
    )


def _run_differences(event: str) -> str:
    sums = ", ".join(f"sum({name})" for name in RUN_SUMS)
    values = ", ".join(f"{{sign}} * ({value}) AS {name}" for name, value in _run_values("{row}", "postgresql").items())
    rows = _signed(event, f"SELECT run_id, status, {values} FROM {{row}}")  # noqa: S608
    any_left = " OR ".join(f"sum({name}) <> 0" for name in RUN_SUMS)
    return (
        f"INSERT INTO run_tallies (run_id, status, {', '.join(RUN_SUMS)}, merged) SELECT run_id, status, {sums}, false"  # noqa: S608
        f" FROM ({rows}) AS differences GROUP BY run_id, status HAVING {any_left};"
    )


def _newest_of(event: str) -> str:
    state = newest_state("images.id")
    touched = {
        "INSERT": "SELECT image_id FROM new_rows",
        "DELETE": "SELECT image_id FROM old_rows",
        "UPDATE": "SELECT new_rows.image_id FROM new_rows JOIN old_rows ON old_rows.id = new_rows.id"
        " WHERE old_rows.status <> new_rows.status",
    }[event]
    return f" UPDATE images SET prelabel = {state} WHERE id IN ({touched}) AND prelabel <> {state};"  # noqa: S608
