/* Following an arc beyond its ends; see app/vision/extension.py. */
#include "tracing.h"

#define SHORTEST 25.0
#define MOST_MISSES 5
#define DENSITY 0.7

/* Tangent coordinate that an end can be moved to, walking outwards over at most the arc's own length. */
static double reached(const Scene *scene, const Arc *arc, int outward) {
    const double length = arc->high - arc->low;
    const double near = outward > 0 ? arc->high : arc->low;
    double best = near;
    Walk walk = outward > 0 ? walk_along(arc, near, near + length) : walk_along(arc, near - length, near);
    if (outward < 0) {
        const int first = walk.first;
        walk.first = walk.last;
        walk.last = first;
        walk.step = -walk.step;
    }
    const int count = walk_length(walk);
    int hits = 0, misses = 0;
    for (int i = 0; i < count; i++) {
        const Sample sample = sample_at(scene, arc, walk.axis, walk.first + i * walk.step);
        if (sample.state & HIT) {
            hits++;
            misses = 0;
            if (hits >= DENSITY * (i + 1)) best = sample.u;
        } else if (++misses > MOST_MISSES) {
            break;
        }
    }
    /* into the corner that the edge ends at, which blur has rounded off */
    const Vector end = arc_position(arc, best);
    const int along = (int)lrint(walk.axis == ALONG_X ? end.x : end.y);
    for (int i = 1; i <= ROUNDED; i++) {
        const Sample sample = sample_at(scene, arc, walk.axis, along + i * walk.step);
        if (!(sample.state & LOOSE)) break;
        best = sample.u;
    }
    return best;
}

/* Move both ends of arcs of 25 px and more outwards over measured points; the fit stays as it is. */
EXPORT void cl_extend(const Scene *scene, Arc *arcs, int64_t count) {
    for (int64_t i = 0; i < count; i++) {
        Arc *arc = &arcs[i];
        if (arc->high - arc->low < SHORTEST) continue;
        const double high = reached(scene, arc, 1), low = reached(scene, arc, -1);
        arc->high = high;
        arc->low = low;
    }
}
