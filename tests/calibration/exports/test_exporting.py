"""Which formats there are, what is refused and why, and what every file tells of itself."""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Mapping

import numpy as np
import pytest

from app.calibration.exports import (
    FORMATS,
    Exported,
    Intrinsics,
    choose_intrinsics,
    export_lens,
    nominal_intrinsics,
    overview,
)
from app.calibration.lens import CameraLens
from app.errors import CannotExport, InvalidInput

KEYS = [
    "opencv-yaml",
    "opencv-json",
    "ros",
    "kalibr",
    "colmap",
    "matlab",
    "lensfun",
    "mrcal",
    "stmap",
    "remap",
    "clearlines",
]
STRONG = CameraLens("division", 1242, 375, (0.5, 0.1, 0.1, 0.01, -0.01))
FOLDING = CameraLens("brown", 120, 80, (-0.6, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))


def text_of(exported: Exported) -> str:
    """All that a person could read in a file."""
    if exported.file_name.endswith(".npz"):
        with np.load(io.BytesIO(exported.content), allow_pickle=False) as archive:
            return "\n".join(archive["notes"].tolist())
    if exported.file_name.endswith(".zip"):
        with zipfile.ZipFile(io.BytesIO(exported.content)) as archive:
            return archive.read("README.txt").decode()
    if exported.file_name.endswith(".mat"):
        # text lies in a MAT-file as 16-bit characters
        return exported.content.replace(b"\0", b"").decode("latin-1")
    return exported.content.decode()


def test_the_formats_are_those_of_the_menu() -> None:
    assert list(FORMATS) == KEYS
    assert [each.name for each in FORMATS.values()] == KEYS
    assert len({each.suffix for each in FORMATS.values()}) == len(KEYS)


@pytest.mark.parametrize("format_name", KEYS)
def test_a_file_tells_its_error_and_its_nominal_focal_length(
    format_name: str, lenses: Mapping[str, CameraLens]
) -> None:
    lens = lenses["barrel"]
    exported = export_lens(lens, format_name, camera_name="front", intrinsics=choose_intrinsics(lens))
    text = text_of(exported)
    assert "nominal, NOT measured" in text
    assert "conversion" in text.lower()
    if format_name != "clearlines":
        assert f"{exported.error.rms:.4f} px rms, {exported.error.maximum:.4f} px at most" in text
    assert exported.intrinsics.source == "nominal"


@pytest.mark.parametrize("format_name", KEYS)
def test_the_same_lens_gives_the_same_bytes(format_name: str, lenses: Mapping[str, CameraLens]) -> None:
    first, second = (
        export_lens(lenses["plain"], format_name, camera_name="a", intrinsics=nominal_intrinsics(240, 160))
        for _ in range(2)
    )
    assert first == second


def test_the_header_of_a_mat_file_has_no_time_of_day(lenses: Mapping[str, CameraLens]) -> None:
    content = export_lens(lenses["plain"], "matlab", camera_name="a", intrinsics=nominal_intrinsics(240, 160)).content
    assert content[:116] == b"MATLAB 5.0 MAT-file, written by ClearLines".ljust(116)


def test_the_overview_says_what_exporting_does() -> None:
    intrinsics = choose_intrinsics(STRONG)
    for option in overview(STRONG, intrinsics):
        if option.allowed:
            assert option.reason is None
            assert option.error is not None
            assert option.error.rms <= 0.5
        else:
            with pytest.raises(CannotExport) as caught:
                export_lens(STRONG, option.format, camera_name="a", intrinsics=intrinsics)
            assert option.reason is not None
            assert option.reason in caught.value.message
    refused = {option.format for option in overview(STRONG, intrinsics) if not option.allowed}
    assert refused == {"kalibr", "matlab", "lensfun"}


def test_an_option_is_serialisable() -> None:
    for option in overview(STRONG, choose_intrinsics(STRONG)):
        fields = json.loads(json.dumps(option.as_dict()))
        assert set(fields) == {"format", "title", "error", "allowed", "reason", "model"}


def test_a_refusal_says_how_far_off_and_what_would_fit() -> None:
    with pytest.raises(CannotExport) as caught:
        export_lens(STRONG, "lensfun", camera_name="a", intrinsics=choose_intrinsics(STRONG))
    error = caught.value
    assert (error.status, error.code) == (422, "cannot-export")
    assert "px rms" in error.message
    assert error.expected == "at most 0.5 px rms"
    assert error.details["rms"] > 0.5
    assert "stmap" in (error.hint or "")
    assert "kalibr" not in (error.hint or "")


def test_a_refusal_tells_of_a_better_principal_point() -> None:
    lens = CameraLens("opencv", 1392, 512, (-0.2, 0.06, -0.01, 0.001, -0.001, 0.005, -0.018))
    x, y = lens.center
    with pytest.raises(CannotExport) as caught:
        export_lens(lens, "mrcal", camera_name="a", intrinsics=Intrinsics(980, (x + 20, y + 20), "given"))
    assert f"mrcal too with the principal point at the distortion centre ({x:.1f}, {y:.1f})" in (
        caught.value.hint or ""
    )


def test_the_limit_can_be_set(lenses: Mapping[str, CameraLens]) -> None:
    lens = lenses["wide"]
    intrinsics = choose_intrinsics(lens)
    error = export_lens(lens, "kalibr", camera_name="a", intrinsics=intrinsics).error
    with pytest.raises(CannotExport):
        export_lens(lens, "kalibr", camera_name="a", intrinsics=intrinsics, limit=0.9 * error.rms)
    assert export_lens(lens, "kalibr", camera_name="a", intrinsics=intrinsics, limit=1.1 * error.rms).error == error
    with pytest.raises(InvalidInput, match="limit"):
        export_lens(lens, "kalibr", camera_name="a", intrinsics=intrinsics, limit=float("nan"))


def test_a_lens_that_folds_is_kept_by_our_own_file_alone() -> None:
    assert not FOLDING.is_invertible()
    options = overview(FOLDING, choose_intrinsics(FOLDING))
    assert [each.format for each in options if each.allowed] == ["clearlines"]
    with pytest.raises(CannotExport, match="folds within the frame"):
        export_lens(FOLDING, "remap", camera_name="a", intrinsics=choose_intrinsics(FOLDING))


def test_a_frame_of_some_pixels_is_refused_and_a_huge_one_gets_no_map() -> None:
    small = CameraLens.identity("brown", 7, 4)
    with pytest.raises(CannotExport, match="7 x 4 px"):
        export_lens(small, "colmap", camera_name="a", intrinsics=choose_intrinsics(small))
    huge = CameraLens.identity("brown", 100_000, 100_000)
    refused = {each.format for each in overview(huge, choose_intrinsics(huge)) if not each.allowed}
    assert refused == {"stmap", "remap"}


def test_an_unknown_format_is_named() -> None:
    with pytest.raises(InvalidInput, match="no format 'pdf'"):
        export_lens(STRONG, "pdf", camera_name="a", intrinsics=choose_intrinsics(STRONG))


def test_our_own_file_keeps_every_bit_and_the_calibration() -> None:
    lens = CameraLens("brown", 1242, 375, (1 / 3, -0.1 / 3, 0.007, 1e-3 / 3, -1e-17, 0.01 / 7, 0.02))
    calibration = {"version": 1, "accepted": True, "lens": lens.as_dict(), "noise": 0.1}
    content = export_lens(
        lens, "clearlines", camera_name='Ä "x"\n\ud800', intrinsics=choose_intrinsics(lens), calibration=calibration
    ).content
    fields = json.loads(content)
    assert CameraLens.from_dict(fields["lens"]) == lens
    assert fields["calibration"] == calibration
    assert fields["camera_name"] == 'Ä "x"\n\ud800'


def test_a_refused_lens_goes_into_no_other_tools_file() -> None:
    intrinsics = choose_intrinsics(STRONG)
    refused = {"accepted": False, "reasons": ["2 usable lines"]}
    options = overview(STRONG, intrinsics, calibration=refused)
    assert {each.format for each in options if each.allowed} == {"clearlines"}
    assert all("2 usable lines" in str(each.reason) for each in options if not each.allowed)
    with pytest.raises(CannotExport, match="2 usable lines"):
        export_lens(STRONG, "opencv-yaml", camera_name="a", intrinsics=intrinsics, calibration=refused)
    assert export_lens(STRONG, "clearlines", camera_name="a", intrinsics=intrinsics, calibration=refused).content
