"""Which code finds candidates: the package's version says which Python, the kernels' hash which compiled part."""

from __future__ import annotations

from app import __version__
from app.vision.native.library import kernels_hash


def code_version() -> str:
    """Return the version with the kernels' hash behind it, as ``0.1.0+kernels.1b4f0e98``.

    Raises:
        BrokenInstallation: The kernels' file can't be read.
    """
    # a version has one "+" at most (PEP 440)
    return f"{__version__}{'.' if '+' in __version__ else '+'}kernels.{kernels_hash()[:8]}"
