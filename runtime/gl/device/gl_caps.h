/* gl_caps.h: what this context can do.
 *
 *   noh_gl_caps_probe        read the limits, then try each ability: draw, and read back
 *   noh_gl_geometry_version  the #version line that a geometry shader needs here
 *   noh_gl_geometry_defines  the #extension line that goes with it
 *
 * Extension strings are wrong in both directions: OSMesa blends floats without listing the extension, and some drivers
 * list formats that they cannot render. So each ability is tried once, on 16 texels. The struct is plain: a test, or a
 * game that knows of a driver bug, may clear any field after the probe.
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
    uint64_t renderer_hash; /* FNV-1a 64 of the three whole texts: a key for what is measured once per driver */

    uint32_t texture_size_max;
    uint32_t array_layers_max;
    uint32_t draw_buffers_max;
    uint32_t color_attachments_max;
    uint32_t samples_max;
    uint32_t vertex_textures_max;
    uint32_t vertex_attributes_max;
    uint32_t uniform_block_bytes_max;
    uint32_t uniform_offset_align; /* bytes, for glBindBufferRange */

    /* 1 or 0. Each was tried with three layers of one array texture as the draw buffers, `layered` with gl_Layer. */
    int mrt3;            /* three draw buffers work in at least one format */
    int render_f32;      /* RGBA32F keeps what is written, bit for bit */
    int render_f16;      /* RGBA16F keeps it within the precision of a half */
    int render_u32;      /* RGBA32UI keeps it; ES 3.0 promises that */
    int blend_f32;       /* blending ONE, ONE into RGBA32F adds */
    int blend_f16;       /* the same into RGBA16F */
    int blend_f32_exact; /* blend_f32, with the bits of C's float addition */
    int layered;         /* a geometry shader reaches all three layers by gl_Layer */
    int block_points;    /* a point of size 4 covers the 4 x 4 texels around its centre once, and no other */
    int timer_query;     /* EXT_disjoint_timer_query, or desktop GL's */
    int etc2;            /* not tried: that of noh_gl_api, for plans of textures */

    /* How this GPU rounds a float to a half. UNKNOWN: like no model, so results are only known within a bound. */
    noh_half_mode f16_store_mode; /* half(source) */
    noh_half_mode f16_blend_mode; /* half(stored + source), the sum in fp32 */
} noh_gl_caps;

/* Fill `out` for the current context. A missing ability is a 0 in its field, not an error.
 * state   gl_state.h
 * memory  none; about 5 KiB of stack. All GL objects that it made are deleted
 * errors  ARG api or out is NULL; GL the driver cannot run the probe's programs */
noh_result noh_gl_caps_probe(const noh_gl_api *api, noh_gl_caps *out, noh_error *error);

/* Capabilities for plans without a driver or a context, as of a build machine: an OpenGL ES 3.2 device with every
 * feature, and limits and textures as large as ES 3.0 demands. Plans of it may choose another path than the player's
 * GPU; a stage is made with a plan of the caps that were probed. */
void noh_gl_caps_nominal(noh_gl_caps *out);

/* For `version` and `geometry_defines` of the desc of a program with a geometry stage (gl_program.h). The version is
 * NULL where there are no geometry shaders; the defines are NULL where no #extension is needed. */
const char *noh_gl_geometry_version(const noh_gl_api *api);
const char *noh_gl_geometry_defines(const noh_gl_api *api);

#ifdef __cplusplus
}
#endif

#endif
