"""Image files: what they are, their pixels as stored, and what a browser is shown.

Pixels count as stored: an orientation in the file's EXIF or TIFF tags is applied nowhere, alpha is ignored.
"""

from app.images.browser import for_browser, shown_as_stored, thumbnail
from app.images.decode import decode_display, decode_eight_bit, decode_gray
from app.images.header import MAX_PIXELS, ImageHeader, describe
from app.images.whole import check_whole

__all__ = [
    "MAX_PIXELS",
    "ImageHeader",
    "check_whole",
    "decode_display",
    "decode_eight_bit",
    "decode_gray",
    "describe",
    "for_browser",
    "shown_as_stored",
    "thumbnail",
]
