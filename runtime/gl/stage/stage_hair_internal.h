/* stage_hair_internal.h: what drawing the hair of one actor and of a crowd have in common. */
#ifndef NOH_STAGE_GL_STAGE_HAIR_INTERNAL_H
#define NOH_STAGE_GL_STAGE_HAIR_INTERNAL_H

#include "gl/device/gl_names_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/low_gl.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"

#define NOH_HAIR_BODY_TEXELS 5u /* of a crowd: 3 rows of 4 from head space, first hair, fade, strips */

/* Rows of the texture: control hairs of all sets, then patches, then bodies. */
typedef struct noh_hair_layout {
    uint32_t width, height; /* texels */
    uint32_t in_row;        /* hairs in a row */
    uint32_t patches;       /* first row of patches */
    uint32_t bodies;        /* first row of bodies */
} noh_hair_layout;

/* sets 0: of one actor, a hair in a row */
noh_hair_layout noh_hair_layout_of(const noh_haircut *cut, uint32_t sets, uint32_t bodies);
noh_gl_texture_desc noh_hair_texture(const noh_haircut *cut, uint32_t sets, uint32_t bodies);

/* Programs and texture of hair whose other fields are there; its points become those of set 0. */
noh_result noh_hair_create_objects(noh_stage_hair *h, char *log, size_t log_bytes, noh_error *error);
/* Its points become those of a set. The texture stays bound. */
void noh_hair_upload(const noh_stage_hair *h, uint32_t set);

void noh_hair_bind(const noh_stage_hair *h, const noh_stage *s, GLuint program, const noh_stage_view *v,
                   uint32_t strips);
void noh_hair_unbind(const noh_stage_hair *h);
/* The pixels of so many strips with an alpha from `low` up to `high`. */
void noh_hair_draw_strips(noh_stage_hair *h, GLuint program, uint32_t strips, float low, float high);

/* Called once for the core, once for the fringe, as the pass wants them. */
typedef void (*noh_hair_strips_fn)(void *user, GLuint program, float low, float high);
/* strips  of one actor, by which they are widened; 0: of a crowd */
void noh_hair_draw_pass(noh_stage_hair *h, const noh_stage *s, uint32_t view, noh_pass pass, uint32_t strips,
                        noh_hair_strips_fn fn, void *user);

/* Returns 0 where there is no shadow map; else end it with noh_gl_light_end_shadow. */
int noh_hair_begin_shadow(const noh_stage_hair *h, const noh_stage *stage);

#endif
