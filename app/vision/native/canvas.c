#include "canvas.h"

#define PARALLEL 6624 /* 18.2 degrees, acos 0.95, in steps of 180 degrees / 2^16 */

uint16_t paint_direction(const Arc *arc) {
    const double turns = atan2(arc->tangent[1], arc->tangent[0]) / (180 * RADIANS_PER_DEGREE);
    const uint16_t direction = (uint16_t)lrint((turns + 1) * 65536);
    return direction ? direction : 1;
}

/* Pixel of a row's first column, or of a column's first row, and the step from one to the next. */
typedef struct {
    uint16_t *first;
    ptrdiff_t stride;
    int size;
} Line;

static Line line_at(const Canvas *canvas, int axis, int along) {
    return axis == ALONG_X ? (Line){canvas->paint + along, canvas->width, canvas->height}
                           : (Line){canvas->paint + (ptrdiff_t)along * canvas->width, 1, canvas->width};
}

static int is_free_at(Line line, int pixel, uint16_t direction) {
    const uint16_t painted = line.first[clamp(pixel, 0, line.size - 1) * line.stride];
    const uint16_t turn = (uint16_t)(painted - direction);
    return !painted || (turn >= PARALLEL && turn <= 65536 - PARALLEL);
}

void fetch_pixel(const Canvas *canvas, int axis, int along, const Sample *sample) {
    const Line line = line_at(canvas, axis, clamp(along, 0, (axis == ALONG_X ? canvas->width : canvas->height) - 1));
    __builtin_prefetch(&line.first[clamp(sample->pixel, 0, line.size - 1) * line.stride]);
}

int is_free(const Canvas *canvas, int axis, int along, const Sample *sample, uint16_t direction) {
    const Line line = line_at(canvas, axis, clamp(along, 0, (axis == ALONG_X ? canvas->width : canvas->height) - 1));
    if (!is_free_at(line, sample->pixel, direction)) return 0;
    /* a point measured beside the arc may be another's although the arc's own pixel is not */
    return !(sample->state & HIT) || is_free_at(line, (int)lrintf(sample->measured), direction);
}

void paint(const Canvas *canvas, int axis, int along, const Sample *sample, double main, uint16_t direction) {
    const Line line = line_at(canvas, axis, along);
    const double reach = canvas->reach / main;
    line.first[clamp((int)lrintf(sample->measured), 0, line.size - 1) * line.stride] = direction;
    const int first = (int)(sample->across - reach + 1), last = (int)(sample->across + reach);
    for (int pixel = first > 0 ? first : 0; pixel <= last && pixel < line.size; pixel++)
        line.first[pixel * line.stride] = direction;
}
