/* The square of a festival, as an .obj model of boxes and round pillars: stalls, benches, lanterns, a drum on its
 * stage, a terrace with stairs. festival.place has the obstacles and what people do there. */
#ifndef FESTIVAL_FESTIVAL_H
#define FESTIVAL_FESTIVAL_H

#include "shared/buffer.h"

typedef struct {
    int vertices, faces;
} FestivalCensus;

/* obj: the model, whose materials are in `library`; mtl: these. */
FestivalCensus festival_write(Buffer *obj, Buffer *mtl, const char *library);

#endif
