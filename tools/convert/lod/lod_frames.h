/* lod_frames.h: frames of a model's clips as poses of a skinned mesh.
 *
 *   lod_frame_pose      one frame
 *   lod_frames_choose   the few that differ most, for lod_options.poses */
#ifndef NOH_CONVERT_LOD_LOD_FRAMES_H
#define NOH_CONVERT_LOD_LOD_FRAMES_H

#include "convert/model/model.h"

#ifdef __cplusplus
extern "C" {
#endif

#define LOD_CAPS 3u /* at most 4, 2 and 1 joints a vertex */

typedef struct lod_moment {
    uint32_t clip;
    double time_s;
} lod_moment;

typedef struct lod_frames {
    uint32_t count;
    float **poses;             /* [count][vertex_count][3], for lod_options.poses */
    lod_moment *moments;       /* [count] when each is */
    float cap_error[LOD_CAPS]; /* largest error of a vertex in these frames if only its 4, 2 or 1 heaviest joints move
                                  it, with weights normalised, as renderers do that cap influences */
} lod_frames;

/* The node that draws a mesh with a skin, or MODEL_NONE. */
uint32_t lod_skinned_node(const model *m, uint32_t mesh);

/* Skin a node's mesh at a time of a clip: linear blending in double precision, targets at rest.
 * Lengths are the mesh's own, in the space of the skin's first joint's parent at rest.
 * out [vertex_count][3]. Returns 1 when out of memory or where a rotation has no length. */
int lod_frame_pose(const model *m, uint32_t node, uint32_t clip, double time_s, float *out);

/* Up to `count` frames of all clips that move the node's joints, from 8 candidates in each second: first the one
 * farthest from rest by its joints' rotations, then each time the one farthest from those taken. Returns 1 when out of
 * memory or if a rotation has no length. */
int lod_frames_choose(const model *m, uint32_t node, uint32_t count, lod_frames *out);
/* The same frames of the mesh as it is now. Returns 1 when out of memory. */
int lod_frames_again(const model *m, uint32_t node, lod_frames *frames);
void lod_frames_free(lod_frames *f);

#ifdef __cplusplus
}
#endif
#endif
