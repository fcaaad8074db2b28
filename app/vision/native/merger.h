/* The search for arcs that may become one: by their ends, in cells of the image. */
#ifndef CLEARLINES_MERGER_H
#define CLEARLINES_MERGER_H

#include "kernels.h"
#include "pair_heap.h"

/* px, two arcs' ends may lie past each other */
#define OVERLAP 2.0
#define GAP_PER_LENGTH 0.7
#define SURE_GAP 6.0

/* What two arcs must fulfil; the fields are those of app.vision.merging.MergeRule. */
typedef struct {
    double same_polarity, angle, offset, offset_per_gap, rms, largest, reach, limit, limit_per_length;
} Rule;

typedef struct {
    Vector place, outward;
    double reach, length;
} End;

/* What the search looks at first, packed. */
typedef struct {
    int32_t end;       /* 2 i is the start of arc i, 2 i + 1 its end */
    int32_t direction; /* see direction_of */
} Slot;

/* Neighbouring cells of a row. */
typedef struct {
    int32_t first, last;
} CellRange;

/* Slots of two ends that wait to be looked at more closely while memory is fetched. */
enum { MOST_WAITING = 16 };
typedef struct {
    int32_t leave, enter;
} Waiting;

typedef struct {
    const Scene *scene;
    const Rule *rule;
    double cosine; /* of the rule's angle */
    uint16_t turn; /* no directions within the rule's angle differ by more */
    Arc *arcs;
    uint8_t *alive; /* of each arc */
    int32_t count;
    int columns, rows;
    /* cells: those of starts row by row, then those of ends. The ends of the arcs given lie in their order, the first
     * of each cell in `firsts`; behind them, by their numbers, those of the arcs made of them, in lists, `heads` being
     * the latest of each cell */
    Slot *slots;
    End *ends; /* of each slot */
    int32_t *firsts, *heads, *next;
    CellRange *ranges; /* cells to be looked into */
    int32_t *listed;   /* slots of ends that may face the one looked at */
    Waiting waiting[MOST_WAITING];
    int waits;
    PairHeap heap;
    double longest_reach;
} Merger;

/* cells.c: returns 0 or OUT_OF_MEMORY; the cells must be closed in either case. */
int open_cells(Merger *merger);
void close_cells(Merger *merger);
/* Put the ends of the arcs given into the order of their cells. */
void order_ends(Merger *merger);
/* Put the ends of an arc that was made into the lists of their cells. */
void list_ends(Merger *merger, int32_t arc);
/* List the ends within `reach` before one whose direction is right, and others near these. Returns their number. */
int32_t list_ahead(Merger *merger, int32_t slot, double reach, int with_made);

#endif
