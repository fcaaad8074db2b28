"""What the command line says: beside its output, on the error stream, so that output can be piped."""

from __future__ import annotations

from pathlib import Path

from rich.console import Console

from app.errors import ClearLinesError

terminal = Console(stderr=True, highlight=False, soft_wrap=True)


def announce(address: str, data_dir: Path) -> None:
    """Say where the tool is."""
    terminal.print(f"ClearLines is at [bold]{address}[/]  (data in {data_dir}; Ctrl-C stops it)")


def tell(error: ClearLinesError) -> None:
    """Say what is wrong, in one line and what helps below it."""
    head = f"{error.where}: {error.message}" if error.where else error.message
    terminal.print("[bold red]error:[/]", end=" ")
    terminal.print(head, markup=False)
    for word, text in (("expected", error.expected), ("hint", error.hint)):
        if text:
            terminal.print(f"  {word}: {text}", markup=False)
