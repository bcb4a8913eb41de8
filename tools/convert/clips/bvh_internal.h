/* bvh_internal.h: a .bvh file while it is read.
 *
 *   bvh_read.c    bvh_read; the hierarchy
 *   bvh_frames.c  the frames */
#ifndef NOH_CONVERT_CLIPS_BVH_INTERNAL_H
#define NOH_CONVERT_CLIPS_BVH_INTERNAL_H

#include "bvh_read.h"
#include "convert/base/text_scan.h"

/* kind: 0 to 2 are positions along x, y, z; 3 to 5 rotations about them. */
typedef struct bvh_channel {
    uint32_t joint;
    uint8_t kind;
} bvh_channel;

typedef struct bvh_joint {
    char *name;
    uint32_t parent, line;
    uint32_t first_channel, channel_count;
    double offset[3], end[3];
    uint8_t has_offset, has_channels, is_end;
} bvh_joint;

typedef struct bvh_file {
    text_scan text;
    int end_joints;
    uint32_t frame_count; /* as announced */
    int any_count;        /* 1: it was not, and frame_count is a limit */
    int is_wrapped;       /* frames end by their numbers, not with their lines */
    uint32_t joint_count, joint_capacity, channel_count, channel_capacity;
    bvh_joint *joints;
    bvh_channel *channels;
    raw_set *set;
} bvh_file;

static inline int bvh_out_of_memory(bvh_file *f)
{
    return model_fail(f->text.error, "", "there is not enough memory to read this file");
}

/* Read what follows the word MOTION into the set's clip. */
int bvh_read_frames(bvh_file *f);

#endif
