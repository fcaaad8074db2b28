/* Planar surfaces of a scene in a pinhole picture, painted one over the other. */
#ifndef CLEARLINES_PAINTING_H
#define CLEARLINES_PAINTING_H

#include "kernels.h"

/* Texels in rows, `channels` floats each: 1, a factor of the surface's colour, or 4, which are red, green and blue in
 * place of it and opacity. Beyond its border a texture is mirrored. */
typedef struct {
    const float *texels;
    int32_t width, height, channels, unused;
} Texture;

/* A convex polygon. Its edge functions are a x + b y + c with |a| + |b| = 1, positive inside. */
typedef struct {
    double lookup[9];                 /* homography from picture to texture positions; texel centres at integers */
    double nearness[3];               /* a x + b y + c: the haze's distance over the depth */
    double clearness;                 /* what haze leaves of the colour, or less than 0: it follows from the depth */
    int32_t left, top, right, bottom; /* within the picture; right and bottom are beyond */
    int32_t first_edge, edges;
    int32_t texture; /* or -1 */
    int32_t shadow;  /* -1, or the number of a shadow: neighbours of one number darken each place once */
    float colour[3]; /* or a shadow's factors */
    float opacity;
} Surface;

/* Pixels [first, last) of a row; those of [solid, solid_end) lie wholly inside, and are none where some don't. */
typedef struct {
    int first, solid, solid_end, last;
} Stretch;

/* texels.c: write the texels that the pixels [first, last) of row `y` show, one plane per channel. */
void fetch_texels(const Texture *texture, const double lookup[9], int y, int first, int last, float *const planes[4]);

#endif
