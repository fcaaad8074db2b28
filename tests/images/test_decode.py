import io

import cv2
import numpy as np
import pytest
from PIL import Image

from app.errors import InvalidImage, TooLarge
from app.images import decode, decode_display, decode_gray, describe, for_browser, thumbnail

RNG = np.random.default_rng(6)
COLOUR = RNG.integers(0, 256, (30, 44, 3), dtype=np.uint8)
GREY = COLOUR[..., 0].copy()
DEEP = RNG.integers(0, 65536, (30, 44), dtype=np.uint16)
DEEP_COLOUR = RNG.integers(0, 65536, (30, 44, 3), dtype=np.uint16)
LOSSLESS = ["PNG", "TIFF", "BMP", "PPM"]


def pillow(array, kind, mode=None, **options):
    stream = io.BytesIO()
    image = Image.fromarray(array)
    (image.convert(mode) if mode else image).save(stream, kind, **options)
    return stream.getvalue()


def opencv(array, extension):
    return cv2.imencode(extension, array)[1].tobytes()


def turned(array, kind, orientation, **options):
    exif = Image.Exif()
    exif[0x0112] = orientation
    return pillow(array, kind, exif=exif, **options)


def open_png(data):
    return np.asarray(Image.open(io.BytesIO(data)))


@pytest.mark.parametrize("kind", LOSSLESS)
def test_eight_bit(kind):
    assert np.array_equal(decode_gray(pillow(GREY, kind)), GREY)
    display = decode_display(pillow(COLOUR, kind))
    assert np.array_equal(display[..., ::-1], COLOUR)
    assert np.array_equal(decode_gray(pillow(COLOUR, kind)), cv2.cvtColor(COLOUR, cv2.COLOR_RGB2GRAY))
    assert np.array_equal(decode_display(pillow(GREY, kind)), np.repeat(GREY[..., None], 3, axis=2))


@pytest.mark.parametrize("extension", [".png", ".tiff"])
def test_sixteen_bit_stays_so_in_grey(extension):
    assert np.array_equal(decode_gray(opencv(DEEP, extension)), DEEP)
    found = decode_gray(opencv(DEEP_COLOUR, extension))
    assert found.dtype == np.uint16
    assert np.array_equal(found, cv2.cvtColor(DEEP_COLOUR, cv2.COLOR_BGR2GRAY))


def test_sixteen_bit_is_shown_between_its_percentiles():
    ramp = np.linspace(1000, 3000, 30 * 44).astype(np.uint16).reshape(30, 44)
    shown = decode_display(opencv(ramp, ".png"))[..., 0]
    low, high = np.percentile(ramp, [0.5, 99.5])
    expected = np.clip((ramp - low) / (high - low) * 255, 0, 255)
    assert np.abs(shown - expected).max() <= 0.5 + 1e-9


@pytest.mark.parametrize(("mode", "kind"), [("RGBA", "PNG"), ("RGBA", "TIFF"), ("LA", "PNG")])
def test_alpha_is_ignored_and_colour_used_as_stored(mode, kind):
    image = Image.fromarray(COLOUR).convert(mode)
    image.putalpha(Image.fromarray(RNG.integers(0, 256, (30, 44), dtype=np.uint8)))
    stream = io.BytesIO()
    image.save(stream, kind)
    expected = np.asarray(image)[..., :-1]
    assert np.array_equal(decode_display(stream.getvalue())[..., ::-1], np.broadcast_to(expected, COLOUR.shape))


def test_palettes_and_bitmaps():
    palette = Image.fromarray(COLOUR).quantize(16)
    stream = io.BytesIO()
    palette.save(stream, "PNG")
    assert np.array_equal(decode_display(stream.getvalue())[..., ::-1], np.asarray(palette.convert("RGB")))
    bitmap = Image.fromarray(COLOUR).convert("1")
    for kind in ("PNG", "TIFF", "PPM"):
        stream = io.BytesIO()
        bitmap.save(stream, kind)
        assert np.array_equal(decode_gray(stream.getvalue()), np.asarray(bitmap.convert("L")))


@pytest.mark.parametrize("orientation", range(1, 9))
@pytest.mark.parametrize("kind", ["PNG", "JPEG", "WEBP", "TIFF", "BIGTIFF"])
def test_orientation_is_applied_nowhere(kind, orientation):
    options = {
        "PNG": {},
        "JPEG": {"quality": 95},
        "WEBP": {"lossless": True},
        "TIFF": {},
        "BIGTIFF": {"big_tiff": True},
    }
    name = kind.removeprefix("BIG")
    data = turned(GREY, name, orientation, **options[kind])
    header = describe(data)
    assert (header.width, header.height, header.orientation) == (44, 30, orientation)
    plain = pillow(GREY, name, **options[kind])
    assert np.array_equal(decode_gray(data), decode_gray(plain))
    shown, _ = for_browser(data)
    assert describe(shown).orientation == 1
    assert np.array_equal(decode_gray(shown), decode_gray(plain))


@pytest.mark.parametrize("place", ["before", "behind"])
def test_orientation_of_a_png_is_found_on_either_side_of_its_pixels(place):
    data = turned(GREY, "PNG", 6)
    start = data.index(b"eXIf") - 4
    end = start + 12 + int.from_bytes(data[start : start + 4])
    chunk, rest = data[start:end], data[:start] + data[end:]
    at = rest.index(b"IDAT" if place == "before" else b"IEND") - 4
    moved = rest[:at] + chunk + rest[at:]
    assert describe(moved).orientation == 6
    assert describe(rest).orientation == 1
    assert np.array_equal(open_png(for_browser(moved)[0]), GREY)


@pytest.mark.parametrize("orientation", range(1, 9))
def test_orientation_of_a_16_bit_tiff(orientation):
    exif = Image.Exif()
    exif[0x0112] = orientation
    stream = io.BytesIO()
    Image.fromarray(DEEP).save(stream, "TIFF", exif=exif)
    assert np.array_equal(decode_gray(stream.getvalue()), DEEP)


@pytest.mark.parametrize("size", [(1, 1), (1, 50), (50, 1)])
def test_the_smallest_images(size):
    image = RNG.integers(0, 256, size, dtype=np.uint8)
    assert np.array_equal(decode_gray(pillow(image, "PNG")), image)
    assert len(thumbnail(pillow(image, "PNG"), 16)[0]) > 0


@pytest.mark.parametrize("kind", ["PNG", "JPEG", "TIFF", "BMP", "WEBP", "PPM"])
@pytest.mark.parametrize("share", [0.3, 0.6, 0.9])
def test_cut_off_files(kind, share, capfd):
    smooth = cv2.GaussianBlur(RNG.integers(0, 256, (200, 300, 3), dtype=np.uint8), (0, 0), 2)
    data = pillow(smooth, kind)
    with pytest.raises(InvalidImage):
        decode_gray(data[: int(len(data) * share)])


def test_a_large_image_that_is_not_there_is_refused():
    data = pillow(np.zeros((8000, 8000), np.uint8), "PNG")
    with pytest.raises(TooLarge):
        decode_gray(data)
    with pytest.raises(InvalidImage):
        decode_gray(data[: len(data) // 2], max_pixels=64_000_000)


def test_pixels_that_are_not_what_the_header_promised(monkeypatch):
    monkeypatch.setattr(decode.cv2, "imdecode", lambda *args: np.zeros((5, 5), np.uint8))
    with pytest.raises(InvalidImage) as caught:
        decode_gray(pillow(GREY, "PNG"))
    assert caught.value.expected == "44 x 30 as its header says"


@pytest.mark.parametrize("kind", ["PNG", "JPEG", "WEBP", "BMP"])
def test_a_browser_gets_the_file_itself_where_it_shows_it_as_stored(kind):
    data = pillow(COLOUR, kind)
    shown, media_type = for_browser(data)
    assert shown is data
    assert media_type == f"image/{kind.lower()}"


@pytest.mark.parametrize(
    "data",
    [
        pillow(COLOUR, "TIFF"),
        pillow(COLOUR, "PPM"),
        opencv(DEEP, ".png"),
        opencv(DEEP_COLOUR, ".png"),
        turned(COLOUR, "JPEG", 6),
        pillow(COLOUR, "PNG", "RGBA"),
        pillow(COLOUR, "PNG", "P", transparency=0),
    ],
)
def test_a_browser_gets_a_png_of_the_pixels_otherwise(data):
    shown, media_type = for_browser(data)
    assert media_type == "image/png"
    assert (describe(shown).bits, describe(shown).format) == (8, "PNG")
    assert np.array_equal(decode_display(shown), decode_display(data))


@pytest.mark.parametrize(("size", "expected"), [(16, (16, 11)), (40, (40, 27)), (44, (44, 30)), (2000, (44, 30))])
def test_thumbnails_keep_their_shape_and_are_never_enlarged(size, expected):
    data, media_type = thumbnail(pillow(COLOUR, "PNG"), size)
    assert media_type == "image/webp"
    header = describe(data)
    assert (header.width, header.height) == expected


def test_a_thumbnail_looks_like_its_image():
    ramp = np.tile(np.linspace(0, 255, 400).astype(np.uint8), (300, 1))
    small = decode_gray(thumbnail(pillow(ramp, "PNG"), 100)[0]).astype(float)
    assert np.abs(small - ramp.reshape(75, 4, 100, 4).mean((1, 3))).max() < 8


@pytest.mark.parametrize("size", [0, -5, 15, 2049])
def test_sizes_of_thumbnails_are_bounded(size):
    with pytest.raises(Exception, match="thumbnail"):
        thumbnail(pillow(COLOUR, "PNG"), size)
