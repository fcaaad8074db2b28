/* Doors for the tests to what kernels keep to themselves; nothing in the product calls them. */
#include "kernels.h"

/* Fit an arc to each run of points, directed from its first point to its last.
 *
 * points double (n, 2), offsets int64 (count + 1,). traits double (count, TRAITS): sums as in Arc. */
EXPORT void cl_probe_fit(const double *points, const int64_t *offsets, const double *traits, int64_t count, Arc *arcs) {
    for (int64_t i = 0; i < count; i++) {
        Arc *arc = &arcs[i];
        memset(arc, 0, sizeof(*arc));
        const Vector start = {points[2 * offsets[i]], points[2 * offsets[i] + 1]};
        const Vector end = {points[2 * offsets[i + 1] - 2], points[2 * offsets[i + 1] - 1]};
        arc->origin[0] = start.x, arc->origin[1] = start.y;
        memcpy(arc->traits, traits + TRAITS * i, sizeof(arc->traits));
        for (int64_t j = offsets[i]; j < offsets[i + 1]; j++) {
            const double x = points[2 * j] - start.x, y = points[2 * j + 1] - start.y, z = x * x + y * y;
            const double terms[MOMENTS] = {1, x, y, x * x, x * y, y * y, x * z, y * z, z * z};
            for (int k = 0; k < MOMENTS; k++) arc->sums[k] += terms[k];
        }
        fit_arc(arc, start, end);
        arc->first_piece = arc->last_piece = (int32_t)i;
        arc->first_join = arc->last_join = -1;
    }
}

/* Points and directions of an arc, double (count, 2) each, at tangent coordinates `along` (count,). */
EXPORT void cl_probe_place(const Arc *arc, const double *along, int64_t count, double *places, double *directions) {
    for (int64_t i = 0; i < count; i++) {
        const Vector place = arc_position(arc, along[i]), direction = arc_direction(arc, along[i]);
        places[2 * i] = place.x, places[2 * i + 1] = place.y;
        directions[2 * i] = direction.x, directions[2 * i + 1] = direction.y;
    }
}

/* Tangent coordinates and signed distances, (count,) each, of points double (count, 2). */
EXPORT void cl_probe_project(const Arc *arc, const double *points, int64_t count, double *along, double *distances) {
    for (int64_t i = 0; i < count; i++)
        arc_project(arc, (Vector){points[2 * i], points[2 * i + 1]}, &along[i], &distances[i]);
}

/* The arc through two arcs. */
EXPORT void cl_probe_join(const Arc *first, int first_leaves_end, const Arc *second, int second_entered_at_start,
                          Arc *joined) {
    memset(joined, 0, sizeof(*joined));
    join_arcs(first, first_leaves_end, second, second_entered_at_start, joined);
}

/* Effective length of the gap from the end of one arc to the start of another, px. */
EXPORT double cl_probe_gap(const Scene *scene, const Arc *first, const Arc *second, int same_polarity) {
    return effective_gap(scene, first, second, arc_end(first, 1), arc_end(second, 0), same_polarity);
}
