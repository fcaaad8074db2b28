#include "pair_heap.h"
#include "kernels.h"

enum { FIRST_ROOM = 4096 };

/* Equal costs are told apart by the numbers of the ends, so that the order never depends on the heap's history. */
static int cheaper(const Pair *a, const Pair *b) {
    if (a->cost != b->cost) return a->cost < b->cost;
    return a->leave != b->leave ? a->leave < b->leave : a->enter < b->enter;
}

int push_pair(PairHeap *heap, Pair pair) {
    if (heap->count == heap->room) {
        const size_t room = heap->room ? 2 * heap->room : FIRST_ROOM;
        Pair *pairs = realloc(heap->pairs, room * sizeof(Pair));
        if (!pairs) return OUT_OF_MEMORY;
        heap->pairs = pairs;
        heap->room = room;
    }
    Pair *pairs = heap->pairs;
    size_t i = heap->count++;
    while (i && cheaper(&pair, &pairs[(i - 1) / 2])) {
        pairs[i] = pairs[(i - 1) / 2];
        i = (i - 1) / 2;
    }
    pairs[i] = pair;
    return 0;
}

Pair pop_pair(PairHeap *heap) {
    Pair *pairs = heap->pairs;
    const Pair top = pairs[0], last = pairs[--heap->count];
    size_t i = 0;
    for (;;) {
        size_t child = 2 * i + 1;
        if (child >= heap->count) break;
        if (child + 1 < heap->count && cheaper(&pairs[child + 1], &pairs[child])) child++;
        if (!cheaper(&pairs[child], &last)) break;
        pairs[i] = pairs[child];
        i = child;
    }
    pairs[i] = last;
    return top;
}
