/* lod_queue.h (private to lod_*.c): points by cost, the cheapest first; ties go to the lower number. */
#ifndef NOH_CONVERT_LOD_LOD_QUEUE_H
#define NOH_CONVERT_LOD_LOD_QUEUE_H

#include <stdint.h>

typedef struct lod_queue {
    uint32_t *heap, count; /* [capacity] points */
    uint32_t *place;       /* [capacity] by point, in the heap */
    float *cost;           /* [capacity] by point */
} lod_queue;

/* For points below `capacity`, each at most once in it. Returns 1 when out of memory. */
int lod_queue_make(lod_queue *q, uint32_t capacity);
void lod_queue_free(lod_queue *q);
void lod_queue_put(lod_queue *q, uint32_t point, float cost);
int lod_queue_first(const lod_queue *q, uint32_t *point); /* 0: empty */
void lod_queue_take(lod_queue *q);
void lod_queue_drop(lod_queue *q, uint32_t point); /* one that is in it */

#endif
