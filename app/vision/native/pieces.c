/* Arcs of the runs that chains were split into. */
#include "kernels.h"

#define SIDE_DISTANCE 3.0f

/* In large images the points of a run and the pixels beside them are far from those of the run before. Nothing but
 * their numbers tells where, so they are asked for so many points before their turn. */
enum { POINTS_AHEAD = 32, GRAY_AHEAD = 16 };

static inline uint8_t gray_near(const uint8_t *gray, int width, int height, float x, float y) {
    const int column = clamp((int)lrintf(x), 0, width - 1), row = clamp((int)lrintf(y), 0, height - 1);
    return gray[(size_t)row * (size_t)width + (size_t)column];
}

/* Fit an arc to each run of points of one pass.
 *
 * rows, runs: see cl_runs. gray: uint8 (height, width). Written: arcs (count,), directed so that the bright side is
 * that of the normal; `number` is the first of the numbers that the pieces get. */
EXPORT void cl_pieces(const EdgePoint *points, int axis, const int32_t *rows, const int64_t *runs, int64_t count,
                      const uint8_t *gray, int width, int height, int32_t number, Arc *arcs) {
    const int64_t listed = count ? runs[2 * count - 1] : 0;
    const size_t along_stride = axis == ALONG_X ? 1 : (size_t)width,
                 across_stride = axis == ALONG_X ? (size_t)width : 1;
    const int size = axis == ALONG_X ? height : width;
    for (int64_t i = 0; i < count; i++) {
        const int64_t first = runs[2 * i], last = runs[2 * i + 1];
        Arc *arc = &arcs[i];
        memset(arc, 0, sizeof(*arc));
        const EdgePoint *middle = &points[rows[(first + last) / 2]];
        const double along = middle->along, across = middle->across;
        arc->origin[0] = axis == ALONG_X ? along : across;
        arc->origin[1] = axis == ALONG_X ? across : along;
        /* apart from the arc, so that they stay in registers */
        double sums[MOMENTS] = {0}, norm = 0;
        int64_t dark = 0, bright = 0, beside = 0;
        Vector start = {0, 0}, end = {0, 0};
        for (int64_t j = first; j < last; j++) {
            if (j + POINTS_AHEAD < listed) {
                __builtin_prefetch(&points[rows[j + POINTS_AHEAD]]);
                const EdgePoint *later = &points[rows[j + GRAY_AHEAD]];
                const uint8_t *line = gray + (size_t)later->along * along_stride;
                const int pixel = (int)later->across;
                __builtin_prefetch(line + (size_t)clamp(pixel - (int)SIDE_DISTANCE, 0, size - 1) * across_stride);
                __builtin_prefetch(line + (size_t)clamp(pixel + (int)SIDE_DISTANCE, 0, size - 1) * across_stride);
            }
            const EdgePoint *point = &points[rows[j]];
            const double x_place = axis == ALONG_X ? point->along : point->across;
            const double y_place = axis == ALONG_X ? point->across : point->along;
            const Vector place = {x_place, y_place};
            const double x = place.x - arc->origin[0], y = place.y - arc->origin[1], z = x * x + y * y;
            sums[0] += 1, sums[1] += x, sums[2] += y;
            sums[3] += x * x, sums[4] += x * y, sums[5] += y * y;
            sums[6] += x * z, sums[7] += y * z, sums[8] += z * z;
            norm += fabs((double)point->norm);
            if (j == first) start = place;
            end = place;
            /* grey levels three pixels off change slowly: every second is enough, the same from either end */
            if ((j - first < last - 1 - j ? j - first : last - 1 - j) % 2) continue;
            beside++;
            const float slope = point->slope;
            const float scale = (point->norm > 0 ? SIDE_DISTANCE : -SIDE_DISTANCE) / sqrtf(1 + slope * slope);
            const float step_x = axis == ALONG_X ? -slope * scale : scale;
            const float step_y = axis == ALONG_X ? scale : -slope * scale;
            dark += gray_near(gray, width, height, (float)place.x - step_x, (float)place.y - step_y);
            bright += gray_near(gray, width, height, (float)place.x + step_x, (float)place.y + step_y);
        }
        memcpy(arc->sums, sums, sizeof(sums));
        arc->traits[0] = (double)dark * sums[0] / (double)beside;
        arc->traits[1] = (double)bright * sums[0] / (double)beside;
        arc->traits[2] = norm;
        const int forward = (points[rows[first]].norm > 0) == (axis == ALONG_X);
        fit_arc(arc, forward ? start : end, forward ? end : start);
        arc->first_piece = arc->last_piece = number + (int32_t)i;
        arc->first_join = arc->last_join = -1;
    }
}
