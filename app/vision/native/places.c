/* How many bits of a byte are set: baseline processors of some families have no instruction for it. */
#include "places.h"

#define FOUR(n) (n), (n) + 1, (n) + 1, (n) + 2
#define SIXTEEN(n) FOUR(n), FOUR((n) + 1), FOUR((n) + 1), FOUR((n) + 2)
#define SIXTY_FOUR(n) SIXTEEN(n), SIXTEEN((n) + 1), SIXTEEN((n) + 1), SIXTEEN((n) + 2)

const uint8_t bits_set[256] = {SIXTY_FOUR(0), SIXTY_FOUR(1), SIXTY_FOUR(1), SIXTY_FOUR(2)};
