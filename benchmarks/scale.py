"""What a request costs as the tables grow: to a hundred thousand images and ten million segments in PostgreSQL.

python benchmarks/scale.py [--data DIR | --postgres URL] [--rounds N] [--plans FILE] [--only WORD] [--json]

Fills three databases, each ten times the one before, unless they are filled already: by COPY from seeded generators,
with datasets, drives, runs, decisions, second reviews and a board as a large installation has them. Then one client
asks the real application over each of them for the same pages in turn. Wall time is what a person waits for on this
machine, with all else that it does; processor time, of server and database together, is what the request itself needs.
The database folder stays (some 12 GB): the next run begins at once.
"""

from __future__ import annotations

import os
import sys
from argparse import Namespace
from collections.abc import Sequence
from contextlib import ExitStack, nullcontext
from datetime import UTC, datetime
from pathlib import Path

from shared.reporting import Target, argument_parser, finish, show_table
from shared.scale_app import scale_settings, served
from shared.scale_fill import fill, is_filled
from shared.scale_measure import Server, Timing, figures_of, time_each, time_page
from shared.scale_plans import written_plans
from shared.scale_requests import page_queries
from shared.scale_server import database_address, own_server
from shared.scale_storage import size_rows, table_sizes
from shared.scale_world import make_world
from shared.scale_writes import Writes
from sqlalchemy import delete

from app.db.models import Token
from app.db.session import Database, open_database
from app.services.tokens import create_token

SEED = 7
SHARES = (0.01, 0.1, 1.0)
READER = "scale reader"
NO_PAGES = ("background", "deciding", "run of one image", "upload")
"""Beginnings of what is timed and shown beside the pages; the bounds are for pages."""
FIRST_PORT = 8790
WRITES = 10
PATIENCE = 50.0
"""ms; what a page may take at the full size, at the 95th percentile."""
GROWTH = 1.5
"""Greatest ratio of medians at the full size and at a hundredth of it; lists of a small dataset are shorter, too."""


def fill_all(server: str, shares: Sequence[float]) -> None:
    """Fill the databases that aren't."""
    for share in shares:
        world = make_world(share, SEED)
        if is_filled(server, name_of(share), world):
            continue
        seconds = fill(server, name_of(share), world, SEED)
        title = f"Filling {world.images:,} images, {world.segments:,} segments"
        show_table(title, ["step", "s"], [[step, f"{value:.1f}"] for step, value in seconds.items()])


def name_of(share: float) -> str:
    """Return the name of the database of a share."""
    return f"clearlines_scale_{round(share * 1000)}"


def reader_token(database: Database) -> str:
    """Return a fresh token of a reader."""
    with database.write() as session:
        session.execute(delete(Token).where(Token.name == READER))
        return create_token(session, READER, "reader", datetime.now(UTC), person=None).text


def measure(options: Namespace, server: str, stack: ExitStack) -> dict[str, list[Timing]]:
    """Time pages, writes and what goes on in the background."""
    servers, writes = [], []
    for place, share in enumerate(SHARES):
        address, folder = database_address(server, name_of(share)), options.data / f"app-{round(share * 1000)}"
        database = open_database(address)
        stack.callback(database.close)
        token = reader_token(database)
        base, process = stack.enter_context(served(address, folder, FIRST_PORT + place))
        servers.append(Server(base, address, process, token))
        writes.append(Writes(base, database, scale_settings(address, folder), make_world(share, SEED)))
    timings: dict[str, list[Timing]] = {}
    for pages in zip(*(page_queries(each.world) for each in writes), strict=True):
        if options.only in pages[0].name:
            timings[pages[0].name] = time_page(servers, pages, options.rounds)
            told(pages[0].name, timings[pages[0].name])
    if options.only:
        return timings
    kinds = {
        "deciding 20 candidates": [each.decide for each in writes],
        "run of one image, 150 candidates": [each.store for each in writes],
        "upload of an image": [each.upload for each in writes],
    }
    for name, write in kinds.items():
        timings[name] = time_each(servers, lambda place, number, write=write: write[place](number), WRITES)
        told(name, timings[name])
    for name in writes[0].background():
        looks = [each.background()[name] for each in writes]
        timings[f"background: {name}"] = time_each(servers, lambda place, number, looks=looks: looks[place](number), 5)
        told(name, timings[f"background: {name}"])
    return timings


def told(page: str, timings: Sequence[Timing]) -> None:
    """Say how far it is, on the way."""
    numbers = "  ".join(f"{each.median:.0f} / {each.p95:.0f} / {each.processor:.0f}" for each in timings)
    print(f"{page}: {numbers}", file=sys.stderr, flush=True)


def show(timings: dict[str, list[Timing]]) -> None:
    """Print the times, and how they grew."""
    parts = {"ms": "median", "p95": "p95", "cpu": "processor"}
    columns = ["", *(f"{part} {name}" for part in parts for name in ("1", "10", "100 %")), "first", "growth"]
    rows = []
    for page, of_page in timings.items():
        numbers = [f"{getattr(each, figure):.0f}" for figure in parts.values() for each in of_page]
        rows.append([page, *numbers, f"{of_page[-1].first:.0f}", f"{growth_of(of_page):.1f}"])
    title = "One client at 1, 10 and 100 %: median, 95th percentile, processor time; first request, ms"
    show_table(title, columns, rows)


def growth_of(timings: Sequence[Timing]) -> float:
    """Return the median at the full size over that at the smallest: asked in turn, all sizes share what disturbs."""
    return timings[-1].median / timings[0].median


def main() -> None:
    parser = argument_parser(str(__doc__))
    parser.add_argument("--data", type=Path, default=Path("build/scale"), help="folder of its own server and of files")
    parser.add_argument("--postgres", help="address of a server whose user is a superuser, instead of its own")
    parser.add_argument("--rounds", type=int, default=40, help="requests of each page and size")
    parser.add_argument("--plans", type=Path, help="file for the query plans at the full size")
    parser.add_argument("--only", default="", help="pages whose name has this in it")
    options = parser.parse_args()
    options.data = options.data.absolute()
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    with nullcontext(options.postgres) if options.postgres else own_server(options.data) as server:
        fill_all(server, SHARES)
        full = database_address(server, name_of(SHARES[-1]))
        columns = ["table", "rows", "heap", "toast", "indexes", "all"]
        show_table("Bytes per row at the full size", columns, size_rows(table_sizes(full)))
        with ExitStack() as stack:
            timings = measure(options, server, stack)
        show(timings)
        if options.plans:
            pages = [page for page in page_queries(make_world(SHARES[-1], SEED)) if options.only in page.name]
            options.plans.write_text(written_plans(scale_settings(full, options.data / "app-plans"), pages))
    figures = figures_of(timings, ["1", "10", "100"])
    pages = {page: of_page for page, of_page in timings.items() if not page.startswith(NO_PAGES)}
    figures["slowest_p95"] = max((of_page[-1].p95 for of_page in pages.values()), default=0.0)
    figures["pages_within"] = float(sum(of_page[-1].p95 <= PATIENCE for of_page in pages.values()))
    figures["largest_growth"] = max(map(growth_of, pages.values()), default=0.0)
    targets = [Target("slowest_p95", PATIENCE), Target("largest_growth", GROWTH)]
    finish(figures, targets, as_json=options.json)


if __name__ == "__main__":
    main()
