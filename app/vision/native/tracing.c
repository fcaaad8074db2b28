#include "tracing.h"
#include "places.h"

enum { BATCH = 32 };
#define TOLERANCE 1.5
#define ANGLE 0.5       /* tan 26.6 degrees */
#define LOOSE_ANGLE 1.0 /* where a corner rounds off, the edge still reaches there */
#define CLOSE_TOLERANCE 0.5
#define CLOSE_ANGLE 0.14054083470239145 /* tan 8 degrees */

Walk walk_along(const Arc *arc, double low, double high) {
    Walk walk;
    walk.axis = fabs(arc->tangent[0]) >= fabs(arc->tangent[1]) ? ALONG_X : ALONG_Y;
    const Vector start = arc_position(arc, low), end = arc_position(arc, high);
    const double from = walk.axis == ALONG_X ? start.x : start.y, to = walk.axis == ALONG_X ? end.x : end.y;
    /* an end lies at a column up to rounding: half a column more keeps it in */
    const int least = (int)ceil(smaller(from, to) - 0.5), most = (int)floor(larger(from, to) + 0.5);
    walk.step = arc->tangent[walk.axis] > 0 ? 1 : -1;
    walk.first = walk.step > 0 ? least : most;
    walk.last = walk.step > 0 ? most : least;
    return walk;
}

/* Where an arc passes some columns (or rows, for steep arcs) in a row. */
typedef struct {
    double u[BATCH], across[BATCH], slope[BATCH], cosine[BATCH];
} Crossings;

/* With v the signed distance from the tangent, the arc is bend (u^2 + v^2) + v = 0, and the column is
 * u main + v normal = d: a quadratic in v. Beyond the circle's own columns the nearest of them counts. */
FOR_EACH_PROCESSOR static void cross_columns(const Arc *arc, int axis, int first, int step, int count,
                                             Crossings *restrict crossings) {
    const double main = arc->tangent[axis], other = arc->tangent[!axis], bend = arc->bend;
    const double normal = axis == ALONG_X ? -other : other, across_normal = axis == ALONG_X ? main : -main;
    const double foot_along = arc->foot[axis], foot_across = arc->foot[!axis];
    for (int i = 0; i < count; i++) {
        const double d = first + i * step - foot_along;
        const double half = main * main - 2 * bend * d * normal, square = half * half - 4 * bend * bend * d * d;
        const double root = sqrt(square > 0 ? square : 0), divisor = half + root;
        const double v = divisor > 0 ? -2 * bend * d * d / divisor : 0, u = (d - v * normal) / main;
        /* direction of the arc there, in parts of the tangent and of the normal */
        const double cosine = 1 + 2 * bend * v, sine = -2 * bend * u;
        const double forward = cosine * main + sine * normal, side = cosine * other + sine * across_normal;
        crossings->u[i] = u;
        crossings->across[i] = foot_across + u * other + v * across_normal;
        crossings->slope[i] = side / forward;
        crossings->cosine[i] = fabs(forward);
    }
}

enum { NEIGHBOURS = 3 };

static inline Places places_of(const Scene *scene, int axis) {
    return (Places){scene->spans[axis], line_spans(axis == ALONG_X ? scene->height : scene->width)};
}

/* The line that has the points where an arc passes; in the margins there are none, and the lines beyond have none. */
static inline int line_at(const Scene *scene, int axis, int along) {
    const int lines = axis == ALONG_X ? scene->width : scene->height;
    return along >= 0 && along < lines ? along : lines;
}

static inline int pixel_at(const Scene *scene, int axis, int pixel) {
    return clamp(pixel, -2, (axis == ALONG_X ? scene->height : scene->width) + 1);
}

static inline void fetch_place(const Scene *scene, const Places *places, int axis, int along, int pixel) {
    const size_t span = (size_t)(pixel_at(scene, axis, pixel) - 1 + MARGIN) / SPAN_PIXELS;
    __builtin_prefetch(places->spans + (size_t)line_at(scene, axis, along) * places->line_spans + span);
}

/* The points at the pixel that an arc passes and at those on either side of it, -1 where there is none; the middle one
 * first, as it wins a draw. */
static inline void look_up(const Scene *scene, const Places *places, int axis, int along, int pixel,
                           int32_t rows[NEIGHBOURS]) {
    const Window window = window_at(places, line_at(scene, axis, along), pixel_at(scene, axis, pixel) - 1, NEIGHBOURS);
    const int32_t below = window.bits & 1, own = window.bits >> 1 & 1, above = window.bits >> 2;
    rows[0] = own ? window.first + below : -1;
    rows[1] = below ? window.first : -1;
    rows[2] = above ? window.first + below + own : -1;
}

static inline Sample sample_crossing(const EdgePoint *points, const int32_t rows[NEIGHBOURS], int pixel,
                                     const Crossings *crossings, int i) {
    const double across = crossings->across[i], arc_slope = crossings->slope[i];
    /* what stands for a point that isn't there: whether one is cannot be guessed, so nothing branches on it */
    static const EdgePoint nowhere = {.across = INFINITY};
    const EdgePoint *nearest = &nowhere;
    double misfit = INFINITY;
    for (int k = 0; k < NEIGHBOURS; k++) {
        const EdgePoint *point = rows[k] < 0 ? &nowhere : &points[rows[k]];
        const double difference = point->across - across;
        const int nearer = fabs(difference) < fabs(misfit);
        misfit = nearer ? difference : misfit;
        nearest = nearer ? point : nearest;
    }
    const double distance = misfit * crossings->cosine[i], slope = nearest->slope;
    const double turn = fabs(slope - arc_slope), level = fabs(1 + slope * arc_slope);
    const int hit = (fabs(distance) <= TOLERANCE) & (turn <= ANGLE * level);
    const int close = (fabs(distance) <= CLOSE_TOLERANCE) & (turn <= CLOSE_ANGLE * level);
    const int loose = (fabs(distance) <= TOLERANCE) & (turn <= LOOSE_ANGLE * level);
    return (Sample){crossings->u[i],
                    (float)across,
                    pixel,
                    nearest->across,
                    (float)distance,
                    fabsf(nearest->norm),
                    hit * HIT | close * CLOSE | loose * LOOSE};
}

/* In rounds, each of which has the memory fetched that the next one reads. */
FOR_EACH_PROCESSOR void sample_walk(const Scene *scene, const Arc *arc, Walk walk, Sample *samples) {
    Crossings crossings;
    int32_t rows[BATCH][NEIGHBOURS], pixels[BATCH];
    const EdgePoint *points = scene->points[walk.axis];
    const Places places = places_of(scene, walk.axis);
    const int length = walk_length(walk);
    for (int start = 0; start < length; start += BATCH) {
        const int count = length - start < BATCH ? length - start : BATCH, first = walk.first + start * walk.step;
        cross_columns(arc, walk.axis, first, walk.step, count, &crossings);
        for (int i = 0; i < count; i++) {
            pixels[i] = (int)lrint(crossings.across[i]);
            fetch_place(scene, &places, walk.axis, first + i * walk.step, pixels[i]);
        }
        for (int i = 0; i < count; i++) {
            look_up(scene, &places, walk.axis, first + i * walk.step, pixels[i], rows[i]);
            for (int k = 0; k < NEIGHBOURS; k++) __builtin_prefetch(points + (rows[i][k] > 0 ? rows[i][k] : 0));
        }
        for (int i = 0; i < count; i++) samples[start + i] = sample_crossing(points, rows[i], pixels[i], &crossings, i);
    }
}
