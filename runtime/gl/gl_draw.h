/* gl_draw.h: meshes on the GPU, and a plain renderer for them.
 *
 * The renderer is small on purpose: one program, one key light, base colour
 * textures and vertex colours. A game brings its own shaders and needs only
 * noh_gl_mesh and a noh_gl_morph_binding. */
#ifndef NOH_GL_GL_DRAW_H
#define NOH_GL_GL_DRAW_H

#include "gl/gl_morph.h"

/* Attribute locations of a noh_gl_mesh's vertex array. */
#define NOH_ATTRIBUTE_POSITION 0u /* float3 */
#define NOH_ATTRIBUTE_NORMAL 1u   /* ivec2, octahedral: direction_of_pair in shaders_es/common_attributes.glsl */
#define NOH_ATTRIBUTE_TANGENT 2u  /* ivec2, octahedral with handedness: tangent_of_pair; constant where the mesh has none */
#define NOH_ATTRIBUTE_UV 3u       /* unorm16 x 2, to be scaled by the mesh's uv_offset and uv_scale */
#define NOH_ATTRIBUTE_COLOR 4u    /* unorm8 x 4, rgb as square roots; constant white where there are none */

typedef struct noh_gl_mesh {
    noh_mesh mesh;
    GLuint vertex_array;
    noh_gl_buffer positions, attributes, indices;
    GLenum index_type;
} noh_gl_mesh;

/* GPU bytes of a mesh's buffers: exact. */
uint64_t noh_gl_mesh_bytes(const noh_mesh *mesh);

/* Upload straight from the pack. errors  as noh_gl_buffer_create */
noh_result noh_gl_mesh_create(const noh_gl_api *api, noh_gl_ledger *ledger, const noh_mesh *mesh, noh_gl_mesh *out,
                              noh_error *error);
void noh_gl_mesh_delete(const noh_gl_api *api, noh_gl_ledger *ledger, noh_gl_mesh *mesh);

/* GPU bytes of a pack's texture with its mip levels: exact. */
uint64_t noh_gl_picture_bytes(const noh_texture *texture);

/* An sRGB texture with mip levels. errors  as noh_gl_texture_create */
noh_result noh_gl_picture_create(const noh_gl_api *api, noh_gl_ledger *ledger, const noh_texture *texture,
                                 noh_gl_texture *out, noh_error *error);

typedef enum noh_debug_view { NOH_VIEW_LIT, NOH_VIEW_POSITION, NOH_VIEW_NORMAL, NOH_VIEW_TANGENT } noh_debug_view;

typedef struct noh_gl_renderer {
    const noh_gl_api *gl;
    noh_gl_ledger *ledger;
    GLuint program;
    noh_gl_texture white; /* 1 x 1, where a material has no texture */
    GLint u_view_projection, u_world, u_normal, u_uv, u_morph, u_camera, u_key, u_base_color, u_material, u_bounds_min, u_bounds_size;
} noh_gl_renderer;

#define NOH_GL_RENDERER_BYTES 4u /* the white texel */

/* layers_uint: as in noh_gl_morph_binding.is_uint. */
noh_result noh_gl_renderer_create(const noh_gl_api *api, noh_gl_ledger *ledger, noh_debug_view view, int layers_uint,
                                  noh_gl_renderer *out, char *log, size_t log_bytes, noh_error *error);
void noh_gl_renderer_delete(noh_gl_renderer *renderer);

typedef struct noh_gl_camera {
    float view_projection[16]; /* column-major, clip space of GL */
    float eye[3];              /* world */
    float key[3];              /* unit vector towards the key light, world */
} noh_gl_camera;

/* Depth test on, the program in use; the framebuffer and viewport are the caller's. */
void noh_gl_draw_begin(const noh_gl_renderer *renderer, const noh_gl_camera *camera);

#define NOH_DRAW_OPAQUE 0
#define NOH_DRAW_BLENDED 1

/* Draw the submeshes of one pass: first every mesh opaque, then every mesh blended.
 * shapes  world[12] rows of 3 x 4; pictures[pack texture_count]
 * binding where the deltas are; NULL: the rest pose */
void noh_gl_draw_mesh(const noh_gl_renderer *renderer, const noh_gl_mesh *mesh, const float world[12],
                      const noh_gl_morph_binding *binding, const noh_gl_texture *pictures, int pass);

/* Back to no program, no vertex array, no textures, no depth or cull test, no blending. */
void noh_gl_draw_end(const noh_gl_renderer *renderer);

#endif
