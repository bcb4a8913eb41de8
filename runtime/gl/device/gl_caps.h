/* gl_caps.h: capabilities of a context.
 *
 *   noh_gl_caps_probe        read the limits and test each capability: draw and read back
 *   noh_gl_geometry_version  the #version line for geometry shaders
 *   noh_gl_geometry_defines  the #extension line for geometry shaders
 *
 * Extension strings can be wrong either way: OSMesa blends floats without listing the extension, and some drivers list
 * formats that they cannot render. So each capability is tested once, on 16 texels. The struct is plain data: a test,
 * or a game that knows of a driver bug, may clear any field after the probe.
 *
 * Threads: the context's own thread, for every function. */
#ifndef NOH_GL_GL_CAPS_H
#define NOH_GL_GL_CAPS_H

#include "gl/device/gl_api.h"
#include "core/base/half.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noh_gl_caps {
    int version;     /* major * 100 + minor * 10 */
    int is_es;       /* 0: desktop GL */
    char vendor[64]; /* GL_VENDOR, GL_RENDERER and GL_VERSION, cut to fit */
    char renderer[128];
    char version_text[128];
    uint64_t renderer_hash; /* FNV-1a 64 of the three uncut texts, as a key for per-driver measurements */

    uint32_t texture_size_max;
    uint32_t array_layers_max;
    uint32_t draw_buffers_max;
    uint32_t color_attachments_max;
    uint32_t samples_max;
    uint32_t vertex_textures_max;
    uint32_t vertex_attributes_max;
    uint32_t uniform_block_bytes_max;
    uint32_t uniform_offset_align; /* bytes, for glBindBufferRange */

    /* 1 or 0. Each is tested with three layers of one array texture as the draw buffers, `layered` with gl_Layer. */
    int mrt3;            /* three draw buffers work in at least one format */
    int render_f32;      /* RGBA32F stores written values bit for bit */
    int render_f16;      /* RGBA16F stores them within the precision of a half */
    int render_u32;      /* RGBA32UI stores them, which ES 3.0 guarantees */
    int blend_f32;       /* blending ONE, ONE into RGBA32F adds */
    int blend_f16;       /* blending ONE, ONE into RGBA16F adds */
    int blend_f32_exact; /* blend_f32, with the bits of C's float addition */
    int layered;         /* a geometry shader can draw to all three layers by gl_Layer */
    int block_points;    /* a point of size 4 covers exactly the 4 x 4 texels around its centre, once each */
    int timer_query;     /* EXT_disjoint_timer_query, or desktop GL's */
    int etc2;            /* not tested: noh_gl_api.etc2, for plans of textures */

    /* How this GPU rounds a float to a half. UNKNOWN: like none of the models, so results are known only within a
     * bound. */
    noh_half_mode f16_store_mode; /* half(source) */
    noh_half_mode f16_blend_mode; /* half(stored + source), the sum in fp32 */
} noh_gl_caps;

/* Probe the capabilities of the current context. A missing capability is a 0 in its field, not an error.
 * state   gl_state.h
 * memory  none; about 5 KiB of stack. All GL objects it makes are deleted
 * errors  ARG api or out is NULL; GL the driver cannot run the probe's programs */
noh_result noh_gl_caps_probe(const noh_gl_api *api, noh_gl_caps *out, noh_error *error);

/* Get capabilities for planning without a context, such as on a build machine: an OpenGL ES 3.2 device with every
 * feature, and limits and texture sizes as guaranteed by ES 3.0. The player's GPU may lead to another plan; make stages
 * with a plan of probed capabilities. */
void noh_gl_caps_nominal(noh_gl_caps *out);

/* `version` and `geometry_defines` for the desc of a program with a geometry stage (gl_program.h). The version is NULL
 * without geometry shaders; the defines are NULL if no #extension is needed. */
const char *noh_gl_geometry_version(const noh_gl_api *api);
const char *noh_gl_geometry_defines(const noh_gl_api *api);

#ifdef __cplusplus
}
#endif

#endif
