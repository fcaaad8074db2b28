"""What a person chooses about a run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from app.errors import InvalidInput
from app.vision.parameters import DetectionParameters

CameraMode = Literal["joint", "per-image"]


@dataclass(frozen=True)
class RunParameters:
    """Parameters of a run.

    Attributes:
        detection: Of the pipeline.
        camera: ``"joint"`` if the images of a camera share its lens, ``"per-image"`` if each is estimated alone.
        discard: Whether undecided candidates that fail straightness are dropped; else they stay, marked.

    Raises:
        InvalidInput: On a value of the wrong kind.
    """

    detection: DetectionParameters = field(default_factory=DetectionParameters)
    camera: CameraMode = "joint"
    discard: bool = False

    def __post_init__(self) -> None:
        if self.camera not in ("joint", "per-image"):
            raise InvalidInput(
                f"{self.camera!r} is no way to share lenses", where="camera", expected="joint, per-image"
            )
        if not isinstance(self.discard, bool):
            raise InvalidInput(f"{self.discard!r} is neither true nor false", where="discard", expected="true or false")

    def as_dict(self) -> dict[str, Any]:
        """Return the parameters as one flat level of JSON-serialisable fields."""
        return {**self.detection.as_dict(), "camera": self.camera, "discard": self.discard}

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> RunParameters:
        """Build parameters from flat fields; those left out, or ``None``, keep their default.

        Raises:
            InvalidInput: On a name that doesn't exist, or a value of the wrong kind or out of range.
        """
        given = {name: value for name, value in values.items() if value is not None}
        own = {name: given.pop(name) for name in ("camera", "discard") if name in given}
        return cls(DetectionParameters.from_dict(given), **own)
