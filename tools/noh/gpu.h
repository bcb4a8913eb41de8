/* gpu.h: a context for the verbs that draw, and reading results back. */
#ifndef NOH_TOOL_GPU_H
#define NOH_TOOL_GPU_H

#include "noh_tool.h"

typedef struct gpu {
    const noh_platform *platform;
    noh_platform_context *context;
    noh_gl_api gl;
    noh_gl_caps caps;
    noh_gl_ledger ledger; /* what the library's objects use */
} gpu;

/* Make a context of that driver ("egl" when NULL) and probe it. Prints why not; 0 on success. */
int gpu_open(gpu *g, const char *driver);
void gpu_close(gpu *g);

/* The values of --path and --accumulate. Return 0, or EXIT_USAGE after printing. */
int parse_path(const char *text, noh_morph_path *path);
int parse_accumulate(const char *text, noh_accumulate *accumulate);
/* The value of --instances. */
int parse_instances(double value, uint32_t *instances);

/* One noh_gl_morph with its memory. */
typedef struct gpu_morph {
    void *memory;
    size_t bytes;
    noh_gl_morph *morph;
} gpu_morph;

/* Prints an error about `subject` and returns an exit code; 0 on success. */
int gpu_morph_open(gpu_morph *m, gpu *g, const noh_gl_morph_desc *desc, const char *subject);
void gpu_morph_close(gpu_morph *m);

/* One noh_gl_skin with its memory; skin NULL: nothing is skinned. */
typedef struct gpu_skin {
    void *memory;
    size_t bytes;
    noh_gl_skin *skin;
} gpu_skin;

int gpu_skin_open(gpu_skin *s, gpu *g, const noh_gl_skin_desc *desc, const char *subject);
void gpu_skin_close(gpu_skin *s);

/* Programs and a target that read results back; not counted in the ledger. */
typedef struct readback {
    gpu *g;
    int is_uint;
    GLuint layers_program, vertex_array;
    noh_gl_variant variant; /* what read vertices last */
} readback;

int readback_open(readback *r, gpu *g, int is_uint);
void readback_close(readback *r);

/* An instance's accumulated deltas, as the vertex shader fetches them:
 * out[3][morph_height << morph_width_log2][3]. */
int readback_layers(readback *r, const noh_mesh *mesh, const noh_gl_morph_binding *binding, float *out);

/* A vertex as mesh.vert leaves it, before the camera. */
typedef struct readback_vertex {
    float position[3]; /* morphed and skinned, model space */
    float normal[3];   /* in the world, as below */
    float tangent[4];  /* with handedness */
    float world[3];
} readback_vertex;

/* Every vertex of a mesh with these bindings (NULL: rest pose, bind pose), each by its own palette: out[vertex_count].
 * crowd: 0 draws one mesh in an identity world; else so many instances in one draw from the one that skin binds, each in
 * its own world, and out is [crowd][vertex_count]. Prints why not; 0 on success. */
int readback_skinned(readback *r, const noh_gl_mesh *mesh, const noh_gl_morph_binding *morph, const noh_gl_skin_binding *skin,
                     uint32_t crowd, readback_vertex *out);

/* Every vertex as drawn in the bind pose: positions, normals, tangents, each [vertex_count][3]. */
int readback_vertices(readback *r, const noh_gl_mesh *mesh, const noh_gl_morph_binding *binding, float *positions,
                      float *normals, float *tangents);

#endif
