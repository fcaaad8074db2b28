"""How fast an installation moves: SQLite to PostgreSQL and back, and into a backup.

python benchmarks/moving.py [--segments N] [--data DIR | --postgres URL] [--json]

Makes an SQLite installation of random segments of 30 points each, 500 in an image, then copies it as
``clearlines migrate`` and ``clearlines backup`` do: rows, indexes and the comparison at the end. Wall time, and the
processor time of this process alone: that of the PostgreSQL server isn't in it.
"""

from __future__ import annotations

import resource
import shutil
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
from shared.reporting import argument_parser, finish, show_table
from shared.scale_server import database_address, execute_alone, own_server
from sqlalchemy import insert

from app.db.copying.copy import copy_rows
from app.db.copying.targets import filling
from app.db.models import Blob, Camera, Dataset, Image, Segment
from app.db.session import Database, open_database, upgrade
from app.db.sqlite_files import filled_file

SEED = 7
POINTS = 30
IN_IMAGE = 500
NAME = "clearlines_moving"
TIME = datetime(2025, 6, 1, tzinfo=UTC)


def make_installation(path: Path, segments: int) -> None:
    """Make a database of so many segments; those of one image at a time."""
    rng = np.random.default_rng(SEED)
    size, made = {"width": 1242, "height": 375}, {"created_at": TIME}
    with opened(f"sqlite:///{path}") as database:
        upgrade(database)
        with database.write() as session:
            session.execute(insert(Dataset).values(id=1, slug="moving", name="Moving", **made))
            session.execute(insert(Camera).values(id=1, dataset_id=1, name="camera", **size, **made))
        for number in range(1, segments // IN_IMAGE + 1):
            named = {"name": f"{number:06}", "file_name": f"{number:06}.png", "sha256": f"{number:064x}"}
            points = rng.random((IN_IMAGE, POINTS, 2), np.float32) * 1000
            with database.write() as session:
                session.execute(insert(Blob).values(sha256=named["sha256"], size=1, media_type="image/png", **made))
                keys = {"id": number, "dataset_id": 1, "camera_id": 1}
                session.execute(insert(Image).values(**keys, **named, bits=8, **size, **made))
                session.execute(insert(Segment), [segment_row(number, *each) for each in enumerate(points)])


def segment_row(image: int, ordinal: int, points: np.ndarray) -> dict[str, object]:
    """Return the row of a segment, from its float32 (N, 2) points in px."""
    first, last = points[0].tolist(), points[-1].tolist()
    return {
        "image_id": image,
        "ordinal": ordinal,
        "n_points": len(points),
        "points": points.tobytes(),
        "x0": first[0],
        "y0": first[1],
        "x1": last[0],
        "y1": last[1],
        "length": 100.0 + ordinal,
        "score": 0.5,
        "origin": "pipeline",
    }


@contextmanager
def opened(address: str) -> Iterator[Database]:
    """Open a database, and close it at the end."""
    database = open_database(address)
    try:
        yield database
    finally:
        database.close()


def migrate(source: str, target: str) -> int:
    """Copy a database into another one; return how many rows it has."""
    with opened(source) as here, opened(target) as there, filling(there) as filled:
        return copy_rows(here, filled).rows


def back_up(source: str, path: Path) -> int:
    """Copy a database into a file; return how many rows it has."""
    with opened(source) as here, filled_file(path) as filled:
        return copy_rows(here, filled).rows


def timed(work: Callable[[], int]) -> tuple[float, float, int]:
    """Return wall time and processor time in s, and the number of rows."""
    wall, processor = time.perf_counter(), time.process_time()
    rows = work()
    return time.perf_counter() - wall, time.process_time() - processor, rows


def main() -> None:
    parser = argument_parser(str(__doc__))
    parser.add_argument("--segments", type=int, default=1_000_000)
    parser.add_argument("--data", type=Path, default=Path("build/moving"), help="folder for all files")
    parser.add_argument("--postgres", help="address of a server whose user is a superuser, instead of its own")
    options = parser.parse_args()
    folder = options.data.absolute()
    shutil.rmtree(folder / "files", ignore_errors=True)
    (folder / "files").mkdir(parents=True)
    source, back = (f"sqlite:///{folder}/files/{name}.sqlite3" for name in ("source", "back"))
    make_installation(folder / "files" / "source.sqlite3", options.segments)
    with nullcontext(options.postgres) if options.postgres else own_server(folder) as server:
        execute_alone(server, f"DROP DATABASE IF EXISTS {NAME} WITH (FORCE)", f"CREATE DATABASE {NAME}")
        postgres = database_address(server, NAME)
        timings = {
            "SQLite to PostgreSQL": timed(lambda: migrate(source, postgres)),
            "PostgreSQL to SQLite": timed(lambda: migrate(postgres, back)),
            "backup of SQLite": timed(lambda: back_up(source, folder / "files" / "backup.sqlite3")),
        }
    rows = [
        [name, f"{rows:,}", f"{wall:.1f}", f"{processor:.1f}", f"{rows / wall:,.0f}"]
        for name, (wall, processor, rows) in timings.items()
    ]
    show_table(f"{options.segments:,} segments of {POINTS} points", ["", "rows", "s", "processor s", "rows/s"], rows)
    print(f"memory at most {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:,.0f} MiB")
    figures = {name.replace(" ", "_"): rows / wall for name, (wall, _, rows) in timings.items()}
    finish(figures, [], as_json=options.json)


if __name__ == "__main__":
    main()
