/* What the image says about the gap between two arcs that may be one; see app/vision/merging.py. */
#include "kernels.h"

/* one look per px of the gap, between these numbers */
enum { FEWEST_LOOKS = 4, MOST_LOOKS = 16 };
#define SUPPORT_NORM (float)(25 * GRADIENT_SCALE)
#define SUPPORT_COSINE 0.92387953251128674f
#define CROSSING_NORM (float)(60 * GRADIENT_SCALE)
#define GREY_CHANGE 25.0
#define CONTRAST_RATIO 0.5

static double gray_change(const Arc *first, const Arc *second) {
    const double n = first->sums[0], m = second->sums[0];
    return smaller(fabs(first->traits[0] / n - second->traits[0] / m),
                   fabs(first->traits[1] / n - second->traits[1] / m));
}

/* Whether the gradient at a place points across a direction, and how strong it is along it. */
static inline int supports(const Scene *scene, float x, float y, float dx, float dy, float *along) {
    const int column = clamp((int)lrintf(x), 0, scene->width - 1), row = clamp((int)lrintf(y), 0, scene->height - 1);
    const size_t pixel = (size_t)row * (size_t)scene->width + (size_t)column;
    const float gx = scene->gradient[pixel].x, gy = scene->gradient[pixel].y;
    const float squared = gx * gx + gy * gy, normal = gy * dx - gx * dy;
    *along = gx * dx + gy * dy;
    return (squared >= SUPPORT_NORM * SUPPORT_NORM) & (normal * normal >= SUPPORT_COSINE * SUPPORT_COSINE * squared);
}

/* Have memory fetched that effective_gap will read. */
void fetch_gap(const Scene *scene, Vector leave, Vector enter) {
    const Vector vector = minus(enter, leave);
    const int looks = clamp((int)(fabs(vector.x) + fabs(vector.y)) + 1, FEWEST_LOOKS, MOST_LOOKS);
    for (int i = 0; i < looks; i++) {
        const double t = (i + 0.5) / looks;
        const int column = clamp((int)(leave.x + t * vector.x), 0, scene->width - 1);
        const int row = clamp((int)(leave.y + t * vector.y), 0, scene->height - 1);
        __builtin_prefetch(&scene->gradient[(size_t)row * (size_t)scene->width + (size_t)column]);
    }
}

/* Share of the gap with an edge along it, and whether an edge runs across it. Looks at every place, as none can be
 * guessed. */
static double look(const Scene *scene, Vector leave, Vector vector, Vector direction, double gap, int *crossed) {
    const float dx = (float)direction.x, dy = (float)direction.y;
    const int looks = clamp((int)gap + 1, FEWEST_LOOKS, MOST_LOOKS);
    int supported = 0;
    *crossed = 0;
    for (int i = 0; i < looks; i++) {
        const double t = (i + 0.5) / looks;
        const float x = (float)(leave.x + t * vector.x), y = (float)(leave.y + t * vector.y);
        float along, unused;
        const int middle = supports(scene, x, y, dx, dy, &along);
        *crossed |= fabsf(along) > CROSSING_NORM;
        supported += middle | supports(scene, x + dy, y - dx, dx, dy, &unused) |
                     supports(scene, x - dy, y + dx, dx, dy, &unused);
    }
    return (double)supported / looks;
}

/* Length of a gap in px, made longer or shorter by the evidence for an interrupted edge. */
double effective_gap(const Scene *scene, const Arc *first, const Arc *second, Vector leave, Vector enter,
                     int same_polarity) {
    const Vector vector = minus(enter, leave);
    const double gap = sqrt(dot(vector, vector));
    double effective = gap;
    if (same_polarity && gray_change(first, second) > GREY_CHANGE) effective *= 1.7;
    const double a = first->traits[2] / first->sums[0], b = second->traits[2] / second->sums[0];
    if (smaller(a, b) < CONTRAST_RATIO * larger(a, b)) effective *= 1.5;
    if (gap > 1.5) {
        const Vector direction = {vector.x / gap, vector.y / gap};
        int crossed;
        effective *= 1 - 0.7 * look(scene, leave, vector, direction, gap, &crossed);
        if (!crossed) effective *= 0.5;
    }
    return effective;
}
