/* A heap of pairs of arcs' ends that may be merged, the cheapest on top (Williams, CACM 7(6), 1964). */
#ifndef CLEARLINES_PAIR_HEAP_H
#define CLEARLINES_PAIR_HEAP_H

#include <stddef.h>
#include <stdint.h>

typedef struct {
    double cost;
    int32_t leave, enter; /* ends: 2 i is the start of arc i, 2 i + 1 its end */
} Pair;

/* Begins as zeros; `pairs` is freed by its owner. */
typedef struct {
    Pair *pairs;
    size_t count, room;
} PairHeap;

/* Returns 0 or OUT_OF_MEMORY. */
int push_pair(PairHeap *heap, Pair pair);
Pair pop_pair(PairHeap *heap);

#endif
