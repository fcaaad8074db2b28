#include "equalisation.h"
#include "kernels.h"

/* First and one-past-last pixel of a tile. Where tiles have no whole number of pixels they overlap by one, so that
 * an image and its mirror have the same tiles. */
static void tile_span(int index, int count, int size, int *first, int *last) {
    *first = (int)((int64_t)index * size / count);
    *last = (int)(((int64_t)(index + 1) * size + count - 1) / count);
}

/* Tables of all tiles, float32 (rows, columns, 256): cumulative histograms, clipped at `clip` times a flat one, what is
 * above being spread evenly. */
EXPORT void cl_equalising_tables(const uint8_t *gray, int width, int height, int columns, int rows, double clip,
                                 float *tables) {
    for (int row = 0; row < rows; row++)
        for (int column = 0; column < columns; column++) {
            int x0, x1, y0, y1;
            tile_span(column, columns, width, &x0, &x1);
            tile_span(row, rows, height, &y0, &y1);
            int32_t counts[4][LEVELS] = {{0}};
            for (int y = y0; y < y1; y++) {
                const uint8_t *line = gray + (size_t)y * width;
                int x = x0;
                for (; x + 3 < x1; x += 4) {
                    /* four histograms: equal neighbours would wait for each other's count */
                    counts[0][line[x]]++;
                    counts[1][line[x + 1]]++;
                    counts[2][line[x + 2]]++;
                    counts[3][line[x + 3]]++;
                }
                for (; x < x1; x++) counts[0][line[x]]++;
            }
            const double area = (double)(x1 - x0) * (y1 - y0), limit = fmax(clip * area / LEVELS, 1);
            double clipped[LEVELS], excess = 0, sum = 0;
            for (int level = 0; level < LEVELS; level++) {
                const double count = (double)counts[0][level] + counts[1][level] + counts[2][level] + counts[3][level];
                clipped[level] = fmin(count, limit);
                excess += count - clipped[level];
            }
            float *table = tables + ((size_t)row * columns + column) * LEVELS;
            for (int level = 0; level < LEVELS; level++) {
                sum += clipped[level] + excess / LEVELS;
                table[level] = (float)(sum * (255.0 / area));
            }
        }
}

/* Tile whose centre lies before a pixel, and the weight of the next one. */
static void tile_before(int pixel, int size, int count, int32_t *before, float *weight) {
    const double place = (pixel + 0.5) * count / size - 0.5;
    const double inside = place < 0 ? 0 : place > count - 1 ? count - 1 : place;
    *before = clamp((int)inside, 0, count > 1 ? count - 2 : 0);
    *weight = (float)(inside - *before);
}

/* Tile whose centre lies before each pixel, and the weight of the next one. */
EXPORT void cl_tile_weights(int size, int count, int32_t *before, float *weight) {
    for (int pixel = 0; pixel < size; pixel++) tile_before(pixel, size, count, &before[pixel], &weight[pixel]);
}

/* Tables of one image row, between those of the tiles above and below it, and what to add to each for the tile on its
 * right. */
static void blend_tables(const Equaliser *equaliser, int row, float *restrict blended, float *restrict step) {
    int32_t above;
    float weight;
    tile_before(row, equaliser->height, equaliser->rows, &above, &weight);
    const int entries = equaliser->columns * LEVELS, inner = entries - LEVELS;
    const float *upper = equaliser->tables + (size_t)above * (size_t)entries;
    const float *lower = equaliser->rows > 1 ? upper + entries : upper;
    for (int i = 0; i < entries; i++) blended[i] = (1 - weight) * upper[i] + weight * lower[i];
    for (int i = 0; i < inner; i++) step[i] = blended[i + LEVELS] - blended[i];
    memset(step + inner, 0, LEVELS * sizeof(float));
}

void equalise_row(const Equaliser *equaliser, int row, float *restrict out) {
    const int width = equaliser->width;
    float *blended = equaliser->blended, *step = blended + equaliser->columns * LEVELS;
    blend_tables(equaliser, row, blended, step);
    const int32_t *left = equaliser->left;
    const float *rightward = equaliser->rightward;
    const uint8_t *line = equaliser->gray + (size_t)row * (size_t)width;
    for (int x = 0; x < width; x++) {
        const int entry = left[x] * LEVELS + line[x];
        out[x] = blended[entry] + rightward[x] * step[entry];
    }
}
