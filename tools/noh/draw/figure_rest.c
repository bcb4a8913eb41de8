/* figure_rest.c: how a figure without a clip stands: as in a clip named idle, otherwise with lowered arms, which most
 * bodies spread in their bind pose. */
#include <math.h>
#include <string.h>

#include "core/base/name_internal.h"
#include "figure.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/low_life.h"

#define ARM_OUT 0.24f /* of a lowered upper arm, relative to its height */
#define FORE_OUT 0.06f
#define FORE_AHEAD 0.22f
#define LOWERED 0.93f /* cosine to straight down: arms at least as low stay as they are */

const char *figure_idle_clip(const noh_pack *pack)
{
    noh_pack_clip clip;
    for (uint32_t i = 0; noh_pack_clip_at(pack, i, &clip, NULL) == NOH_OK; i++) {
        if (clip.header->joint_count && noh_name_has(clip.name, "idle")) return clip.name;
    }
    return NULL;
}

/* Turn a joint so that its bone to `end` points in a direction of model space. */
static void point(noh_modifier_work *w, uint32_t joint, uint32_t end, const float direction[3])
{
    const float *m = noh_modifier_model(w), *from = m + 12u * joint, *to = m + 12u * end;
    const uint32_t up = w->skeleton->parents[joint];
    const float *parent = up == NOH_JOINT_ROOT ? NULL : m + 12u * up;
    float bone[3], turn[4] = { 0.0f, 0.0f, 0.0f, 1.0f }, local[4], length = 0.0f, along = 0.0f, aim = 0.0f;
    for (int c = 0; c < 3; c++) {
        bone[c] = to[4 * c + 3] - from[4 * c + 3];
        length += bone[c] * bone[c];
        aim += direction[c] * direction[c];
        along += bone[c] * direction[c];
    }
    const float across[3] = { bone[1] * direction[2] - bone[2] * direction[1],
                              bone[2] * direction[0] - bone[0] * direction[2],
                              bone[0] * direction[1] - bone[1] * direction[0] };
    turn[3] = sqrtf(length * aim) + along;
    for (int c = 0; c < 3; c++) {
        float size = 0.0f; /* of the parent's column, which may be scaled */
        turn[c] = across[c];
        if (!parent) continue;
        turn[c] = 0.0f;
        for (int r = 0; r < 3; r++) {
            turn[c] += parent[4 * r + c] * across[r];
            size += parent[4 * r + c] * parent[4 * r + c];
        }
        turn[c] /= size > 0.0f ? sqrtf(size) : 1.0f;
    }
    noh_quat_normalize(turn);
    noh_quat_mul(turn, w->local[joint].rotation, local);
    memcpy(w->local[joint].rotation, local, sizeof local);
}

static int is_lowered(const float *model, const noh_reach_arm *arm)
{
    float drop[3], square = 0.0f;
    for (uint32_t c = 0; c < 3; c++) {
        drop[c] = model[12u * arm->fore + 4u * c + 3u] - model[12u * arm->upper + 4u * c + 3u];
        square += drop[c] * drop[c];
    }
    return -drop[1] >= LOWERED * sqrtf(square);
}

static void lower_arms(noh_modifier_work *w)
{
    const noh_reach_rig *rig = w->user;
    if (w->joint_count <= rig->last) return;
    for (uint32_t i = 0; i < rig->arm_count; i++) {
        const noh_reach_arm *arm = &rig->arms[i];
        const float *model = noh_modifier_model(w);
        const float side = model[12u * arm->hand + 3] < model[3] ? -1.0f : 1.0f;
        const float upper[3] = { side * ARM_OUT, -1.0f, 0.0f }, fore[3] = { side * FORE_OUT, -1.0f, FORE_AHEAD };
        if (is_lowered(model, arm)) continue;
        point(w, arm->upper, arm->fore, upper);
        point(w, arm->fore, arm->hand, fore);
    }
}

void figure_add_rest(figure *f)
{
    for (uint32_t k = 0; k < f->stage_desc.kind_count && f->desc.lowers_arms; k++) {
        noh_kind_desc *kind = &f->kinds[k];
        const noh_skeleton_header *header;
        noh_ragdoll_source source;
        memset(&source, 0, sizeof source);
        source.pack = kind->mesh;
        source.skeleton = kind->skeleton;
        if (noh_pack_skeleton_at(kind->mesh, kind->skeleton, &source.joints, &header, NULL)) continue;
        source.metres = (float)header->unit_cm / 100.0f;
        if (noh_reach_rig_make(&source, &f->arms[k], NULL)) continue; /* it has no arms */
        if (kind->modifier_count) {
            memcpy(f->rest_parts[k], kind->modifiers, kind->modifier_count * sizeof *kind->modifiers);
        }
        f->rest_parts[k][kind->modifier_count] = (noh_modifier){ .name = "arms",
                                                                 .modify = lower_arms,
                                                                 .user = &f->arms[k] };
        kind->modifiers = f->rest_parts[k];
        kind->modifier_count++;
    }
}
