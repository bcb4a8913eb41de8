/* Arms, bent in every way that noh knows, side by side in a glTF 2.0 binary. */
#ifndef ARM_WRITE_H
#define ARM_WRITE_H

#include "shared/buffer.h"

/* What went into the file, for the summary. */
typedef struct {
    int meshes, vertices, triangles, joints, animations;
} ArmCensus;

/* The buffer receives the file. */
ArmCensus arm_write(Buffer *file);

#endif
