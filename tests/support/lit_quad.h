/* lit_quad.h: one quad drawn by the plain renderer, and what its pixels must be, in closed form.
 *
 * The quad fills a square picture. Its normals differ enough from corner to corner to show where they are not
 * made unit again; it is turned by half a turn and scaled differently along each axis, so that it shows where they are
 * transformed wrongly. */
#ifndef NOH_TESTS_SUPPORT_LIT_QUAD_H
#define NOH_TESTS_SUPPORT_LIT_QUAD_H

#include "gpu/gpu.h"
#include "convert/model/model.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"
#include "support/srgb.h"

#define LIT_QUAD_SIDE 33u  /* pixels of the picture's side */
#define LIT_QUAD_CLOSE 1.5 /* of 255: what rounding may leave between a pixel and its closed form */

typedef struct lit_quad {
    float world[12];
    noh_gl_camera camera;
    float base[4], metallic, roughness, cutoff;
    model_alpha alpha;
    int double_sided, unlit;
    const float *uv;    /* [4][2] or NULL; corners at (-1, -1), (1, -1), (-1, 1), (1, 1) */
    const float *color; /* [4][4] or NULL */
    /* [2][4]: a texture of two texels side by side, the second of the pack's two; or NULL */
    const uint8_t *picture;
    const model_texture *base_map; /* in place of that picture, to be compressed as it says, or NULL */
    const uint8_t *normal_map;     /* [4] one texel, or NULL */
    const uint8_t *surface_map;    /* [4] one texel, or NULL */
    const uint8_t *specular_map;   /* [4] one texel, or NULL */
    int specular_roughness;        /* its alpha is roughness, not weight */
    float f0, f90_loss;            /* f0 0: 0.04 */
    float tangent[4];              /* of all vertices, with a normal map */
    float emissive[3], normal_scale, occlusion_strength;
    const noh_gl_shader_desc *shaders; /* in place of the library's; NULL: none */
} lit_quad;

/* Opaque, half metal, without UVs, colours and texture. */
lit_quad lit_quad_of(void);

/* Draw a pass of it over the canvas's background: rgba[LIT_QUAD_SIDE][LIT_QUAD_SIDE][4], to be freed. */
uint8_t *lit_quad_draw(gpu *g, const lit_quad *q, int pass);

/* The pixel of a column of the middle row. */
const uint8_t *lit_quad_at(const uint8_t *rgba, uint32_t column);

/* Whether nothing was drawn at that pixel. */
int lit_quad_is_background(const uint8_t *pixel);

/* How normals are made for the light; only the first way is right. */
typedef enum lit_quad_normals {
    NORMALS_BY_INVERSE_TRANSPOSE,
    NORMALS_BY_MATRIX,
    NORMALS_BY_NOTHING,
    NORMALS_NOT_UNIT,
    FRAME_AS_IT_IS,     /* with a normal map: the tangent not made orthogonal to the normal again */
    FRAME_NOT_MIRRORED, /* the bitangent by the cross product alone, in a mirrored world too */
    FRAME_IN_OBJECT     /* normal and tangent as the mesh has them, under a light in the world */
} lit_quad_normals;

/* The normal in the world at a column of the middle row. world must be diagonal. */
void lit_quad_normal(const lit_quad *q, uint32_t column, lit_quad_normals by, double n[3]);

/* mesh.frag's light on a column of the middle row, in sRGB 0..255. world must be diagonal.
 * held: what faces away from the light gets none; 0: as in the source */
void lit_quad_pixel(const lit_quad *q, uint32_t column, lit_quad_normals by, int held, double out[3]);

#endif
