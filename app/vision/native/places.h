/* Where the edge points of a pass are: a bit per pixel, and the points before each 32 of these.
 *
 * Lines are columns in the pass along x and rows in that along y. Points are kept line after line, rising across in
 * each, so that those of a few neighbouring pixels are a range: a look at 0.25 bytes per pixel finds it, mostly in one
 * place of memory. */
#ifndef CLEARLINES_PLACES_H
#define CLEARLINES_PLACES_H

#include "kernels.h"

/* MARGIN: pixels without points on either side of a line, LINES_BEYOND: such lines after the last, so that whoever
 * looks a few pixels ahead need not ask where the image ends. app/vision/native/records.py has the same numbers. */
enum { MARGIN = 16, LINES_BEYOND = 3, SPAN_PIXELS = 32 };

typedef struct {
    const Span *spans; /* (lines + LINES_BEYOND, line_spans) */
    size_t line_spans;
} Places;

/* Points in a window of pixels: from `first` on, one for each bit set in `bits`, whose lowest is the first pixel's. */
typedef struct {
    int32_t first;
    uint32_t bits;
} Window;

/* An odd number: lines a power of two apart would share few places of the cache. */
static inline size_t line_spans(int pixels) { return (((size_t)pixels + 2 * MARGIN) / SPAN_PIXELS + 1) | 1; }

static inline int32_t bits_set(uint32_t bits) { return __builtin_popcount(bits); }

/* `pixel` is the window's first, within the margins as its last is; it may span 8 pixels at most. */
static inline Window window_at(const Places *places, int line, int pixel, int span) {
    const size_t place = (size_t)(pixel + MARGIN), shift = place % SPAN_PIXELS;
    const Span *own = places->spans + (size_t)line * places->line_spans + place / SPAN_PIXELS;
    const uint64_t bits = own[0].occupied | (uint64_t)own[1].occupied << 32;
    const Window window = {own->before + bits_set(own->occupied & ((1u << shift) - 1)),
                           (uint32_t)(bits >> shift) & ((1u << span) - 1)};
    return window;
}

#endif
