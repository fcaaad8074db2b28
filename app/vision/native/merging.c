/* Merging arcs that lie on one circle, best pair first; see app/vision/merging.py. */
#include "merger.h"

enum { REPORT_EVERY = 4096, CACHE_LINE = 64, NEXT_PAIRS = 3 };
#define LONGEST_COUNTED 200.0

/* How two arcs became one. */
typedef struct {
    float leave_x, leave_y, enter_x, enter_y; /* the gap's ends, px */
    float cost;
    int32_t flipped; /* whether the bright side changes there */
    int32_t next;
} Join;

/* In large images an arc, and what lies between two, is far from the ones before: all is asked for before its turn. */
static void fetch_arc(const Arc *arc) {
    for (size_t i = 0; i < sizeof(Arc); i += CACHE_LINE) __builtin_prefetch((const char *)arc + i);
}

/* Whether the ends of two arcs face each other as the rule demands, by what is known of the ends alone. */
static int is_facing(const Rule *rule, double cosine, const End *from, const End *to) {
    if (-dot(from->outward, to->outward) < cosine) return 0;
    const Vector vector = minus(to->place, from->place);
    const double gap = sqrt(dot(vector, vector)), both = from->length + to->length;
    if (gap > smaller(GAP_PER_LENGTH * both + SURE_GAP, rule->reach)) return 0;
    const double sideways = rule->offset + rule->offset_per_gap * gap;
    const Vector back = {-to->outward.x, -to->outward.y};
    if (dot(vector, from->outward) < -OVERLAP || dot(vector, back) < -OVERLAP) return 0;
    return fabs(cross(from->outward, vector)) <= sideways && fabs(cross(back, vector)) <= sideways;
}

/* Put a pair of ends that face each other on the heap if it fulfils the rest of the rule. */
static int weigh(Merger *merger, Waiting pair) {
    const Rule *rule = merger->rule;
    const int32_t leave = merger->slots[pair.leave].end, enter = merger->slots[pair.enter].end;
    const End *from = &merger->ends[pair.leave], *to = &merger->ends[pair.enter];
    const Arc *first = &merger->arcs[leave / 2], *second = &merger->arcs[enter / 2];
    Arc joined;
    join_arcs(first, leave % 2, second, enter % 2 == 0, &joined);
    if (joined.rms > rule->rms) return 0;
    const Vector four[4] = {from->place, to->place, arc_end(first, leave % 2 == 0), arc_end(second, enter % 2 == 0)};
    for (int i = 0; i < 4; i++) {
        double along, distance;
        arc_project(&joined, four[i], &along, &distance);
        if (fabs(distance) > rule->largest) return 0;
    }
    const double both = from->length + to->length;
    const double limit = rule->limit + rule->limit_per_length * smaller(both, LONGEST_COUNTED);
    double cost = effective_gap(merger->scene, first, second, from->place, to->place, rule->same_polarity != 0);
    cost *= 1 + 2 * joined.rms;
    if (cost > limit) return 0;
    return push_pair(&merger->heap, (Pair){cost + joined.rms, leave, enter});
}

static int weigh_waiting(Merger *merger) {
    for (int i = 0; i < merger->waits; i++)
        if (weigh(merger, merger->waiting[i])) return OUT_OF_MEMORY;
    merger->waits = 0;
    return 0;
}

/* Have a pair weighed if its ends, of which the slots are given, face each other. */
static int consider(Merger *merger, int32_t one, int32_t other) {
    const int32_t end = merger->slots[one].end, other_end = merger->slots[other].end;
    /* the end that is left comes first: an arc's end before a start, else the lower number */
    const int swap = end % 2 < other_end % 2 || (end % 2 == other_end % 2 && end > other_end);
    const Waiting pair = {swap ? other : one, swap ? one : other};
    const End *from = &merger->ends[pair.leave], *to = &merger->ends[pair.enter];
    if (!is_facing(merger->rule, merger->cosine, from, to)) return 0;
    fetch_arc(&merger->arcs[end / 2]);
    fetch_arc(&merger->arcs[other_end / 2]);
    fetch_gap(merger->scene, from->place, to->place);
    merger->waiting[merger->waits++] = pair;
    return merger->waits < MOST_WAITING ? 0 : weigh_waiting(merger);
}

/* Consider the pairs of the end in a slot with all others within `reach` before it. With `shorter_only` pairs with ends
 * of longer arcs, and of equals those of a higher number, are left to these. */
static int consider_ahead(Merger *merger, int32_t slot, double reach, int shorter_only) {
    /* while each end looks for shorter arcs, nothing has been merged yet */
    const int32_t count = list_ahead(merger, slot, reach, !shorter_only), end = merger->slots[slot].end;
    const End *own = &merger->ends[slot];
    for (int32_t i = 0; i < count; i++) __builtin_prefetch(&merger->ends[merger->listed[i]]);
    for (int32_t i = 0; i < count; i++) {
        const int32_t other = merger->listed[i], other_end = merger->slots[other].end;
        if (other_end / 2 == end / 2 || !merger->alive[other_end / 2]) continue;
        const End *to = &merger->ends[other];
        if (shorter_only && (to->length > own->length || (to->length == own->length && other_end < end))) continue;
        const Vector vector = minus(to->place, own->place);
        const double most = larger(own->reach, to->reach);
        if (dot(vector, vector) > most * most) continue;
        if (consider(merger, slot, other)) return OUT_OF_MEMORY;
    }
    return 0;
}

/* Put all pairs of the arcs given on the heap. Ends are gone through in the order of their cells, so that what is near
 * one is still at hand for the next. Returns 0, OUT_OF_MEMORY or CANCELLED. */
static int find_pairs(Merger *merger, Report report) {
    const int32_t count = merger->count;
    memset(merger->alive, 1, (size_t)count);
    order_ends(merger);
    for (int32_t slot = 0; slot < 2 * count; slot++) {
        if (slot % REPORT_EVERY == 0 && is_cancelled(report, slot, 3 * (int64_t)count)) return CANCELLED;
        if (consider_ahead(merger, slot, merger->ends[slot].reach, 1)) return OUT_OF_MEMORY;
    }
    return weigh_waiting(merger);
}

/* Put one list behind another; the ends of lists are kept in their arcs. */
static void append_joins(Join *joins, int32_t *tail, const Arc *part) {
    if (part->first_join < 0) return;
    joins[*tail].next = part->first_join;
    *tail = part->last_join;
}

/* Make one arc of two. */
static void join_pair(Merger *merger, Pair pair, int32_t index, int32_t *next_piece, Join *joins, int32_t made) {
    const int32_t one = pair.leave / 2, other = pair.enter / 2;
    const Arc *first = &merger->arcs[one], *second = &merger->arcs[other];
    Arc *joined = &merger->arcs[index];
    const Vector leave = arc_end(first, pair.leave % 2), enter = arc_end(second, pair.enter % 2);
    join_arcs(first, pair.leave % 2, second, pair.enter % 2 == 0, joined);
    joins[made] = (Join){(float)leave.x,
                         (float)leave.y,
                         (float)enter.x,
                         (float)enter.y,
                         (float)pair.cost,
                         pair.leave % 2 == pair.enter % 2,
                         -1};
    joined->first_piece = first->first_piece;
    next_piece[first->last_piece] = second->first_piece;
    joined->last_piece = second->last_piece;
    joined->first_join = joined->last_join = made;
    append_joins(joins, &joined->last_join, first);
    append_joins(joins, &joined->last_join, second);
    merger->alive[one] = merger->alive[other] = 0;
    merger->alive[index] = 1;
    list_ends(merger, index);
}

/* The pairs that are likely to be merged next lie anywhere in the image. */
static void fetch_next(const Merger *merger) {
    for (size_t i = 0; i < NEXT_PAIRS && i < merger->heap.count; i++) {
        const Pair *pair = &merger->heap.pairs[i];
        fetch_arc(&merger->arcs[pair->leave / 2]);
        fetch_arc(&merger->arcs[pair->enter / 2]);
    }
}

/* Merge arcs until no pair fulfils the rule.
 *
 * arcs: `count` of them, room for 2 * count; those left are written to its front. rule: see Rule. next_piece int32:
 * lists of pieces, joined as their arcs are. joins: room for one per piece in all; `made` of them exist, its new number
 * is written back. Returns the number of arcs left, OUT_OF_MEMORY or CANCELLED. */
EXPORT int64_t cl_merge(const Scene *scene, Arc *arcs, int64_t count, const Rule *rule, int32_t *next_piece,
                        Join *joins, int64_t *made, Report report) {
    Merger merger = {.scene = scene, .rule = rule, .arcs = arcs, .count = (int32_t)count};
    merger.cosine = cos(rule->angle * RADIANS_PER_DEGREE);
    merger.alive = malloc((size_t)(2 * count + 1));
    int64_t left = OUT_OF_MEMORY;
    if (open_cells(&merger) || !merger.alive) goto end;
    const int status = find_pairs(&merger, report);
    if (status) {
        left = status;
        goto end;
    }
    while (merger.heap.count) {
        const Pair pair = pop_pair(&merger.heap);
        fetch_next(&merger);
        if (!merger.alive[pair.leave / 2] || !merger.alive[pair.enter / 2]) continue;
        const int32_t index = merger.count++;
        if (index % REPORT_EVERY == 0 && is_cancelled(report, count + index, 3 * count)) {
            left = CANCELLED;
            goto end;
        }
        join_pair(&merger, pair, index, next_piece, joins, (int32_t)(*made)++);
        for (int side = 0; side < 2; side++)
            if (consider_ahead(&merger, 2 * index + side, merger.longest_reach, 0)) goto end;
        if (weigh_waiting(&merger)) goto end;
    }
    left = 0;
    for (int32_t arc = 0; arc < merger.count; arc++)
        if (merger.alive[arc]) arcs[left++] = arcs[arc];
end:
    close_cells(&merger);
    free(merger.alive);
    free(merger.heap.pairs);
    return left;
}

/* Move the arcs of at least some length, px, to the front. Returns their number. */
EXPORT int64_t cl_leave_out_short(Arc *arcs, int64_t count, double least) {
    int64_t left = 0;
    for (int64_t i = 0; i < count; i++)
        if (arcs[i].high - arcs[i].low >= least) arcs[left++] = arcs[i];
    return left;
}
