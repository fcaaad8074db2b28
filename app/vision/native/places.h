/* Where the edge points of a pass are: a bit per pixel, and the points before each eight of these.
 *
 * Lines are columns in the pass along x and rows in that along y. Points are kept line after line, rising across in
 * each, so that those of a few neighbouring pixels are a range: a look at 0.6 bytes per pixel finds it. */
#ifndef CLEARLINES_PLACES_H
#define CLEARLINES_PLACES_H

#include <stddef.h>
#include <stdint.h>

/* MARGIN: pixels without points on either side of a line, LINES_BEYOND: such lines after the last, so that whoever
 * looks a few pixels ahead need not ask where the image ends. app/vision/native/records.py has the same numbers. */
enum { MARGIN = 16, LINES_BEYOND = 3 };

typedef struct {
    const uint8_t *occupied; /* (lines + LINES_BEYOND, line_bytes), the lowest bit is the first pixel's */
    const int32_t *before;   /* of the same shape: points before the byte's first pixel */
    size_t line_bytes;
} Places;

/* Points in a window of pixels: from `first` on, one for each bit set in `bits`, whose lowest is the first pixel's. */
typedef struct {
    int32_t first;
    uint32_t bits;
} Window;

extern const uint8_t bits_set[256];

static inline size_t line_bytes(int pixels) { return ((size_t)pixels + 2 * MARGIN + 15) / 8; }

/* `pixel` is the window's first, within the margins as its last is; it may span 8 pixels at most. */
static inline Window window_at(const Places *places, int line, int pixel, int span) {
    const size_t place = (size_t)(pixel + MARGIN), byte = (size_t)line * places->line_bytes + place / 8;
    const uint32_t own = places->occupied[byte], next = places->occupied[byte + 1], shift = place % 8;
    const Window window = {places->before[byte] + bits_set[own & ((1u << shift) - 1)],
                           (own | next << 8) >> shift & ((1u << span) - 1)};
    return window;
}

#endif
