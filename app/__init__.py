"""ClearLines: ground truth for straight edge-segments, detector scores and lens distortion."""

from importlib.metadata import PackageNotFoundError, version

try:
    __version__ = version("clearlines")
except PackageNotFoundError:  # a checkout that was never installed
    __version__ = "0+unknown"
