"""The command line: each command reads its arguments and calls one function of ``app.commands``.

Whatever is slow to import, a command imports when it is run, after its arguments were looked at.
"""

from __future__ import annotations

import signal
import sys
from types import FrameType
from typing import Annotated, NoReturn

import typer

from app import __version__
from app.cli.calibrating import calibrate
from app.cli.cluster import scheduler, worker
from app.cli.exchange import export, import_
from app.cli.leaderboard import baseline, card, submit
from app.cli.moving import backup, migrate, restore
from app.cli.serving import demo, serve
from app.cli.terminal import tell, terminal
from app.cli.tokens import token_commands
from app.cli.users import user_commands
from app.cli.without_server import evaluate, prelabel, synthesize
from app.errors import ClearLinesError

app = typer.Typer(
    name="clearlines",
    help="Turn street images into ground truth for straight edge-segments.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
for _name, _command in {
    "demo": demo,
    "serve": serve,
    "prelabel": prelabel,
    "evaluate": evaluate,
    "calibrate": calibrate,
    "synthesize": synthesize,
    "import": import_,
    "export": export,
    "submit": submit,
    "baseline": baseline,
    "card": card,
    "migrate": migrate,
    "backup": backup,
    "restore": restore,
    "scheduler": scheduler,
    "worker": worker,
}.items():
    app.command(_name)(_command)
app.add_typer(token_commands, name="token")
app.add_typer(user_commands, name="user")
INTERRUPTED = 130  # exit status after Ctrl-C


@app.callback(invoke_without_command=True)
def _version(version: Annotated[bool, typer.Option("--version", help="Print the version.")] = False) -> None:
    if version:
        typer.echo(__version__)
        raise typer.Exit


def main() -> None:
    """Run the command line; errors of ours are told in one line, without a traceback."""
    signal.signal(signal.SIGTERM, _end)
    try:
        app(standalone_mode=True)
    except SystemExit as end:
        if end.code == INTERRUPTED:
            terminal.print("stopped; no file is half-written, and the same command can be given again")
        raise
    except ClearLinesError as error:
        tell(error)
        sys.exit(2)
    except OSError as error:
        where = None if error.filename is None else str(error.filename)
        tell(ClearLinesError(error.strerror or str(error), where=where))
        sys.exit(2)


def _end(number: int, _frame: FrameType | None) -> NoReturn:
    """End as after Ctrl-C: whatever is at work puts itself away."""
    sys.exit(128 + number)
