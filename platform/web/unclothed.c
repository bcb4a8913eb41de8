/* unclothed.c: replaces stage_wear.c and stage_cover.c in the page's programs, whose characters wear no garments. */
#include "gl/stage/stage_gl_internal.h"
#include "stage/cast/stage_internal.h"

noh_stage_actor *noh_stage_wearer_of(const noh_stage *s, const noh_stage_actor *a, noh_stage_kind **kind)
{
    (void)s;
    (void)a;
    (void)kind;
    return NULL;
}

const char *noh_stage_bad_worn(const noh_stage_desc *desc, const noh_kind_desc *kind)
{
    (void)desc;
    return kind->worn_by ? "this program has no garments" : NULL;
}

size_t noh_stage_worn_maps(const noh_kind_desc *kind)
{
    (void)kind;
    return 0;
}

void noh_stage_open_worn(noh_stage *s, uint32_t kind)
{
    (void)s;
    (void)kind;
}

int noh_stage_can_wear(const noh_stage_kind *garment, uint32_t wearer_kind)
{
    (void)garment;
    (void)wearer_kind;
    return 0;
}

int noh_stage_fits(const noh_stage *s, const noh_stage_kind *garment, const noh_stage_kind *wearer)
{
    (void)s;
    (void)garment;
    (void)wearer;
    return 0;
}

void noh_stage_link_worn(noh_stage *s)
{
    (void)s;
}

void noh_stage_update_worn(noh_stage *s)
{
    (void)s;
}

void noh_stage_wear_pose(const noh_stage *s, const noh_stage_job_part *job, const noh_stage_kind *k, uint32_t index,
                         noh_transform *local)
{
    (void)s;
    (void)job;
    (void)k;
    (void)index;
    (void)local;
}

void noh_stage_wear_palette(const noh_stage *s, const noh_stage_kind *k, uint32_t index)
{
    (void)s;
    (void)k;
    (void)index;
}

void noh_stage_wear_floats(const noh_stage *s, const noh_stage_kind *k, uint32_t index)
{
    (void)s;
    (void)k;
    (void)index;
}

/* ---- stage_cover.c ---- */

uint64_t noh_gl_covers_bytes(const noh_stage_desc *desc, const noh_stage_plan *plan, uint32_t kind)
{
    (void)desc;
    (void)plan;
    (void)kind;
    return 0;
}

noh_result noh_gl_covers_create(const noh_stage_desc *desc, const noh_stage_plan *plan, const noh_gl_device *device,
                                noh_gl_kind *kinds, noh_error *error)
{
    (void)desc;
    (void)plan;
    (void)device;
    (void)kinds;
    (void)error;
    return NOH_OK;
}

void noh_gl_covers_delete(const noh_stage_desc *desc, const noh_stage_plan *plan, const noh_gl_device *device,
                          noh_gl_kind *kinds, uint32_t kind)
{
    (void)desc;
    (void)plan;
    (void)device;
    (void)kinds;
    (void)kind;
}

void noh_gl_choose_covers(noh_stage *stage)
{
    (void)stage;
}
