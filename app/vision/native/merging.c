/* Merging arcs that lie on one circle, best pair first; see app/vision/merging.py. */
#include "kernels.h"
#include "pair_heap.h"

#define CELL 16.0
enum { REPORT_EVERY = 4096 };
#define OVERLAP 2.0
#define GAP_PER_LENGTH 0.7
#define SURE_GAP 6.0
#define LONGEST_COUNTED 200.0

/* What two arcs must fulfil; the fields are those of app.vision.merging.MergeRule. */
typedef struct {
    double same_polarity, angle, offset, offset_per_gap, rms, largest, reach, limit, limit_per_length;
} Rule;

/* How two arcs became one. */
typedef struct {
    float leave_x, leave_y, enter_x, enter_y; /* the gap's ends, px */
    float cost;
    int32_t flipped; /* whether the bright side changes there */
    int32_t next;
} Join;

typedef struct {
    Vector place, outward;
    double reach, length;
} End;

/* What the search looks at first, packed. */
typedef struct {
    int32_t end;
    int32_t direction; /* see direction_of */
} Slot;

typedef struct {
    const Scene *scene;
    const Rule *rule;
    double cosine; /* of the rule's angle */
    uint16_t turn; /* no directions within the rule's angle differ by more */
    Arc *arcs;
    End *ends;
    uint8_t *alive; /* of each arc */
    int32_t count;
    int columns, rows;
    /* cells: those of starts row by row, then those of ends. The ends of the arcs given lie in their order, the first
     * of each cell in `firsts`; those of the arcs made of them are in lists, `heads` being the latest of each cell */
    Slot *slots; /* in order, then those in the lists */
    int32_t *firsts, *heads, *next;
    int32_t *listed; /* ends that may face the one looked at */
    PairHeap heap;
    double longest_reach;
} Merger;

/* places beyond the border count as the cells there, so that truncation does as well as floor, which is a call */
static int cell_of(double place, int count) { return clamp((int)(place / CELL), 0, count - 1); }

static int32_t cell_at(const Merger *merger, int32_t end) {
    const Vector place = merger->ends[end].place;
    const int row = cell_of(place.y, merger->rows) + end % 2 * merger->rows;
    return row * merger->columns + cell_of(place.x, merger->columns);
}

/* Stands for the angle of a direction: rises with it, by a whole turn in 2^16 steps; a right angle is 2^14. */
#define DIRECTION_STEPS 16384.0
static uint16_t direction_of(Vector v) {
    const double share = v.y / (fabs(v.x) + fabs(v.y));
    return (uint16_t)(int32_t)((v.x >= 0 ? 4 + share : 2 - share) * DIRECTION_STEPS);
}

static void note_ends(Merger *merger, int32_t arc) {
    const Arc *own = &merger->arcs[arc];
    const double length = larger(own->high - own->low, 1);
    for (int side = 0; side < 2; side++) {
        End *end = &merger->ends[2 * arc + side];
        const Vector direction = arc_direction(own, side ? own->high : own->low);
        end->place = arc_end(own, side);
        end->outward = side ? direction : (Vector){-direction.x, -direction.y};
        end->length = length;
        /* a gap is at most 0.7 (L1 + L2) + 6, so the longer arc's length bounds it */
        end->reach = smaller(2 * GAP_PER_LENGTH * length + SURE_GAP, merger->rule->reach);
        if (end->reach > merger->longest_reach) merger->longest_reach = end->reach;
    }
    merger->alive[arc] = 1;
}

/* Put the ends of the arcs given into the order of their cells. */
static void order_ends(Merger *merger) {
    const int32_t ends = 2 * merger->count, cells = 2 * merger->columns * merger->rows;
    int32_t *firsts = merger->firsts, sum = 0;
    for (int32_t end = 0; end < ends; end++) firsts[cell_at(merger, end)]++;
    for (int32_t cell = 0; cell <= cells; cell++) sum += firsts[cell], firsts[cell] = sum;
    /* filled from behind, which leaves the first of each */
    for (int32_t end = ends - 1; end >= 0; end--)
        merger->slots[--firsts[cell_at(merger, end)]] = (Slot){end, direction_of(merger->ends[end].outward)};
}

/* Put the ends of an arc that was made into the lists of their cells. */
static void list_ends(Merger *merger, int32_t arc) {
    for (int32_t end = 2 * arc; end < 2 * arc + 2; end++) {
        int32_t *head = &merger->heads[cell_at(merger, end)];
        merger->slots[end] = (Slot){end, direction_of(merger->ends[end].outward)};
        merger->next[end] = *head;
        *head = end;
    }
}

/* Put a pair of ends on the heap if it fulfils the rule. */
static int consider(Merger *merger, int32_t one, int32_t two) {
    const Rule *rule = merger->rule;
    /* the end that is left comes first: an arc's end before a start, else the lower number */
    const int swap = one % 2 < two % 2 || (one % 2 == two % 2 && one > two);
    const int32_t leave = swap ? two : one, enter = swap ? one : two;
    const End *from = &merger->ends[leave], *to = &merger->ends[enter];
    if (-dot(from->outward, to->outward) < merger->cosine) return 0;
    const Vector vector = minus(to->place, from->place);
    const double gap = sqrt(dot(vector, vector)), both = from->length + to->length;
    if (gap > smaller(GAP_PER_LENGTH * both + SURE_GAP, rule->reach)) return 0;
    const double sideways = rule->offset + rule->offset_per_gap * gap;
    const Vector back = {-to->outward.x, -to->outward.y};
    if (dot(vector, from->outward) < -OVERLAP || dot(vector, back) < -OVERLAP) return 0;
    if (fabs(cross(from->outward, vector)) > sideways || fabs(cross(back, vector)) > sideways) return 0;
    const Arc *first = &merger->arcs[leave / 2], *second = &merger->arcs[enter / 2];
    Arc joined;
    join_arcs(first, leave % 2, second, enter % 2 == 0, &joined);
    if (joined.rms > rule->rms) return 0;
    const int32_t four[4] = {leave, enter, leave ^ 1, enter ^ 1};
    for (int i = 0; i < 4; i++) {
        double along, distance;
        arc_project(&joined, merger->ends[four[i]].place, &along, &distance);
        if (fabs(distance) > rule->largest) return 0;
    }
    const double limit = rule->limit + rule->limit_per_length * smaller(both, LONGEST_COUNTED);
    double cost = effective_gap(merger->scene, first, second, from->place, to->place, rule->same_polarity != 0);
    cost *= 1 + 2 * joined.rms;
    if (cost > limit) return 0;
    return push_pair(&merger->heap, (Pair){cost + joined.rms, leave, enter});
}

/* Directions that an end's partner may have: from `first` on, within a number of steps. */
typedef struct {
    uint16_t first, steps;
} Facing;

/* List the ends in some neighbouring cells whose direction is right. Which are cannot be guessed, so all are written
 * and those counted. Returns their number, those listed before included. */
static int32_t list_facing(Merger *merger, Facing facing, int32_t first, int32_t last, int with_made, int32_t count) {
    int32_t *listed = merger->listed;
    const Slot *stop = merger->slots + merger->firsts[last + 1];
    for (const Slot *slot = merger->slots + merger->firsts[first]; slot < stop; slot++) {
        listed[count] = slot->end;
        count += (uint16_t)(slot->direction - facing.first) <= facing.steps;
    }
    if (!with_made) return count;
    for (int32_t cell = first; cell <= last; cell++)
        for (int32_t other = merger->heads[cell]; other >= 0; other = merger->next[other]) {
            listed[count] = other;
            count += (uint16_t)(merger->slots[other].direction - facing.first) <= facing.steps;
        }
    return count;
}

/* Consider the pairs of an end with the first `count` listed. With `shorter_only` pairs with ends of longer arcs, and
 * of equals those of a higher number, are left to these. */
static int consider_listed(Merger *merger, int32_t end, int32_t count, int shorter_only) {
    const End *own = &merger->ends[end];
    /* in large images each lies far from the others, and is asked for before its turn */
    for (int32_t i = 0; i < count; i++) __builtin_prefetch(&merger->ends[merger->listed[i]]);
    for (int32_t i = 0; i < count; i++) {
        const int32_t other = merger->listed[i];
        if (other / 2 == end / 2 || !merger->alive[other / 2]) continue;
        const End *to = &merger->ends[other];
        if (shorter_only && (to->length > own->length || (to->length == own->length && other < end))) continue;
        const Vector vector = minus(to->place, own->place);
        const double most = larger(own->reach, to->reach);
        if (dot(vector, vector) > most * most) continue;
        if (consider(merger, end, other)) return OUT_OF_MEMORY;
    }
    return 0;
}

/* Consider the pairs of an end with all others within `reach` before it. No pair is farther sideways than the rule
 * allows at that distance, so only cells that touch a narrow rectangle are looked into. */
static int consider_ahead(Merger *merger, int32_t end, double reach, int shorter_only) {
    const End *own = &merger->ends[end];
    const double width = merger->rule->offset + merger->rule->offset_per_gap * reach;
    const double back_y = -OVERLAP * own->outward.y, ahead_y = reach * own->outward.y;
    const double margin_x = width * fabs(own->outward.y), margin_y = width * fabs(own->outward.x);
    const int y0 = cell_of(own->place.y + smaller(back_y, ahead_y) - margin_y, merger->rows);
    const int y1 = cell_of(own->place.y + larger(back_y, ahead_y) + margin_y, merger->rows);
    const uint16_t opposite = (uint16_t)(direction_of(own->outward) + (int)(2 * DIRECTION_STEPS));
    const Facing facing = {(uint16_t)(opposite - merger->turn), (uint16_t)(2 * merger->turn)};
    int32_t count = 0;
    const double per_row = fabs(own->outward.y) > 1e-6 ? 1 / own->outward.y : 0;
    for (int y = y0; y <= y1; y++) {
        /* the part of the rectangle's middle line whose breadth touches this row of cells; those at the border hold all
         * that lies beyond */
        double from = -OVERLAP, to = reach;
        if (per_row != 0) {
            const double top = y > 0 ? y * CELL - own->place.y - margin_y : -INFINITY;
            const double bottom = y < merger->rows - 1 ? (y + 1) * CELL - own->place.y + margin_y : INFINITY;
            from = larger(from, smaller(top * per_row, bottom * per_row));
            to = smaller(to, larger(top * per_row, bottom * per_row));
            if (from > to) continue;
        }
        const double one = own->place.x + from * own->outward.x, two = own->place.x + to * own->outward.x;
        const int x0 = cell_of(smaller(one, two) - margin_x, merger->columns);
        const int x1 = cell_of(larger(one, two) + margin_x, merger->columns);
        for (int side = 0; side < 2; side++) {
            if (merger->rule->same_polarity != 0 && side == end % 2) continue;
            const int32_t row = (side * merger->rows + y) * merger->columns;
            /* while each end looks for shorter arcs, nothing has been merged yet */
            count = list_facing(merger, facing, row + x0, row + x1, !shorter_only, count);
        }
    }
    return consider_listed(merger, end, count, shorter_only);
}

/* Merge arcs until no pair fulfils the rule.
 *
 * arcs: `count` of them, room for 2 * count; those left are written to its front. rule: see Rule. next_piece int32:
 * lists of pieces, joined as their arcs are. joins: room for one per piece in all; `made` of them exist, its new number
 * is written back. Returns the number of arcs left, OUT_OF_MEMORY or CANCELLED. */
EXPORT int64_t cl_merge(const Scene *scene, Arc *arcs, int64_t count, const Rule *rule, int32_t *next_piece,
                        Join *joins, int64_t *made, Report report) {
    Merger merger = {.scene = scene, .rule = rule, .cosine = cos(rule->angle * (RADIANS_PER_DEGREE)), .arcs = arcs};
    /* a direction's number rises by at most 2^14 a radian */
    merger.turn = (uint16_t)smaller(rule->angle * RADIANS_PER_DEGREE * DIRECTION_STEPS + 2, 2 * DIRECTION_STEPS - 1);
    merger.columns = (int)(scene->width / CELL) + 1;
    merger.rows = (int)(scene->height / CELL) + 1;
    const size_t cells = (size_t)merger.columns * merger.rows, room = (size_t)(2 * count + 1);
    merger.ends = malloc(2 * room * sizeof(End));
    merger.alive = malloc(room);
    merger.slots = malloc(2 * room * sizeof(Slot));
    merger.listed = malloc(2 * room * sizeof(int32_t));
    merger.next = malloc(2 * room * sizeof(int32_t));
    merger.firsts = calloc(2 * cells + 1, sizeof(int32_t));
    merger.heads = malloc(2 * cells * sizeof(int32_t));
    int64_t left = OUT_OF_MEMORY;
    if (!merger.ends || !merger.listed || !merger.alive || !merger.slots || !merger.next || !merger.firsts ||
        !merger.heads)
        goto end;
    memset(merger.heads, 0xff, 2 * cells * sizeof(int32_t));
    merger.count = (int32_t)count;
    for (int32_t arc = 0; arc < count; arc++) note_ends(&merger, arc);
    order_ends(&merger);
    for (int32_t end = 0; end < 2 * count; end++) {
        if (end % REPORT_EVERY == 0 && is_cancelled(report, end, 3 * count)) {
            left = CANCELLED;
            goto end;
        }
        if (consider_ahead(&merger, end, merger.ends[end].reach, 1)) goto end;
    }
    while (merger.heap.count) {
        const Pair pair = pop_pair(&merger.heap);
        const int32_t first = pair.leave / 2, second = pair.enter / 2;
        if (!merger.alive[first] || !merger.alive[second]) continue;
        const int32_t index = merger.count++;
        if (index % REPORT_EVERY == 0 && is_cancelled(report, count + index, 3 * count)) {
            left = CANCELLED;
            goto end;
        }
        Arc *joined = &arcs[index];
        const Vector leave = merger.ends[pair.leave].place, enter = merger.ends[pair.enter].place;
        join_arcs(&arcs[first], pair.leave % 2, &arcs[second], pair.enter % 2 == 0, joined);
        const Join join = {(float)leave.x,
                           (float)leave.y,
                           (float)enter.x,
                           (float)enter.y,
                           (float)pair.cost,
                           pair.leave % 2 == pair.enter % 2,
                           -1};
        joins[*made] = join;
        joined->first_piece = arcs[first].first_piece;
        next_piece[arcs[first].last_piece] = arcs[second].first_piece;
        joined->last_piece = arcs[second].last_piece;
        int32_t head = (int32_t)*made, tail = head;
        for (int i = 0; i < 2; i++) {
            const Arc *part = &arcs[i ? second : first];
            if (part->first_join < 0) continue;
            joins[tail].next = part->first_join;
            tail = part->last_join;
        }
        joined->first_join = head;
        joined->last_join = tail;
        (*made)++;
        merger.alive[first] = merger.alive[second] = 0;
        note_ends(&merger, index);
        list_ends(&merger, index);
        for (int side = 0; side < 2; side++)
            if (consider_ahead(&merger, 2 * index + side, merger.longest_reach, 0)) goto end;
    }
    left = 0;
    for (int32_t arc = 0; arc < merger.count; arc++)
        if (merger.alive[arc]) arcs[left++] = arcs[arc];
end:
    free(merger.ends);
    free(merger.alive);
    free(merger.slots);
    free(merger.next);
    free(merger.listed);
    free(merger.firsts);
    free(merger.heads);
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
