/* One segment per edge, what speaks for each, and the points measured along it; see app/vision/selection.py. */
#include "canvas.h"

enum { REPORT_EVERY = 4096 };
#define LARGEST_SHARE 0.4
#define FARTHEST 0.7f /* px, of a returned point from the arc */

/* What is known of a segment; the names are those of app.vision.scoring. */
typedef struct {
    int32_t arc;         /* which arc it is a part of */
    int32_t first, last; /* its points, first and one past last */
    float chord;         /* px */
    float samples, hits, close;
    float rms;         /* px, of the hits from the arc */
    float mean_norm;   /* over the hits */
    float longest_gap; /* samples without a hit in a row */
    float contrast;    /* grey levels, mean difference of the two sides */
} Finding;

typedef struct {
    double priority;
    int32_t arc;
} Rank;

static int by_priority(const void *a, const void *b) {
    const Rank *one = a, *two = b;
    if (one->priority != two->priority) return one->priority > two->priority ? -1 : 1;
    return one->arc < two->arc ? -1 : 1;
}

static Finding measure(const Arc *arc, const Sample *samples, int count) {
    Finding finding = {0};
    double squares = 0, sum = 0;
    int gap = 0, longest = 0, hits = 0, close = 0;
    for (int i = 0; i < count; i++) {
        if (samples[i].state & HIT) {
            hits++;
            squares += (double)samples[i].distance * samples[i].distance;
            sum += samples[i].norm;
            gap = 0;
        } else if (++gap > longest) {
            longest = gap;
        }
        if (samples[i].state & CLOSE) close++;
    }
    finding.samples = (float)count;
    finding.hits = (float)hits;
    finding.close = (float)close;
    finding.rms = (float)sqrt(squares / (hits ? hits : 1));
    finding.mean_norm = (float)(sum / (hits ? hits : 1));
    finding.longest_gap = (float)longest;
    finding.contrast = (float)((arc->traits[1] - arc->traits[0]) / arc->sums[0]);
    return finding;
}

/* De-duplicate arcs and measure what is left.
 *
 * Arcs are painted into the image, the best first. One that runs over the paint of arcs in its direction for more than
 * 40 % of its way goes; of the others the painted ends go, and what has no point at the ends.
 *
 * arcs (count,). least: shortest arc to look at, px. width: how far from an arc the paint reaches, px. Written:
 * findings, room for (count,), in the order painted; xy float32, room for (room, 2). Returns the number of findings,
 * OUT_OF_MEMORY, CANCELLED, or NO_ROOM where that for points is too small. */
EXPORT int64_t cl_select(const Scene *scene, const Arc *arcs, int64_t count, double least, double width,
                         Finding *findings, float *xy, int64_t room, Report report) {
    const size_t pixels = (size_t)scene->width * scene->height, arcs_room = (size_t)(count ? count : 1);
    Rank *ranks = malloc(arcs_room * sizeof(Rank));
    /* fresh memory is zero already: only what gets painted is touched */
    uint16_t *canvas_pixels = calloc(pixels, sizeof(uint16_t));
    int64_t *begins = malloc((arcs_room + 1) * sizeof(int64_t));
    Sample *samples = NULL;
    int64_t found = OUT_OF_MEMORY, used = 0, total = 0;
    if (!ranks || !canvas_pixels || !begins) goto end;
    for (int64_t i = 0; i < count; i++) {
        begins[i] = total;
        if (arcs[i].high - arcs[i].low >= least) total += walk_length(walk_along(&arcs[i], arcs[i].low, arcs[i].high));
    }
    begins[count] = total;
    samples = malloc((size_t)(total ? total : 1) * sizeof(Sample));
    if (!samples) goto end;
    int64_t ranked = 0;
    for (int64_t i = 0; i < count; i++) {
        if (i % REPORT_EVERY == 0 && is_cancelled(report, i, 2 * count)) {
            found = CANCELLED;
            goto end;
        }
        const int64_t own = begins[i + 1] - begins[i];
        if (own <= 0) continue;
        const Walk walk = walk_along(&arcs[i], arcs[i].low, arcs[i].high);
        int64_t hits = 0;
        sample_walk(scene, &arcs[i], walk, samples + begins[i]);
        for (int64_t j = 0; j < own; j++) {
            Sample *sample = &samples[begins[i] + j];
            if ((j < ROUNDED || j >= own - ROUNDED) && sample->state & LOOSE) sample->state |= HIT;
            hits += sample->state & HIT;
        }
        ranks[ranked++] = (Rank){(arcs[i].high - arcs[i].low) * (double)hits / (double)own, (int32_t)i};
    }
    qsort(ranks, (size_t)ranked, sizeof(Rank), by_priority);
    const Canvas canvas = {canvas_pixels, scene->width, scene->height, width};
    found = 0;
    for (int64_t r = 0; r < ranked; r++) {
        if (r % REPORT_EVERY == 0 && is_cancelled(report, ranked + r, 2 * ranked)) {
            found = CANCELLED;
            goto end;
        }
        const int32_t index = ranks[r].arc;
        const Arc *arc = &arcs[index];
        const Sample *own = samples + begins[index];
        const int64_t length = begins[index + 1] - begins[index];
        const Walk walk = walk_along(arc, arc->low, arc->high);
        const int axis = walk.axis;
        const uint16_t direction = paint_direction(arc);
        const double main = fabs(arc->tangent[axis]);
        int64_t free_samples = 0, first = -1, last = -1;
        for (int64_t j = 0; j < length; j++) {
            if (!is_free(&canvas, axis, walk.first + (int)j * walk.step, &own[j], direction)) continue;
            free_samples++;
            if (first < 0) first = j;
            last = j;
        }
        if (first < 0 || (double)free_samples < (1 - LARGEST_SHARE) * (double)length) continue;
        for (int64_t j = first; j <= last; j++)
            if (own[j].state & HIT) paint(&canvas, axis, walk.first + (int)j * walk.step, &own[j], main, direction);
        while (first <= last && !(own[first].state & HIT)) first++;
        while (last >= first && !(own[last].state & HIT)) last--;
        if (last - first < 1) continue;
        Finding finding = measure(arc, own + first, (int)(last - first + 1));
        finding.arc = index;
        finding.first = (int32_t)used;
        for (int64_t j = first; j <= last; j++) {
            if (!(own[j].state & HIT)) continue;
            /* it may support the edge, but a point so far off is hardly its own; the ends tell how far it reaches */
            if (fabsf(own[j].distance) > FARTHEST && j > first && j < last) continue;
            if (used >= room) {
                found = NO_ROOM;
                goto end;
            }
            const float along = (float)(walk.first + (int)j * walk.step);
            xy[2 * used] = axis == ALONG_X ? along : own[j].measured;
            xy[2 * used + 1] = axis == ALONG_X ? own[j].measured : along;
            used++;
        }
        finding.last = (int32_t)used;
        const float *start = xy + 2 * finding.first, *stop = xy + 2 * (finding.last - 1);
        finding.chord = hypotf(stop[0] - start[0], stop[1] - start[1]);
        findings[found++] = finding;
    }
end:
    free(ranks);
    free(canvas_pixels);
    free(begins);
    free(samples);
    return found;
}
