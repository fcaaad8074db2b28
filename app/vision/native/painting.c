#include "painting.h"

#define MOST 0.5f /* share of a pixel from which on it shows a surface */
#define LEAST_NEARNESS 1e-3f
/* px; narrower surfaces hide too little to be worth a look */
enum { NARROW = 12, ROWS = 8 };

typedef struct {
    float *colours; /* planes of red, green and blue */
    int32_t *shown; /* number of the surface that each pixel shows, from 1 on; 0 where it is the background */
    int32_t width, height;
    const double *edges; /* (a, b, c) each */
    const Texture *textures;
    const float *air; /* what haze makes of far colours */
    float *cover;     /* of the pixels of a row, as are those that follow */
    float *clearness, *texels[4], *ones, *mask;
} Painting;

static inline float *plane_row(const Painting *painting, int channel, int y) {
    return painting->colours + ((size_t)channel * (size_t)painting->height + (size_t)y) * (size_t)painting->width;
}

/* Share of each pixel of row `y` inside a polygon: the least of its distances to the edges in units of the width that a
 * pixel has across the edge, plus one half, and cut to 0..1. */
FOR_EACH_PROCESSOR
static Stretch cover_row(const Surface *surface, const double *edges, int y, float *cover) {
    double first = surface->left, last = surface->right;
    for (int i = 0; i < surface->edges; i++) {
        const double a = edges[3 * i], value = edges[3 * i + 1] * y + edges[3 * i + 2] + 0.5;
        if (a > 0) first = larger(first, floor(-value / a));
        else if (a < 0) last = smaller(last, ceil(-value / a) + 1);
        else if (value <= 0) return (Stretch){0, 0, 0, 0};
    }
    if (!(first < last)) return (Stretch){0, 0, 0, 0};
    Stretch stretch = {(int)first, (int)first, (int)last, (int)last};
    for (int x = stretch.first; x < stretch.last; x++) cover[x] = 1;
    for (int i = 0; i < surface->edges; i++) {
        const double a = edges[3 * i], value = edges[3 * i + 1] * y + edges[3 * i + 2] + 0.5;
        /* where the pixels end that this edge has a part in */
        int begin = stretch.first, end = stretch.last;
        if (a > 0) {
            end = (int)larger(smaller(ceil((1 - value) / a), last), first);
            if (end > stretch.solid) stretch.solid = end;
        } else if (a < 0) {
            begin = (int)larger(smaller(floor((1 - value) / a) + 1, last), first);
            if (begin < stretch.solid_end) stretch.solid_end = begin;
        } else if (value < 1) stretch.solid = stretch.last;
        else continue;
        const float at = (float)(value + a * begin), slope = (float)a;
        for (int x = begin; x < end; x++) {
            const float share = at + slope * (float)(x - begin), most = cover[x] < share ? cover[x] : share;
            cover[x] = most > 0 ? most : 0;
        }
    }
    if (stretch.solid >= stretch.solid_end) stretch.solid = stretch.solid_end = stretch.first;
    return stretch;
}

/* exp of what is not above 0, to 1e-7: e^x = 2^n e^r with |r| <= ln(2) / 2, and e^r by its series. */
static inline float exponential(float x) {
    const float limited = x > -80 ? x : -80;
    const int32_t n = (int32_t)(limited * 1.44269504f - 0.5f);
    const float r = limited - (float)n * 0.693147181f;
    const float series = 1 + r * (1 + r * (1 / 2.f + r * (1 / 6.f + r * (1 / 24.f + r * (1 / 120.f + r / 720.f)))));
    const int32_t bits = (n + 127) * (1 << 23);
    float power;
    memcpy(&power, &bits, sizeof power);
    return series * power;
}

/* What haze leaves of the colour of each pixel; it takes over exponentially with the depth (Koschmieder 1924). */
FOR_EACH_PROCESSOR
static void fill_clearness(const Surface *surface, int y, int first, int last, float *clearness) {
    const double *plane = surface->nearness;
    const float at = (float)(plane[1] * y + plane[2]), step = (float)plane[0], constant = (float)surface->clearness;
    for (int x = first; x < last; x++) {
        const float nearness = at + step * (float)x;
        clearness[x] =
            constant < 0 ? exponential(-1 / (nearness > LEAST_NEARNESS ? nearness : LEAST_NEARNESS)) : constant;
    }
}

/* Mix one channel of a row: what is painted is `tone` times a factor, in the haze. */
FOR_EACH_PROCESSOR
static void lay(float *target, float tone, float air, const float *factors, const float *clearness, const float *cover,
                Stretch stretch) {
    for (int x = stretch.first; x < stretch.last; x++) {
        const float value = air + clearness[x] * (tone * factors[x] - air);
        target[x] = x >= stretch.solid && x < stretch.solid_end ? value : target[x] + (value - target[x]) * cover[x];
    }
}

FOR_EACH_PROCESSOR
static void lay_flat(float *target, float value, const float *cover, Stretch stretch) {
    for (int x = stretch.first; x < stretch.solid; x++) target[x] += (value - target[x]) * cover[x];
    for (int x = stretch.solid; x < stretch.solid_end; x++) target[x] = value;
    for (int x = stretch.solid_end; x < stretch.last; x++) target[x] += (value - target[x]) * cover[x];
}

FOR_EACH_PROCESSOR
static void show(int32_t *shown, const float *cover, Stretch stretch, int32_t number) {
    for (int x = stretch.first; x < stretch.last; x++) shown[x] = cover[x] >= MOST ? number : shown[x];
}

static void paint_stretch(const Painting *painting, const Surface *surface, int y, Stretch stretch) {
    const float *air = painting->air;
    float *cover = painting->cover, *clearness = painting->clearness, *const *texels = painting->texels;
    const Texture *texture = surface->texture < 0 ? NULL : painting->textures + surface->texture;
    if (!texture && surface->clearness >= 0) {
        for (int channel = 0; channel < 3; channel++) {
            const float tone = surface->colour[channel];
            const float value = air[channel] + (float)surface->clearness * (tone - air[channel]);
            lay_flat(plane_row(painting, channel, y), value, cover, stretch);
        }
        return;
    }
    fill_clearness(surface, y, stretch.first, stretch.last, clearness);
    if (texture) fetch_texels(texture, surface->lookup, y, stretch.first, stretch.last, texels);
    const int is_coloured = texture && texture->channels == 4;
    if (is_coloured)
        for (int x = stretch.first; x < stretch.last; x++) cover[x] *= texels[3][x];
    for (int channel = 0; channel < 3; channel++) {
        const float tone = is_coloured ? 1 : surface->colour[channel];
        const float *factors = !texture ? painting->ones : texels[is_coloured ? channel : 0];
        lay(plane_row(painting, channel, y), tone, air[channel], factors, clearness, cover, stretch);
    }
}

static int is_opaque(const Painting *painting, const Surface *surface) {
    return surface->opacity >= 1 && (surface->texture < 0 || painting->textures[surface->texture].channels == 1);
}

static inline Stretch part(Stretch stretch, int first, int last) {
    return (Stretch){first, clamp(stretch.solid, first, last), clamp(stretch.solid_end, first, last), last};
}

/* Paint what no later surface hides wholly: where `shown` has no higher number yet. */
static void paint_row(const Painting *painting, const Surface *surface, int y, int32_t number) {
    float *cover = painting->cover;
    int32_t *shown = painting->shown + (size_t)y * (size_t)painting->width;
    Stretch stretch = cover_row(surface, painting->edges + 3 * (size_t)surface->first_edge, y, cover);
    if (!is_opaque(painting, surface)) {
        stretch.solid = stretch.solid_end = stretch.first;
        for (int x = stretch.first; x < stretch.last; x++) cover[x] *= surface->opacity;
    }
    for (int x = stretch.first; x < stretch.last;) {
        const int first = x;
        while (x < stretch.last && shown[x] <= number) x++;
        if (x > first) {
            const Stretch seen = part(stretch, first, x);
            paint_stretch(painting, surface, y, seen);
            show(shown, cover, seen, number);
        }
        while (x < stretch.last && shown[x] > number) x++;
    }
}

/* Write the numbers of surfaces to where they hide all that lies below. */
static void hide(const Painting *painting, const Surface *surface, int32_t number) {
    if (surface->right - surface->left < NARROW || !is_opaque(painting, surface)) return;
    for (int y = surface->top; y < surface->bottom; y++) {
        int32_t *shown = painting->shown + (size_t)y * (size_t)painting->width;
        const double *edges = painting->edges + 3 * (size_t)surface->first_edge;
        const Stretch stretch = cover_row(surface, edges, y, painting->cover);
        for (int x = stretch.solid; x < stretch.solid_end; x++) shown[x] = number;
    }
}

/* Multiply a row of what lies below the union of shadows by their factors. Shares are added, so that shadows which meet
 * leave no seam. */
static void darken_row(const Painting *painting, const Surface *surfaces, int64_t count, int y) {
    float *mask = painting->mask;
    int first = painting->width, last = 0;
    for (int64_t i = 0; i < count; i++) {
        const Surface *surface = surfaces + i;
        if (y < surface->top || y >= surface->bottom) continue;
        const Stretch stretch =
            cover_row(surface, painting->edges + 3 * (size_t)surface->first_edge, y, painting->cover);
        if (stretch.first >= stretch.last) continue;
        for (int x = stretch.first; x < stretch.last; x++) mask[x] += painting->cover[x];
        if (stretch.first < first) first = stretch.first;
        if (stretch.last > last) last = stretch.last;
    }
    for (int channel = 0; channel < 3; channel++) {
        float *target = plane_row(painting, channel, y);
        const float loss = 1 - surfaces->colour[channel];
        for (int x = first; x < last; x++) target[x] *= 1 - (mask[x] < 1 ? mask[x] : 1) * loss;
    }
    for (int x = first; x < last; x++) mask[x] = 0;
}

static void darken(const Painting *painting, const Surface *surfaces, int64_t count) {
    int top = painting->height, bottom = 0;
    for (int64_t i = 0; i < count; i++) {
        if (surfaces[i].top < top) top = surfaces[i].top;
        if (surfaces[i].bottom > bottom) bottom = surfaces[i].bottom;
    }
    for (int y = top; y < bottom; y++) darken_row(painting, surfaces, count, y);
}

/* Paint surfaces in their order over `colours`, float32 (3, height, width), and write to `shown`, int32 (height,
 * width) of zeros, which of them, counted from 1, each pixel shows. Returns 0 or OUT_OF_MEMORY. */
EXPORT int cl_paint(float *colours, int32_t *shown, int width, int height, const Surface *surfaces, int64_t count,
                    const double *edges, const Texture *textures, const float *air) {
    float *memory = calloc(ROWS * (size_t)width, sizeof *memory), *rows[ROWS];
    if (!memory) return OUT_OF_MEMORY;
    for (int i = 0; i < ROWS; i++) rows[i] = memory + (size_t)i * (size_t)width;
    const Painting painting = {colours,  shown,  width,   height,  edges,
                               textures, air,    rows[0], rows[1], {rows[2], rows[3], rows[4], rows[5]},
                               rows[6],  rows[7]};
    for (int x = 0; x < width; x++) painting.ones[x] = 1;
    for (int64_t i = 0; i < count; i++)
        if (surfaces[i].shadow < 0) hide(&painting, surfaces + i, (int32_t)(i + 1));
    for (int64_t i = 0, next; i < count; i = next) {
        const Surface *surface = surfaces + i;
        next = i + 1;
        if (surface->shadow < 0) {
            for (int y = surface->top; y < surface->bottom; y++) paint_row(&painting, surface, y, (int32_t)next);
            continue;
        }
        while (next < count && surfaces[next].shadow == surface->shadow) next++;
        darken(&painting, surface, next - i);
    }
    free(memory);
    return 0;
}
