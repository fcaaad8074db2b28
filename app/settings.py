"""Every knob of the service; each is also an environment variable with the prefix ``CLEARLINES_``."""

from __future__ import annotations

from datetime import timedelta
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import platformdirs
from pydantic import Field
from pydantic_settings import BaseSettings, SettingsConfigDict

if TYPE_CHECKING:
    from sqlalchemy import URL

MEBIBYTE = 2**20


class Settings(BaseSettings):
    """Where things lie, what is allowed, how work is done.

    ``CLEARLINES_DATA_DIR=/srv/clearlines CLEARLINES_WORKERS=8 clearlines serve`` sets two of them.
    """

    model_config = SettingsConfigDict(env_prefix="CLEARLINES_", frozen=True, extra="forbid")

    data_dir: Path = Field(
        default_factory=lambda: platformdirs.user_data_path("clearlines", appauthor=False),
        description="Folder of the database and of the uploaded files.",
    )
    database_url: str | None = Field(
        default=None, description="sqlite:///FILE or postgresql://USER@HOST/NAME; an SQLite file in data_dir if unset."
    )
    host: str = Field(default="127.0.0.1", description="Address to listen on.")
    port: int = Field(default=8765, ge=0, le=65535, description="Port to listen on; 0 takes a free one.")
    person: str = Field(default="owner", min_length=1, max_length=200, description="Whose decisions are stored.")

    anonymous_role: Literal["owner", "reader"] = Field(
        default="owner", description="Who asks without a token: owner in local mode; reader where others ask too."
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
    def blob_dir(self) -> Path:
        """Folder of the uploaded files, by their hash."""
        return self.data_dir / "blobs"

    @property
    def grace(self) -> timedelta:
        """How long what was deleted can be restored."""
        return timedelta(days=self.grace_days)
