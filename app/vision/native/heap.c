/* Letting the C library keep the memory of one detection for the next. */
#include "kernels.h"

#if defined(__GLIBC__)
#include <malloc.h>
#endif

/* glibc takes blocks above a threshold from the system and gives them back at once, as it does with what is free at the
 * heap's end beyond another. So every detection would pay for fresh pages: some 5000 faults a megapixel, a tenth of its
 * time. These are the largest threshold there is, and what an image of 12 megapixels needs. Elsewhere this changes
 * nothing. */
EXPORT void cl_keep_heap(void) {
#if defined(__GLIBC__)
    mallopt(M_MMAP_THRESHOLD, 32 << 20);
    mallopt(M_TRIM_THRESHOLD, 256 << 20);
#endif
}
