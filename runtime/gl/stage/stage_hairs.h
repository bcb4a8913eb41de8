/* stage_hairs.h: hair of a whole kind (wigs.h) drawn: at most NOH_HAIRS_GROUPS calls for each of its passes,
 * however many heads there are.
 *
 *   noh_stage_hairs_size, noh_stage_hairs_bytes   exact bytes on the CPU and on the GPU
 *   noh_stage_hairs_create                        _delete, _restore
 *   noh_stage_hairs_update                        upload the hair that moves, and where heads are
 *   noh_stage_hairs_draw                          what a view sees; noh_stage_hairs_draw_shadow
 *
 * All is as in stage_hair.h: each head has as many strips as its size in pixels wants, fewer being wider, and fades
 * into what is painted on it. Hair that moves has control hairs of its own in the texture, all other hair shares those
 * at rest. Fringes of several heads are blended the smaller heads first, within a group of about one size in no order.
 *
 * Threads: as stage_hair.h. */
#ifndef NOH_STAGE_GL_STAGE_HAIRS_H
#define NOH_STAGE_GL_STAGE_HAIRS_H

#include "stage/actors/wigs.h"
#include "gl/stage/stage_hair.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_HAIRS_GROUPS 5u /* each of heads that have half as many strips as those before */

typedef struct noh_stage_hairs {
    noh_stage_hair hair; /* its shaders, and a texture for all */
    const noh_wigs *wigs;
    float *table;                                              /* of heads, as the texture has it */
    uint32_t first[NOH_HAIRS_GROUPS], count[NOH_HAIRS_GROUPS]; /* heads of each group in it */
    uint32_t views;                                            /* a bit for each that sees some */
    uint32_t strips;                                           /* of all heads */
} noh_stage_hairs;

/* The exact bytes: 12 a control point of one head, 60 a head of actor_max, the latter rounded up to whole rows of the
 * texture. */
size_t noh_stage_hairs_size(const noh_wigs_desc *desc);
/* The exact bytes on the GPU: 12 a control point of near_max + 1 heads, 60 a head, each rounded up to whole rows. */
uint64_t noh_stage_hairs_bytes(const noh_wigs_desc *desc);

/* wigs must stay; all else as noh_stage_hair_create. */
noh_result noh_stage_hairs_create(const noh_gl_device *device, const noh_wigs *wigs, void *memory, size_t bytes,
                                  int lit, int encode_srgb, noh_stage_hairs *out, noh_error *error);
void noh_stage_hairs_delete(noh_stage_hairs *hairs);
noh_result noh_stage_hairs_restore(noh_stage_hairs *hairs, char *log, size_t log_bytes, noh_error *error);

/* After noh_wigs_frame. */
void noh_stage_hairs_update(noh_stage_hairs *hairs);

/* As noh_stage_hair_draw and noh_stage_hair_draw_shadow. */
void noh_stage_hairs_draw(noh_stage_hairs *hairs, const noh_stage *stage, uint32_t view, noh_pass pass);
void noh_stage_hairs_draw_shadow(noh_stage_hairs *hairs, const noh_stage *stage, uint32_t view);

#ifdef __cplusplus
}
#endif

#endif
