/* Directional Canny with sub-pixel positions, row by row; see app/vision/edges.py. */
#include "equalisation.h"
#include "gradient.h"
#include "kernels.h"
#include "places.h"

enum { REPORT_PIXELS = 32768, MARKED_X = 1, MARKED_Y = 2 };
/* edges up to 5 degrees beyond the diagonal belong to both passes, or noise would chop those near 45 degrees */
#define SECTOR 1.1917535925942099f
#define LARGEST_SLOPE 2.0f
/* added to a float below 2^21, it leaves the nearest integer in the low bits: no call, and whole vectors at once */
#define TO_INTEGER 12582912.0f

/* The points of one pass as they are found, image row by image row. */
typedef struct {
    EdgePoint *points;
    int64_t count;
    Span *spans; /* see Places */
    size_t line_spans;
    int32_t *latest; /* point of each line, where there is one */
} Pass;

/* Both gradients round an edge pixel, across the edge: the equalised one at -1..1, the plain one at -2..2. */
typedef struct {
    float norm[3], forward[3], sideways[3];
    float plain_norm[5], plain_forward[3];
} Profile;

static int16_t to_step(float value) {
    const float shifted = value * (float)GRADIENT_SCALE + TO_INTEGER;
    int32_t bits;
    memcpy(&bits, &shifted, sizeof(bits));
    return (int16_t)bits;
}

FOR_EACH_PROCESSOR static void write_steps(const float *x, const float *y, int width, Steps *restrict steps) {
    for (int i = 0; i < width; i++) steps[i] = (Steps){to_step(x[i]), to_step(y[i])};
}

/* Mark the pixels of a row whose norm is largest across the edge, for the pass or passes that their edge belongs to. */
static void mark_maxima(const float *above, const float *norm, const float *below, const float *gradient_x,
                        const float *gradient_y, int width, float weakest, uint8_t *restrict marks) {
    marks[0] = marks[width - 1] = 0;
    for (int x = 1; x < width - 1; x++) {
        const float n = norm[x], ax = fabsf(gradient_x[x]), ay = fabsf(gradient_y[x]);
        const int strong = n > weakest;
        const int along_x = strong & (n > above[x]) & (n >= below[x]) & (ay * SECTOR >= ax);
        const int along_y = strong & (n > norm[x - 1]) & (n >= norm[x + 1]) & (ax * SECTOR >= ay);
        marks[x] = (uint8_t)(along_x * MARKED_X | along_y * MARKED_Y);
    }
}

/* List the pixels with any mark; returns their number. */
static int list_marked(const uint8_t *marks, int width, int32_t *list) {
    int count = 0, x = 0;
    for (; x + 8 <= width; x += 8) {
        uint64_t eight;
        memcpy(&eight, marks + x, sizeof(eight));
        if (!eight) continue;
        /* every pixel is written: which ones are marked cannot be guessed */
        for (int i = x; i < x + 8; i++) {
            list[count] = i;
            count += marks[i] != 0;
        }
    }
    for (; x < width; x++) {
        list[count] = x;
        count += marks[x] != 0;
    }
    return count;
}

/* List those of some pixels that have one mark; returns their number. */
static int choose_marked(const uint8_t *marks, const int32_t *pixels, int size, int mark, int32_t *chosen) {
    int count = 0;
    for (int i = 0; i < size; i++) {
        chosen[count] = pixels[i];
        count += (marks[pixels[i]] & mark) != 0;
    }
    return count;
}

/* Where the plain gradient has its maximum across an edge pixel of the equalised one: at most one pixel away and on the
 * same side of the step, the pixel itself first. Returns the pixel's shift; the position only the equalised gradient
 * knows stays as it is. */
static int plain_maximum(const Profile *profile, float *offset) {
    const float *n = profile->plain_norm, *side = profile->plain_forward, sign = profile->forward[1];
    const int own = (n[2] >= n[1]) & (n[2] >= n[3]) & (side[1] * sign > 0);
    const int before = (n[1] >= n[0]) & (n[1] >= n[2]) & (side[0] * sign > 0);
    const int after = (n[3] >= n[2]) & (n[3] >= n[4]) & (side[2] * sign > 0);
    int shift = 0;
    const float *peak = n + 2;
    if (!own) {
        if (before && !(after && n[3] > n[1])) shift = -1, peak = n + 1;
        else if (after) shift = 1, peak = n + 3;
        else peak = profile->norm + 1;
    }
    const float bend = peak[-1] - 2 * peak[0] + peak[1], tilt = peak[-1] - peak[1];
    *offset = (float)shift + (bend < 0 ? 0.5f * tilt / bend : 0);
    return shift;
}

/* Put a point down at pixel (along, across + shift); of two edge pixels that were led to one maximum between them the
 * stronger stays. */
static inline void put(Pass *pass, const Profile *profile, int along, int across) {
    float offset;
    const int shift = plain_maximum(profile, &offset);
    const float forward = profile->forward[1 + shift], sideways = profile->sideways[1 + shift];
    const float norm = profile->norm[1 + shift];
    const int steep = (fabsf(sideways) <= LARGEST_SLOPE * fabsf(forward)) & (forward != 0);
    const EdgePoint point = {along, (float)across + offset, steep ? -sideways / forward : 0,
                             profile->forward[1] > 0 ? norm : -norm};
    const size_t place = (size_t)(across + shift + MARGIN);
    Span *span = &pass->spans[(size_t)along * pass->line_spans + place / SPAN_PIXELS];
    const uint32_t bit = 1u << place % SPAN_PIXELS;
    if (!(span->occupied & bit)) {
        span->occupied |= bit;
        pass->latest[along] = (int32_t)pass->count;
        pass->points[pass->count++] = point;
        return;
    }
    /* shifts of one pixel leave the points of a line in order, so it can only be the latest */
    EdgePoint *other = &pass->points[pass->latest[along]];
    if (fabsf(point.norm) > fabsf(other->norm)) *other = point;
}

/* Count the points before each span of a pass. */
FOR_EACH_PROCESSOR static void count_before(const Pass *pass, int lines) {
    const size_t spans = (size_t)(lines + LINES_BEYOND) * pass->line_spans;
    int32_t count = 0;
    for (size_t i = 0; i < spans; i++) {
        pass->spans[i].before = count;
        count += bits_set(pass->spans[i].occupied);
    }
}

/* Order points found row by row by their columns; `next` gets a point to be written next for each of these. */
static void order_by_line(const Pass *pass, int lines, int32_t *next, EdgePoint *ordered) {
    for (int line = 0; line < lines; line++) next[line] = pass->spans[(size_t)line * pass->line_spans].before;
    for (int64_t i = 0; i < pass->count; i++) ordered[next[pass->points[i].along]++] = pass->points[i];
}

/* Edge points of both passes in image row y, neither the first nor the last. */
static void find_points(const Gradient *equalised, const Gradient *plain, int y, float weakest, uint8_t *marks,
                        int32_t *list, Pass passes[2]) {
    const int width = equalised->width, height = equalised->height;
    const float *norm[3], *gx[3], *gy[3], *plain_norm[5], *plain_y[3];
    for (int k = 0; k < 3; k++) {
        norm[k] = kept_row(equalised->norm, width, y + k - 1);
        gx[k] = kept_row(equalised->x, width, y + k - 1);
        gy[k] = kept_row(equalised->y, width, y + k - 1);
        plain_y[k] = kept_row(plain->y, width, y + k - 1);
    }
    for (int k = 0; k < 5; k++) plain_norm[k] = kept_row(plain->norm, width, clamp(y + k - 2, 0, height - 1));
    const float *plain_x = kept_row(plain->x, width, y), *plain_own = plain_norm[2];
    mark_maxima(norm[0], norm[1], norm[2], gx[1], gy[1], width, weakest, marks);
    int32_t *chosen = list + width;
    const int marked = list_marked(marks, width, list);
    int count = choose_marked(marks, list, marked, MARKED_X, chosen);
    for (int i = 0; i < count; i++) {
        const int x = chosen[i];
        const Profile profile = {
            {norm[0][x], norm[1][x], norm[2][x]},
            {gy[0][x], gy[1][x], gy[2][x]},
            {gx[0][x], gx[1][x], gx[2][x]},
            {plain_norm[0][x], plain_norm[1][x], plain_own[x], plain_norm[3][x], plain_norm[4][x]},
            {plain_y[0][x], plain_y[1][x], plain_y[2][x]},
        };
        put(&passes[ALONG_X], &profile, x, y);
    }
    count = choose_marked(marks, list, marked, MARKED_Y, chosen);
    for (int i = 0; i < count; i++) {
        const int x = chosen[i], before = x > 1 ? x - 2 : 0, after = x < width - 2 ? x + 2 : width - 1;
        const Profile profile = {
            {norm[1][x - 1], norm[1][x], norm[1][x + 1]},
            {gx[1][x - 1], gx[1][x], gx[1][x + 1]},
            {gy[1][x - 1], gy[1][x], gy[1][x + 1]},
            {plain_own[before], plain_own[x - 1], plain_own[x], plain_own[x + 1], plain_own[after]},
            {plain_x[x - 1], plain_x[x], plain_x[x + 1]},
        };
        put(&passes[ALONG_Y], &profile, y, x);
    }
}

typedef struct {
    const uint8_t *gray;
    int width;
} Plain;

static void plain_row(const void *image, int row, float *out) {
    const Plain *plain = image;
    const uint8_t *gray = plain->gray + (size_t)row * (size_t)plain->width;
    for (int x = 0; x < plain->width; x++) out[x] = gray[x];
}

static void equalised_row(const void *image, int row, float *out) { equalise_row(image, row, out); }

/* Find the sub-pixel edge points of both passes, weak ones included.
 *
 * gray: uint8 (height, width), both 3 or more. tables, left, rightward: see cl_equalising_tables, cl_tile_weights.
 * sigma: blur of the equalised image, that edges are found in; position_sigma: of the plain one, that they are measured
 * in. weakest: norm that an edge point exceeds.
 * spans_x, spans_y: zeros. Written: gradient (height, width); of both passes the points, room for (capacity,) each,
 * counts int64 (2,), and spans as in Places.
 * Returns 1, or 0 where the room for points may be too small; OUT_OF_MEMORY or CANCELLED. */
EXPORT int cl_edge_points(const uint8_t *gray, int width, int height, const float *tables, int columns, int rows,
                          const int32_t *left, const float *rightward, double sigma, double position_sigma,
                          double weakest, Steps *gradient, EdgePoint *points_x, EdgePoint *points_y, int64_t capacity,
                          Span *spans_x, Span *spans_y, int64_t *counts, Report report) {
    const size_t line = (size_t)width;
    float *blended = malloc(sizeof(float) * 2 * (size_t)columns * LEVELS);
    const Equaliser equaliser = {gray, width, height, columns, rows, tables, left, rightward, blended};
    const Plain plain_image = {gray, width};
    Gradient equalised = {0}, plain = {0};
    uint8_t *marks = malloc(line);
    int32_t *list = malloc(sizeof(int32_t) * 2 * line), *latest = malloc(sizeof(int32_t) * (line + (size_t)height));
    EdgePoint *by_row = malloc(sizeof(EdgePoint) * (size_t)capacity);
    Pass passes[2] = {{by_row, 0, spans_x, line_spans(height), latest},
                      {points_y, 0, spans_y, line_spans(width), latest + width}};
    const int report_rows = clamp(REPORT_PIXELS / width, 16, height > 16 ? height : 16);
    int status = 1;
    if (!blended || !marks || !list || !latest || !by_row ||
        gradient_open(&equalised, equalised_row, &equaliser, width, height, sigma) ||
        gradient_open(&plain, plain_row, &plain_image, width, height, position_sigma)) {
        status = OUT_OF_MEMORY;
        goto end;
    }
    /* points are looked for two rows behind the gradient */
    for (int row = 0; row < height + 2; row++) {
        if (row < height) {
            if (row % report_rows == 0 && is_cancelled(report, row, height)) {
                status = CANCELLED;
                goto end;
            }
            gradient_advance(&equalised);
            gradient_advance(&plain);
            write_steps(kept_row(equalised.x, width, row), kept_row(equalised.y, width, row), width,
                        gradient + (size_t)row * line);
        }
        if (row < 3 || row >= height + 1) continue;
        if (passes[ALONG_X].count + width > capacity || passes[ALONG_Y].count + width > capacity) {
            status = 0;
            goto end;
        }
        find_points(&equalised, &plain, row - 2, (float)weakest, marks, list, passes);
    }
    count_before(&passes[ALONG_X], width);
    count_before(&passes[ALONG_Y], height);
    order_by_line(&passes[ALONG_X], width, latest, points_x);
    counts[ALONG_X] = passes[ALONG_X].count;
    counts[ALONG_Y] = passes[ALONG_Y].count;
end:
    gradient_close(&equalised);
    gradient_close(&plain);
    free(blended);
    free(marks);
    free(list);
    free(latest);
    free(by_row);
    return status;
}
