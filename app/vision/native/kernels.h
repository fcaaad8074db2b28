/* What the detector's kernels share. Coordinates are px, x right, y down, pixel centre at integers. */
#ifndef CLEARLINES_KERNELS_H
#define CLEARLINES_KERNELS_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#if defined(_WIN32)
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

#define RADIANS_PER_DEGREE 0.017453292519943295
#define ROOT_OF_TWO 1.4142135623730951

/* For loops that wider registers make faster; the results are the same, as no multiply and add are fused. */
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__GLIBC__)
#define FOR_EACH_PROCESSOR __attribute__((target_clones("avx2", "default")))
#else
#define FOR_EACH_PROCESSOR
#endif

enum { ALONG_X = 0, ALONG_Y = 1 };
/* What a kernel returns in place of a count. */
enum { OUT_OF_MEMORY = -1, CANCELLED = -2, NO_ROOM = -3 };

/* Told now and then what share of the call's work is done, in [0, 1]; anything but 0 cancels it. May be null. */
typedef int32_t (*Report)(double share);
static inline int is_cancelled(Report report, int64_t done, int64_t total) {
    return report && report(total > 0 ? (double)done / (double)total : 1);
}

/* A sub-pixel edge point of one pass, found at a pixel of its map. */
typedef struct {
    int32_t along; /* pixel coordinate along the axis of the pass */
    float across;  /* sub-pixel coordinate across it */
    float slope;   /* d across / d along of the edge */
    float norm;    /* gradient norm of the equalised image; negative where it gets darker with rising across */
} EdgePoint;

/* Gradient of the equalised image at a pixel, in steps of 1 / GRADIENT_SCALE grey levels. */
typedef struct {
    int16_t x, y;
} Steps;
#define GRADIENT_SCALE 16.0

/* SPAN_PIXELS pixels of a line: which of them have points, the lowest bit first, and how many points come before. */
typedef struct {
    int32_t before;
    uint32_t occupied;
} Span;

typedef struct {
    int32_t width, height;
    const uint8_t *gray;
    const Steps *gradient;
    const EdgePoint *points[2]; /* of both passes */
    const Span *spans[2];       /* where they are; see Places */
} Scene;

enum { MOMENTS = 9, TRAITS = 3 };

/* A circular arc fitted to edge points, directed so that the image is brighter on the side of its normal. */
typedef struct {
    double origin[2];                /* what the sums are about */
    double sums[MOMENTS];            /* of 1, x, y, xx, xy, yy, xz, yz, zz with z = xx + yy */
    double traits[TRAITS];           /* sums of the grey level on the dark side, on the bright side, and of the norm */
    double foot[2];                  /* point of the arc nearest the centroid */
    double tangent[2];               /* unit direction there */
    double bend;                     /* half the curvature, positive where the centre lies against the normal */
    double low, high;                /* start and end, measured along the tangent from the foot */
    double rms;                      /* of the distances of its points */
    int32_t first_piece, last_piece; /* list of the pieces it was merged from */
    int32_t first_join, last_join;   /* list of the joins that merged them */
} Arc;

typedef struct {
    double x, y;
} Vector;

static inline double dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y; }
static inline double cross(Vector a, Vector b) { return a.x * b.y - a.y * b.x; }
static inline Vector minus(Vector a, Vector b) { return (Vector){a.x - b.x, a.y - b.y}; }
/* fmin and fmax are calls where NaN could be meant */
static inline double smaller(double a, double b) { return a < b ? a : b; }
static inline double larger(double a, double b) { return a > b ? a : b; }
static inline int clamp(int value, int low, int high) { return value < low ? low : value > high ? high : value; }

/* arcs.c */
void fit_arc(Arc *arc, Vector start, Vector end);
void join_arcs(const Arc *first, int first_leaves_end, const Arc *second, int second_entered_at_start, Arc *joined);
Vector arc_position(const Arc *arc, double u);
Vector arc_direction(const Arc *arc, double u);
void arc_project(const Arc *arc, Vector point, double *along, double *distance);
static inline Vector arc_end(const Arc *arc, int end) { return arc_position(arc, end ? arc->high : arc->low); }

/* splitting.c: write the first and one past the last index of each run, counted from `begin` on; `stack` has room for
 * 4 (count + 2). Returns the number of runs. */
int64_t split_chain(const float *along, const float *across, int count, int *stack, int64_t begin, int64_t *runs);

/* gaps.c */
double effective_gap(const Scene *scene, const Arc *first, const Arc *second, Vector leave, Vector enter,
                     int same_polarity);
void fetch_gap(const Scene *scene, Vector leave, Vector enter);

#endif
