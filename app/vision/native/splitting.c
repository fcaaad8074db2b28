/* Splitting chains into runs that an arc fits; see app/vision/chaining.py. */
#include "kernels.h"

enum { SHORTEST_RUN = 6, POINTS_FOR_CURVATURE = 24 };
#define TOLERANCE 0.7f
#define LARGEST_CURVATURE (1.0 / 300)

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

/* The point of a cut belongs to neither side: a corner is no measurement of either edge. */
int64_t split_chain(const float *along, const float *across, int count, int *stack, int64_t begin, int64_t *runs) {
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
