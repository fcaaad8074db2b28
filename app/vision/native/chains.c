/* Linking edge points into chains and splitting these into runs that an arc fits; see app/vision/chaining.py. */
#include "kernels.h"

enum { LONGEST_STEP = 3, SHORTEST_CHAIN = 5, SHORTEST_RUN = 6, POINTS_FOR_CURVATURE = 24 };
/* px, of a point from where the mean of both slopes puts it: without a step, and for each */
#define LARGEST_MISFIT 0.7f
#define MISFIT_PER_STEP 0.3f
#define LARGEST_TURN 1.0f
#define TOLERANCE 0.7f
#define LARGEST_CURVATURE (1.0 / 300)

#define TAKEN -1.0f
enum { WINDOW = 2, WIDEST = 2 * WINDOW + 1 };

typedef struct {
    const EdgePoint *points;
    const int32_t *map;
    int along_size, across_size;           /* of the image, px */
    ptrdiff_t along_stride, across_stride; /* of the map */
    float low;
} Field;

static Field field_of(const EdgePoint *points, const int32_t *map, int axis, int width, int height, float low) {
    return axis == ALONG_X ? (Field){points, map, width, height, 1, width, low}
                           : (Field){points, map, height, width, width, 1, low};
}

/* The points `step` columns ahead of one within two pixels of where it points: wide enough for every pair that both
 * slopes allow, or the direction of linking would matter. Returns their number. */
static int points_ahead(const Field *field, const EdgePoint *from, int step, int32_t ahead[WIDEST]) {
    const int along = from->along + step, expected = (int)lrintf(from->across + from->slope * (float)step);
    if (along >= field->along_size) return 0;
    const int32_t *place = field->map + along * field->along_stride + (expected - WINDOW) * field->across_stride;
    int count = 0;
    if (expected >= WINDOW && expected < field->across_size - WINDOW) {
        /* every pixel is written: whether there is a point cannot be guessed */
        for (int i = 0; i < WIDEST; i++) {
            ahead[count] = place[i * field->across_stride];
            count += ahead[count] >= 0;
        }
    } else {
        for (int i = 0; i < WIDEST; i++) {
            const int across = expected - WINDOW + i;
            if (across < 0 || across >= field->across_size) continue;
            ahead[count] = place[i * field->across_stride];
            count += ahead[count] >= 0;
        }
    }
    return count;
}

/* The point `step` columns ahead of `from` that fits best and its misfit; notes how near each target's
 * nearest source is. */
static int32_t best_target(const Field *field, const EdgePoint *from, int step, float *nearest_source, float *misfit) {
    const float limit = LARGEST_MISFIT + MISFIT_PER_STEP * (float)step;
    int32_t ahead[WIDEST], best = -1;
    float least = INFINITY;
    const int count = points_ahead(field, from, step, ahead);
    for (int i = 0; i < count; i++) {
        const int32_t target = ahead[i];
        const EdgePoint *to = &field->points[target];
        const float slope = 0.5f * (from->slope + to->slope);
        const float distance = fabsf(to->across - from->across - slope * (float)step);
        const float nearest = nearest_source[target];
        const int fits = (nearest >= 0) & ((to->norm > 0) == (from->norm > 0)) &
                         (fabsf(to->slope - from->slope) <= LARGEST_TURN) & (distance <= limit);
        if (!fits) continue;
        if (distance < nearest) nearest_source[target] = distance;
        if (distance < least) least = distance, best = target;
    }
    *misfit = least;
    return best;
}

typedef struct {
    int32_t *following, *preceding; /* -1 where there is none */
    int32_t *loose, *target;        /* points without a following one, and the best for each */
    float *misfit;
    float *nearest; /* misfit of each point's nearest source; TAKEN where there is a preceding one, or none may be */
} Links;

/* Link every point to the one that follows it, one to three columns on, where each is the other's nearest. */
static void link_points(const Field *field, int64_t count, Links links) {
    memset(links.following, 0xff, (size_t)count * sizeof(int32_t));
    memset(links.preceding, 0xff, (size_t)count * sizeof(int32_t));
    int64_t loose = 0;
    for (int64_t i = 0; i < count; i++) {
        const int strong = fabsf(field->points[i].norm) > field->low;
        links.nearest[i] = strong ? INFINITY : TAKEN;
        links.loose[loose] = (int32_t)i;
        loose += strong;
    }
    for (int step = 1; step <= LONGEST_STEP; step++) {
        for (int64_t i = 0; i < loose; i++)
            links.target[i] = best_target(field, &field->points[links.loose[i]], step, links.nearest, &links.misfit[i]);
        int64_t left = 0;
        for (int64_t i = 0; i < loose; i++) {
            const int32_t from = links.loose[i], to = links.target[i];
            if (to >= 0 && links.misfit[i] == links.nearest[to]) {
                links.following[from] = to;
                links.preceding[to] = from;
                links.nearest[to] = TAKEN;
            } else {
                links.loose[left++] = from;
            }
        }
        loose = left;
        for (int64_t i = 0; i < count; i++) links.nearest[i] = links.nearest[i] >= 0 ? INFINITY : TAKEN;
    }
}

/* The parabola through a run of points, across = constant + linear u + square u^2 with u measured from `middle`. */
typedef struct {
    float middle, constant, linear, square;
    float cosine; /* of its direction at the mean */
} Parabola;

static Parabola fit_parabola(const float *along, const float *across, int count) {
    const double middle = along[count / 2], level = across[count / 2];
    double su = 0, suu = 0, suuu = 0, suuuu = 0, sv = 0, suv = 0, suuv = 0;
    for (int i = 0; i < count; i++) {
        const double u = along[i] - middle, v = across[i] - level, square = u * u;
        su += u, suu += square, suuu += square * u, suuuu += square * square;
        sv += v, suv += u * v, suuv += square * v;
    }
    /* moments about the mean */
    const double m = su / count, n = sv / count, raw2 = suu / count, raw3 = suuu / count, raw4 = suuuu / count;
    const double uu = raw2 - m * m, uv = suv / count - m * n, uuu = raw3 - 3 * m * raw2 + 2 * m * m * m;
    const double tilt = uv / uu, cosine = 1 / sqrt(1 + tilt * tilt), skew = uuu / uu;
    /* by a polynomial orthogonal to 1 and u; curvature = 2 b cos^3 */
    double b = 0;
    if (count >= POINTS_FOR_CURVATURE) {
        const double uuuu = raw4 - 4 * m * raw3 + 6 * m * m * raw2 - 3 * m * m * m * m;
        const double uuv = suuv / count - 2 * m * suv / count + m * m * n - uu * n;
        const double norm = uuuu - uu * uu - skew * uuu, product = uuv - skew * uv;
        const double limit = LARGEST_CURVATURE / (2 * cosine * cosine * cosine), free = product / norm;
        if (norm > 0) b = free > limit ? limit : free < -limit ? -limit : free;
    }
    /* n + tilt (u - m) + b ((u - m)^2 - uu - skew (u - m)) in powers of u */
    const double linear = tilt - b * skew;
    return (Parabola){(float)middle, (float)(level + n - linear * m + b * (m * m - uu)), (float)(linear - 2 * b * m),
                      (float)b, (float)cosine};
}

/* Whether an arc fits a run of points to 0.7 px; if not, the point farthest from its chord. */
static int fits_arc(const float *along, const float *across, int count, int *cut) {
    const Parabola fit = fit_parabola(along, across, count);
    const float tolerance = TOLERANCE / fit.cosine;
    int outside = 0;
    for (int i = 0; i < count; i++) {
        const float u = along[i] - fit.middle;
        outside += fabsf(across[i] - fit.constant - u * (fit.linear + u * fit.square)) > tolerance;
    }
    if (!outside) return 1;
    const double start = along[0], level = across[0];
    const double chord = (across[count - 1] - level) / (along[count - 1] - start);
    double farthest = -1;
    for (int i = 1; i < count - 1; i++) {
        const double deviation = fabs(across[i] - level - chord * (along[i] - start));
        if (deviation > farthest) farthest = deviation, *cut = i;
    }
    return 0;
}

/* Split one chain; the point of a cut belongs to neither side: a corner is no measurement of either edge. */
static int64_t split_chain(const float *along, const float *across, int count, int *stack, int64_t begin,
                           int64_t *runs) {
    int64_t found = 0;
    int depth = 0;
    stack[depth++] = 0, stack[depth++] = count;
    while (depth) {
        const int stop = stack[--depth], start = stack[--depth];
        if (stop - start < SHORTEST_RUN) continue;
        int cut = 0;
        if (fits_arc(along + start, across + start, stop - start, &cut)) {
            runs[2 * found] = begin + start;
            runs[2 * found + 1] = begin + stop;
            found++;
        } else {
            stack[depth++] = start + cut + 1, stack[depth++] = stop;
            stack[depth++] = start, stack[depth++] = start + cut;
        }
    }
    return found;
}

/* Chain the points of one pass and split the chains.
 *
 * points (count,), map int32 (height, width). low, high: hysteresis on the norm.
 * Written: rows int32, room for (count,), the chained points in order; chain_ends int64, room for (count,); runs int64,
 * room for (count, 2), first and one past last index into rows; sizes int64 (2,): chained points and chains.
 * Returns the number of runs or OUT_OF_MEMORY. */
EXPORT int64_t cl_runs(const EdgePoint *points, int64_t count, const int32_t *map, int axis, int width, int height,
                       double low, double high, int32_t *rows, int64_t *chain_ends, int64_t *runs, int64_t *sizes) {
    const Field field = field_of(points, map, axis, width, height, (float)low);
    const size_t room = (size_t)(count ? count : 1);
    int32_t *rows_of_links = malloc(sizeof(int32_t) * 4 * room);
    float *distances = malloc(sizeof(float) * 2 * room);
    const int longest = axis == ALONG_X ? width : height;
    float *along = malloc(sizeof(float) * 2 * (size_t)longest);
    int *stack = malloc(sizeof(int) * 4 * (size_t)(longest + 2));
    int64_t found = 0, used = 0, chains = 0;
    if (!rows_of_links || !distances || !along || !stack) {
        found = OUT_OF_MEMORY;
        goto end;
    }
    float *across = along + longest;
    const Links links = {rows_of_links, rows_of_links + room, rows_of_links + 2 * room, rows_of_links + 3 * room,
                         distances,     distances + room};
    const int32_t *following = links.following, *preceding = links.preceding;
    link_points(&field, count, links);
    for (int64_t i = 0; i < count; i++) {
        if (preceding[i] >= 0 || following[i] < 0) continue;
        int length = 0;
        float strongest = 0;
        for (int32_t row = (int32_t)i; row >= 0; row = following[row]) {
            rows[used + length] = row;
            along[length] = (float)points[row].along;
            across[length] = points[row].across;
            const float norm = fabsf(points[row].norm);
            strongest = norm > strongest ? norm : strongest;
            length++;
        }
        if (length < SHORTEST_CHAIN || !(strongest > (float)high)) continue;
        found += split_chain(along, across, length, stack, used, runs + 2 * found);
        used += length;
        chain_ends[chains++] = used;
    }
    sizes[0] = used;
    sizes[1] = chains;
end:
    free(rows_of_links);
    free(distances);
    free(along);
    free(stack);
    return found;
}
