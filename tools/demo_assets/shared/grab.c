#include "grab.h"

#include <stdio.h>
#include <stdlib.h>

void *grab(void *old, int count, int size)
{
    void *memory = realloc(old, (size_t)count * (size_t)size);
    if (!memory) {
        fprintf(stderr, "out of memory\n");
        exit(1);
    }
    return memory;
}
