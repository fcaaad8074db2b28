/* Gradient of a blurred image, row by row: a Gaussian followed by a 3x3 Sobel operator. */
#ifndef CLEARLINES_GRADIENT_H
#define CLEARLINES_GRADIENT_H

#include <stddef.h>
#include <stdint.h>

/* KEPT: how many gradient rows are kept, a power of two; LARGEST_HALF: of the Gaussian, px. */
enum { KEPT = 8, LARGEST_HALF = 31 };

/* Write an image row to `out`. */
typedef void (*RowSource)(const void *image, int row, float *out);

typedef struct {
    RowSource source;
    const void *image;
    int width, height;
    int half;                        /* of the Gaussian, px */
    float weights[LARGEST_HALF + 1]; /* of the Gaussian, from its centre outwards */
    int next;                        /* image row to be read next; those beyond the border are mirrored */
    float *memory;
    float *rows;             /* ring of 2 half + 1 image rows */
    float *column, *blurred; /* a row blurred along y, and one along both axes; their borders are padded */
    float *smooth, *slope;   /* rings of 4 blurred rows, smoothed and differentiated along x */
    float *x, *y, *norm;     /* rings of KEPT gradient rows, in grey levels of the 3x3 Sobel operator */
} Gradient;

/* Returns 0 or OUT_OF_MEMORY; `gradient` must be closed in either case. */
int gradient_open(Gradient *gradient, RowSource source, const void *image, int width, int height, double sigma);
void gradient_close(Gradient *gradient);

/* Make the next gradient row; the first call makes row 0. */
void gradient_advance(Gradient *gradient);

static inline const float *kept_row(const float *ring, int width, int row) {
    return ring + (size_t)(row % KEPT) * (size_t)width;
}

#endif
