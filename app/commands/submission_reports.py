"""What ``clearlines submit`` prints: numbers of a scored submission, or everything that is wrong with it."""

from __future__ import annotations

from typing import Any

from rich.console import Console
from rich.markup import escape

from app.formats.submission_problems import InvalidSubmission

SHOWN = ("f1", "precision", "recall", "mean_f1", "ap", "official_f1")
MOST_ERRORS = 50


def print_errors(error: InvalidSubmission, terminal: Console) -> None:
    """Print every complaint, with its place and what would help."""
    errors = error.details.get("errors") or []
    count = int(error.details.get("count", len(errors)))
    terminal.print(f"[bold red]{count} {'thing is' if count == 1 else 'things are'} wrong[/]")
    for each in errors[:MOST_ERRORS]:
        place = [str(each["file"])] if each.get("file") else []
        place += [f"{word} {each[word]}" for word in ("segment", "point") if each.get(word) is not None]
        terminal.print(f"  {', '.join(place)}: {each['message']}", markup=False)
        for word in ("expected", "hint"):
            if each.get(word):
                terminal.print(f"    {word}: {each[word]}", markup=False)
    if count > MOST_ERRORS:
        terminal.print(f"  and {count - MOST_ERRORS:,} more")


def print_validation(found: dict[str, Any], terminal: Console) -> None:
    """Print what an upload holds."""
    terminal.print(f"valid: {found['segments']:,} segments of {found['images']:,} images")
    for warning in found["warnings"]:
        terminal.print(f"  note: {warning}", markup=False)
    if found["missing"]:
        names = ", ".join(found["missing"][:10]) + (" ..." if len(found["missing"]) > 10 else "")
        terminal.print(f"  without a file, counted as empty: {names}", markup=False)
    for file in found["left_out"]:
        terminal.print(f"  left out: {file['file']} ({file['reason']})", markup=False)


def print_submission(submission: dict[str, Any], server: str, terminal: Console) -> None:
    """Print a submission's numbers with their intervals, and where it is."""
    address = f"{server.rstrip('/')}/submissions/{submission['id']}"
    if submission["status"] != "scored":
        error = submission.get("error") or {}
        terminal.print(f"[bold red]{submission['status']}[/]: {escape(str(error.get('message', 'no reason given')))}")
        terminal.print(address)
        return
    score = submission["scores"][0]
    terminal.print(f"scored under {score['protocol']} {score['protocol_version']}")
    for name in SHOWN:
        numbers = score["totals"].get(name)
        if numbers and numbers["value"] is not None:
            within = "" if numbers["low"] is None else f"  ({numbers['low']:.3f} to {numbers['high']:.3f})"
            terminal.print(f"  {name:<12} {numbers['value']:.3f}{within}", markup=False)
    terminal.print(address)
