/* The mask alone as a glTF 2.0 binary. */
#ifndef MASK_GLTF_WRITE_H
#define MASK_GLTF_WRITE_H

#include "shared/buffer.h"
#include "figure.h"

/* What went into the file, for the summary. */
typedef struct {
    int vertices, triangles, targets, animations;
} Census;

/* The buffer receives the file. */
Census gltf_write(Buffer *file, const Figure *mask);

#endif
