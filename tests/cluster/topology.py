"""The services of ``docker-compose.yml`` as plain processes on loopback: started, killed and started again by a test.

The commands are those of the file, with loopback addresses for the names of services. PostgreSQL comes from the
fixture ``postgres_server``. Servers answer in local mode, where the one person at the machine may do everything.
"""

from __future__ import annotations

import os
import re
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import httpx2 as httpx
import psutil
import yaml

PROJECT = Path(__file__).resolve().parents[2]
COMPOSE = PROJECT / "docker-compose.yml"
DEADLINE = 90.0


def free_port() -> int:
    """Return a port that nobody listens on right now."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def compose_services(variables: Mapping[str, str]) -> dict[str, Any]:
    """Return the services of the compose file, variables put in."""

    def value(match: re.Match[str]) -> str:
        given = variables.get(match["name"])
        return given if given is not None else match["default"] or ""

    pattern = re.compile(r"\$\{(?P<name>\w+)(?::[-?](?P<default>[^}]*))?\}")
    return yaml.safe_load(pattern.sub(value, COMPOSE.read_text()))["services"]


def eventually(condition: Callable[[], Any], what: str, *, seconds: float = DEADLINE) -> Any:
    """Wait until a condition holds, and return its value."""
    deadline = time.monotonic() + seconds
    while not (value := condition()):
        assert time.monotonic() < deadline, f"never happened: {what}"
        time.sleep(0.1)
    return value


@dataclass
class Part:
    """One process of the topology: ``app-1``, ``app-2``, ``scheduler``, ``worker-1``, ...

    Attributes:
        command: As in the compose file, on loopback.
        environment: All of it.
        log: What it wrote.
    """

    name: str
    command: list[str]
    environment: dict[str, str]
    log: Path
    process: subprocess.Popen[bytes] | None = None

    def start(self) -> None:
        """Start it; doesn't wait until it answers."""
        assert self.process is None or self.process.poll() is not None, f"{self.name} runs"
        with self.log.open("ab") as log:
            self.process = subprocess.Popen(
                self.command, stdout=log, stderr=log, env=self.environment, cwd="/", start_new_session=True
            )

    def kill(self) -> None:
        """Kill it as ``kill -9`` does; its child processes are left to themselves."""
        self._end(signal.SIGKILL)

    def stop(self) -> None:
        """Stop it as ``docker stop`` does."""
        self._end(signal.SIGTERM)

    def restart(self) -> None:
        """Start it again, as a restart policy does."""
        self.start()

    def children(self) -> list[psutil.Process]:
        """Return the processes below it that Python started for work."""
        if self.process is None or self.process.poll() is not None:
            return []
        found = psutil.Process(self.process.pid).children(recursive=True)
        return [child for child in found if "spawn_main" in " ".join(child.cmdline())]

    def text(self) -> str:
        """Return what it wrote."""
        return self.log.read_text() if self.log.exists() else ""

    def tell(self, number: signal.Signals) -> None:
        """Send it a signal, and don't wait for what comes of it."""
        if self.process is not None and self.process.poll() is None:
            self.process.send_signal(number)

    def _end(self, number: signal.Signals) -> None:
        if self.process is not None and self.process.poll() is None:
            self.process.send_signal(number)
            try:
                self.process.wait(30)
            except subprocess.TimeoutExpired:
                self.process.kill()
                self.process.wait()


@dataclass
class Topology:
    """Scheduler, workers and servers over one PostgreSQL.

    Attributes:
        database_url: Of an empty database of its own.
        folder: Data of the servers, logs.
        settings: Further environment of the servers: ``CLEARLINES_TASK_SECONDS`` and the like.
        servers: Number of servers.
        workers: Number of worker commands; each has one worker process.
    """

    database_url: str
    folder: Path
    settings: Mapping[str, str] = field(default_factory=dict)
    servers: int = 2
    workers: int = 2
    worker_environment: Mapping[str, str] = field(default_factory=dict)
    parts: dict[str, Part] = field(default_factory=dict)
    ports: dict[str, int] = field(default_factory=dict)

    def __post_init__(self) -> None:
        services = compose_services({"CLEARLINES_PUBLIC_URL": ""})
        self.folder.mkdir(parents=True, exist_ok=True)
        self.ports["scheduler"] = free_port()
        self._add("scheduler", services["scheduler"]["command"], {})
        for place in range(1, self.workers + 1):
            self._add(f"worker-{place}", services["worker"]["command"], dict(self.worker_environment))
        for place in range(1, self.servers + 1):
            name = f"app-{place}"
            self.ports[name] = free_port()
            environment = {
                **services["app"]["environment"],
                "CLEARLINES_DATA_DIR": str(self.folder / "data"),
                "CLEARLINES_DATABASE_URL": self.database_url,
                "CLEARLINES_HEARTBEAT_SECONDS": "0.5",
                "CLEARLINES_LOG_LEVEL": "info",
                "TMPDIR": str(self.folder),
                **self.settings,
            }
            for left_out in ("CLEARLINES_SECRETS_DIR", "CLEARLINES_PUBLIC_URL", "CLEARLINES_TRUSTED_PROXIES"):
                environment.pop(left_out)
            self._add(name, services["app"]["command"], environment)

    def start(self) -> None:
        """Start everything and wait until all servers see all workers."""
        self.part("scheduler").start()
        for name in [*self.named("worker"), *self.named("app")]:
            self.part(name).start()
        for name in self.named("app"):
            self.wait_for_server(name)
            self.wait_for_workers(name)

    def wait_for_workers(self, name: str, seen: int | None = None) -> None:
        """Wait until so many workers have joined a server since it was first started; as many as there are if unset."""
        wanted = len(self.named("worker")) if seen is None else seen
        eventually(lambda: self.joined(name) >= wanted, f"{name} sees {wanted} workers")

    def joined(self, name: str) -> int:
        """Return how many workers have joined a server since it was first started."""
        return self.part(name).text().count("of the cluster joined")

    def part(self, name: str) -> Part:
        """Return one process."""
        return self.parts[name]

    def named(self, prefix: str) -> list[str]:
        """Return the names of all servers (``app``) or all workers (``worker``)."""
        return [name for name in self.parts if name.startswith(prefix)]

    def kill(self, name: str) -> None:
        """Kill a process with -9."""
        self.part(name).kill()

    def restart(self, name: str) -> None:
        """Start a process again that was killed; returns once a server answers."""
        self.part(name).restart()
        if name.startswith("app"):
            self.wait_for_server(name)

    def stop(self) -> None:
        """Stop everything: servers first."""
        for names in (self.named("app"), [*self.named("worker"), "scheduler"]):
            for name in names:
                self.part(name).tell(signal.SIGTERM)
            for name in names:
                self.part(name).stop()

    def end(self) -> None:
        """Kill everything that is left."""
        for part in self.parts.values():
            part.kill()

    def address(self, name: str) -> str:
        """Return the address of a server."""
        return f"http://127.0.0.1:{self.ports[name]}"

    def client(self, name: str) -> httpx.Client:
        """Return a client of a server's API; to be closed by whoever asked for it."""
        return httpx.Client(base_url=f"{self.address(name)}/api", timeout=30)

    def get(self, name: str, path: str) -> Any:
        """Return what a server answers, as JSON."""
        with self.client(name) as client:
            answer = client.get(path)
            assert answer.is_success, answer.text
            return answer.json()

    def wait_for_server(self, name: str) -> None:
        """Wait until a server answers."""
        part = self.part(name)

        def answers() -> bool:
            assert part.process is None or part.process.poll() is None, part.text()
            try:
                return httpx.get(f"{self.address(name)}/api/health", timeout=5).is_success
            except httpx.TransportError:
                return False

        eventually(answers, f"{name} answers")

    def _add(self, name: str, command: list[str], environment: dict[str, str]) -> None:
        at = {"scheduler": f"127.0.0.1:{self.ports['scheduler']}"}
        own = {"0.0.0.0": "127.0.0.1", "8786": str(self.ports["scheduler"]), "8765": str(self.ports.get(name, 0))}
        program, *arguments = command
        assert program == "clearlines"
        arguments = [own.get(each, each).replace("scheduler:8786", at["scheduler"]) for each in arguments]
        clean = {key: value for key, value in os.environ.items() if not key.startswith("CLEARLINES_")}
        local = {key: value.replace("scheduler:8786", at["scheduler"]) for key, value in environment.items()}
        self.parts[name] = Part(
            name,
            [str(Path(sys.executable).with_name("clearlines")), *arguments],
            {**clean, "OMP_NUM_THREADS": "1", **local},
            self.folder / f"{name}.log",
        )
