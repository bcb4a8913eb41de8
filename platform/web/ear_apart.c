/* ear_apart.c: the ear's tables as zeros, in place of the library's: the page fetches them when it first listens
 * (ear.bin, by tools/web_ear). They do not compress, and are a twentieth of the first picture's bytes. */
#include <emscripten.h>

#include "life/face/ear_internal.h"

const ear_tables noh_ear_tables;

/* Where the page writes them. */
EMSCRIPTEN_KEEPALIVE const void *web_ear_tables(void)
{
    return &noh_ear_tables;
}
EMSCRIPTEN_KEEPALIVE uint32_t web_ear_tables_bytes(void)
{
    return sizeof noh_ear_tables;
}
