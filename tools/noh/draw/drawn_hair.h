/* drawn_hair.h: the hair of actors of one kind, if their pack has hair: memory, GL objects and draws.
 *
 *   drawn_hair_plan     for a kind; drawn_hair_bytes
 *   drawn_hair_open     on a driver; drawn_hair_restore, drawn_hair_close
 *   drawn_hair_frame    after each frame of the stage
 *   drawn_hair_update   before the draws of a frame
 *   drawn_hair_draw     after the stage; drawn_hair_draw_shadow */
#ifndef NOH_NOH_DRAW_DRAWN_HAIR_H
#define NOH_NOH_DRAW_DRAWN_HAIR_H

#include "noh/base.h"
#include "noh/body.h"
#include "noh/gl_device.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"
#include "gpu/gpu.h"

#define DRAWN_HAIR_NEAR 16u /* heads whose hair moves, at most */

/* Do not move it once it is planned. */
typedef struct drawn_hair {
    int is_there; /* 0: the pack has no hair; all calls do nothing */
    noh_haircut cut;
    noh_actor_hair_desc desc;
    noh_actor_hair *heads;
    noh_stage_hair drawn;
    void *memory, *drawn_memory;
} drawn_hair;

/* kind: its index on the stage, with this skeleton and number of actors.
 * errors  as noh_actor_hair_desc_make; OK where the pack has no hair */
noh_result drawn_hair_plan(drawn_hair *h, const noh_pack *pack, uint32_t kind, uint32_t skeleton, uint32_t actors,
                           noh_error *error);
void drawn_hair_bytes(const drawn_hair *h, uint64_t *cpu_bytes, uint64_t *gpu_bytes);

/* Prints an error and returns an exit code; 0 on success. lit: the stage has a light */
int drawn_hair_open(drawn_hair *h, gpu *g, noh_gl_ledger *ledger, int lit);
noh_result drawn_hair_restore(drawn_hair *h, char *log, size_t log_bytes, noh_error *error);
void drawn_hair_close(drawn_hair *h);
void drawn_hair_frame(drawn_hair *h, noh_stage *stage, uint32_t ticks);
void drawn_hair_update(drawn_hair *h);
void drawn_hair_draw(drawn_hair *h, const noh_stage *stage, uint32_t view, noh_pass pass);
void drawn_hair_draw_shadow(drawn_hair *h, const noh_stage *stage, uint32_t view);

#endif
