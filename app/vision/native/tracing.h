/* Walking along arcs and picking up the measured points that support them; see app/vision/extension.py and
 * selection.py. */
#ifndef CLEARLINES_TRACING_H
#define CLEARLINES_TRACING_H

#include "kernels.h"

enum { HIT = 1, CLOSE = 2, LOOSE = 4 };

/* Samples at each end of an arc where a LOOSE point is as good as a HIT. */
enum { ROUNDED = 2 };

/* One column (or row, for steep arcs) that an arc passes. */
typedef struct {
    double u;       /* tangent coordinate on the arc, px */
    float across;   /* where the arc passes it, px */
    int32_t pixel;  /* the same, rounded */
    float measured; /* where the measured point there is, px; infinite where there is none */
    float distance; /* of the point from the arc, px, signed; infinite where there is none */
    float norm;     /* of the point, 0 where there is none */
    int32_t state;  /* a point within 1.5 px and: HIT 27, LOOSE 45 degrees; CLOSE: within 0.5 px and 8 degrees */
} Sample;

/* Columns (or rows) that an arc passes between two tangent coordinates, in rising u. */
typedef struct {
    int axis, first, last, step;
} Walk;

Walk walk_along(const Arc *arc, double low, double high);
/* Sample all that a walk passes; `samples` has room for walk_length(walk). */
void sample_walk(const Scene *scene, const Arc *arc, Walk walk, Sample *samples);
static inline int walk_length(Walk walk) { return walk.step * (walk.last - walk.first) + 1; }

#endif
