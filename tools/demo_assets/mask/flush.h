/* The places where the mask changes colour with its targets, as a picture for noh build --color-map. */
#ifndef MASK_FLUSH_H
#define MASK_FLUSH_H

#include "shared/buffer.h"

/* A PNG of 64 x 64 pixels: red where it blushes, green the whole face, blue the brow. */
void flush_write(Buffer *png);

#endif
