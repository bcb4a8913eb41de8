/* readback.h: results of the GPU, read back. */
#ifndef NOH_NOH_GPU_READBACK_H
#define NOH_NOH_GPU_READBACK_H

#include "gpu.h"
#include "noh/pack.h"
#include "noh/noh_gl.h"
#include "noh/low_gl.h"

/* Programs and a target that read results back; not counted in the ledger. */
typedef struct readback {
    gpu *g;
    int is_uint;
    GLuint layers_programs[2]; /* of three layers; of two, made when it is needed */
    GLuint vertex_array;
    noh_gl_variant variant; /* with which vertices were read last */
} readback;

int readback_open(readback *r, gpu *g, int is_uint);
void readback_close(readback *r);

/* An instance's accumulated deltas, as the vertex shader fetches them:
 * out[3][morph_height << morph_width_log2][3]; the third layer is zeros where there are two. */
int readback_layers(readback *r, const noh_mesh *mesh, const noh_gl_morph_binding *binding, float *out);

/* Bytes of a buffer, from an offset on. */
int readback_buffer(readback *r, GLuint buffer, size_t offset, size_t bytes, void *out);

/* A vertex as mesh.vert leaves it, before the camera. */
typedef struct readback_vertex {
    float position[3]; /* morphed and skinned, model space */
    float normal[3];   /* in the world, as below */
    float tangent[4];  /* with handedness */
    float world[3];
    float uv[2];
} readback_vertex;

/* Every vertex of a mesh with these bindings (NULL: rest pose, bind pose), each by its own palette: out[vertex_count].
 * crowd: 0 draws one mesh with an identity world matrix; else this many instances in one draw, from the one that skin
 * binds, each with its own world matrix, into out[crowd][vertex_count]. Prints an error and returns an exit code; 0 on
 * success. */
int readback_skinned(readback *r, const noh_gl_mesh *mesh, const noh_gl_morph_binding *morph,
                     const noh_gl_skin_binding *skin, uint32_t crowd, readback_vertex *out);

/* Every vertex as drawn in the bind pose: positions, normals, tangents, each [vertex_count][3]. */
int readback_vertices(readback *r, const noh_gl_mesh *mesh, const noh_gl_morph_binding *binding, float *positions,
                      float *normals, float *tangents);

/* The same of texture coordinates, too: uvs[vertex_count][2], or NULL. */
int readback_vertices_uv(readback *r, const noh_gl_mesh *mesh, const noh_gl_morph_binding *binding, float *positions,
                         float *normals, float *tangents, float *uvs);

#endif
