/* retarget.c: the map from one humanoid to another.
 *
 * With R a joint's rotation in its reference pose, G in a frame, both in the model's space, and A what turns the
 * target's reference limb along the source's: G_target = G_source K, K = inverse(R_source) A R_target. Local to the
 * nearest mapped joint above: inverse(K_above) * (the source's local rotations from there on) * K. */
#include "core/base/assert_internal.h"
#include "life/reach/retarget_internal.h"
#include "life/reach/rig_internal.h"

enum { SOURCE, TARGET };

#define UPRIGHT 0.7f /* of a leg's length: hips at least so far over the feet */

typedef struct making {
    const noh_retarget_rig *rigs[2];
    const noh_transform *rest[2];
    float align[NOH_BONES][4]; /* A of each bone */
    noh_retarget *r;
} making;

static const float none[4] = { 0.0f, 0.0f, 0.0f, 1.0f }, up[3] = { 0.0f, 1.0f, 0.0f };

/* ---- reference poses ---- */

static int is_common(const making *m, uint32_t bone)
{
    return m->rigs[SOURCE]->bones[bone] != NOH_JOINT_ROOT && m->rigs[TARGET]->bones[bone] != NOH_JOINT_ROOT;
}

static void place_rest(const making *m, int side, uint32_t bone, noh_retarget_place *out)
{
    noh_retarget_place_of(m->rigs[side]->skeleton, m->rest[side], m->rigs[side]->bones[bone], NOH_JOINT_ROOT, out);
}

/* From one bone to another, the source's as it faces as the target does. */
static void way_of(const making *m, int side, uint32_t from, uint32_t to, float out[3])
{
    noh_retarget_place a, b;
    place_rest(m, side, from, &a);
    place_rest(m, side, to, &b);
    noh_sub3(b.position, a.position, out);
    if (side == SOURCE) noh_quat_rotate(m->r->facing, out, out);
}

static float length_of(const making *m, int side, uint32_t upper)
{
    float a[3], b[3];
    way_of(m, side, upper, upper + 1u, a);
    way_of(m, side, upper + 1u, upper + 2u, b);
    return noh_length3(a) + noh_length3(b);
}

static int has_limb(const making *m, int side, uint32_t upper)
{
    const uint16_t *bones = m->rigs[side]->bones;
    return bones[upper] != NOH_JOINT_ROOT && bones[upper + 1u] != NOH_JOINT_ROOT && bones[upper + 2u] != NOH_JOINT_ROOT;
}

static int is_upright(const making *m, int side)
{
    float way[3];
    for (uint32_t i = 0; i < 2; i++) {
        const uint32_t leg = NOH_BONE_UPPER_LEG + i * NOH_BONE_RIGHT;
        if (!has_limb(m, side, leg)) continue;
        way_of(m, side, leg + 2u, leg, way);
        if (!(way[1] > UPRIGHT * length_of(m, side, leg))) return 0;
    }
    if (m->rigs[side]->bones[NOH_BONE_HEAD] == NOH_JOINT_ROOT) return 1;
    way_of(m, side, NOH_BONE_HIPS, NOH_BONE_HEAD, way);
    return way[1] > 0.0f;
}

/* From right to left, horizontal; zeros: not known. */
static void across_body(const making *m, int side, float out[3])
{
    static const uint32_t pairs[] = { NOH_BONE_UPPER_LEG, NOH_BONE_UPPER_ARM };
    out[0] = out[1] = out[2] = 0.0f;
    for (uint32_t i = 0; i < 2; i++) {
        const uint32_t left = pairs[i], right = left + NOH_BONE_RIGHT;
        float way[3];
        if (!is_common(m, left) || !is_common(m, right)) continue;
        way_of(m, side, right, left, way);
        noh_madd3(out, 1.0f, way, out);
    }
    out[1] = 0.0f;
}

static void find_facing(making *m, float forward[3])
{
    float from[3], to[3], turn[4];
    memcpy(m->r->facing, none, sizeof none);
    across_body(m, SOURCE, from);
    across_body(m, TARGET, to);
    noh_quat_between(from, to, up, turn);
    memcpy(m->r->facing, turn, sizeof turn);
    noh_cross3(to, up, forward);
}

static void find_ratio(making *m)
{
    float sizes[2] = { 0.0f, 0.0f };
    noh_retarget_place hips[2];
    for (int side = 0; side < 2; side++) {
        for (uint32_t i = 0; i < 2; i++) {
            const uint32_t leg = NOH_BONE_UPPER_LEG + i * NOH_BONE_RIGHT;
            if (has_limb(m, SOURCE, leg) && has_limb(m, TARGET, leg)) sizes[side] += length_of(m, side, leg);
        }
        place_rest(m, side, NOH_BONE_HIPS, &hips[side]);
    }
    if (!(sizes[SOURCE] > 0.0f && sizes[TARGET] > 0.0f)) { /* without legs: by height */
        for (int side = 0; side < 2; side++) sizes[side] = hips[side].position[1];
    }
    m->r->clips.ratio = sizes[SOURCE] > 0.0f && sizes[TARGET] > 0.0f ? sizes[TARGET] / sizes[SOURCE] : 1.0f;
}

/* ---- alignment ---- */

/* The target's bone, turned with the one above it, along the source's. */
static void align_bone(making *m, uint32_t bone, const float *above)
{
    float have[3], want[3], turn[4];
    memcpy(m->align[bone], above, sizeof none);
    if (!is_common(m, bone) || !is_common(m, bone + 1u)) return;
    way_of(m, TARGET, bone, bone + 1u, have);
    way_of(m, SOURCE, bone, bone + 1u, want);
    noh_quat_rotate(above, have, have);
    noh_quat_between(have, want, up, turn);
    noh_quat_mul(turn, above, m->align[bone]);
}

/* Two bones whose way goes across a hand: knuckles, else hand and thumb. 0: none in both. */
static int across_hand(const making *m, uint32_t side, uint32_t bones[2])
{
    static const uint8_t pairs[][2] = { { NOH_BONE_LITTLE, NOH_BONE_INDEX },
                                        { NOH_BONE_RING, NOH_BONE_INDEX },
                                        { NOH_BONE_LITTLE, NOH_BONE_MIDDLE },
                                        { NOH_BONE_HAND, NOH_BONE_THUMB + 1 },
                                        { NOH_BONE_HAND, NOH_BONE_THUMB } };
    for (uint32_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        bones[0] = pairs[i][0] + side;
        bones[1] = pairs[i][1] + side;
        if (is_common(m, bones[0]) && is_common(m, bones[1])) return 1;
    }
    return 0;
}

/* A forearm's direction leaves its twist open: the hand has it all, the forearm half. */
static void twist_hand(making *m, uint32_t side)
{
    const uint32_t forearm = NOH_BONE_LOWER_ARM + side, hand = NOH_BONE_HAND + side;
    float axis[3], have[3], want[3], twist[4], half[4];
    uint32_t bones[2];
    memcpy(m->align[hand], m->align[forearm], sizeof none);
    if (!is_common(m, forearm) || !is_common(m, hand) || !across_hand(m, side, bones)) return;
    way_of(m, SOURCE, forearm, hand, axis);
    noh_normalize3(axis, up);
    way_of(m, TARGET, bones[0], bones[1], have);
    way_of(m, SOURCE, bones[0], bones[1], want);
    noh_quat_rotate(m->align[hand], have, have);
    noh_reject3(have, axis, have);
    noh_reject3(want, axis, want);
    noh_quat_between(have, want, axis, twist);
    noh_ik_share(twist, 0.5f, half);
    noh_quat_mul(twist, m->align[hand], m->align[hand]);
    noh_quat_mul(half, m->align[forearm], m->align[forearm]);
}

static void align_all(making *m)
{
    for (uint32_t b = 0; b < NOH_BONES; b++) memcpy(m->align[b], none, sizeof none);
    for (uint32_t side = 0; side <= NOH_BONE_RIGHT; side += NOH_BONE_RIGHT) {
        align_bone(m, NOH_BONE_UPPER_ARM + side, none);
        align_bone(m, NOH_BONE_LOWER_ARM + side, m->align[NOH_BONE_UPPER_ARM + side]);
        align_bone(m, NOH_BONE_UPPER_LEG + side, none);
        align_bone(m, NOH_BONE_LOWER_LEG + side, m->align[NOH_BONE_UPPER_LEG + side]);
        twist_hand(m, side);
        for (uint32_t b = NOH_BONE_THUMB; b < NOH_BONE_LITTLE + 3u; b++) {
            memcpy(m->align[b + side], m->align[NOH_BONE_HAND + side], sizeof none);
        }
    }
}

/* ---- joints ---- */

static uint32_t bone_of(const making *m, uint32_t joint)
{
    uint32_t b = 0;
    while (b < NOH_BONES && !(m->rigs[TARGET]->bones[b] == joint && is_common(m, b))) b++;
    return b;
}

static void make_k(const making *m, uint32_t bone, float k[4])
{
    noh_retarget_place source, target;
    float back[4];
    place_rest(m, SOURCE, bone, &source);
    place_rest(m, TARGET, bone, &target);
    noh_quat_mul(m->r->facing, source.rotation, back);
    noh_quat_conjugate(back, back);
    noh_quat_mul(m->align[bone], target.rotation, k);
    noh_quat_mul(back, k, k);
}

static void pack(float q[4], int16_t out[4])
{
    noh_quat_normalize(q);
    for (int i = 0; i < 4; i++) out[i] = (int16_t)(q[i] * 32767.0f + (q[i] < 0.0f ? -0.5f : 0.5f));
}

/* Joints between a joint and one above it; NOH_NONE: that is not above it. */
static uint32_t count_between(const noh_skeleton *s, uint32_t joint, uint32_t above)
{
    uint32_t count = 0, at = s->parents[joint];
    for (; at != NOH_JOINT_ROOT && at != above; at = s->parents[at]) count++;
    return at == above ? count : NOH_NONE;
}

static void map_joint(const making *m, uint32_t joint, uint32_t bone, noh_retarget_joint *out)
{
    const noh_skeleton *target = m->rigs[TARGET]->skeleton, *source = m->rigs[SOURCE]->skeleton;
    uint32_t at = target->parents[joint], above = NOH_BONES, count;
    float before[4], after[4], between[4];
    memcpy(between, none, sizeof none);
    for (; at != NOH_JOINT_ROOT && (above = bone_of(m, at)) == NOH_BONES; at = target->parents[at]) {
        noh_quat_mul(m->rest[TARGET][at].rotation, between, between);
    }
    out->source = m->rigs[SOURCE]->bones[bone];
    count = above < NOH_BONES ? count_between(source, out->source, m->rigs[SOURCE]->bones[above]) : NOH_NONE;
    make_k(m, bone, after);
    if (count != NOH_NONE) {
        make_k(m, above, before);
        noh_quat_mul(before, between, before);
        noh_quat_conjugate(before, before);
        out->above = (uint16_t)count;
    } else {
        noh_quat_conjugate(between, before);
        noh_quat_mul(above < NOH_BONES ? none : before, m->r->facing, before);
        out->above = (uint16_t)(count_between(source, out->source, NOH_JOINT_ROOT) |
                                (above < NOH_BONES ? NOH_RETARGET_WHOLE : 0u));
    }
    pack(before, out->before);
    pack(after, out->after);
}

static void map_joints(const making *m, noh_retarget_joint *joints)
{
    static const noh_retarget_joint keeps = { { 0, 0, 0, 32767 }, { 0, 0, 0, 32767 }, NOH_JOINT_ROOT, 0 };
    for (uint32_t j = 0; j < m->rigs[TARGET]->skeleton->joint_count; j++) {
        const uint32_t bone = bone_of(m, j);
        joints[j] = keeps;
        if (bone < NOH_BONES) map_joint(m, j, bone, &joints[j]);
    }
}

/* ---- what moves, and limbs ---- */

static void find_moved(making *m)
{
    for (uint32_t i = 0; i < 2; i++) {
        const uint32_t bone = i ? NOH_BONE_HIPS : NOH_BONE_ROOT;
        noh_retarget_place from, to;
        m->r->moved[i][SOURCE] = m->r->moved[i][TARGET] = NOH_JOINT_ROOT;
        if (!is_common(m, bone)) continue;
        for (int side = 0; side < 2; side++) m->r->moved[i][side] = m->rigs[side]->bones[bone];
        place_rest(m, SOURCE, bone, &from);
        place_rest(m, TARGET, bone, &to);
        memcpy(m->r->from[i], from.position, sizeof from.position);
        memcpy(m->r->to[i], to.position, sizeof to.position);
    }
}

static void make_leg(const making *m, uint32_t upper, noh_retarget_limb *limb)
{
    noh_retarget_place from, to, shin;
    float way[3], back[4];
    place_rest(m, SOURCE, upper + 2u, &from);
    place_rest(m, TARGET, upper + 1u, &shin);
    place_rest(m, TARGET, upper + 2u, &to);
    noh_quat_conjugate(to.rotation, limb->rest);
    noh_retarget_point(m->r, from.position, way);
    noh_sub3(to.position, way, limb->stance);
    limb->height = to.position[1];
    noh_quat_conjugate(shin.rotation, back);
    noh_sub3(to.position, shin.position, way);
    noh_quat_rotate(back, way, limb->tip);
    for (int i = 0; i < 3; i++) limb->tip[i] /= shin.scale;
    if (!is_common(m, upper + 3u)) return; /* toes */
    way_of(m, TARGET, upper + 2u, upper + 3u, limb->sole);
    way_of(m, SOURCE, upper + 2u, upper + 3u, way);
    noh_madd3(limb->sole, -m->r->clips.ratio, way, limb->shorter);
}

static int is_below(const making *m, int side, uint32_t bone, uint32_t above)
{
    const uint16_t *bones = m->rigs[side]->bones;
    return count_between(m->rigs[side]->skeleton, bones[bone], bones[above]) != NOH_NONE;
}

static void make_limb(const making *m, uint32_t index, const float forward[3])
{
    const uint32_t upper = (index < 2 ? NOH_BONE_UPPER_LEG : NOH_BONE_UPPER_ARM) + (index & 1u) * NOH_BONE_RIGHT;
    noh_retarget_limb *limb = &m->r->limbs[index];
    noh_retarget_place start;
    float back[4];
    if (!has_limb(m, SOURCE, upper) || !has_limb(m, TARGET, upper) || !is_below(m, TARGET, upper + 1u, upper)) return;
    for (uint32_t i = 0; i < 3; i++) {
        limb->source[i] = m->rigs[SOURCE]->bones[upper + i];
        limb->target[i] = m->rigs[TARGET]->bones[upper + i];
    }
    limb->is_apart = !is_below(m, TARGET, upper + 2u, upper + 1u);
    if (index > 1 && (limb->is_apart || !is_below(m, SOURCE, upper + 2u, upper))) return;
    limb->length = length_of(m, TARGET, upper);
    limb->ratio = limb->length / length_of(m, SOURCE, upper);
    if (!(limb->length > 0.0f && limb->ratio < 1e9f)) return;
    place_rest(m, TARGET, upper, &start);
    noh_quat_mul(m->align[upper], start.rotation, back);
    noh_quat_conjugate(back, back);
    noh_quat_rotate(back, forward, limb->bend); /* knees ahead, elbows back */
    for (int i = 0; i < 3 && index > 1; i++) limb->bend[i] = -limb->bend[i];
    if (index < 2) make_leg(m, upper, limb);
    limb->exists = 1;
}

static noh_result check_rigs(const making *m, noh_error *error)
{
    uint32_t common = 0;
    if (!is_common(m, NOH_BONE_HIPS)) {
        return noh_fail(error, NOH_ERR_NOT_FOUND, "a rig to retarget has no hips",
                        m->rigs[SOURCE]->bones[NOH_BONE_HIPS] != NOH_JOINT_ROOT, 0);
    }
    for (uint32_t b = NOH_BONE_HIPS; b < NOH_BONES; b++) common += is_common(m, b) != 0;
    if (common < 2) return noh_fail(error, NOH_ERR_NOT_FOUND, "two rigs to retarget share no bone but the hips", 0, 0);
    for (int side = 0; side < 2; side++) {
        if (!is_upright(m, side)) {
            return noh_fail(error, NOH_ERR_DATA,
                            "a reference pose for retargeting does not stand upright with +y up: give one that does",
                            (uint64_t)side, 0);
        }
    }
    m->r->bone_count = common;
    return NOH_OK;
}

static void pose_of_clip(const noh_clip_map *map, const noh_transform *from, uint32_t joint_count, noh_transform *to)
{
    noh_retarget_pose((const noh_retarget *)(const void *)map, from, NULL, joint_count, to);
}

/* Where the hips are the first joint, legs that do not reach move it: a pose of one joint then needs the legs'. */
static uint32_t joints_for_first(const noh_retarget *r)
{
    uint32_t least = 0;
    for (uint32_t i = 0; i < 6 && r->moved[1][TARGET] == 0; i++) {
        const noh_retarget_limb *leg = &r->limbs[i / 3u];
        if (leg->exists && leg->target[i % 3u] >= least) least = leg->target[i % 3u] + 1u;
    }
    return least;
}

noh_result noh_retarget_init(noh_retarget *retarget, const noh_retarget_rig *source, const noh_retarget_rig *target,
                             uint32_t flags, noh_retarget_joint *joints, noh_error *error)
{
    making m;
    float forward[3];
    NOH_ASSERT(retarget && source && target && joints);
    memset(retarget, 0, sizeof *retarget);
    memcpy(retarget->facing, none, sizeof none);
    m.rigs[SOURCE] = source;
    m.rigs[TARGET] = target;
    for (int side = 0; side < 2; side++) {
        const noh_retarget_rig *rig = m.rigs[side];
        m.rest[side] = rig->reference ? rig->reference : rig->skeleton->bind_pose;
    }
    m.r = retarget;
    const noh_result result = check_rigs(&m, error);
    if (result) return result;
    retarget->clips.source = source->skeleton;
    retarget->clips.target = target->skeleton;
    retarget->clips.pose = pose_of_clip;
    retarget->rest = m.rest[TARGET];
    retarget->joints = joints;
    retarget->flags = flags;
    find_facing(&m, forward);
    noh_normalize3(forward, (const float[3]){ 0.0f, 0.0f, 1.0f });
    find_ratio(&m);
    align_all(&m);
    map_joints(&m, joints);
    find_moved(&m);
    for (uint32_t i = 0; i < 4; i++) make_limb(&m, i, forward);
    retarget->clips.least = joints_for_first(retarget);
    return NOH_OK;
}
