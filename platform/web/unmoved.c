/* unmoved.c: replaces stage_slot.c, stage_gl_slot.c and stage_motion.c in the page's programs: all kinds stay, and
 * nothing asks where vertices were. */
#include "gl/stage/stage_gl_internal.h"
#include "stage/cast/stage_internal.h"

int noh_stage_has_slots(const noh_stage_desc *desc)
{
    (void)desc;
    return 0;
}

noh_result noh_stage_plan_rooms(const noh_stage_desc *desc, const struct noh_gl_caps *caps, noh_stage_plan *plan,
                                noh_error *error)
{
    (void)desc;
    (void)caps;
    (void)plan;
    (void)error;
    return NOH_OK;
}

noh_result noh_stage_open_slots(noh_stage *s, const noh_stage_desc *desc, noh_error *error)
{
    (void)s;
    (void)desc;
    (void)error;
    return NOH_OK;
}

uint32_t noh_gl_candidate_meshes(const noh_stage_desc *desc, noh_mesh *meshes)
{
    (void)desc;
    (void)meshes;
    return 0;
}

void noh_gl_candidates_want(const noh_stage_desc *desc, noh_gl_renderer_desc *want)
{
    (void)desc;
    (void)want;
}

void noh_gl_candidates_list(const noh_stage_desc *desc, const noh_gl_renderer_desc *want, noh_gl_variant_list *list)
{
    (void)desc;
    (void)want;
    (void)list;
}

noh_result noh_gl_slots_compile(const noh_stage_desc *asked, noh_stage_gl *gl, uint32_t path, noh_error *error)
{
    (void)asked;
    (void)gl;
    (void)path;
    (void)error;
    return NOH_OK;
}

noh_result noh_gl_slots_recompile(noh_stage_gl *gl, const noh_stage_desc *desc, uint32_t path, noh_error *error)
{
    (void)gl;
    (void)desc;
    (void)path;
    (void)error;
    return NOH_OK;
}

void noh_gl_slots_forget_programs(noh_stage_gl *gl, const noh_gl_device *device)
{
    (void)gl;
    (void)device;
}

noh_result noh_gl_slot_open(noh_stage *s, uint32_t kind, noh_error *error)
{
    (void)s;
    (void)kind;
    (void)error;
    return NOH_OK;
}

noh_result noh_gl_slot_come(noh_stage *s, uint32_t kind, noh_error *error)
{
    (void)s;
    (void)kind;
    (void)error;
    return NOH_OK;
}

noh_result noh_gl_slot_fill_all(noh_stage *s, uint32_t kind, noh_error *error)
{
    (void)s;
    (void)kind;
    (void)error;
    return NOH_OK;
}

int noh_gl_slot_fill(noh_stage *s, uint32_t kind, uint32_t *bytes)
{
    (void)s;
    (void)kind;
    (void)bytes;
    return 1;
}

void noh_gl_slot_close(noh_stage *s, uint32_t kind)
{
    (void)s;
    (void)kind;
}

void noh_gl_slots_show(noh_stage *s)
{
    (void)s;
}

int noh_gl_motion_pose(const noh_stage *s, const noh_stage_kind *k, uint32_t index)
{
    (void)s;
    (void)k;
    (void)index;
    return 0;
}

void noh_gl_motion_begin(const noh_stage *s)
{
    (void)s;
}

void noh_gl_motion_upload(const noh_stage *s, const noh_stage_kind *k, uint32_t index, uint32_t mesh)
{
    (void)s;
    (void)k;
    (void)index;
    (void)mesh;
}

void noh_gl_motion_end(const noh_stage *s)
{
    (void)s;
}

void noh_gl_motion_turn(const noh_gl_item *item, const noh_stage_shown *shown, const float *weights, uint32_t count)
{
    (void)item;
    (void)shown;
    (void)weights;
    (void)count;
}

int noh_gl_motion_of(const noh_stage *s, const noh_stage_kind *k, uint32_t index, uint32_t mesh, float world[12],
                     noh_gl_morph_binding *morph)
{
    (void)s;
    (void)k;
    (void)index;
    (void)mesh;
    (void)world;
    (void)morph;
    return 0;
}

void noh_gl_motion_view(const noh_stage *s, uint32_t view, float view_projection[16])
{
    (void)s;
    (void)view;
    (void)view_projection;
}
