"""A worker process that takes longer to start than it may: it is ended before another one is started."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import psutil

Eventually = Callable[[Callable[[], Any], str], Any]
COMMAND = """
import app.commands.cluster as command

command.START_SECONDS, command.AGAIN_PAUSE = 1.5, 0.05
command.run_workers({address!r}, 1, megabytes=None, announce=print)
"""
HELD_UP = """
import sys, time

if any("spawn_main" in argument for argument in sys.orig_argv):
    time.sleep(600)
"""


def test_a_worker_that_starts_too_slowly_is_ended(cluster: Any, tmp_path: Path, eventually: Eventually) -> None:
    address = f"tcp://127.0.0.1:{cluster.ports['scheduler']}"
    script = tmp_path / "slow.py"
    script.write_text(f'if __name__ == "__main__":{COMMAND.format(address=address)}'.replace("\n", "\n    "))
    (tmp_path / "sitecustomize.py").write_text(HELD_UP)
    environment = {**os.environ, "PYTHONPATH": str(tmp_path)}
    with (tmp_path / "log").open("wb") as log:
        process = subprocess.Popen([sys.executable, str(script)], env=environment, stdout=log, stderr=log)
    seen: set[int] = set()

    def working() -> list[psutil.Process]:
        found = psutil.Process(process.pid).children(recursive=True)
        return [child for child in found if "spawn_main" in " ".join(child.cmdline())]

    def several() -> bool:
        now = [child.pid for child in working()]
        assert len(now) <= 1
        seen.update(now)
        return len(seen) >= 2

    try:
        eventually(several, "it is tried again")
        left = working()
        process.send_signal(signal.SIGTERM)
        assert process.wait(30) == 0, (tmp_path / "log").read_text()
        assert not psutil.wait_procs(left, timeout=30)[1]
        assert (tmp_path / "log").read_text().count("it took more than 1.5 s to start") == 1
    finally:
        process.kill()
        process.wait()
