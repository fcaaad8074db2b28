"""What room is left for files."""

from __future__ import annotations

import shutil

from app.api.deps import Server
from app.api.schemas.status import DiskStatus
from app.errors import Unavailable


def disks_of(server: Server) -> list[DiskStatus]:
    """Return how full the data folder's disk is, and what holds the blobs."""
    return [_data(server), _blobs(server)]


def _data(server: Server) -> DiskStatus:
    folder = server.settings.data_dir
    try:
        usage = shutil.disk_usage(folder)
    except OSError as error:
        return DiskStatus(name="data", address=str(folder), used=None, free=None, problem=str(error.strerror))
    return DiskStatus(name="data", address=str(folder), used=usage.used, free=usage.free, problem=None)


def _blobs(server: Server) -> DiskStatus:
    address = server.blobs.address
    try:
        usage = server.blobs.usage()
    except Unavailable as error:
        return DiskStatus(name="blobs", address=address, used=None, free=None, problem=error.message)
    return DiskStatus(name="blobs", address=address, used=usage.used, free=usage.free, problem=None)
