"""Every knob of the service; each is also an environment variable with the prefix ``CLEARLINES_``."""

from __future__ import annotations

import ipaddress
import os
from datetime import timedelta
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Self
from urllib.parse import urlsplit

import platformdirs
from pydantic import Field, SecretStr, model_validator
from pydantic_settings import BaseSettings, SettingsConfigDict

if TYPE_CHECKING:
    from sqlalchemy import URL

MEBIBYTE = 2**20
LOOPBACK_NAMES = frozenset({"localhost"})


def is_loopback(host: str) -> bool:
    """Whether an address to listen on can be reached from this machine alone."""
    try:
        return ipaddress.ip_address(host.strip("[]")).is_loopback
    except ValueError:
        return host.lower() in LOOPBACK_NAMES


class Settings(BaseSettings):
    """Where things lie, what is allowed, how work is done.

    ``CLEARLINES_DATA_DIR=/srv/clearlines CLEARLINES_WORKERS=8 clearlines serve`` sets two of them. With
    ``CLEARLINES_SECRETS_DIR=/run/secrets`` the file ``/run/secrets/clearlines_database_url`` sets another one, so that
    no secret need stand in the environment.
    """

    model_config = SettingsConfigDict(env_prefix="CLEARLINES_", frozen=True, extra="forbid")

    def __init__(self, **given: Any) -> None:
        given.setdefault("_secrets_dir", os.environ.get("CLEARLINES_SECRETS_DIR"))
        super().__init__(**given)

    data_dir: Path = Field(
        default_factory=lambda: platformdirs.user_data_path("clearlines", appauthor=False),
        description="Folder of the database and of the uploaded files.",
    )
    database_url: str | None = Field(
        default=None,
        repr=False,
        description="sqlite:///FILE or postgresql://USER@HOST/NAME; an SQLite file in data_dir if unset.",
    )
    host: str = Field(default="127.0.0.1", description="Address to listen on.")
    port: int = Field(default=8765, ge=0, le=65535, description="Port to listen on; 0 takes a free one.")
    person: str = Field(default="owner", min_length=1, max_length=200, description="Whose decisions are stored.")

    public_url: str | None = Field(
        default=None,
        description="https://lines.example.org where a proxy serves it to others; accounts are required then.",
    )
    allowed_hosts: list[str] = Field(default=[], description="Further names that it is asked under.")
    trusted_proxies: str = Field(
        default="127.0.0.1", description="Whose X-Forwarded-For and -Proto count: addresses, or networks, with commas."
    )
    cors_origins: list[str] = Field(default=[], description="Other sites whose pages may ask, with a token; none.")
    anonymous_role: Literal["admin", "reader"] | None = Field(
        default=None, description="Who asks without an account or token; admin in local mode and reader else if unset."
    )

    session_days: float = Field(default=30, gt=0, description="How long a browser stays signed in.")
    session_idle_days: float = Field(default=7, gt=0, description="How long it does when nobody uses it.")
    invitation_days: float = Field(default=7, gt=0, description="How long an invitation is good.")
    sign_in_limit: str = Field(default="5/minute;30/hour", description="Failed sign-ins per account and per address.")
    request_limit: str = Field(default="6000/minute", description="Requests per account, or per address without one.")
    upload_limit: str = Field(default="240/hour", description="Uploads per account, or per address without one.")
    openid_issuer: str | None = Field(default=None, description="OpenID Connect: the provider, https://id.example.org.")
    openid_client_id: str | None = Field(default=None, description="OpenID Connect: what the provider calls us.")
    openid_client_secret: SecretStr | None = Field(default=None, description="OpenID Connect: our secret there.")
    openid_name: str = Field(default="OpenID Connect", description="What the button to sign in with it says.")
    openid_role: Literal["reader", "submitter", "annotator"] | None = Field(
        default=None,
        description="Role of whoever comes from there for the first time; they need an invitation if unset.",
    )

    log_format: Literal["text", "json"] = Field(default="text", description="One line of text, or of JSON, per event.")
    log_level: Literal["debug", "info", "warning", "error"] | None = Field(
        default=None, description="What is logged; warning in local mode and info else if unset."
    )
    metrics_token: SecretStr | None = Field(default=None, description="Bearer token that may read /metrics.")

    blob_url: str | None = Field(
        default=None, description="Where uploaded files lie: any address of fsspec, s3://BUCKET/PREFIX; in data_dir."
    )
    blob_options: dict[str, Any] = Field(
        default={}, repr=False, description='Options of it, JSON: {"endpoint_url": "http://..."}.'
    )
    backup_dir: Path | None = Field(
        default=None, description="Where backups before an upgrade go; in data_dir if unset."
    )

    cluster: str | None = Field(default=None, description="Dask scheduler, tcp://HOST:8786; processes here if unset.")
    worker_megabytes: int | None = Field(
        default=None, ge=256, description="A worker that holds more memory is replaced; unbounded if unset."
    )
    task_seconds: float = Field(
        default=900.0, gt=0, description="A task of a worker that takes longer is taken for hung, and tried again."
    )
    workers: int | None = Field(default=None, ge=1, description="Processes of the pipeline; one per core if unset.")
    heartbeat_seconds: float = Field(default=5.0, gt=0, description="How often work in progress says that it lives.")
    stale_seconds: float = Field(default=30.0, gt=0, description="Without a heartbeat for so long, work is taken back.")
    max_attempts: int = Field(default=3, ge=1, description="Tries per image before it counts as failed.")

    grace_days: int = Field(default=7, ge=0, description="How long what was deleted can be restored.")

    max_image_pixels: int = Field(default=40_000_000, ge=1, description="Width times height of one image.")
    max_upload_bytes: int = Field(default=2048 * MEBIBYTE, ge=1, description="Size of one request's body.")
    max_file_bytes: int = Field(default=256 * MEBIBYTE, ge=1, description="Size of one image or label file.")
    max_archive_members: int = Field(default=20_000, ge=1, description="Files in one uploaded zip.")
    max_archive_bytes: int = Field(default=8192 * MEBIBYTE, ge=1, description="Size of an uploaded zip once unpacked.")

    max_submission_bytes: int = Field(default=256 * MEBIBYTE, ge=1, description="Size of one submission as uploaded.")
    max_submission_files: int = Field(default=20_000, ge=1, description="Files in one submission.")
    max_submission_unpacked_bytes: int = Field(
        default=1024 * MEBIBYTE, ge=1, description="Size of one submission once unpacked."
    )
    max_submission_segments: int = Field(default=500_000, ge=1, description="Segments of one submission.")
    max_image_segments: int = Field(default=20_000, ge=1, description="Segments of a submission in one image.")
    max_submission_points: int = Field(default=20_000_000, ge=1, description="Points of one submission.")
    max_segment_points: int = Field(default=20_000, ge=1, description="Points of one segment of a submission.")
    scoring_seconds: float = Field(default=300.0, gt=0, description="Time that one task of a submission may take.")
    scoring_megabytes: int = Field(default=2048, ge=64, description="Memory that one task of a submission may take.")
    validation_seconds: float = Field(
        default=120.0, gt=0, description="How long an upload's sender waits to be told whether it is valid."
    )
    webhook_seconds: float = Field(default=5.0, gt=0, description="How long a webhook may take to answer.")
    webhook_private_addresses: bool = Field(
        default=False, description="Whether webhooks may be sent to addresses that aren't public."
    )

    @property
    def database_address(self) -> str | URL:
        """The database's address, from ``database_url`` or in ``data_dir``."""
        # it takes long to import, and a command that ends before it needs the database doesn't wait for it
        from sqlalchemy import URL

        # not as text: a folder's name may hold what means something in an address
        return self.database_url or URL.create("sqlite", database=str(self.data_dir.absolute() / "clearlines.sqlite3"))

    @property
    def hosted(self) -> bool:
        """Whether others than the one at the machine can reach it, so that accounts are required."""
        return self.public_url is not None or not is_loopback(self.host)

    @property
    def anonymous(self) -> Literal["admin", "reader"]:
        """The role of who asks without an account or token."""
        return self.anonymous_role or ("reader" if self.hosted else "admin")

    @property
    def logged(self) -> Literal["debug", "info", "warning", "error"]:
        """The least level that is logged: in local mode a terminal shows what needs a look, and nothing else."""
        return self.log_level or ("info" if self.hosted else "warning")

    @property
    def backups(self) -> Path:
        """Folder of the backups that are taken before an upgrade."""
        return self.backup_dir or self.data_dir / "backups"

    @property
    def blob_dir(self) -> Path:
        """Folder of the uploaded files, by their hash."""
        return self.data_dir / "blobs"

    @property
    def grace(self) -> timedelta:
        """How long what was deleted can be restored."""
        return timedelta(days=self.grace_days)

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        if self.hosted and self.anonymous_role == "admin":
            raise ValueError("anonymous_role can't be admin where others can reach it: leave it out, or say reader")
        if self.public_url is not None:
            parts = urlsplit(self.public_url)
            if parts.scheme not in ("http", "https") or not parts.hostname or parts.path.strip("/") or parts.query:
                raise ValueError("public_url must be https://NAME or https://NAME:PORT, without a path")
        openid = (self.openid_issuer, self.openid_client_id, self.openid_client_secret)
        if any(openid) and not all(openid):
            raise ValueError("OpenID Connect needs openid_issuer, openid_client_id and openid_client_secret")
        return self
