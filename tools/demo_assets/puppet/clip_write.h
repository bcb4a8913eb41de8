/* A clip as a glTF animation. */
#ifndef PUPPET_CLIP_WRITE_H
#define PUPPET_CLIP_WRITE_H

#include "clips.h"
#include "shared/writer.h"

/* Prints an animation object. Node numbers are joint numbers; `mask_node` has the morph targets. */
void clip_write(Writer *w, Buffer *json, const Clip *clip, int mask_node);

#endif
