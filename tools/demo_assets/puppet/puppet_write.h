/* The puppet as a glTF 2.0 binary. */
#ifndef PUPPET_WRITE_H
#define PUPPET_WRITE_H

#include "body.h"
#include "shared/buffer.h"
#include "shared/writer.h"

/* What went into the file, for the summary. */
typedef struct {
    int body_vertices, mask_vertices, triangles, joints, animations;
} PuppetCensus;

/* The buffer receives the file: all of it; its skeleton with the clips that get up, or with those that roam. */
PuppetCensus puppet_write(Buffer *file);
PuppetCensus get_up_write(Buffer *file);
PuppetCensus roam_write(Buffer *file);
PuppetCensus roam_all_write(Buffer *file); /* 476 s, for measurements */

/* A coat that the puppet can wear: it has some of the puppet's joints, and a tail with two joints of its own. */
PuppetCensus coat_write(Buffer *file);

/* Prints a primitive. */
void piece_write(Writer *w, Buffer *json, const Piece *piece, int material);

#endif
