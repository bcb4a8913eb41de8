/* crowd_hair.h: the hair of a crowd's bodies, if their pack has any.
 *
 *   crowd_hair_plan     of a kind; crowd_hair_bytes
 *   crowd_hair_open     on a driver; crowd_hair_close
 *   crowd_hair_frame    after each frame of the stage
 *   crowd_hair_draw     after the stage; crowd_hair_draw_shadow */
#ifndef NOH_NOH_CROWD_CROWD_HAIR_H
#define NOH_NOH_CROWD_CROWD_HAIR_H

#include "file/pack_file.h"
#include "gpu/gpu.h"
#include "noh/body.h"
#include "noh/gl_device.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"

#define CROWD_HAIR_NEAR 16u /* bodies whose hair moves */

/* Do not move it once it is open. */
typedef struct crowd_hair {
    int is_there;
    noh_haircut cut;
    noh_wig wig;
    noh_wigs_desc desc;
    noh_wigs *wigs;
    noh_stage_hairs drawn;
    void *memory, *drawn_memory;
} crowd_hair;

/* kind: its index on the stage, and its number of actors. Prints an error and returns an exit code; 0 on success, also
 * if there is no hair. */
int crowd_hair_plan(crowd_hair *h, const pack_file *file, uint32_t kind, uint32_t skeleton, uint32_t actors);
/* In addition to the stage; 0 without hair. */
void crowd_hair_bytes(const crowd_hair *h, uint64_t *cpu_bytes, uint64_t *gpu_bytes);

/* lit: the stage has a light */
int crowd_hair_open(crowd_hair *h, gpu *g, noh_gl_ledger *ledger, int lit);
void crowd_hair_close(crowd_hair *h);
void crowd_hair_frame(crowd_hair *h, noh_stage *stage, uint32_t ticks);
/* Call once per frame, before the functions below, which draw the last frame. */
void crowd_hair_update(crowd_hair *h);
void crowd_hair_draw(crowd_hair *h, const noh_stage *stage, uint32_t view);
void crowd_hair_draw_shadow(crowd_hair *h, const noh_stage *stage, uint32_t view);

#endif
