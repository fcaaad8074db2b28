#include "painting.h"

enum { CHUNK = 64 };

/* Texture positions of a few pixels: the texel before each, and how far on from it each lies, 0..1. */
typedef struct {
    int32_t column[CHUNK], row[CHUNK];
    float right[CHUNK], down[CHUNK];
} Places;

/* Positions beyond this are as good as infinite: integers hold them. */
#define FARTHEST 1e6f
#define LEAST_INVERSE_DEPTH 1e-6f

static inline float limited(float value) {
    const float low = value > -FARTHEST ? value : -FARTHEST;
    return low < FARTHEST ? low : FARTHEST;
}

FOR_EACH_PROCESSOR
static void locate(const double lookup[9], int y, int first, int count, Places *places) {
    float at[3], step[3];
    for (int i = 0; i < 3; i++) {
        at[i] = (float)(lookup[3 * i] * first + lookup[3 * i + 1] * y + lookup[3 * i + 2]);
        step[i] = (float)lookup[3 * i];
    }
    for (int i = 0; i < count; i++) {
        const float depth = at[2] + step[2] * (float)i;
        const float scale = 1.0f / (depth > LEAST_INVERSE_DEPTH ? depth : LEAST_INVERSE_DEPTH);
        const float u = limited((at[0] + step[0] * (float)i) * scale);
        const float v = limited((at[1] + step[1] * (float)i) * scale);
        /* a conversion rounds towards zero */
        const int32_t column = (int32_t)u - (u < (float)(int32_t)u), row = (int32_t)v - (v < (float)(int32_t)v);
        places->column[i] = column;
        places->row[i] = row;
        places->right[i] = u - (float)column;
        places->down[i] = v - (float)row;
    }
}

static inline int mirrored(int place, int size) {
    if (place >= 0 && place < size) return place;
    const int turn = place % (2 * size), from_zero = turn < 0 ? turn + 2 * size : turn;
    return from_zero < size ? from_zero : 2 * size - 1 - from_zero;
}

/* Mix the four texels about a place, each of `channels` numbers. */
static inline void mix(const Texture *texture, const Places *places, int i, int channels, int is_inside, float *mixed) {
    const int column = places->column[i], row = places->row[i], width = texture->width, height = texture->height;
    const int left = is_inside ? column : mirrored(column, width);
    const int right = is_inside ? column + 1 : mirrored(column + 1, width);
    const int upper = is_inside ? row * width : mirrored(row, height) * width;
    const int lower = is_inside ? (row + 1) * width : mirrored(row + 1, height) * width;
    const float *a = texture->texels + (ptrdiff_t)(upper + left) * channels;
    const float *b = texture->texels + (ptrdiff_t)(upper + right) * channels;
    const float *c = texture->texels + (ptrdiff_t)(lower + left) * channels;
    const float *d = texture->texels + (ptrdiff_t)(lower + right) * channels;
    const float across = places->right[i], down = places->down[i];
    for (int channel = 0; channel < channels; channel++) {
        const float above = a[channel] + across * (b[channel] - a[channel]);
        const float below = c[channel] + across * (d[channel] - c[channel]);
        mixed[channel] = above + down * (below - above);
    }
}

/* Whether all four texels about each place are the texture's own. */
FOR_EACH_PROCESSOR
static int are_inside(const Texture *texture, const Places *places, int count) {
    const uint32_t columns = (uint32_t)texture->width - 1, rows = (uint32_t)texture->height - 1;
    uint32_t outside = 0;
    for (int i = 0; i < count; i++)
        outside |= ((uint32_t)places->column[i] >= columns) | ((uint32_t)places->row[i] >= rows);
    return !outside;
}

static inline void fetch_factors(const Texture *texture, const Places *places, int count, int is_inside,
                                 float *factors) {
    for (int i = 0; i < count; i++) mix(texture, places, i, 1, is_inside, factors + i);
}

static inline void fetch_colours(const Texture *texture, const Places *places, int count, int is_inside, int begin,
                                 float *const planes[4]) {
    for (int i = 0; i < count; i++) {
        float texel[4];
        mix(texture, places, i, 4, is_inside, texel);
        for (int channel = 0; channel < 4; channel++) planes[channel][begin + i] = texel[channel];
    }
}

void fetch_texels(const Texture *texture, const double lookup[9], int y, int first, int last, float *const planes[4]) {
    Places places;
    for (int begin = first; begin < last; begin += CHUNK) {
        const int count = last - begin < CHUNK ? last - begin : CHUNK;
        locate(lookup, y, begin, count, &places);
        const int is_inside = are_inside(texture, &places, count);
        if (texture->channels == 1) {
            if (is_inside) fetch_factors(texture, &places, count, 1, planes[0] + begin);
            else fetch_factors(texture, &places, count, 0, planes[0] + begin);
        } else if (is_inside) fetch_colours(texture, &places, count, 1, begin, planes);
        else fetch_colours(texture, &places, count, 0, begin, planes);
    }
}
