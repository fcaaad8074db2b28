"""A hosted server behind the proxies of docs/examples, each as the example has it: TLS, addresses, sizes, headers."""

from __future__ import annotations

import datetime as dates
import ipaddress
import os
import shutil
import signal
import socket
import ssl
import subprocess
import sys
import time
import uuid
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import cv2
import httpx2 as httpx
import numpy as np
import pytest
from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.x509.oid import NameOID

from app.clock import utc_now
from app.commands.stores import opened_stores
from app.services.accounts import add_account
from app.services.events import Actor
from app.services.passwords import Passwords
from app.settings import Settings

PASSWORD = "seven grey herons"
FROM = "127.0.0.2"
EXAMPLES = Path(__file__).parents[2] / "docs" / "examples"
CADDY = str(Path(sys.executable).with_name("caddy"))
NGINX = shutil.which("nginx", path=f"{os.defpath}:/usr/sbin:/usr/local/sbin:{os.environ['PATH']}")


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


def caddy(folder: Path, pem: Path, public: int, behind: int) -> list[str]:
    """Write the example under a name and with a certificate that a test can have; return the command."""
    text = (EXAMPLES / "Caddyfile").read_text().replace("127.0.0.1:8765", f"127.0.0.1:{behind}")
    text = text.replace("lines.example.org {", f"https://127.0.0.1:{public} {{\n\ttls {pem} {pem}")
    text = text.replace("{\n\tservers", "{\n\tadmin off\n\tauto_https disable_redirects\n\tservers", 1)
    (folder / "Caddyfile").write_text(text)
    return [CADDY, "run", "--config", str(folder / "Caddyfile"), "--adapter", "caddyfile"]


def nginx(folder: Path, pem: Path, public: int, behind: int) -> list[str]:
    """Write the example under a name and with a certificate that a test can have; return the command."""
    text = (EXAMPLES / "nginx.conf").read_text().replace("127.0.0.1:8765", f"127.0.0.1:{behind}")
    text = text.partition("\nserver {\n    listen 80;")[0].replace("lines.example.org;", "127.0.0.1;")
    text = text.replace("    listen [::]:443 ssl http2;\n", "").replace("listen 443 ", f"listen 127.0.0.1:{public} ")
    for ending in ("pem", "key"):
        text = text.replace(f"/etc/ssl/lines.example.org.{ending}", str(pem))
    kept = ("client_body", "proxy", "fastcgi", "uwsgi", "scgi")
    places = "\n".join(f"{each}_temp_path {folder}/{each};" for each in kept)
    user = "user root;\n" if os.geteuid() == 0 else ""  # else its workers can't write into the folder
    (folder / "nginx.conf").write_text(
        f"{user}pid {folder}/nginx.pid;\nevents {{}}\nhttp {{\naccess_log off;\n{places}\n{text}}}\n"
    )
    return [str(NGINX), "-e", "stderr", "-c", str(folder / "nginx.conf"), "-g", "daemon off;"]


@contextmanager
def proxy(command: list[str], folder: Path, public: int) -> Iterator[None]:
    """Run a proxy, from when it listens."""
    home = {**os.environ, **dict.fromkeys(("HOME", "XDG_DATA_HOME", "XDG_CONFIG_HOME"), str(folder))}
    with (folder / "proxy.log").open("wb") as log:
        process = subprocess.Popen(command, env=home, stdout=log, stderr=log)
    try:
        deadline = time.monotonic() + 30
        while True:
            with suppress(OSError), socket.create_connection(("127.0.0.1", public)):
                break
            assert process.poll() is None, (folder / "proxy.log").read_text()
            assert time.monotonic() < deadline
            time.sleep(0.05)
        yield
    finally:
        process.terminate()
        process.wait(30)


@pytest.fixture(scope="module")
def ports() -> tuple[int, int]:
    """Two ports that nobody listens on: of the proxies, one after the other, and of the server behind them."""
    with socket.create_server(("127.0.0.1", 0)) as first, socket.create_server(("127.0.0.1", 0)) as second:
        return first.getsockname()[1], second.getsockname()[1]


@pytest.fixture(scope="module")
def server(ports: tuple[int, int], tmp_path_factory: pytest.TempPathFactory) -> Iterator[subprocess.Popen[str]]:
    """A hosted server with the admin ada."""
    public, behind = ports
    folder = tmp_path_factory.mktemp("hosted")
    with opened_stores(Settings(data_dir=folder)) as (database, _), database.write() as session:
        hashed = Passwords().hash_of(PASSWORD)
        add_account(session, "ada", "admin", utc_now(), Actor(None), password_hash=hashed)
    settings = {"DATA_DIR": str(folder), "LOG_FORMAT": "json", "WORKERS": "1"}
    command = [str(Path(sys.executable).with_name("clearlines")), "serve", "--no-browser", "--port", str(behind)]
    process = subprocess.Popen(
        [*command, "--public-url", f"https://127.0.0.1:{public}"],
        cwd=folder,
        env={**os.environ, **{f"CLEARLINES_{name}": value for name, value in settings.items()}},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        wait_for(process, behind)
        yield process
    finally:
        process.kill()
        process.communicate()


without_nginx = pytest.mark.skipif(NGINX is None, reason="no nginx here; the same is tried behind Caddy")


@pytest.fixture(scope="module", params=[caddy, pytest.param(nginx, marks=without_nginx)])
def browser(
    request: pytest.FixtureRequest,
    server: subprocess.Popen[str],
    ports: tuple[int, int],
    tmp_path_factory: pytest.TempPathFactory,
) -> Iterator[httpx.Client]:
    """A browser before one of the proxies, whose certificate it trusts."""
    public, behind = ports
    folder = tmp_path_factory.mktemp("proxy")
    pem = certificate(folder)
    trusting = ssl.create_default_context(cafile=str(pem))
    transport = httpx.HTTPTransport(verify=trusting, local_address=FROM)
    with (
        proxy(request.param(folder, pem, public, behind), folder, public),
        httpx.Client(base_url=f"https://127.0.0.1:{public}", transport=transport, timeout=30) as browser,
    ):
        yield browser


def signed_in(browser: httpx.Client, **headers: str) -> httpx.Response:
    given = {"name": "ada", "password": PASSWORD}
    return browser.post("/api/session", json=given, headers={"origin": home_of(browser), **headers})


def home_of(browser: httpx.Client) -> str:
    return str(browser.base_url).rstrip("/")


def test_people_sign_in_with_cookies_for_tls_alone(browser: httpx.Client) -> None:
    assert signed_in(browser, origin=home_of(browser).replace("https:", "http:")).status_code == 403
    answer = signed_in(browser, **{"sec-fetch-site": "same-origin", "x-forwarded-for": "203.0.113.5"})
    assert answer.status_code == 200, answer.text
    cookie = next(text for text in answer.headers.get_list("set-cookie") if text.startswith("clearlines_session="))
    for attribute in ("Secure", "HttpOnly", "SameSite=strict"):
        assert attribute in cookie
    assert browser.get("/api/me").json()["name"] == "ada"
    (mine,) = [each for each in browser.get("/api/account/sessions").json() if each["current"]]
    assert mine["address"] == FROM  # as the proxy saw it, not as the browser said


def test_headers_come_once_and_metrics_not_at_all(browser: httpx.Client) -> None:
    for path in ("/", "/api/health"):
        headers = browser.get(path).headers
        assert headers.get_list("strict-transport-security") == ["max-age=31536000"]
        for name in ("content-security-policy", "x-content-type-options", "x-request-id"):
            assert len(headers.get_list(name)) == 1, name
    assert browser.get("/metrics").status_code == 404
    assert browser.get("/api/metrics").status_code == 404


def test_an_image_of_several_megabytes_comes_in(browser: httpx.Client) -> None:
    assert signed_in(browser).status_code == 200
    noise = np.random.default_rng(0).integers(0, 256, (700, 1000, 3), np.uint8)
    image = cv2.imencode(".png", noise)[1].tobytes()
    assert len(image) > 2_000_000
    own_page = {"origin": home_of(browser)}
    made = browser.post("/api/datasets", json={"name": uuid.uuid4().hex}, headers=own_page).raise_for_status()
    files = [("files", ("noise.png", image, "image/png"))]
    answer = browser.post(f"/api/datasets/{made.json()['slug']}/images", files=files, headers=own_page)
    assert [added["name"] for added in answer.json()["added"]] == ["noise"]


def test_a_stop_waits_for_nobody_and_tells_no_secrets(server: subprocess.Popen[str], ports: tuple[int, int]) -> None:
    """The last one: it ends the server."""
    _, behind = ports
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
    assert "clearlines_session" not in said


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
