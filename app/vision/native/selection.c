/* One segment per edge, what speaks for each, and the points measured along it; see app/vision/selection.py. */
#include "canvas.h"

/* in large images the pixels that a steep arc passes are far apart, so each is asked for before its turn */
enum { REPORT_EVERY = 4096, AHEAD = 16 };
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

/* An arc that may become a segment, and where its samples are. */
typedef struct {
    Walk walk;
    int32_t arc;
    int64_t begin;   /* of its samples among those of all */
    double priority; /* length x share of hits */
} Candidate;

/* Samples of a candidate, first to last; none where last < first. */
typedef struct {
    int first, last;
} Stretch;

static int by_priority(const void *a, const void *b) {
    const Candidate *one = a, *two = b;
    if (one->priority != two->priority) return one->priority > two->priority ? -1 : 1;
    return one->arc < two->arc ? -1 : 1;
}

/* List the arcs of at least some length; returns their number, and in `total` that of their samples. */
static int64_t list_candidates(const Arc *arcs, int64_t count, double least, Candidate *candidates, int64_t *total) {
    int64_t listed = 0;
    *total = 0;
    for (int64_t i = 0; i < count; i++) {
        if (arcs[i].high - arcs[i].low < least) continue;
        const Walk walk = walk_along(&arcs[i], arcs[i].low, arcs[i].high);
        if (walk_length(walk) < 1) continue;
        candidates[listed++] = (Candidate){walk, (int32_t)i, *total, 0};
        *total += walk_length(walk);
    }
    return listed;
}

static void sample_candidate(const Scene *scene, const Arc *arc, Candidate *candidate, Sample *samples) {
    const int length = walk_length(candidate->walk);
    int hits = 0;
    sample_walk(scene, arc, candidate->walk, samples);
    for (int i = 0; i < length; i++) {
        if ((i < ROUNDED || i >= length - ROUNDED) && samples[i].state & LOOSE) samples[i].state |= HIT;
        hits += samples[i].state & HIT;
    }
    candidate->priority = (arc->high - arc->low) * (double)hits / (double)length;
}

static int along_at(Walk walk, int sample) { return walk.first + sample * walk.step; }

/* The candidate of the next lower priority may be anywhere. */
static void fetch_candidate(const Arc *arcs, const Candidate *candidate, const Sample *samples) {
    __builtin_prefetch(&arcs[candidate->arc].tangent);
    const int length = walk_length(candidate->walk);
    for (int i = 0; i < length; i += 2) __builtin_prefetch(&samples[candidate->begin + i]);
}

/* What of a candidate no better one covers, and paint it. */
static Stretch take_free(const Canvas *canvas, const Arc *arc, Walk walk, const Sample *samples) {
    const uint16_t direction = paint_direction(arc);
    const double main = fabs(arc->tangent[walk.axis]);
    const int length = walk_length(walk);
    int free_samples = 0;
    Stretch stretch = {0, -1};
    for (int i = 0; i < AHEAD && i < length; i++) fetch_pixel(canvas, walk.axis, along_at(walk, i), &samples[i]);
    for (int i = 0; i < length; i++) {
        if (i + AHEAD < length) fetch_pixel(canvas, walk.axis, along_at(walk, i + AHEAD), &samples[i + AHEAD]);
        if (!is_free(canvas, walk.axis, along_at(walk, i), &samples[i], direction)) continue;
        if (!free_samples++) stretch.first = i;
        stretch.last = i;
    }
    if ((double)free_samples < (1 - LARGEST_SHARE) * (double)length) return (Stretch){0, -1};
    for (int i = stretch.first; i <= stretch.last; i++)
        if (samples[i].state & HIT) paint(canvas, walk.axis, along_at(walk, i), &samples[i], main, direction);
    return stretch;
}

static Stretch between_hits(Stretch stretch, const Sample *samples) {
    while (stretch.first <= stretch.last && !(samples[stretch.first].state & HIT)) stretch.first++;
    while (stretch.last >= stretch.first && !(samples[stretch.last].state & HIT)) stretch.last--;
    return stretch;
}

/* Write the points measured along a stretch that begins and ends with a hit; returns their number, or NO_ROOM. */
static int64_t write_points(Stretch stretch, Walk walk, const Sample *samples, float *xy, int64_t room) {
    int64_t written = 0;
    for (int i = stretch.first; i <= stretch.last; i++) {
        if (!(samples[i].state & HIT)) continue;
        /* it may support the edge, but a point so far off is hardly its own; the ends tell how far it reaches */
        if (fabsf(samples[i].distance) > FARTHEST && i > stretch.first && i < stretch.last) continue;
        if (written >= room) return NO_ROOM;
        const float along = (float)along_at(walk, i);
        xy[2 * written] = walk.axis == ALONG_X ? along : samples[i].measured;
        xy[2 * written + 1] = walk.axis == ALONG_X ? samples[i].measured : along;
        written++;
    }
    return written;
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

/* How many columns (or rows) arcs of at least some length pass: no more points are measured along them. */
EXPORT int64_t cl_count_samples(const Arc *arcs, int64_t count, double least) {
    int64_t total = 0;
    for (int64_t i = 0; i < count; i++)
        if (arcs[i].high - arcs[i].low >= least) total += walk_length(walk_along(&arcs[i], arcs[i].low, arcs[i].high));
    return total;
}

/* De-duplicate arcs and measure what is left.
 *
 * Arcs are painted into the image, the best first. One that runs over the paint of arcs in its direction for more than
 * 40 % of its way goes; of the others the painted ends go, and what has no point at the ends.
 *
 * arcs (count,). least: shortest arc to look at, px. width: how far from an arc the paint reaches, px. Written:
 * findings, room for (count,), in the order painted; xy float32, room for (room, 2), see cl_count_samples. Returns the
 * number of findings, OUT_OF_MEMORY, CANCELLED, or NO_ROOM where that for points is too small. */
EXPORT int64_t cl_select(const Scene *scene, const Arc *arcs, int64_t count, double least, double width,
                         Finding *findings, float *xy, int64_t room, Report report) {
    /* fresh memory is zero already: only what gets painted is touched */
    uint16_t *pixels = calloc((size_t)scene->width * scene->height, sizeof(uint16_t));
    Candidate *candidates = malloc((size_t)(count ? count : 1) * sizeof(Candidate));
    Sample *samples = NULL;
    int64_t found = OUT_OF_MEMORY, used = 0, total = 0;
    if (!pixels || !candidates) goto end;
    const int64_t listed = list_candidates(arcs, count, least, candidates, &total);
    samples = malloc((size_t)(total ? total : 1) * sizeof(Sample));
    if (!samples) goto end;
    for (int64_t i = 0; i < listed; i++) {
        if (i % REPORT_EVERY == 0 && is_cancelled(report, i, 2 * listed)) {
            found = CANCELLED;
            goto end;
        }
        sample_candidate(scene, &arcs[candidates[i].arc], &candidates[i], samples + candidates[i].begin);
    }
    qsort(candidates, (size_t)listed, sizeof(Candidate), by_priority);
    const Canvas canvas = {pixels, scene->width, scene->height, width};
    found = 0;
    for (int64_t i = 0; i < listed; i++) {
        if (i % REPORT_EVERY == 0 && is_cancelled(report, listed + i, 2 * listed)) {
            found = CANCELLED;
            goto end;
        }
        if (i + 1 < listed) fetch_candidate(arcs, &candidates[i + 1], samples);
        const Walk walk = candidates[i].walk;
        const Arc *arc = &arcs[candidates[i].arc];
        const Sample *own = samples + candidates[i].begin;
        const Stretch stretch = between_hits(take_free(&canvas, arc, walk, own), own);
        if (stretch.last - stretch.first < 1) continue;
        const int64_t written = write_points(stretch, walk, own, xy + 2 * used, room - used);
        if (written < 0) {
            found = written;
            goto end;
        }
        Finding finding = measure(arc, own + stretch.first, stretch.last - stretch.first + 1);
        finding.arc = candidates[i].arc;
        finding.first = (int32_t)used;
        finding.last = (int32_t)(used += written);
        const float *start = xy + 2 * finding.first, *stop = xy + 2 * (finding.last - 1);
        finding.chord = hypotf(stop[0] - start[0], stop[1] - start[1]);
        findings[found++] = finding;
    }
end:
    free(pixels);
    free(candidates);
    free(samples);
    return found;
}
