/* Circular arcs from moments: Taubin, IEEE TPAMI 13(11), 1991; see app/vision/arcs.py for the form used. */
#include "kernels.h"

#define LARGEST_CURVATURE 1e-3  /* an image of a straight edge bends no more than this under a usable lens; 1 / px */
#define POINTS_FOR_CURVATURE 24 /* fewer points say nothing about the curvature: a line is fitted */

typedef struct {
    double A, B, C, D, rms;
} Circle;

/* Moment sums about an origin moved by (dx, dy), by binomial expansion. */
static void shift_sums(const double *sums, double dx, double dy, double *out) {
    const double n = sums[0], sx = sums[1], sy = sums[2], sxx = sums[3], sxy = sums[4], syy = sums[5];
    const double sxz = sums[6], syz = sums[7], szz = sums[8];
    const double a = -dx, b = -dy, c = a * a + b * b, sz = sxx + syy;
    const double linear = a * sx + b * sy, linear_x = a * sxx + b * sxy, linear_y = a * sxy + b * syy;
    const double linear_z = a * sxz + b * syz, z = sz + 2 * linear + c * n;
    out[0] = n;
    out[1] = sx + a * n;
    out[2] = sy + b * n;
    out[3] = sxx + 2 * a * sx + a * a * n;
    out[4] = sxy + a * sy + b * sx + a * b * n;
    out[5] = syy + 2 * b * sy + b * b * n;
    out[6] = sxz + 2 * linear_x + c * sx + a * z;
    out[7] = syz + 2 * linear_y + c * sy + b * z;
    out[8] = szz + 4 * (a * linear_x + b * linear_y) + c * c * n + 4 * linear_z + 2 * c * sz + 4 * c * linear;
}

/* Parabola of at most the curvature `limit` over the principal axis, as a circle. */
static Circle fit_bounded(double xx, double xy, double yy, double xz, double yz, double zz, double limit) {
    const double half = 0.5 * (xx - yy), root = sqrt(half * half + xy * xy);
    double cosine = 1, sine = 0;
    if (root > 0) {
        /* the half angle, from the larger of the two components */
        if (half >= 0) {
            cosine = sqrt(0.5 * (1 + half / root));
            sine = xy / (2 * root * cosine);
        } else {
            sine = sqrt(0.5 * (1 - half / root));
            cosine = xy / (2 * root * sine);
        }
    }
    const double uu = 0.5 * (xx + yy) + root;
    const double vv = larger(xx * sine * sine - 2 * xy * cosine * sine + yy * cosine * cosine, 0);
    const double uz = cosine * xz + sine * yz, vz = cosine * yz - sine * xz;
    const double spread = uu > 0 ? uu : 1;
    const double room = larger(zz - uu * uu - uz * uz / spread, 0);
    double b = room > 0 ? vz / room : 0;
    b = smaller(larger(b, -0.5 * limit), 0.5 * limit);
    const double h = -b * uu, c = -b * uz / spread;
    Circle circle = {-b, -c * cosine - sine, -c * sine + cosine, -h, sqrt(larger(vv - 2 * b * vz + b * b * room, 0))};
    const double scale = 1 / sqrt(circle.B * circle.B + circle.C * circle.C - 4 * circle.A * circle.D);
    circle.A *= scale;
    circle.B *= scale;
    circle.C *= scale;
    circle.D *= scale;
    return circle;
}

/* Taubin's circle: smallest eigenpair of a symmetric 3 x 3 matrix. Returns 0 where it is degenerate. */
static int fit_taubin(double xx, double xy, double yy, double xz, double yz, double zz, Circle *circle) {
    const double s2 = xx + yy;
    if (!(s2 > 0)) return 0;
    const double s = sqrt(s2), m00 = 0.25 * (zz / (s2 * s2) - 1), m01 = 0.5 * xz / (s2 * s), m02 = 0.5 * yz / (s2 * s);
    const double m11 = xx / s2, m12 = xy / s2, m22 = yy / s2;
    const double trace = m00 + m11 + m22;
    const double minors = m00 * m11 - m01 * m01 + m00 * m22 - m02 * m02 + m11 * m22 - m12 * m12;
    const double determinant =
        m00 * (m11 * m22 - m12 * m12) - m01 * (m01 * m22 - m12 * m02) + m02 * (m01 * m12 - m11 * m02);
    /* Newton from 0, below every root, rises to the smallest root of t^3 - trace t^2 + minors t - determinant */
    double t = 0;
    for (int round = 0; round < 30; round++) {
        const double value = ((t - trace) * t + minors) * t - determinant;
        const double slope = (3 * t - 2 * trace) * t + minors;
        if (!(slope > 0)) break;
        const double step = value / slope;
        t -= step;
        if (fabs(step) <= 1e-14 * fabs(t)) break;
    }
    /* the eigenvector is orthogonal to the rows of M - t: the longest of their cross products */
    const double a = m00 - t, b = m11 - t, c = m22 - t;
    const double v[3][3] = {
        {m01 * m12 - m02 * b, m02 * m01 - a * m12, a * b - m01 * m01},
        {m01 * c - m02 * m12, m02 * m02 - a * c, a * m12 - m01 * m02},
        {b * c - m12 * m12, m12 * m02 - m01 * c, m01 * m12 - b * m02},
    };
    int best = -1;
    double longest = 0;
    for (int i = 0; i < 3; i++) {
        const double length = v[i][0] * v[i][0] + v[i][1] * v[i][1] + v[i][2] * v[i][2];
        if (length > longest) longest = length, best = i;
    }
    if (best < 0 || !(longest > 1e-60)) return 0;
    const double scale = 1 / sqrt(longest);
    circle->A = v[best][0] * scale / (2 * s);
    circle->B = v[best][1] * scale;
    circle->C = v[best][2] * scale;
    circle->D = -circle->A * s2;
    circle->rms = s * sqrt(larger(t, 0));
    return 1;
}

static void project_on(Vector foot, Vector tangent, double bend, Vector point, double *along, double *distance) {
    const Vector relative = minus(point, foot);
    const double u = dot(relative, tangent), v = cross(tangent, relative);
    const double F = bend * (u * u + v * v) + v;
    const double steepness = sqrt(larger(1 + 4 * bend * F, 1e-12));
    *along = u / steepness;
    *distance = 2 * F / (1 + steepness);
}

/* Fit an arc to its sums; `start` and `end` give its ends and its direction. */
void fit_arc(Arc *arc, Vector start, Vector end) {
    const double n = arc->sums[0], mx = arc->sums[1] / n, my = arc->sums[2] / n;
    double central[MOMENTS];
    shift_sums(arc->sums, mx, my, central);
    for (int i = 3; i < MOMENTS; i++) central[i] /= n;
    const double limit = n >= POINTS_FOR_CURVATURE ? LARGEST_CURVATURE : 0;
    Circle circle;
    const double *m = central;
    if (!(limit > 0) || !fit_taubin(m[3], m[4], m[5], m[6], m[7], m[8], &circle) || 2 * fabs(circle.A) > limit)
        circle = fit_bounded(m[3], m[4], m[5], m[6], m[7], m[8], limit);
    const double length = 1 / sqrt(circle.B * circle.B + circle.C * circle.C);
    const Vector normal = {circle.B * length, circle.C * length};
    const double offset = 2 * circle.D / (1 + sqrt(larger(1 + 4 * circle.A * circle.D, 0)));
    const Vector foot = {arc->origin[0] + mx - offset * normal.x, arc->origin[1] + my - offset * normal.y};
    Vector tangent = {normal.y, -normal.x};
    double bend = circle.A;
    if (dot(minus(end, start), tangent) < 0) {
        tangent = (Vector){-tangent.x, -tangent.y};
        bend = -bend;
    }
    arc->foot[0] = foot.x, arc->foot[1] = foot.y;
    arc->tangent[0] = tangent.x, arc->tangent[1] = tangent.y;
    arc->bend = bend;
    arc->rms = circle.rms;
    double distance;
    project_on(foot, tangent, bend, start, &arc->low, &distance);
    project_on(foot, tangent, bend, end, &arc->high, &distance);
}

Vector arc_position(const Arc *arc, double u) {
    const double bend = arc->bend, sine = 2 * bend * u;
    const double sagitta = -2 * bend * u * u / (1 + sqrt(larger(1 - sine * sine, 0)));
    return (Vector){arc->foot[0] + u * arc->tangent[0] - sagitta * arc->tangent[1],
                    arc->foot[1] + u * arc->tangent[1] + sagitta * arc->tangent[0]};
}

Vector arc_direction(const Arc *arc, double u) {
    const double sine = smaller(larger(-2 * arc->bend * u, -1), 1), cosine = sqrt(1 - sine * sine);
    return (Vector){cosine * arc->tangent[0] - sine * arc->tangent[1],
                    cosine * arc->tangent[1] + sine * arc->tangent[0]};
}

void arc_project(const Arc *arc, Vector point, double *along, double *distance) {
    const Vector foot = {arc->foot[0], arc->foot[1]}, tangent = {arc->tangent[0], arc->tangent[1]};
    project_on(foot, tangent, arc->bend, point, along, distance);
}

/* The arc through both arcs; its direction is that of the longer one. */
void join_arcs(const Arc *first, int first_leaves_end, const Arc *second, int second_entered_at_start, Arc *joined) {
    double moved[MOMENTS];
    shift_sums(second->sums, first->origin[0] - second->origin[0], first->origin[1] - second->origin[1], moved);
    joined->origin[0] = first->origin[0], joined->origin[1] = first->origin[1];
    for (int i = 0; i < MOMENTS; i++) joined->sums[i] = first->sums[i] + moved[i];
    const Vector begin = arc_end(first, !first_leaves_end), finish = arc_end(second, second_entered_at_start);
    const int longer_first = first->high - first->low >= second->high - second->low;
    const int onward = longer_first ? first_leaves_end : second_entered_at_start;
    /* a flipped arc's dark side is the other one's bright side */
    const int flipped = first_leaves_end != second_entered_at_start;
    const int turn_first = flipped && !longer_first, turn_second = flipped && longer_first;
    joined->traits[0] = first->traits[turn_first] + second->traits[turn_second];
    joined->traits[1] = first->traits[!turn_first] + second->traits[!turn_second];
    joined->traits[2] = first->traits[2] + second->traits[2];
    fit_arc(joined, onward ? begin : finish, onward ? finish : begin);
}
