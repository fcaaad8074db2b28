"""Images that are broken, odd or made to harm: each is shown, or refused for what it is, and takes little memory."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from app.errors import InvalidImage, TooLarge
from app.images import check_whole, decode_display, describe, for_browser, thumbnail
from tools.fuzzing.broken_images import BrokenImage, broken_images

ROOT = Path(__file__).resolve().parents[2]
IMAGES = {image.name: image for image in broken_images()}
MEBIBYTE = 2**20
IN_LITTLE_MEMORY = """
import resource, sys
from app.errors import ClearLinesError
from app.images import decode_display, describe, thumbnail
from tools.fuzzing.broken_images import broken_images

def peak():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

images = broken_images()
decode_display(next(image.data for image in images if image.fate == "shown"))
for image in images:
    before = peak()
    for read in (describe, decode_display, thumbnail):
        try:
            read(image.data)
        except ClearLinesError:
            pass
    print(f"{peak() - before}\\t{image.name}")
"""


def received(image: BrokenImage) -> None:
    """Do with the file what is done before it is stored, and what is done to show it."""
    header = describe(image.data)
    check_whole(image.data, header)
    pixels = decode_display(image.data)
    assert pixels.shape == (header.height, header.width, 3)
    assert (header.width, header.height) == image.size
    shown, media_type = for_browser(image.data)
    assert media_type in ("image/png", "image/jpeg", "image/webp", "image/bmp")
    assert (decode_display(shown) == pixels).all() or media_type != "image/png"
    assert describe(thumbnail(image.data, 16)[0]).format == "WEBP"


@pytest.mark.parametrize("name", IMAGES)
@pytest.mark.filterwarnings("ignore:Corrupt EXIF data", "ignore:Truncated File Read")
def test_a_broken_image_is_shown_or_refused_for_what_it_is(name: str) -> None:
    image = IMAGES[name]
    if image.fate == "shown":
        received(image)
        return
    with pytest.raises(TooLarge if image.fate == "too large" else InvalidImage) as caught:
        received(image)
    assert caught.value.message
    assert caught.value.expected or caught.value.hint


def test_none_of_them_takes_much_memory() -> None:
    """In a process of its own, which tells the most it ever held: none of these files is worth more."""
    done = subprocess.run(
        [sys.executable, "-c", IN_LITTLE_MEMORY], cwd=ROOT, capture_output=True, text=True, timeout=60, check=True
    )
    taken = {name: int(size) * 1024 for size, name in (line.split("\t") for line in done.stdout.splitlines())}
    assert taken.keys() == IMAGES.keys()
    assert {name: size for name, size in taken.items() if size > 48 * MEBIBYTE} == {}
