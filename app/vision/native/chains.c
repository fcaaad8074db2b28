/* Linking edge points into chains; see app/vision/chaining.py. */
#include "kernels.h"
#include "places.h"

enum { LONGEST_STEP = 3, SHORTEST_CHAIN = 5 };
/* px, of a point from where the mean of both slopes puts it: without a step, and for each */
#define LARGEST_MISFIT 0.7f
#define MISFIT_PER_STEP 0.3f
#define LARGEST_TURN 1.0f

#define TAKEN -1.0f
/* RING: lines whose points may still be linked to the next one, a power of two */
enum { WINDOW = 2, WIDEST = 2 * WINDOW + 1, LIKELY = 2, RING = 4 };
/* points are as far apart in memory as chains are long, so each is asked for before its turn */
enum { AHEAD = 32 };

/* The points of one pass; those up to `low` are left out. */
typedef struct {
    const EdgePoint *points;
    Places places;
    int lines;
    float low;
} Field;

/* A chain of two points and more. */
typedef struct {
    int32_t length;
    float strongest; /* norm of a point */
    int32_t next;    /* where its next point is listed */
    int32_t is_kept;
} Chain;

/* What linking has found so far, and the room it works in. */
typedef struct {
    int32_t *following; /* of each point, -1 where there is none */
    int32_t *chain;     /* of each point, and of one more that isn't there: the number of its chain, 0 for none */
    /* of the latest lines, the points without a following one */
    int32_t *loose[RING];
    int count[RING];
    /* of the loose points of one line: the best in the line looked at, -1 where there is none, and its misfit */
    int32_t *best;
    float *least;
    /* of the points of the line looked at, and of one more that isn't there: misfit of the nearest source; TAKEN where
     * none may be */
    float *nearest;
    /* pairs of a loose point, by its number in its line, and one that may follow it, and their misfit */
    int32_t *source, *target;
    float *misfit;
} Links;

static int32_t first_of_line(const Field *field, int line) {
    return field->places.spans[(size_t)line * field->places.line_spans].before;
}

/* The loops of linking branch on nothing that depends on a point, as none of it can be guessed: what there may be is
 * written in any case, and counted if it is there. */

/* List all points of a line within two pixels of where loose points point: wide enough for every pair that both slopes
 * allow, or the direction of linking would matter. Returns the number of pairs. */
FOR_EACH_PROCESSOR static int list_pairs(const Field *field, int line, int step, const int32_t *loose, int count,
                                         int32_t *source, int32_t *target) {
    int pairs = 0;
    for (int i = 0; i < count; i++) {
        const EdgePoint *from = &field->points[loose[i]];
        const int expected = (int)lrintf(from->across + from->slope * (float)step);
        const Window window = window_at(&field->places, line, expected - WINDOW, WIDEST);
        const int found = bits_set(window.bits);
        for (int k = 0; k < LIKELY || k < found; k++) source[pairs + k] = i, target[pairs + k] = window.first + k;
        pairs += found;
    }
    return pairs;
}

/* Leave the pairs that fit. Returns their number. */
static int keep_fitting(const Field *field, int step, const int32_t *loose, int32_t first, int count, Links *links) {
    const float limit = LARGEST_MISFIT + MISFIT_PER_STEP * (float)step;
    int32_t *source = links->source, *target = links->target;
    float *restrict misfits = links->misfit;
    const float *nearest = links->nearest;
    int kept = 0;
    for (int i = 0; i < count; i++) {
        const int32_t one = source[i], other = target[i];
        const EdgePoint *from = &field->points[loose[one]], *to = &field->points[other];
        const float slope = 0.5f * (from->slope + to->slope);
        const float misfit = fabsf(to->across - from->across - slope * (float)step);
        source[kept] = one, target[kept] = other - first, misfits[kept] = misfit;
        kept += (nearest[other - first] >= 0) & ((to->norm > 0) == (from->norm > 0)) &
                (fabsf(to->slope - from->slope) <= LARGEST_TURN) & (misfit <= limit);
    }
    return kept;
}

/* Link loose points to those of a line `step` lines on, where each is the other's nearest. */
static void link_line(const Field *field, int line, int step, Links *links) {
    const int32_t first = first_of_line(field, line), size = first_of_line(field, line + 1) - first;
    const int number = (line - step) % RING, count = links->count[number];
    int32_t *loose = links->loose[number], *best = links->best;
    float *least = links->least, *nearest = links->nearest;
    int pairs = list_pairs(field, line, step, loose, count, links->source, links->target);
    pairs = keep_fitting(field, step, loose, first, pairs, links);
    for (int i = 0; i < count; i++) best[i] = size, least[i] = INFINITY;
    for (int i = 0; i < pairs; i++) {
        const int32_t one = links->source[i], other = links->target[i];
        const float misfit = links->misfit[i];
        best[one] = misfit < least[one] ? other : best[one];
        least[one] = misfit < least[one] ? misfit : least[one];
        nearest[other] = misfit < nearest[other] ? misfit : nearest[other];
    }
    nearest[size] = TAKEN;
    int left = 0;
    for (int i = 0; i < count; i++) {
        const int32_t one = loose[i], other = best[i];
        const int linked = least[i] == nearest[other];
        nearest[other] = linked ? TAKEN : nearest[other];
        links->following[one] = linked ? first + other : -1;
        loose[left] = one;
        left += !linked;
    }
    links->count[number] = left;
    for (int32_t i = 0; i < size; i++) nearest[i] = nearest[i] >= 0 ? INFINITY : TAKEN;
}

/* Link every point to the one that follows it, one to three lines on, where each is the other's nearest; nearer lines
 * come first. */
static void link_points(const Field *field, Links *links) {
    for (int line = 0; line < field->lines; line++) {
        const int32_t first = first_of_line(field, line), last = first_of_line(field, line + 1);
        int32_t *loose = links->loose[line % RING];
        int count = 0;
        for (int32_t i = first; i < last; i++) {
            const int strong = fabsf(field->points[i].norm) > field->low;
            links->nearest[i - first] = strong ? INFINITY : TAKEN;
            links->following[i] = -1;
            links->chain[i] = 0;
            loose[count] = i;
            count += strong;
        }
        links->count[line % RING] = count;
        for (int step = 1; step <= LONGEST_STEP && step <= line; step++) link_line(field, line, step, links);
    }
}

/* Take memory for `points` in lines of at most `most`; it must be freed even if there is not enough. */
static int take_memory(Links *links, size_t points, size_t most) {
    const size_t pairs = WIDEST * most + LIKELY;
    *links = (Links){.following = malloc(sizeof(int32_t) * points),
                     .chain = malloc(sizeof(int32_t) * (points + 1)),
                     .best = malloc(sizeof(int32_t) * ((RING + 1) * most + 2 * pairs)),
                     .least = malloc(sizeof(float) * (2 * most + pairs))};
    if (!links->following || !links->chain || !links->best || !links->least) return OUT_OF_MEMORY;
    for (int i = 0; i < RING; i++) links->loose[i] = links->best + (size_t)(i + 1) * most;
    links->source = links->best + (RING + 1) * most;
    links->target = links->source + pairs;
    links->nearest = links->least + most;
    links->misfit = links->nearest + most;
    return 0;
}

static void free_memory(Links *links) {
    free(links->following);
    free(links->chain);
    free(links->best);
    free(links->least);
}

/* Number the chains of two points and more from 1 on, in the order of their first points. The points are gone through
 * as they lie in memory: from link to link, each would have to be waited for. Returns the number of chains. */
static int32_t number_chains(const Field *field, const Links *links, int32_t count, Chain *chains) {
    int32_t numbers = 0, *chain = links->chain;
    for (int32_t i = 0; i < count; i++) {
        const int32_t following = links->following[i], is_first = chain[i] == 0, is_last = following < 0;
        const int32_t number = is_first ? numbers + 1 : chain[i];
        const float norm = fabsf(field->points[i].norm), strongest = is_first ? 0 : chains[number].strongest;
        chains[number].length = is_first ? 1 : chains[number].length + 1;
        chains[number].strongest = norm > strongest ? norm : strongest;
        chain[is_last ? count : following] = number;
        chain[i] = is_first & is_last ? 0 : number;
        numbers += is_first & !is_last;
    }
    return numbers;
}

/* Move the chains that are long and strong enough to the front, and list their points in `rows`, chain after chain.
 * Returns their number. */
static int32_t list_chains(const Links *links, int32_t count, Chain *chains, int32_t numbers, float high,
                           int32_t *rows) {
    int32_t used = 0, kept = 0;
    chains[0] = (Chain){0};
    for (int32_t i = 1; i <= numbers; i++) {
        chains[i].is_kept = (chains[i].length >= SHORTEST_CHAIN) & (chains[i].strongest > high);
        chains[i].next = used;
        used += chains[i].is_kept ? chains[i].length : 0;
    }
    /* the points left out are written behind the others, one over the other: if there is one there is room */
    for (int32_t i = 0; i <= numbers; i++)
        if (!chains[i].is_kept) chains[i].next = used;
    for (int32_t i = 0; i < count; i++) {
        Chain *own = &chains[links->chain[i]];
        rows[own->next] = i;
        own->next += own->is_kept;
    }
    for (int32_t i = 1; i <= numbers; i++)
        if (chains[i].is_kept) chains[kept++] = chains[i];
    return kept;
}

/* Chain the points of one pass and split the chains.
 *
 * points (count,), spans: see cl_edge_points. low, high: hysteresis on the norm.
 * Written: rows int32, room for (count,), the chained points in order; chain_ends int64, room for (count,); runs int64,
 * room for (count, 2), first and one past last index into rows; sizes int64 (2,): chained points and chains.
 * Returns the number of runs or OUT_OF_MEMORY. */
EXPORT FOR_EACH_PROCESSOR int64_t cl_runs(const EdgePoint *points, int64_t count, const Span *spans, int axis,
                                          int width, int height, double low, double high, int32_t *rows,
                                          int64_t *chain_ends, int64_t *runs, int64_t *sizes) {
    const int lines = axis == ALONG_X ? width : height, across_size = axis == ALONG_X ? height : width;
    const Field field = {points, {spans, line_spans(across_size)}, lines, (float)low};
    const size_t room = (size_t)(count ? count : 1), most = (size_t)across_size + 1;
    Links links;
    float *along = malloc(sizeof(float) * 2 * (size_t)lines);
    int *stack = malloc(sizeof(int) * 4 * (size_t)(lines + 2));
    Chain *chains = malloc(sizeof(Chain) * (room / 2 + 2));
    int64_t found = 0, used = 0;
    if (take_memory(&links, room, most) || !along || !stack || !chains) {
        found = OUT_OF_MEMORY;
        goto end;
    }
    float *across = along + lines;
    link_points(&field, &links);
    const int32_t numbers = number_chains(&field, &links, (int32_t)count, chains);
    const int32_t kept = list_chains(&links, (int32_t)count, chains, numbers, (float)high, rows);
    const int64_t listed = kept ? chains[kept - 1].next : 0;
    for (int32_t i = 0; i < kept; i++) {
        for (int j = 0; j < chains[i].length; j++) {
            const EdgePoint *point = &points[rows[used + j]];
            if (used + j + AHEAD < listed) __builtin_prefetch(&points[rows[used + j + AHEAD]]);
            along[j] = (float)point->along;
            across[j] = point->across;
        }
        found += split_chain(along, across, chains[i].length, stack, used, runs + 2 * found);
        used += chains[i].length;
        chain_ends[i] = used;
    }
    sizes[0] = used;
    sizes[1] = kept;
end:
    free_memory(&links);
    free(along);
    free(stack);
    free(chains);
    return found;
}
