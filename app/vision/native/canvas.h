/* Which edges are taken: arcs painted over the pixels they pass, in the colour of their direction. */
#ifndef CLEARLINES_CANVAS_H
#define CLEARLINES_CANVAS_H

#include "tracing.h"

/* Directions in steps of 180 degrees / 2^16: a difference modulo 2^16 is one modulo 180 degrees. 0 stands for no paint.
 */
typedef struct {
    uint16_t *paint;
    int32_t width, height;
    double reach; /* of the brush to either side, px */
} Canvas;

uint16_t paint_direction(const Arc *arc);
/* Whether neither the pixel that an arc passes in a column (or row) nor that of its point there has such paint. */
int is_free(const Canvas *canvas, int axis, int along, const Sample *sample, uint16_t direction);
/* Have that pixel's memory fetched. */
void fetch_pixel(const Canvas *canvas, int axis, int along, const Sample *sample);
/* Paint where an arc passes a column (or row) of the image and where its point is there; `main` is the arc's cosine. */
void paint(const Canvas *canvas, int axis, int along, const Sample *sample, double main, uint16_t direction);

#endif
