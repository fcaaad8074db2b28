#include "tracing.h"

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

/* Where an arc passes a column (or row, for steep arcs). */
typedef struct {
    double u, across, slope, cosine;
} Crossing;

/* With v the signed distance from the tangent, the arc is bend (u^2 + v^2) + v = 0, and the column is
 * u main + v normal = d: a quadratic in v. Beyond the circle's own columns the nearest of them counts. */
static inline Crossing crossing_at(const Arc *arc, int axis, int along) {
    const double main = arc->tangent[axis], other = arc->tangent[!axis], bend = arc->bend;
    const double normal = axis == ALONG_X ? -other : other, d = along - arc->foot[axis];
    const double half = main * main - 2 * bend * d * normal, square = half * half - 4 * bend * bend * d * d;
    const double root = sqrt(square > 0 ? square : 0), divisor = half + root;
    const double v = divisor > 0 ? -2 * bend * d * d / divisor : 0, u = (d - v * normal) / main;
    /* direction of the arc there, in parts of the tangent and of the normal */
    const double cosine = 1 + 2 * bend * v, sine = -2 * bend * u;
    const double across_normal = axis == ALONG_X ? main : -main;
    const double forward = cosine * main + sine * normal, side = cosine * other + sine * across_normal;
    return (Crossing){u, arc->foot[!axis] + u * other + v * across_normal, side / forward, fabs(forward)};
}

enum { NEIGHBOURS = 3 };

/* The map at the pixel that an arc passes and at those on either side of it; the middle one first, as it wins a draw.
 */
static inline void look_up(const Scene *scene, int axis, int along, int pixel, int32_t rows[NEIGHBOURS]) {
    const int along_size = axis == ALONG_X ? scene->width : scene->height;
    const int across_size = axis == ALONG_X ? scene->height : scene->width;
    const ptrdiff_t stride = axis == ALONG_X ? scene->width : 1;
    const int32_t *map = scene->map[axis] + (axis == ALONG_X ? along : (ptrdiff_t)along * scene->width);
    const int inside = along >= 0 && along < along_size;
    rows[0] = inside && pixel >= 0 && pixel < across_size ? map[pixel * stride] : -1;
    rows[1] = inside && pixel > 0 && pixel <= across_size ? map[(pixel - 1) * stride] : -1;
    rows[2] = inside && pixel >= -1 && pixel < across_size - 1 ? map[(pixel + 1) * stride] : -1;
}

static inline Sample sample_crossing(const EdgePoint *points, const int32_t rows[NEIGHBOURS], int pixel,
                                     const Crossing *crossing) {
    /* what stands for a point that isn't there: whether one is cannot be guessed, so nothing branches on it */
    static const EdgePoint nowhere = {.across = INFINITY};
    const EdgePoint *nearest = &nowhere;
    double misfit = INFINITY;
    for (int i = 0; i < NEIGHBOURS; i++) {
        const EdgePoint *point = rows[i] < 0 ? &nowhere : &points[rows[i]];
        const double difference = point->across - crossing->across;
        const int nearer = fabs(difference) < fabs(misfit);
        misfit = nearer ? difference : misfit;
        nearest = nearer ? point : nearest;
    }
    const double distance = misfit * crossing->cosine, slope = nearest->slope;
    const double turn = fabs(slope - crossing->slope), level = fabs(1 + slope * crossing->slope);
    const int hit = (fabs(distance) <= TOLERANCE) & (turn <= ANGLE * level);
    const int close = (fabs(distance) <= CLOSE_TOLERANCE) & (turn <= CLOSE_ANGLE * level);
    const int loose = (fabs(distance) <= TOLERANCE) & (turn <= LOOSE_ANGLE * level);
    return (Sample){crossing->u,
                    (float)crossing->across,
                    pixel,
                    nearest->across,
                    (float)distance,
                    fabsf(nearest->norm),
                    hit * HIT | close * CLOSE | loose * LOOSE};
}

Sample sample_at(const Scene *scene, const Arc *arc, int axis, int along) {
    const Crossing crossing = crossing_at(arc, axis, along);
    const int pixel = (int)lrint(crossing.across);
    int32_t rows[NEIGHBOURS];
    look_up(scene, axis, along, pixel, rows);
    return sample_crossing(scene->points[axis], rows, pixel, &crossing);
}

/* In three rounds, each of which has the memory fetched that the next one reads. */
void sample_walk(const Scene *scene, const Arc *arc, Walk walk, Sample *samples) {
    Crossing crossings[BATCH];
    int32_t rows[BATCH][NEIGHBOURS], pixels[BATCH];
    const EdgePoint *points = scene->points[walk.axis];
    const int length = walk_length(walk);
    for (int start = 0; start < length; start += BATCH) {
        const int count = length - start < BATCH ? length - start : BATCH, first = walk.first + start * walk.step;
        for (int i = 0; i < count; i++) {
            crossings[i] = crossing_at(arc, walk.axis, first + i * walk.step);
            pixels[i] = (int)lrint(crossings[i].across);
        }
        for (int i = 0; i < count; i++) {
            look_up(scene, walk.axis, first + i * walk.step, pixels[i], rows[i]);
            for (int k = 0; k < NEIGHBOURS; k++) __builtin_prefetch(points + (rows[i][k] > 0 ? rows[i][k] : 0));
        }
        for (int i = 0; i < count; i++) samples[start + i] = sample_crossing(points, rows[i], pixels[i], &crossings[i]);
    }
}
