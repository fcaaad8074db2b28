/* Where the ends of arcs are, and which face each other; see app/vision/merging.py. */
#include "merger.h"

#define CELL 16.0
enum { AHEAD = 8 };

/* places beyond the border count as the cells there, so that truncation does as well as floor, which is a call */
static int cell_of(double place, int count) { return clamp((int)(place / CELL), 0, count - 1); }

static int32_t cell_at(const Merger *merger, Vector place, int side) {
    const int row = cell_of(place.y, merger->rows) + side * merger->rows;
    return row * merger->columns + cell_of(place.x, merger->columns);
}

/* Stands for the angle of a direction: rises with it, by a whole turn in 2^16 steps; a right angle is 2^14. */
#define DIRECTION_STEPS 16384.0
static uint16_t direction_of(Vector v) {
    const double share = v.y / (fabs(v.x) + fabs(v.y));
    return (uint16_t)(int32_t)((v.x >= 0 ? 4 + share : 2 - share) * DIRECTION_STEPS);
}

int open_cells(Merger *merger) {
    /* a direction's number rises by at most 2^14 a radian */
    const double turn = merger->rule->angle * RADIANS_PER_DEGREE * DIRECTION_STEPS + 2;
    merger->turn = (uint16_t)smaller(turn, 2 * DIRECTION_STEPS - 1);
    merger->columns = (int)(merger->scene->width / CELL) + 1;
    merger->rows = (int)(merger->scene->height / CELL) + 1;
    const size_t cells = 2 * (size_t)merger->columns * (size_t)merger->rows, room = 2 * (2 * (size_t)merger->count + 1);
    merger->ends = malloc(room * sizeof(End));
    merger->slots = malloc(room * sizeof(Slot));
    merger->listed = malloc(room * sizeof(int32_t));
    merger->next = malloc(room * sizeof(int32_t));
    merger->firsts = calloc(cells + 1, sizeof(int32_t));
    merger->heads = malloc(cells * sizeof(int32_t));
    merger->ranges = malloc(2 * (size_t)merger->rows * sizeof(CellRange));
    if (!merger->ends || !merger->slots || !merger->listed || !merger->ranges || !merger->next || !merger->firsts ||
        !merger->heads)
        return OUT_OF_MEMORY;
    memset(merger->heads, 0xff, cells * sizeof(int32_t));
    return 0;
}

void close_cells(Merger *merger) {
    free(merger->ends);
    free(merger->slots);
    free(merger->listed);
    free(merger->ranges);
    free(merger->next);
    free(merger->firsts);
    free(merger->heads);
}

/* Write where an arc's start and end are. */
static void note_ends(Merger *merger, const Arc *arc, End *two) {
    const double length = larger(arc->high - arc->low, 1);
    for (int side = 0; side < 2; side++) {
        End *end = &two[side];
        const Vector direction = arc_direction(arc, side ? arc->high : arc->low);
        end->place = arc_end(arc, side);
        end->outward = side ? direction : (Vector){-direction.x, -direction.y};
        end->length = length;
        /* a gap is at most 0.7 (L1 + L2) + 6, so the longer arc's length bounds it */
        end->reach = smaller(2 * GAP_PER_LENGTH * length + SURE_GAP, merger->rule->reach);
        if (end->reach > merger->longest_reach) merger->longest_reach = end->reach;
    }
}

void order_ends(Merger *merger) {
    const int32_t ends = 2 * merger->count, cells = 2 * merger->columns * merger->rows;
    int32_t *firsts = merger->firsts, *cell = merger->listed, sum = 0;
    /* at first in the order of the arcs, where the ends of what is made of them will be */
    End *noted = merger->ends + ends;
    for (int32_t arc = 0; arc < merger->count; arc++) {
        if (arc + AHEAD < merger->count) __builtin_prefetch(&merger->arcs[arc + AHEAD].high);
        note_ends(merger, &merger->arcs[arc], noted + 2 * arc);
    }
    for (int32_t end = 0; end < ends; end++) {
        cell[end] = cell_at(merger, noted[end].place, end % 2);
        firsts[cell[end]]++;
    }
    for (int32_t i = 0; i <= cells; i++) sum += firsts[i], firsts[i] = sum;
    /* filled from behind, which leaves the first of each */
    for (int32_t end = ends - 1; end >= 0; end--) {
        const int32_t slot = --firsts[cell[end]];
        merger->ends[slot] = noted[end];
        merger->slots[slot] = (Slot){end, direction_of(noted[end].outward)};
    }
}

void list_ends(Merger *merger, int32_t arc) {
    note_ends(merger, &merger->arcs[arc], merger->ends + 2 * arc);
    for (int32_t slot = 2 * arc; slot < 2 * arc + 2; slot++) {
        const End *end = &merger->ends[slot];
        int32_t *head = &merger->heads[cell_at(merger, end->place, slot % 2)];
        merger->slots[slot] = (Slot){slot, direction_of(end->outward)};
        merger->next[slot] = *head;
        *head = slot;
    }
}

/* Directions that an end's partner may have: from `first` on, within a number of steps. */
typedef struct {
    uint16_t first, steps;
} Facing;

/* List the ends in some cells whose direction is right. Which are cannot be guessed, so all are written and those
 * counted. Returns their number, those listed before included. */
static int32_t list_facing(Merger *merger, Facing facing, CellRange range, int with_made, int32_t count) {
    int32_t *listed = merger->listed;
    for (int32_t slot = merger->firsts[range.first]; slot < merger->firsts[range.last + 1]; slot++) {
        listed[count] = slot;
        count += (uint16_t)(merger->slots[slot].direction - facing.first) <= facing.steps;
    }
    if (!with_made) return count;
    for (int32_t cell = range.first; cell <= range.last; cell++)
        for (int32_t other = merger->heads[cell]; other >= 0; other = merger->next[other]) {
            listed[count] = other;
            count += (uint16_t)(merger->slots[other].direction - facing.first) <= facing.steps;
        }
    return count;
}

/* List the cells, row by row, that touch a narrow rectangle before an end: no pair is farther sideways than the rule
 * allows at that distance. Returns the number of ranges. */
static int list_ranges(Merger *merger, const End *own, int own_side, double reach) {
    const double width = merger->rule->offset + merger->rule->offset_per_gap * reach;
    const double back_y = -OVERLAP * own->outward.y, ahead_y = reach * own->outward.y;
    const double margin_x = width * fabs(own->outward.y), margin_y = width * fabs(own->outward.x);
    const int y0 = cell_of(own->place.y + smaller(back_y, ahead_y) - margin_y, merger->rows);
    const int y1 = cell_of(own->place.y + larger(back_y, ahead_y) + margin_y, merger->rows);
    const double per_row = fabs(own->outward.y) > 1e-6 ? 1 / own->outward.y : 0;
    int count = 0;
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
            if (merger->rule->same_polarity != 0 && side == own_side) continue;
            const int32_t row = (side * merger->rows + y) * merger->columns;
            merger->ranges[count++] = (CellRange){row + x0, row + x1};
        }
    }
    return count;
}

int32_t list_ahead(Merger *merger, int32_t slot, double reach, int with_made) {
    const End *own = &merger->ends[slot];
    const uint16_t opposite = (uint16_t)(direction_of(own->outward) + (int)(2 * DIRECTION_STEPS));
    const Facing facing = {(uint16_t)(opposite - merger->turn), (uint16_t)(2 * merger->turn)};
    const CellRange *ranges = merger->ranges;
    const int rows = list_ranges(merger, own, merger->slots[slot].end % 2, reach);
    int32_t count = 0;
    if (with_made) {
        /* made arcs lie anywhere, so that nothing near them is at hand */
        for (int i = 0; i < rows; i++) {
            __builtin_prefetch(&merger->firsts[ranges[i].first]);
            __builtin_prefetch(&merger->heads[ranges[i].first]);
        }
        for (int i = 0; i < rows; i++) __builtin_prefetch(&merger->slots[merger->firsts[ranges[i].first]]);
    }
    for (int i = 0; i < rows; i++) count = list_facing(merger, facing, ranges[i], with_made, count);
    return count;
}
