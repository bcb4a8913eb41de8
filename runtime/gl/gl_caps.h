/* gl_caps.h: what this context really does.
 *
 *   noh_gl_caps_probe        asks the limits, then draws and reads back
 *   noh_gl_geometry_version  the #version line that a geometry shader needs here
 *   noh_gl_geometry_defines  the #extension line that goes with it
 *
 * Extension strings lie both ways: OSMesa blends floats without listing the
 * extension, some drivers list formats that they cannot render. So each ability
 * is decided by doing it once, on 16 texels. The struct is plain: a test, or a
 * user with a driver bug, may clear any field after the probe.
 *
 * Threads: the context's own thread, for every function. */
#ifndef NOH_GL_GL_CAPS_H
#define NOH_GL_GL_CAPS_H

#include "gl/gl_api.h"
#include "base/half.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noh_gl_caps {
    int version;     /* major * 100 + minor * 10 */
    int is_es;       /* 0: desktop GL */
    char vendor[64]; /* cut to fit */
    char renderer[128];
    char version_text[128];
    uint64_t renderer_hash; /* FNV-1a 64 of the three whole texts: a key for calibrations kept between runs */

    uint32_t texture_size_max;
    uint32_t array_layers_max;
    uint32_t draw_buffers_max;
    uint32_t color_attachments_max;
    uint32_t samples_max;
    uint32_t vertex_textures_max;
    uint32_t vertex_attributes_max;
    uint32_t uniform_block_bytes_max;
    uint32_t uniform_offset_align; /* bytes, for glBindBufferRange */

    /* 1 or 0. All but layered draw into three layers of one array texture at once. */
    int mrt3;            /* three layers of one array texture as draw buffers, in some format */
    int render_f32;      /* RGBA32F arrives, bit for bit */
    int render_f16;      /* RGBA16F arrives, within a half's precision */
    int render_u32;      /* RGBA32UI arrives; ES 3.0 promises it */
    int blend_f32;       /* ONE, ONE into RGBA32F adds */
    int blend_f16;       /* the same into RGBA16F */
    int blend_f32_exact; /* and gives the bits of C's float addition */
    int layered;         /* a geometry shader's gl_Layer reaches three layers of a layered framebuffer */
    int timer_query;     /* EXT_disjoint_timer_query, or desktop GL's */

    /* How a fragment's float becomes a half. UNKNOWN: not as either model, so
     * results can only be compared within a bound. */
    noh_half_mode f16_store_mode; /* half(source) */
    noh_half_mode f16_blend_mode; /* half(stored + source), the sum in fp32 */
} noh_gl_caps;

/* Fill `out` for the current context. Expects a context in the state that it was
 * made in: nothing bound to GL_PIXEL_PACK_BUFFER or GL_PIXEL_UNPACK_BUFFER,
 * default pixel store, no scissor, depth or stencil test, no rasteriser discard.
 * Afterwards framebuffer, program, vertex array and the textures of unit 0 are 0,
 * blending is off with ONE, ZERO, and the viewport as before. All GL objects that
 * it made are gone.
 * memory  none; about 5 KiB of stack
 * errors  NOH_ERR_ARG; NOH_ERR_GL the driver cannot even run the probe's programs.
 *         An ability that is lacking is a 0 in its field, not an error */
noh_result noh_gl_caps_probe(const noh_gl_api *api, noh_gl_caps *out, noh_error *error);

/* For noh_gl_program_desc.version and .geometry_defines of a program with a geometry
 * stage. version is NULL where there are no geometry shaders, defines where no
 * #extension is needed. */
const char *noh_gl_geometry_version(const noh_gl_api *api);
const char *noh_gl_geometry_defines(const noh_gl_api *api);

#ifdef __cplusplus
}
#endif

#endif
