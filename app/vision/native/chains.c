/* Linking edge points into chains and splitting these into runs that an arc fits; see app/vision/chaining.py. */
#include "kernels.h"
#include "places.h"

enum { LONGEST_STEP = 3, SHORTEST_CHAIN = 5, SHORTEST_RUN = 6, POINTS_FOR_CURVATURE = 24 };
/* px, of a point from where the mean of both slopes puts it: without a step, and for each */
#define LARGEST_MISFIT 0.7f
#define MISFIT_PER_STEP 0.3f
#define LARGEST_TURN 1.0f
#define TOLERANCE 0.7f
#define LARGEST_CURVATURE (1.0 / 300)

#define TAKEN -1.0f
/* RING: lines whose points may still be linked to the next one, a power of two */
enum { WINDOW = 2, WIDEST = 2 * WINDOW + 1, LIKELY = 2, RING = 4 };

/* The points of one pass; those up to `low` are left out. */
typedef struct {
    const EdgePoint *points;
    Places places;
    int lines;
    float low;
} Field;

/* What linking has found so far, and the room it works in. */
typedef struct {
    int32_t *following; /* of each point, -1 where there is none */
    uint8_t *preceded;  /* whether a point follows another */
    /* of the latest lines, the points without a following one */
    int32_t *loose[RING];
    int count[RING];
    /* of the loose points of one line: the best in the line looked at, -1 where there is none, and its misfit */
    int32_t *best;
    float *least;
    /* of the points of the line looked at, and of one more that isn't there: misfit of the nearest source; TAKEN where
     * none may be */
    float *nearest;
    /* pairs of a loose point, by its number in its line, and one that may follow it, and their misfit */
    int32_t *source, *target;
    float *misfit;
} Links;

static int32_t first_of_line(const Field *field, int line) {
    return field->places.before[(size_t)line * field->places.line_bytes];
}

/* The loops of linking branch on nothing that depends on a point, as none of it can be guessed: what there may be is
 * written in any case, and counted if it is there. */

/* List all points of a line within two pixels of where loose points point: wide enough for every pair that both slopes
 * allow, or the direction of linking would matter. Returns the number of pairs. */
static int list_pairs(const Field *field, int line, int step, const int32_t *loose, int count, int32_t *source,
                      int32_t *target) {
    int pairs = 0;
    for (int i = 0; i < count; i++) {
        const EdgePoint *from = &field->points[loose[i]];
        const int expected = (int)lrintf(from->across + from->slope * (float)step);
        const Window window = window_at(&field->places, line, expected - WINDOW, WIDEST);
        const int found = bits_set[window.bits];
        for (int k = 0; k < LIKELY || k < found; k++) source[pairs + k] = i, target[pairs + k] = window.first + k;
        pairs += found;
    }
    return pairs;
}

/* Leave the pairs that fit. Returns their number. */
static int keep_fitting(const Field *field, int step, const int32_t *loose, int32_t first, int count, Links *links) {
    const float limit = LARGEST_MISFIT + MISFIT_PER_STEP * (float)step;
    int32_t *source = links->source, *target = links->target;
    float *restrict misfits = links->misfit;
    const float *nearest = links->nearest;
    int kept = 0;
    for (int i = 0; i < count; i++) {
        const int32_t one = source[i], other = target[i];
        const EdgePoint *from = &field->points[loose[one]], *to = &field->points[other];
        const float slope = 0.5f * (from->slope + to->slope);
        const float misfit = fabsf(to->across - from->across - slope * (float)step);
        source[kept] = one, target[kept] = other - first, misfits[kept] = misfit;
        kept += (nearest[other - first] >= 0) & ((to->norm > 0) == (from->norm > 0)) &
                (fabsf(to->slope - from->slope) <= LARGEST_TURN) & (misfit <= limit);
    }
    return kept;
}

/* Link loose points to those of a line `step` lines on, where each is the other's nearest. */
static void link_line(const Field *field, int line, int step, Links *links) {
    const int32_t first = first_of_line(field, line), size = first_of_line(field, line + 1) - first;
    const int number = (line - step) % RING, count = links->count[number];
    int32_t *loose = links->loose[number], *best = links->best;
    float *least = links->least, *nearest = links->nearest;
    int pairs = list_pairs(field, line, step, loose, count, links->source, links->target);
    pairs = keep_fitting(field, step, loose, first, pairs, links);
    for (int i = 0; i < count; i++) best[i] = size, least[i] = INFINITY;
    for (int i = 0; i < pairs; i++) {
        const int32_t one = links->source[i], other = links->target[i];
        const float misfit = links->misfit[i];
        best[one] = misfit < least[one] ? other : best[one];
        least[one] = misfit < least[one] ? misfit : least[one];
        nearest[other] = misfit < nearest[other] ? misfit : nearest[other];
    }
    nearest[size] = TAKEN;
    int left = 0;
    for (int i = 0; i < count; i++) {
        const int32_t one = loose[i], other = best[i];
        const int linked = least[i] == nearest[other];
        nearest[other] = linked ? TAKEN : nearest[other];
        links->following[one] = linked ? first + other : -1;
        links->preceded[linked ? first + other : one] |= (uint8_t)linked;
        loose[left] = one;
        left += !linked;
    }
    links->count[number] = left;
    for (int32_t i = 0; i < size; i++) nearest[i] = nearest[i] >= 0 ? INFINITY : TAKEN;
}

/* Link every point to the one that follows it, one to three lines on, where each is the other's nearest; nearer lines
 * come first. */
static void link_points(const Field *field, Links *links) {
    for (int line = 0; line < field->lines; line++) {
        const int32_t first = first_of_line(field, line), last = first_of_line(field, line + 1);
        int32_t *loose = links->loose[line % RING];
        int count = 0;
        for (int32_t i = first; i < last; i++) {
            const int strong = fabsf(field->points[i].norm) > field->low;
            links->nearest[i - first] = strong ? INFINITY : TAKEN;
            links->following[i] = -1;
            links->preceded[i] = 0;
            loose[count] = i;
            count += strong;
        }
        links->count[line % RING] = count;
        for (int step = 1; step <= LONGEST_STEP && step <= line; step++) link_line(field, line, step, links);
    }
}

/* Take memory for `points` in lines of at most `most`; it must be freed even if there is not enough. */
static int take_memory(Links *links, size_t points, size_t most) {
    const size_t pairs = WIDEST * most + LIKELY;
    *links = (Links){.following = malloc(sizeof(int32_t) * points),
                     .preceded = malloc(points),
                     .best = malloc(sizeof(int32_t) * ((RING + 1) * most + 2 * pairs)),
                     .least = malloc(sizeof(float) * (2 * most + pairs))};
    if (!links->following || !links->preceded || !links->best || !links->least) return OUT_OF_MEMORY;
    for (int i = 0; i < RING; i++) links->loose[i] = links->best + (size_t)(i + 1) * most;
    links->source = links->best + (RING + 1) * most;
    links->target = links->source + pairs;
    links->nearest = links->least + most;
    links->misfit = links->nearest + most;
    return 0;
}

static void free_memory(Links *links) {
    free(links->following);
    free(links->preceded);
    free(links->best);
    free(links->least);
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
 * points (count,), occupied, before: see cl_edge_points. low, high: hysteresis on the norm.
 * Written: rows int32, room for (count,), the chained points in order; chain_ends int64, room for (count,); runs int64,
 * room for (count, 2), first and one past last index into rows; sizes int64 (2,): chained points and chains.
 * Returns the number of runs or OUT_OF_MEMORY. */
EXPORT FOR_EACH_PROCESSOR int64_t cl_runs(const EdgePoint *points, int64_t count, const uint8_t *occupied,
                                          const int32_t *before, int axis, int width, int height, double low,
                                          double high, int32_t *rows, int64_t *chain_ends, int64_t *runs,
                                          int64_t *sizes) {
    const int lines = axis == ALONG_X ? width : height, across_size = axis == ALONG_X ? height : width;
    const Field field = {points, {occupied, before, line_bytes(across_size)}, lines, (float)low};
    const size_t room = (size_t)(count ? count : 1), most = (size_t)across_size + 1;
    Links links;
    float *along = malloc(sizeof(float) * 2 * (size_t)lines);
    int *stack = malloc(sizeof(int) * 4 * (size_t)(lines + 2));
    int64_t found = 0, used = 0, chains = 0;
    if (take_memory(&links, room, most) || !along || !stack) {
        found = OUT_OF_MEMORY;
        goto end;
    }
    float *across = along + lines;
    link_points(&field, &links);
    for (int64_t i = 0; i < count; i++) {
        if (links.preceded[i] || links.following[i] < 0) continue;
        int length = 0;
        float strongest = 0;
        for (int32_t row = (int32_t)i; row >= 0; row = links.following[row]) {
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
    free_memory(&links);
    free(along);
    free(stack);
    return found;
}
