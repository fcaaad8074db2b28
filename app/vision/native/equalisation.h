/* Contrast-limited adaptive histogram equalisation (CLAHE; Zuiderveld, Graphics Gems IV, 1994). */
#ifndef CLEARLINES_EQUALISATION_H
#define CLEARLINES_EQUALISATION_H

#include <stdint.h>

enum { LEVELS = 256 };

/* An image and the equalising tables of a grid of tiles. */
typedef struct {
    const uint8_t *gray;    /* (height, width) */
    int width, height;      /* px */
    int columns, rows;      /* of the grid */
    const float *tables;    /* (rows, columns, LEVELS), grey levels */
    const int32_t *left;    /* (width,), tile whose centre lies at or left of a column's pixel */
    const float *rightward; /* (width,), weight of the tile to the right of it */
    float *blended;         /* room for (2, columns, LEVELS): tables of one image row */
} Equaliser;

/* Write one row of the equalised image. */
void equalise_row(const Equaliser *equaliser, int row, float *out);

#endif
