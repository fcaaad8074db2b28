"""Loading of the kernels, how each is called, and what tells one build of them from another."""

from __future__ import annotations

import ctypes
import hashlib
import os
import sys
from ctypes import CFUNCTYPE, POINTER, c_double, c_int, c_int32, c_int64, c_void_p
from functools import cache
from pathlib import Path
from typing import Any

from app.errors import BrokenInstallation
from app.vision.native.records import Scene

Report = CFUNCTYPE(c_int32, c_double)
"""Told the share of a call's work that is done, in [0, 1]; anything but 0 cancels it. ``Report()`` is no callback."""

OUT_OF_MEMORY, CANCELLED = -1, -2

_SUFFIX = {"win32": ".dll", "darwin": ".dylib"}.get(sys.platform, ".so")
_NAMED_BY = "CLEARLINES_KERNELS"

_p = c_void_p
_SIGNATURES: dict[str, tuple[Any, list[Any]]] = {
    # heap.c
    "cl_keep_heap": (None, []),
    # equalisation.c
    "cl_equalising_tables": (None, [_p, c_int, c_int, c_int, c_int, c_double, _p]),
    "cl_tile_weights": (None, [c_int, c_int, _p, _p]),
    # edge_points.c
    "cl_edge_points": (
        c_int,
        [
            *(_p, c_int, c_int, _p, c_int, c_int, _p, _p),
            *(c_double, c_double, c_double),
            *(_p, _p, _p, c_int64, _p, _p, _p, Report),
        ],
    ),
    # chains.c
    "cl_runs": (c_int64, [_p, c_int64, _p, c_int, c_int, c_int, c_double, c_double, _p, _p, _p, _p]),
    # pieces.c
    "cl_pieces": (None, [_p, c_int, _p, _p, c_int64, _p, c_int, c_int, c_int32, _p]),
    # merging.c
    "cl_merge": (c_int64, [POINTER(Scene), _p, c_int64, _p, _p, _p, _p, Report]),
    "cl_leave_out_short": (c_int64, [_p, c_int64, c_double]),
    # extension.c
    "cl_extend": (None, [POINTER(Scene), _p, c_int64]),
    # selection.c
    "cl_count_samples": (c_int64, [_p, c_int64, c_double]),
    "cl_select": (c_int64, [POINTER(Scene), _p, c_int64, c_double, c_double, _p, _p, c_int64, Report]),
    # painting.c
    "cl_paint": (c_int, [_p, _p, c_int, c_int, _p, c_int64, _p, _p, _p]),
}


@cache
def kernels() -> ctypes.CDLL:
    """Load the kernels, once a process.

    The environment's ``CLEARLINES_KERNELS`` names another library than the one beside this file.

    Raises:
        BrokenInstallation: The library isn't there, can't be loaded, or is of another version.
    """
    path = _path()
    try:
        library = ctypes.CDLL(str(path))
        for name, (result, arguments) in _SIGNATURES.items():
            function = getattr(library, name)
            function.restype = result
            function.argtypes = arguments
    except (OSError, AttributeError) as error:
        raise _broken(path, error) from error
    library.cl_keep_heap()
    return library


@cache
def kernels_hash() -> str:
    """Return the SHA-256 of the kernels' file as 64 hexadecimal digits; the file is read once a process.

    Raises:
        BrokenInstallation: The file can't be read.
    """
    path = _path()
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError as error:
        raise _broken(path, error) from error


def _path() -> Path:
    return Path(os.environ.get(_NAMED_BY) or Path(__file__).with_name(f"_kernels{_SUFFIX}"))


def _broken(path: Path, error: Exception) -> BrokenInstallation:
    return BrokenInstallation(
        f"the detector's compiled kernels can't be used: {error}",
        where=str(path),
        hint=f"{_NAMED_BY} in the environment names this file; unset it, or name another"
        if os.environ.get(_NAMED_BY)
        else "in a copy of the project run: python build_native.py; otherwise install clearlines again",
    )
