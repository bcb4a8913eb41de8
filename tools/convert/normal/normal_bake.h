/* normal_bake.h: a normal map for a coarse model out of a fine one that lies on it.
 *
 * From each texel's place on the coarse surface a ray goes out along its normal, and one in. What faces the same way
 * and is nearer counts; its normal is written in the coarse surface's own frame, which is made at each texel as the
 * shader makes it at each pixel: the normal unit, the tangent at right angles to it, the bitangent by their cross
 * product and the tangent's sign. */
#ifndef NOH_CONVERT_NORMAL_NORMAL_BAKE_H
#define NOH_CONVERT_NORMAL_NORMAL_BAKE_H

#include "convert/model/model.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct normal_bake_settings {
    uint32_t size;        /* side of the map, texels */
    double reach;         /* how far the fine surface may be off, metres; 0: 2 % of the coarse one's diagonal */
    const char *material; /* of the coarse model, the triangles that the map is for; NULL: all with coordinates */
} normal_bake_settings;

typedef struct normal_map {
    uint32_t size;
    uint8_t *rgba;       /* [size][size][4] as normal_texel writes them, to be freed */
    uint32_t covered;    /* texels on a triangle of the coarse surface */
    uint32_t overlapped; /* times that a further triangle lies on one of them */
    uint32_t missed;     /* of those covered, with no fine surface in reach: they are flat */
    double reach;        /* metres */
    double lean;         /* degrees: the mean angle between the two normals, of the others */
} normal_map;

/* Both as their nodes place them at rest. Returns 0, or 1 and *error, and out->rgba is NULL. */
int normal_map_bake(const model *coarse, const model *fine, const normal_bake_settings *settings, normal_map *out,
                    model_error *error);

#ifdef __cplusplus
}
#endif
#endif
