"""A real provider in a process of its own (the npm package oidc-provider), and somebody who signs in there."""

from __future__ import annotations

import hashlib
import json
import re
import shutil
import subprocess
from pathlib import Path
from urllib.parse import urljoin, urlsplit

import httpx2 as httpx

from build_frontend import node_environment, node_folder, run_npm

SOURCES = Path(__file__).parent / "provider_process"
KEPT = Path(__file__).parent.parent.parent / ".tools"
CLIENT = "clearlines"
SECRET = "a secret: with odd/characters+in it"


def installed() -> Path:
    """Return the folder with the provider and what it needs, fetched when it isn't there yet."""
    lock = SOURCES / "package-lock.json"
    folder = KEPT / f"openid-provider-{hashlib.sha256(lock.read_bytes()).hexdigest()[:12]}"
    if not (folder / "whole").is_file():
        folder.mkdir(parents=True, exist_ok=True)
        for name in ("package.json", "package-lock.json"):
            shutil.copy(SOURCES / name, folder)
        run_npm("ci", "--no-audit", "--no-fund", folder=folder)
        (folder / "whole").touch()
    shutil.copy(SOURCES / "provider.mjs", folder)
    return folder


def start_provider(redirect: str, people: dict[str, dict[str, object]]) -> tuple[subprocess.Popen[str], str]:
    """Start a provider; returns its process and its address."""
    command = [str(node_folder() / "bin" / "node"), "provider.mjs", redirect, json.dumps(people)]
    process = subprocess.Popen(
        command, cwd=installed(), env=node_environment(), stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    )
    assert process.stdout is not None
    address = process.stdout.readline().strip()
    assert address.startswith("http://"), "the provider didn't start"
    return process, address


def answer_of(person: str, address: str) -> str:
    """Sign in at the provider as its pages do, and return the address that it sends the browser back to."""
    with httpx.Client(follow_redirects=False) as browser:
        provider = urlsplit(address).netloc
        response = browser.get(address)
        for _ in range(12):
            if response.status_code in (302, 303):
                onward = urljoin(str(response.url), response.headers["location"])
                if urlsplit(onward).netloc != provider:
                    return onward
                response = browser.get(onward)
                continue
            assert response.status_code == 200, response.text
            action = re.search(r'action="([^"]+)"', response.text)
            prompt = re.search(r'name="prompt" value="(\w+)"', response.text)
            assert action is not None, response.text
            assert prompt is not None, response.text
            form = {"prompt": prompt[1], "login": person, "password": "any"}
            response = browser.post(urljoin(str(response.url), action[1]), data=form)
    raise AssertionError("the provider sends nobody back")
