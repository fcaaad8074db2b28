"""A server that others reach: not before somebody may let them in, and then behind a proxy that ends TLS."""

from __future__ import annotations

import datetime as dates
import ipaddress
import os
import signal
import socket
import ssl
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import httpx2 as httpx
import pytest
from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.x509.oid import NameOID

from app.clock import utc_now
from app.commands.hosting import require_admin
from app.commands.stores import opened_stores
from app.errors import Forbidden
from app.services.accounts import add_account
from app.services.events import Actor
from app.services.passwords import Passwords
from app.settings import Settings

PASSWORD = "seven grey herons"
FROM = "127.0.0.2"
EXAMPLE = Path(__file__).parent.parent.parent / "docs" / "examples" / "Caddyfile"
CADDY = str(Path(sys.executable).with_name("caddy"))


@pytest.mark.parametrize("option", [("--host", "0.0.0.0"), ("--public-url", "https://lines.example.org")])
def test_others_are_not_let_in_before_there_is_an_admin(clearlines: Any, option: tuple[str, str]) -> None:
    said = clearlines("serve", *option, "--port", 0, status=2).stderr
    assert "clearlines user create NAME --role admin" in said
    assert "ClearLines is at" not in said


def test_an_admin_who_may_not_come_in_lets_nobody_in(tmp_path: Path) -> None:
    settings = Settings(data_dir=tmp_path, host="0.0.0.0")
    with opened_stores(settings) as (database, _), database.write() as session:
        add_account(session, "ada", "maintainer", utc_now(), Actor(None))
        add_account(session, "bea", "admin", utc_now(), Actor(None)).disabled_at = utc_now()
    with pytest.raises(Forbidden, match="no account"):
        require_admin(settings)
    with opened_stores(settings) as (database, _), database.write() as session:
        add_account(session, "cid", "admin", utc_now(), Actor(None))
    require_admin(settings)


def certificate(folder: Path) -> Path:
    """Make a key and a certificate of 127.0.0.1, in one file."""
    key = ec.generate_private_key(ec.SECP256R1())
    name = x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, "127.0.0.1")])
    now = dates.datetime.now(dates.UTC)
    made = (
        x509.CertificateBuilder()
        .subject_name(name)
        .issuer_name(name)
        .public_key(key.public_key())
        .serial_number(x509.random_serial_number())
        .not_valid_before(now - dates.timedelta(days=1))
        .not_valid_after(now + dates.timedelta(days=1))
        .add_extension(x509.SubjectAlternativeName([x509.IPAddress(ipaddress.ip_address("127.0.0.1"))]), critical=False)
        .add_extension(x509.BasicConstraints(ca=True, path_length=None), critical=True)
        .sign(key, hashes.SHA256())
    )
    private = key.private_bytes(
        serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
    )
    path = folder / "certificate.pem"
    path.write_bytes(private + made.public_bytes(serialization.Encoding.PEM))
    return path


@pytest.fixture
def ports() -> tuple[int, int]:
    """Two ports that nobody listens on: of the proxy, and of the server behind it."""
    with socket.create_server(("127.0.0.1", 0)) as first, socket.create_server(("127.0.0.1", 0)) as second:
        return first.getsockname()[1], second.getsockname()[1]


@pytest.fixture
def start_proxy(tmp_path: Path, ports: tuple[int, int]) -> Iterator[Callable[[], None]]:
    """Start Caddy as the example has it, under a name and with a certificate that a test can have."""
    public, behind = ports
    started: list[subprocess.Popen[bytes]] = []

    def start_proxy() -> None:
        pem = certificate(tmp_path)
        text = EXAMPLE.read_text().replace("127.0.0.1:8765", f"127.0.0.1:{behind}")
        text = text.replace("lines.example.org {", f"https://127.0.0.1:{public} {{\n\ttls {pem} {pem}")
        text = text.replace("{\n\tservers", "{\n\tadmin off\n\tauto_https disable_redirects\n\tservers", 1)
        (tmp_path / "Caddyfile").write_text(text)
        command = [CADDY, "run", "--config", str(tmp_path / "Caddyfile"), "--adapter", "caddyfile"]
        home = {**os.environ, "HOME": str(tmp_path), "XDG_DATA_HOME": str(tmp_path), "XDG_CONFIG_HOME": str(tmp_path)}
        started.append(subprocess.Popen(command, env=home, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))
        deadline = time.monotonic() + 30
        while True:
            with suppress(OSError), socket.create_connection(("127.0.0.1", public)):
                return
            assert started[0].poll() is None
            assert time.monotonic() < deadline
            time.sleep(0.05)

    yield start_proxy
    for process in started:
        process.terminate()
        process.wait(30)


def test_behind_a_proxy_with_tls_people_sign_in_and_a_stop_waits_for_nobody(
    start: Callable[..., subprocess.Popen[str]],
    start_proxy: Callable[[], None],
    ports: tuple[int, int],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    public, behind = ports
    home = f"https://127.0.0.1:{public}"
    with opened_stores(Settings(data_dir=tmp_path / "data")) as (database, _), database.write() as session:
        hashed = Passwords().hash_of(PASSWORD)
        add_account(session, "ada", "admin", utc_now(), Actor(None), password_hash=hashed)
    monkeypatch.setenv("CLEARLINES_LOG_FORMAT", "json")
    server = start("serve", "--public-url", home, "--no-browser", "--port", behind)
    wait_for(server, behind)
    start_proxy()
    trusting = ssl.create_default_context(cafile=str(tmp_path / "certificate.pem"))
    transport = httpx.HTTPTransport(verify=trusting, local_address=FROM)
    with httpx.Client(base_url=home, transport=transport, timeout=30) as browser:
        own_page = {"origin": home, "sec-fetch-site": "same-origin", "x-forwarded-for": "203.0.113.5"}
        given = {"name": "ada", "password": PASSWORD}
        plain = {"origin": home.replace("https:", "http:")}
        assert browser.post("/api/session", json=given, headers=plain).status_code == 403
        answer = browser.post("/api/session", json=given, headers=own_page)
        assert answer.status_code == 200, answer.text
        cookie = next(text for text in answer.headers.get_list("set-cookie") if text.startswith("clearlines_session="))
        for attribute in ("Secure", "HttpOnly", "SameSite=strict"):
            assert attribute in cookie
        assert answer.headers["strict-transport-security"] == "max-age=31536000"
        assert browser.get("/api/me").json()["name"] == "ada"
        (mine,) = browser.get("/api/account/sessions").json()
        assert mine["address"] == FROM  # as the proxy saw it, not as the browser said
        assert browser.get("/metrics").status_code == 404
        assert "server" not in httpx.get(f"http://127.0.0.1:{behind}/api/health").headers
        # somebody who sends half a request and waits doesn't keep it from ending
        with socket.create_connection(("127.0.0.1", behind)) as waiting:
            waiting.sendall(b"POST /api/datasets HTTP/1.1\r\nHost: localhost\r\n")
            server.send_signal(signal.SIGTERM)
            _, said = server.communicate(timeout=60)
    assert server.returncode == 128 + signal.SIGTERM
    assert "Traceback" not in said
    assert '"path": "/api/session"' in said
    assert PASSWORD not in said
    assert cookie.partition("=")[2].partition(";")[0] not in said


def wait_for(server: subprocess.Popen[str], port: int) -> None:
    deadline = time.monotonic() + 90
    while True:
        try:
            if httpx.get(f"http://127.0.0.1:{port}/api/ready", timeout=30).status_code == 200:
                return
        except httpx.HTTPError:
            assert server.poll() is None, server.communicate()
        assert time.monotonic() < deadline
        time.sleep(0.1)
