/* retarget_rig.c: the bones of a pack's skeleton, by their names, or else by the rows of its ragdoll. */
#include "core/base/assert_internal.h"
#include "life/physics/ragdoll_rig_internal.h"
#include "life/reach/bone_names_internal.h"
#include "life/reach/feet_internal.h"
#include "life/reach/retarget_internal.h"
#include "noh/base.h"

typedef struct finding {
    const noh_ragdoll_source *source;
    noh_ragdoll_row rows[NOH_RAGDOLL_BODIES_MAX];
    uint32_t count;
    uint8_t used[NOH_RAGDOLL_BODIES_MAX];
    uint32_t front; /* noh_front_of */
} finding;

static uint32_t above(const finding *f, uint32_t row)
{
    return noh_ragdoll_row_above(f->source, f->rows, f->count, f->rows[row].joint);
}

/* Whether a joint is at the right of the pelvis, seen from the body. */
static int is_right(const finding *f, uint32_t joint)
{
    float at[3], pelvis[3], rotation[4];
    noh_ragdoll_bind(&f->source->joints, joint, at, rotation);
    noh_ragdoll_bind(&f->source->joints, f->rows[0].joint, pelvis, rotation);
    const uint32_t axis = f->front % 2u ? 2u : 0u; /* of a body that faces +x, the left is at -z */
    return (at[axis] < pelvis[axis]) != (f->front == 1u || f->front == 2u);
}

/* A limb from the row of its end: upwards bend feet alone, and the joint above a hand bends forwards. Returns the row of
 * its first joint; NOH_NONE: none. */
static uint32_t take_limb(finding *f, uint32_t end, noh_retarget_rig *rig)
{
    const int is_leg = f->rows[end].toward == NOH_RAGDOLL_UPWARD;
    const uint32_t middle = above(f, end), start = middle == NOH_NONE ? NOH_NONE : above(f, middle);
    const uint32_t toward = is_leg ? NOH_RAGDOLL_BACKWARD : NOH_RAGDOLL_FORWARD;
    if (start == NOH_NONE || start == 0 || !f->rows[middle].hinge || f->rows[middle].toward != toward) return NOH_NONE;
    uint16_t *bones = rig->bones + (is_right(f, f->rows[start].joint) ? NOH_BONE_RIGHT : 0) +
                      (is_leg ? NOH_BONE_UPPER_LEG : NOH_BONE_UPPER_ARM);
    const uint32_t rows[3] = { start, middle, end };
    for (uint32_t i = 0; i < 3; i++) {
        bones[i] = (uint16_t)f->rows[rows[i]].joint;
        f->used[rows[i]] = 1;
    }
    for (uint32_t j = 0; is_leg && j < f->source->joints.joint_count; j++) { /* toes: what hangs from the foot first */
        if (f->source->joints.parents[j] != bones[2]) continue;
        bones[3] = (uint16_t)j;
        break;
    }
    return start;
}

/* The pelvis is the first row; the chest has arms, the spine is below it, and what is left there is the head. */
static void take_trunk(finding *f, uint32_t chest, noh_retarget_rig *rig)
{
    const uint16_t *parents = f->source->joints.parents;
    const uint32_t pelvis = f->rows[0].joint;
    uint32_t top = parents[pelvis];
    rig->bones[NOH_BONE_HIPS] = (uint16_t)pelvis;
    while (top != NOH_JOINT_ROOT && parents[top] != NOH_JOINT_ROOT) top = parents[top];
    rig->bones[NOH_BONE_ROOT] = (uint16_t)top;
    f->used[0] = 1;
    if (chest != NOH_NONE && chest) {
        const uint32_t spine = above(f, chest);
        rig->bones[NOH_BONE_UPPER_CHEST] = (uint16_t)f->rows[chest].joint;
        f->used[chest] = 1;
        if (spine != NOH_NONE && spine) {
            rig->bones[NOH_BONE_SPINE] = (uint16_t)f->rows[spine].joint;
            f->used[spine] = 1;
        }
    }
    for (uint32_t i = 0; i < f->count; i++) {
        if (f->used[i] || above(f, i) != (chest == NOH_NONE ? 0u : chest)) continue;
        rig->bones[NOH_BONE_HEAD] = (uint16_t)f->rows[i].joint;
        break;
    }
}

/* Returns whether there are two thighs. */
static int find_by_names(const noh_ragdoll_source *source, uint16_t *bones)
{
    for (uint32_t j = 0; j < source->joints.joint_count; j++) {
        const char *name = noh_pack_joint_name(source->pack, source->skeleton, j);
        const uint32_t bone = name ? noh_bone_of(name) : NOH_BONES;
        if (bone < NOH_BONES && bones[bone] == NOH_JOINT_ROOT) bones[bone] = (uint16_t)j;
    }
    noh_bones_find_trunk(source->joints.parents, bones);
    return bones[NOH_BONE_UPPER_LEG] != NOH_JOINT_ROOT && bones[NOH_BONE_UPPER_LEG + NOH_BONE_RIGHT] != NOH_JOINT_ROOT;
}

static noh_result find_by_rows(const noh_ragdoll_source *source, noh_retarget_rig *rig, noh_error *error)
{
    finding f;
    uint32_t chest = NOH_NONE;
    memset(&f, 0, sizeof f);
    f.source = source;
    const noh_result result = noh_ragdoll_find_rows(source, f.rows, &f.count, error);
    if (result) return result;
    f.front = noh_front_of(source);
    for (uint32_t i = 1; i < f.count; i++) {
        const uint32_t start = take_limb(&f, i, rig);
        if (start != NOH_NONE && f.rows[i].toward != NOH_RAGDOLL_UPWARD) chest = above(&f, start);
    }
    take_trunk(&f, chest, rig);
    return NOH_OK;
}

noh_result noh_retarget_rig_make(const noh_ragdoll_source *source, noh_retarget_rig *rig, noh_error *error)
{
    NOH_ASSERT(source && source->pack && rig);
    rig->skeleton = &source->joints;
    rig->reference = NULL;
    for (uint32_t b = 0; b < NOH_BONES; b++) rig->bones[b] = NOH_JOINT_ROOT;
    if (find_by_names(source, rig->bones)) return NOH_OK;
    for (uint32_t b = 0; b < NOH_BONES; b++) rig->bones[b] = NOH_JOINT_ROOT;
    return find_by_rows(source, rig, error);
}
