/* The model as a glTF 2.0 binary. */
#ifndef MASK_GLTF_WRITE_H
#define MASK_GLTF_WRITE_H

#include "buffer.h"
#include "mesh.h"

/* What went into the file, for the summary. */
typedef struct {
    int vertices, triangles, targets, animations;
} Census;

/* `rest` and `weld` hold one entry per part. The buffer receives the file. */
Census gltf_write(Buffer *file, const Model *model, const Frame *rest, int *const *weld);

#endif
