"""An S3-compatible server: a process of its own that asks for credentials."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
import time
import urllib.request
import uuid
from pathlib import Path
from typing import Any

OBJECT_SERVER = "from moto.server import main; main()"
UNASKED = ("CreateUser", "CreateAccessKey", "PutUserPolicy")
"""Actions of the identity service that need no credentials yet: they make some."""


class ObjectServer:
    """A process of moto's server, which forgets everything when it ends.

    Attributes:
        address: Its URL, the same after each start.
        options: Of a file system for it: the address and good credentials.
    """

    def __init__(self, log: Path) -> None:
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        self.address = f"http://127.0.0.1:{self.port}"
        self.options: dict[str, str] = {}
        self._log = log

    def start(self) -> None:
        environment = {**os.environ, "INITIAL_NO_AUTH_ACTION_COUNT": str(len(UNASKED))}
        command = [sys.executable, "-c", OBJECT_SERVER, "-H", "127.0.0.1", "-p", str(self.port)]
        with self._log.open("ab") as log:
            self._process = subprocess.Popen(command, env=environment, stdout=log, stderr=log)
        deadline = time.monotonic() + 60
        while not self._listens():
            assert self._process.poll() is None, self._log.read_text()
            assert time.monotonic() < deadline, "moto's server didn't start"
            time.sleep(0.02)
        self._make_credentials()

    def _listens(self) -> bool:
        with socket.socket() as asking:
            return asking.connect_ex(("127.0.0.1", self.port)) == 0

    def _make_credentials(self) -> None:
        everything = {"Version": "2012-10-17", "Statement": [{"Effect": "Allow", "Action": "s3:*", "Resource": "*"}]}
        urllib.request.urlopen(f"{self.address}/moto-api/seed?a=1", data=b"").close()  # the same ones after each start
        identities = self._client("iam", "nobody", "nothing")
        identities.create_user(UserName="clearlines")
        made = identities.create_access_key(UserName="clearlines")["AccessKey"]
        key, secret = made["AccessKeyId"], made["SecretAccessKey"]
        identities.put_user_policy(UserName="clearlines", PolicyName="blobs", PolicyDocument=json.dumps(everything))
        identities.close()
        self.options = {"endpoint_url": self.address, "key": key, "secret": secret}
        self._objects = self._client("s3", key, secret)

    def _client(self, service: str, key: str, secret: str) -> Any:
        import boto3  # takes long

        given = {"aws_access_key_id": key, "aws_secret_access_key": secret, "region_name": "us-east-1"}
        return boto3.client(service, endpoint_url=self.address, **given)

    def make_bucket(self, name: str | None = None) -> str:
        """Make an empty bucket and return its name."""
        bucket = name or f"blobs-{uuid.uuid4().hex[:12]}"
        self._objects.create_bucket(Bucket=bucket)
        return bucket

    def remove_bucket(self, name: str) -> None:
        """Remove a bucket that is empty."""
        self._objects.delete_bucket(Bucket=name)

    def send(self, number: signal.Signals) -> None:
        self._process.send_signal(number)
        if number == signal.SIGKILL:
            self._process.wait()
