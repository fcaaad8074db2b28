/* Following an arc beyond its ends; see app/vision/extension.py. */
#include "tracing.h"

#define SHORTEST 25.0
#define MOST_MISSES 5
#define DENSITY 0.7
enum { BATCH = 8 };

/* The part of a walk from a sample on, `most` samples long where there are so many. */
static Walk part_of(Walk walk, int sample, int most) {
    const int last = sample + most < walk_length(walk) ? sample + most - 1 : walk_length(walk) - 1;
    return (Walk){walk.axis, walk.first + sample * walk.step, walk.first + last * walk.step, walk.step};
}

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
    Sample samples[BATCH];
    for (int i = 0; i < count; i++) {
        if (i % BATCH == 0) sample_walk(scene, arc, part_of(walk, i, BATCH), samples);
        const Sample *sample = &samples[i % BATCH];
        if (sample->state & HIT) {
            hits++;
            misses = 0;
            if (hits >= DENSITY * (i + 1)) best = sample->u;
        } else if (++misses > MOST_MISSES) {
            break;
        }
    }
    /* into the corner that the edge ends at, which blur has rounded off */
    const Vector end = arc_position(arc, best);
    const int along = (int)lrint(walk.axis == ALONG_X ? end.x : end.y);
    const Walk corner = {walk.axis, along + walk.step, along + ROUNDED * walk.step, walk.step};
    sample_walk(scene, arc, corner, samples);
    for (int i = 0; i < ROUNDED && samples[i].state & LOOSE; i++) best = samples[i].u;
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
