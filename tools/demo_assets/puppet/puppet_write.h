/* The puppet as a glTF 2.0 binary. */
#ifndef PUPPET_WRITE_H
#define PUPPET_WRITE_H

#include "shared/buffer.h"

/* What went into the file, for the summary. */
typedef struct {
    int body_vertices, mask_vertices, triangles, joints, animations;
} PuppetCensus;

/* The buffer receives the file: all of it; its skeleton with the clips that get up. */
PuppetCensus puppet_write(Buffer *file);
PuppetCensus get_up_write(Buffer *file);

#endif
