"""Schedulers and workers, and servers over PostgreSQL where they are needed: started once, for all tests."""

from __future__ import annotations

import importlib.util
import os
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import psycopg
import pytest
from sqlalchemy import make_url

from app.db.session import Database

HERE = Path(__file__).parent


def _topology_module() -> Any:
    sys.path.insert(0, str(HERE))
    try:
        return importlib.import_module("topology")
    finally:
        sys.path.remove(str(HERE))


@pytest.fixture(scope="session")
def gate(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where the workers' gated tasks say that they wait, and are let through."""
    return tmp_path_factory.mktemp("gate")


@pytest.fixture(scope="session")
def topology(postgres_server: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    """Everything running: scheduler, two workers, two servers over one PostgreSQL."""
    name = f"clearlines_topology_{os.getpid()}"
    address = make_url(postgres_server).set(database=name).render_as_string(hide_password=False)
    with psycopg.connect(postgres_server, autocommit=True) as connection:
        connection.execute(f"CREATE DATABASE {name}".encode())
    topology = _topology_module().Topology(address, tmp_path_factory.mktemp("topology"))
    try:
        topology.start()
        yield topology
    finally:
        topology.end()
        with psycopg.connect(postgres_server, autocommit=True) as connection:
            connection.execute(f"DROP DATABASE {name} WITH (FORCE)".encode())


@pytest.fixture(scope="session")
def cluster(tmp_path_factory: pytest.TempPathFactory, gate: Path) -> Iterator[Any]:
    """A scheduler and two workers that know the tasks of tests/jobs, and ``old``, one that isn't; without servers."""
    tasks = {"PYTHONPATH": str(HERE.parent / "jobs"), "TEST_GATE": str(gate)}
    folder = tmp_path_factory.mktemp("cluster")
    topology = _topology_module()
    cluster = topology.Topology("", folder, servers=0, worker_environment=tasks)
    (folder / "sitecustomize.py").write_text("import app\napp.__version__ = '0.0.1'\n")
    worker = cluster.part("worker-1")
    old = {**worker.environment, "PYTHONPATH": str(folder)}
    cluster.parts["old"] = topology.Part("old", worker.command, old, folder / "old.log")
    try:
        cluster.start()
        cluster.part("old").start()
        yield cluster
    finally:
        cluster.end()


def _yards() -> Any:
    """The yards of tests/jobs, where dispatchers of the test's own process work."""
    spec = importlib.util.spec_from_file_location("yards_of_jobs", HERE.parent / "jobs" / "conftest.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # its data classes look their annotations up there
    spec.loader.exec_module(module)
    return module


@pytest.fixture(autouse=True)
def _tasks_by_name(monkeypatch: pytest.MonkeyPatch) -> None:
    """Find the tasks of tests/jobs by the name under which workers find them."""
    monkeypatch.syspath_prepend(str(HERE.parent / "jobs"))


@pytest.fixture
def small_yard(sqlite_database: Database, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """A yard as in tests/jobs, on SQLite alone."""
    return _yards().make_yard(sqlite_database, tmp_path, monkeypatch)


@pytest.fixture
def eventually() -> Callable[[Callable[[], Any], str], Any]:
    """Waits until a condition holds, up to a deadline, and returns its value."""
    return _topology_module().eventually
