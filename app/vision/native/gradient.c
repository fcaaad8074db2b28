#include "gradient.h"
#include "kernels.h"

enum { BLURRED = 4 };

static int mirrored(int index, int size) {
    while (index < 0 || index >= size) index = index < 0 ? -index : 2 * (size - 1) - index;
    return index;
}

/* Copy the border's mirror image to both sides of a row; `row` points to its first pixel. */
static void pad_row(float *row, int width, int reach) {
    for (int i = 1; i <= reach; i++) {
        row[-i] = row[mirrored(-i, width)];
        row[width - 1 + i] = row[mirrored(width - 1 + i, width)];
    }
}

/* Weighted sum of 2 half + 1 rows, symmetric about the one in the middle, rows[half]. The usual sizes are spelled out,
 * so that sums stay in registers. */
FOR_EACH_PROCESSOR static void weigh(const float *const *rows, const float *weights, int half, int width,
                                     float *restrict out) {
    const float *const *own = rows + half, *centre = own[0];
    const float w = weights[0];
    if (half == 2) {
        const float w1 = weights[1], w2 = weights[2];
        const float *a1 = own[-1], *b1 = own[1], *a2 = own[-2], *b2 = own[2];
        for (int x = 0; x < width; x++) out[x] = w * centre[x] + w1 * (a1[x] + b1[x]) + w2 * (a2[x] + b2[x]);
    } else if (half == 3) {
        const float w1 = weights[1], w2 = weights[2], w3 = weights[3];
        const float *a1 = own[-1], *b1 = own[1], *a2 = own[-2], *b2 = own[2], *a3 = own[-3], *b3 = own[3];
        for (int x = 0; x < width; x++)
            out[x] = w * centre[x] + w1 * (a1[x] + b1[x]) + w2 * (a2[x] + b2[x]) + w3 * (a3[x] + b3[x]);
    } else {
        for (int x = 0; x < width; x++) out[x] = w * centre[x];
        for (int k = 1; k <= half; k++) {
            const float *a = own[-k], *b = own[k];
            for (int x = 0; x < width; x++) out[x] += weights[k] * (a[x] + b[x]);
        }
    }
}

/* Sobel's two factors along x; `blurred` is padded by one pixel. */
FOR_EACH_PROCESSOR static void sobel_along(const float *blurred, int width, float *restrict smooth,
                                           float *restrict slope) {
    for (int x = 0; x < width; x++) {
        const float before = blurred[x - 1], after = blurred[x + 1];
        smooth[x] = before + 2 * blurred[x] + after;
        slope[x] = after - before;
    }
}

/* Sobel's factors along y, and the norm. */
FOR_EACH_PROCESSOR static void sobel_across(const float *const *smooth, const float *const *slope, int width,
                                            float *restrict gradient_x, float *restrict gradient_y,
                                            float *restrict norm) {
    const float *smooth_above = smooth[0], *smooth_below = smooth[2];
    const float *slope_above = slope[0], *slope_own = slope[1], *slope_below = slope[2];
    for (int x = 0; x < width; x++) {
        const float gx = slope_above[x] + 2 * slope_own[x] + slope_below[x], gy = smooth_below[x] - smooth_above[x];
        gradient_x[x] = gx;
        gradient_y[x] = gy;
        norm[x] = sqrtf(gx * gx + gy * gy);
    }
}

int gradient_open(Gradient *gradient, RowSource source, const void *image, int width, int height, double sigma) {
    const int half = clamp((int)ceil(3 * sigma), 1, LARGEST_HALF), ring = 2 * half + 1;
    *gradient = (Gradient){source, image, width, height, .half = half, .next = -1 - half};
    double weights[LARGEST_HALF + 1], sum = 0;
    for (int i = 0; i <= half; i++) {
        weights[i] = exp(-0.5 * i * i / (sigma * sigma));
        sum += i ? 2 * weights[i] : weights[i];
    }
    for (int i = 0; i <= half; i++) gradient->weights[i] = (float)(weights[i] / sum);
    const size_t row = (size_t)width, padding = 2 * (size_t)(half + 1);
    gradient->memory = malloc(sizeof(float) * (row * (size_t)(ring + 2 + 2 * BLURRED + 3 * KEPT) + 2 * padding));
    if (!gradient->memory) return OUT_OF_MEMORY;
    gradient->rows = gradient->memory;
    gradient->smooth = gradient->rows + row * (size_t)ring;
    gradient->slope = gradient->smooth + row * BLURRED;
    gradient->x = gradient->slope + row * BLURRED;
    gradient->y = gradient->x + row * KEPT;
    gradient->norm = gradient->y + row * KEPT;
    gradient->column = gradient->norm + row * KEPT + half + 1;
    gradient->blurred = gradient->column + row + padding;
    return 0;
}

void gradient_close(Gradient *gradient) { free(gradient->memory); }

/* Read one image row, and blur the row that it makes complete. */
static void blur_next(Gradient *gradient) {
    const int half = gradient->half, ring = 2 * half + 1, width = gradient->width;
    /* so that no row has a negative number */
    const int read = gradient->next + 1 + half, blurred = read - 2 * half;
    gradient->source(gradient->image, mirrored(gradient->next, gradient->height),
                     gradient->rows + (size_t)(read % ring) * (size_t)width);
    gradient->next++;
    if (blurred < 0) return;
    const float *rows[2 * LARGEST_HALF + 1] = {0};
    for (int k = 0; k < ring; k++) rows[k] = gradient->rows + (size_t)((blurred + k) % ring) * (size_t)width;
    weigh(rows, gradient->weights, half, width, gradient->column);
    pad_row(gradient->column, width, half);
    for (int k = 0; k < ring; k++) rows[k] = gradient->column + k - half;
    weigh(rows, gradient->weights, half, width, gradient->blurred);
    pad_row(gradient->blurred, width, 1);
    const size_t place = (size_t)(blurred % BLURRED) * (size_t)width;
    sobel_along(gradient->blurred, width, gradient->smooth + place, gradient->slope + place);
}

void gradient_advance(Gradient *gradient) {
    /* the first row needs all that its blur reaches */
    if (gradient->next < 0)
        while (gradient->next < gradient->half + 1) blur_next(gradient);
    const int width = gradient->width, row = gradient->next - gradient->half - 1;
    blur_next(gradient);
    const float *smooth[3], *slope[3];
    for (int k = 0; k < 3; k++) {
        const size_t place = (size_t)((row + k) % BLURRED) * (size_t)width;
        smooth[k] = gradient->smooth + place;
        slope[k] = gradient->slope + place;
    }
    const size_t place = (size_t)(row % KEPT) * (size_t)width;
    sobel_across(smooth, slope, width, gradient->x + place, gradient->y + place, gradient->norm + place);
}
