/* drawable_internal.h (private to gl/stage/): GL objects of what is drawn together with a stage, from creation to a
 * lost context, and the state around its draws. */
#ifndef NOH_STAGE_GL_DRAWABLE_INTERNAL_H
#define NOH_STAGE_GL_DRAWABLE_INTERNAL_H

#include "noh/base.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"

enum { NOH_DRAWABLE_COLOR, NOH_DRAWABLE_DEPTH }; /* noh_gl_drawable.programs */

/* noh_gl_drawable.uniforms: two for the light, then noh_gl_drawable_desc.uniforms. */
enum { NOH_DRAWABLE_LIGHTING, NOH_DRAWABLE_KEY, NOH_DRAWABLE_OWN };

/* Texture units: its own texture at 0. */
enum { NOH_DRAWABLE_UNIT_ENVIRONMENT = 1, NOH_DRAWABLE_UNIT_SHADOW, NOH_DRAWABLE_UNITS };

typedef struct noh_gl_drawable_desc {
    const char
        *name[2]; /* of the programs, for logs and debug labels; NULL: no such program. Neither: no vertex array */
    const noh_gl_source *vertex, *fragment;
    const char *defines; /* as in noh_gl_program_desc */
    int bare;            /* 1: the fragment shader is compiled alone, without common_*.glsl and textures */
    int lit;             /* 1: NOH_LIT is defined in the colour program */
    const char *sampler; /* reads the texture; NULL: none does */
    const char *const *uniforms;
    uint32_t uniform_count;      /* up to NOH_DRAWABLE_UNIFORMS - NOH_DRAWABLE_OWN */
    noh_gl_texture_desc texture; /* width 0: none */
    uint64_t index_bytes;        /* of a buffer for indices; 0: none */
} noh_gl_drawable_desc;

/* The define of a program that writes sRGB values itself; NULL: it writes linear ones. */
const char *noh_gl_encode_define(int encode_srgb);

/* Locations of uniforms in a linked program: out[count], -1 for a name that it does not use. */
void noh_gl_find_uniforms(const noh_gl_api *gl, unsigned program, const char *const *names, uint32_t count, int *out);

/* On error nothing is left behind but `gl` and `ledger`, for a later restore. */
noh_result noh_gl_drawable_create(const noh_gl_device *device, const noh_gl_drawable_desc *desc, noh_gl_drawable *out,
                                  noh_error *error);
/* Last in a create that uploads more: the driver's error, after which nothing is left. */
noh_result noh_gl_drawable_check(noh_gl_drawable *d, noh_error *error);
void noh_gl_drawable_delete(noh_gl_drawable *d);
/* After a lost context: take the old objects out of the ledger without calling GL, and create them again. */
noh_result noh_gl_drawable_restore(noh_gl_drawable *d, const noh_gl_drawable_desc *desc, char *log, size_t log_bytes,
                                   noh_error *error);

/* Bind a program, the vertex array and the texture, without sampler objects. */
void noh_gl_drawable_begin(const noh_gl_drawable *d, int program);
/* Set the light's uniforms in the colour program and bind its textures. origin: that positions in shaders count from */
void noh_gl_drawable_light(const noh_gl_drawable *d, const noh_gl_light *light, const noh_lighting *lighting,
                           const float origin[3]);
/* Put the render state back and unbind everything. */
void noh_gl_drawable_end(const noh_gl_drawable *d, const noh_gl_raster *raster);

#endif
