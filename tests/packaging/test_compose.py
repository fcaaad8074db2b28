"""The compose files: read by `docker compose` and `docker-compose` where they are, and looked through everywhere."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest
import yaml
from typer.main import get_command

from app.cli import app
from app.settings import Settings

ROOT = Path(__file__).resolve().parents[2]
HOSTED = ROOT / "docker-compose.yml"
SMALL = ROOT / "docker-compose.small.yml"
OURS = ("app", "app-two", "scheduler", "worker")


def compose(path: Path = HOSTED) -> dict[str, Any]:
    return yaml.safe_load(path.read_text())


def services() -> dict[str, dict[str, Any]]:
    return compose()["services"]


def test_the_hosted_form_has_its_parts() -> None:
    assert set(services()) == {*OURS, "postgres"}
    assert services()["app-two"]["profiles"] == ["two"]
    assert services()["worker"]["deploy"]["replicas"] == 2
    differing = {"command", "ports", "profiles"}
    first, second = (
        {key: value for key, value in services()[name].items() if key not in differing} for name in OURS[:2]
    )
    assert first == second
    assert services()["app"]["command"] == services()["app-two"]["command"]


@pytest.mark.parametrize("name", [*OURS, "postgres"])
def test_each_part_comes_back_and_says_how_it_is(name: str) -> None:
    service = services()[name]
    assert service["restart"] == "unless-stopped"
    assert service["healthcheck"]["test"][0] == "CMD"
    assert {"interval", "timeout", "retries", "start_period"} <= set(service["healthcheck"])
    assert re.fullmatch(r"\d+s", service["stop_grace_period"])
    assert service["read_only"] is True
    assert "no-new-privileges:true" in service["security_opt"]


@pytest.mark.parametrize("name", OURS)
def test_each_of_our_parts_runs_a_command_that_there_is(name: str) -> None:
    service = services()[name]
    program, command, *arguments = service["command"]
    assert program == "clearlines"
    found = get_command(app).commands[command]  # type: ignore[attr-defined]
    found.make_context(command, list(arguments))
    assert service["cap_drop"] == ["ALL"]
    assert not service.get("privileged")


def test_who_depends_on_whom() -> None:
    healthy = {"condition": "service_healthy"}
    for name in ("app", "app-two"):
        assert services()[name]["depends_on"] == {"postgres": healthy, "scheduler": healthy}
    assert services()["worker"]["depends_on"] == {"scheduler": healthy}


def test_the_scheduler_and_the_database_are_reached_from_inside_alone() -> None:
    assert compose()["networks"]["inside"] == {"internal": True}
    for name in ("scheduler", "worker", "postgres"):
        assert services()[name]["networks"] == ["inside"]
        assert "ports" not in services()[name]
    for name in ("app", "app-two"):
        (published,) = services()[name]["ports"]
        assert published.startswith("127.0.0.1:")
        (subnet,) = compose()["networks"]["outside"]["ipam"]["config"]
        assert services()[name]["environment"]["CLEARLINES_TRUSTED_PROXIES"] == subnet["gateway"]


def test_workers_are_given_no_settings_and_no_secrets() -> None:
    for name in ("scheduler", "worker"):
        assert not {"environment", "secrets", "volumes", "env_file"} & set(services()[name])


def test_settings_exist_and_secrets_are_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    environment = services()["app"]["environment"]
    for key in environment:
        if key.startswith("CLEARLINES_") and key != "CLEARLINES_SECRETS_DIR":
            assert key.removeprefix("CLEARLINES_").lower() in Settings.model_fields, key
    secrets = compose()["secrets"]
    used = {secret for service in services().values() for secret in service.get("secrets", [])}
    assert used == set(secrets)
    assert all(secret["file"].startswith("./secrets/") for secret in secrets.values())
    assert "secrets" in (ROOT / ".dockerignore").read_text().split()
    told = [key for service in services().values() for key in service.get("environment", {}) if "PASSWORD" in key]
    assert told == ["POSTGRES_PASSWORD_FILE"]
    (tmp_path / services()["app"]["secrets"][0]).write_text("postgresql://clearlines:secret@postgres/clearlines\n")
    monkeypatch.setenv("CLEARLINES_SECRETS_DIR", str(tmp_path))
    assert Settings().database_url == "postgresql://clearlines:secret@postgres/clearlines"


def test_what_is_mounted_is_declared() -> None:
    declared = compose()
    mounts = [mount.split(":")[0] for service in services().values() for mount in service.get("volumes", [])]
    assert {mount for mount in mounts if not mount.startswith(".")} == set(declared["volumes"])
    for service in services().values():
        assert set(service["networks"]) <= set(declared["networks"])


def test_the_small_form_is_one_process_on_loopback() -> None:
    (service,) = compose(SMALL)["services"].values()
    assert service["network_mode"] == "host"
    assert "ports" not in service
    assert "command" not in service
    image = (ROOT / "Dockerfile").read_text()
    assert 'CMD ["clearlines", "serve", "--port", "8765", "--no-browser"]' in image
    assert "USER clearlines" in image


def _engine() -> list[str] | None:
    """The command that reads compose files, where one is installed."""
    docker = shutil.which("docker")
    if docker and subprocess.run([docker, "compose", "version"], capture_output=True).returncode == 0:
        return [docker, "compose"]
    single = shutil.which("docker-compose")
    return [single] if single else None


@pytest.mark.parametrize("path", [HOSTED, SMALL], ids=["hosted", "small"])
def test_an_engine_reads_the_files(path: Path) -> None:
    command = _engine()
    if command is None:
        pytest.skip("neither `docker compose` nor `docker-compose` here: the tests above look through the files")

    def read(public_url: str) -> subprocess.CompletedProcess[str]:
        environment = {**os.environ, "CLEARLINES_PUBLIC_URL": public_url}
        options = ["--file", str(path), "--profile", "two", "config"]
        return subprocess.run([*command, *options], capture_output=True, text=True, env=environment)

    found = read("https://lines.example.org")
    assert found.returncode == 0, found.stderr
    assert set(yaml.safe_load(found.stdout)["services"]) == set(compose(path)["services"])
    if path == HOSTED:
        refused = read("")
        assert refused.returncode != 0
        assert "the address of the proxy" in refused.stderr


def test_the_two_forms_share_no_files() -> None:
    """Else the server of one would take the images of the other for forgotten ones, and remove them."""
    assert not set(compose()["volumes"]) & set(compose(SMALL)["volumes"])
    assert "VOLUME" not in (ROOT / "Dockerfile").read_text().replace("# no VOLUME", "")
