"""Annotators, readers and submitters at once, on SQLite and PostgreSQL, with one server process and with two.

Each setup gets servers of its own on loopback and is filled alike: 24 images of 300 candidates that annotators judge in
batches of five, 200 images that readers browse, a board that submitters hand zips in to while they are scored. Nobody
thinks long: between requests annotators wait 0.05 to 0.15 s, readers 0.1 to 0.3 s, submitters 0.5 to 1.5 s. At the end
every verdict and every submission that was answered must be stored, once.

    .venv/bin/python benchmarks/load.py --users 24 --seconds 30 --write docs/load.md
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path
from typing import Any

from shared.load_site import Setup, fill, running, what_is_wrong
from shared.reporting import Target, argument_parser, finish, show_table

USERS_FILE = Path(__file__).with_name("shared") / "load_users.py"
SETUPS = (Setup("SQLite", 1), Setup("PostgreSQL", 1), Setup("PostgreSQL", 2))
BEGIN, END = "<!-- tables of load.py -->", "<!-- end of the tables of load.py -->"
TARGETS = (Target("errors", 0), Target("lost_or_twice", 0))


def percentile(times: Counter[float], share: float) -> float:
    """Return the time that this share of the requests took at most, ms; locust rounds long ones."""
    left = share * sum(times.values())
    for milliseconds, count in sorted(times.items()):
        left -= count
        if left <= 0:
            return milliseconds
    return 0.0


def run_people(world: dict[str, Any], folder: Path, options: argparse.Namespace) -> list[dict[str, Any]]:
    """Let the people loose, and return locust's statistics of each kind of request."""
    counts = {"annotator": options.users // 2, "submitter": max(1, options.users // 6)}
    counts["reader"] = options.users - sum(counts.values())
    (folder / "world.json").write_text(json.dumps(world))
    command = [sys.executable, "-m", "locust", "-f", str(USERS_FILE), "--headless", "--json", "--only-summary"]
    command += ["-u", str(options.users), "-r", str(options.users), "-t", f"{options.seconds}s", "--stop-timeout", "30"]
    environment = {
        **os.environ,
        "LOAD_WORLD": str(folder / "world.json"),
        "LOAD_RECORDS": str(folder),
        "LOAD_COUNTS": json.dumps(counts),
    }
    done = subprocess.run(
        [*command, "--host", world["hosts"][0], "--exit-code-on-error", "0"],
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode:
        raise RuntimeError(done.stderr[-3000:])
    return json.loads(done.stdout)


def measure(setup: Setup, options: argparse.Namespace) -> dict[str, Any]:
    """Return the figures of a setup: requests per second, errors, what is wrong, and the times of each kind."""
    with tempfile.TemporaryDirectory(prefix="clearlines-people-") as name, running(setup) as site:
        folder = Path(name)
        statistics = run_people(fill(site, folder), folder, options)
        records = [json.loads(file.read_text()) for file in folder.glob("*-*.json")]
        wrong = what_is_wrong(site, records)
    kinds: dict[str, Any] = {}
    for entry in statistics:
        times = Counter({float(time): count for time, count in entry["response_times"].items()})
        kinds[entry["name"]] = {
            "requests": entry["num_requests"],
            "errors": entry["num_failures"],
            "per_second": entry["num_requests"] / options.seconds,
            **{f"p{share}_ms": percentile(times, share / 100) for share in (50, 95, 99)},
        }
    verdicts = sum(len(entry["rows"]) for record in records for entry in record if entry.get("rows") and entry["good"])
    return {
        "kinds": kinds,
        "wrong": wrong,
        "errors": sum(kind["errors"] for kind in kinds.values()),
        "requests_per_second": sum(kind["per_second"] for kind in kinds.values()),
        "verdicts_per_second": verdicts / options.seconds,
    }


def show(setup: Setup, found: dict[str, Any]) -> None:
    rows = [
        [
            name,
            f"{kind['per_second']:.1f}",
            *(f"{kind[f'p{share}_ms']:.0f}" for share in (50, 95, 99)),
            str(kind["errors"]),
        ]
        for name, kind in sorted(found["kinds"].items())
    ]
    title = (
        f"{setup.name}: {found['requests_per_second']:.0f} requests/s, {found['verdicts_per_second']:.0f} verdicts/s"
    )
    show_table(title, ["request", "1/s", "p50 ms", "p95 ms", "p99 ms", "errors"], rows)
    for words in found["wrong"]:
        print("WRONG:", words)


def markdown(setup: Setup, found: dict[str, Any]) -> str:
    """Return a setup's table for the documentation."""
    head = f"{setup.name}: {found['requests_per_second']:.0f} requests/s, {found['verdicts_per_second']:.0f} verdicts/s"
    lines = [f"**{head}**", "", "| request | per second | p50 | p95 | p99 | errors |", "|---|---|---|---|---|---|"]
    for name, kind in sorted(found["kinds"].items()):
        times = " | ".join(f"{kind[f'p{share}_ms']:.0f} ms" for share in (50, 95, 99))
        lines.append(f"| {name} | {kind['per_second']:.1f} | {times} | {kind['errors']} |")
    return "\n".join(lines)


def write_tables(page: Path, tables: list[str], options: argparse.Namespace) -> None:
    """Put the tables between the two marks of a page, with what they were measured on."""
    before, rest = page.read_text().split(BEGIN)
    after = rest.split(END)[1]
    machine = f"{platform.machine()}, {os.cpu_count()} cores, Python {platform.python_version()}"
    words = f"{options.users} users for {options.seconds} s; {machine}, load {os.getloadavg()[0]:.1f} at the end."
    body = "\n\n".join([words, *tables])
    page.write_text(f"{before}{BEGIN}\n{body}\n{END}{after}")


def main() -> None:
    parser = argument_parser(str(__doc__))
    parser.add_argument("--users", type=int, default=24, help="half annotators, a third readers, the others submitters")
    parser.add_argument("--seconds", type=int, default=20)
    parser.add_argument("--write", type=Path, help="the page whose tables are replaced")
    parser.add_argument("--only", help="one setup: 'SQLite, 1 server'")
    options = parser.parse_args()
    tables: list[str] = []
    figures: dict[str, float | None] = {"errors": 0, "lost_or_twice": 0}
    for setup in SETUPS:
        if options.only in (None, setup.name):
            found = measure(setup, options)
            show(setup, found)
            tables.append(markdown(setup, found))
            figures["errors"] = (figures["errors"] or 0) + found["errors"]
            figures["lost_or_twice"] = (figures["lost_or_twice"] or 0) + len(found["wrong"])
            for name, kind in found["kinds"].items():
                for figure in ("per_second", "p50_ms", "p95_ms", "p99_ms"):
                    figures[f"{setup.name}: {name}: {figure}"] = kind[figure]
            for figure in ("requests_per_second", "verdicts_per_second"):
                figures[f"{setup.name}: {figure}"] = found[figure]
    if options.write:
        write_tables(options.write, tables, options)
    finish(figures, TARGETS, as_json=options.json)


if __name__ == "__main__":
    main()
