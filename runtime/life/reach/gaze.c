/* gaze.c: turns the head, with spine and neck, and eyes ahead of them. */
#include "core/base/quarter_internal.h"
#include "core/base/trig_internal.h"
#include "life/physics/ragdoll_rig_internal.h"
#include "life/reach/feet_internal.h"
#include "life/reach/gaze_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/low_life.h"
#include "noh/low_motion.h"
#include "noh/pack.h"

#include "core/base/assert_internal.h"
#include "core/base/name_internal.h"
#include "life/reach/rig_internal.h"

#define HEAD_ANGLE_MAX (NOH_PI / 3.0f)
#define HEAD_SPEED 4.0f /* radians a second */
#define EYES_ANGLE_MAX (35.0f * NOH_PI / 180.0f)
#define EYES_SPEED 12.0f /* radians per second */
#define HEAD_PART 0.75f  /* share of the turn, if eyes take the rest */
#define NEAR_HALF_LIFE 0.1f
#define ENOUGH_SECONDS 100.0f /* enough for any turn */

/* ---- the rig ---- */

static const char *name_of(const noh_ragdoll_source *s, uint32_t joint)
{
    const char *name = noh_pack_joint_name(s->pack, s->skeleton, joint);
    return name ? noh_name_english(name) : "";
}

static int has_any(const char *name, const char *const *words)
{
    while (*words && !noh_name_has(name, *words)) words++;
    return *words != NULL;
}

int noh_name_is_head(const char *name)
{
    static const char *const no_head[] = { "headtop", "headend", "headnub", "forehead", "headlight", NULL };
    return (noh_name_has(name, "head") || noh_name_has(name, "kopf")) && !has_any(name, no_head);
}

static uint32_t find_head(const noh_ragdoll_source *s)
{
    uint32_t joint = 0;
    while (joint < s->joints.joint_count && !noh_name_is_head(name_of(s, joint))) joint++;
    return joint < s->joints.joint_count ? joint : NOH_NONE;
}

static int has_legs_below(const noh_ragdoll_source *s, uint32_t joint)
{
    static const char *const legs[] = { "leg", "thigh", "knee", "shin", "calf", "foot", NULL };
    for (uint32_t i = joint + 1u; i < s->joints.joint_count; i++) {
        if (noh_joint_is_below(&s->joints, i, joint) && has_any(name_of(s, i), legs)) return 1;
    }
    return 0;
}

/* The relative share of a joint above the head; 0 if it is neither neck nor spine. */
static float part_of(const noh_ragdoll_source *s, uint32_t joint)
{
    static const char *const necks[] = { "neck", NULL };
    static const char *const spines[] = { "spine", "chest", "torso", "abdomen", "thorax", "back", NULL };
    if (has_any(name_of(s, joint), necks)) return 2.0f;
    return has_any(name_of(s, joint), spines) && !has_legs_below(s, joint) ? 1.0f : 0.0f;
}

/* Collect joints from the head down, then reverse them, so that parents come before their children. */
static void find_chain(const noh_ragdoll_source *s, uint32_t head, noh_gaze_rig *rig)
{
    float sum = 0.0f;
    uint32_t joint = head;
    while (joint != NOH_JOINT_ROOT && rig->joint_count < NOH_GAZE_JOINTS_MAX) {
        const float part = joint == head ? 3.0f : part_of(s, joint);
        if (part > 0.0f) {
            rig->joints[rig->joint_count] = joint;
            rig->shares[rig->joint_count++] = part;
            sum += part;
        }
        joint = s->joints.parents[joint];
    }
    for (uint32_t a = 0, b = rig->joint_count - 1u; a < b; a++, b--) {
        const uint32_t other = rig->joints[a];
        const float share = rig->shares[a];
        rig->joints[a] = rig->joints[b];
        rig->shares[a] = rig->shares[b];
        rig->joints[b] = other;
        rig->shares[b] = share;
    }
    for (uint32_t i = 0; i < rig->joint_count; i++) rig->shares[i] /= sum;
}

/* The first two eye joints below the head; neither is a descendant of the other. */
static void find_eyes(const noh_ragdoll_source *s, uint32_t head, uint32_t eyes[2])
{
    static const char *const eye[] = { "eye", "eyeball", NULL };
    static const char *const no_eye[] = { "lid",    "brow", "lash", "lashes", "socket", "corner",
                                          "target", "end",  "nub",  "bag",    NULL };
    uint32_t count = 0;
    for (uint32_t i = head + 1u; i < s->joints.joint_count && count < 2u; i++) {
        const char *name = name_of(s, i);
        if (!has_any(name, eye) || has_any(name, no_eye) || !noh_joint_is_below(&s->joints, i, head)) continue;
        if (count && noh_joint_is_below(&s->joints, i, eyes[0])) continue;
        eyes[count++] = i;
    }
    if (count < 2u) eyes[0] = eyes[1] = NOH_NONE;
}

/* The box around the skin of the head. Returns 0 if there is none. */
static int find_skin(const noh_ragdoll_source *s, uint32_t head, float low[3], float high[3])
{
    uint32_t count = 0;
    for (uint32_t m = 0; m < s->pack->runs[NOH_CHUNK_MESH].count; m++) {
        noh_mesh mesh;
        noh_skin skin;
        if (noh_pack_mesh_at(s->pack, m, &mesh, NULL) || noh_pack_skin_at(s->pack, mesh.header->skin, &skin, NULL) ||
            skin.header->skeleton != s->skeleton) {
            continue;
        }
        for (uint32_t v = 0; v < mesh.header->vertex_count; v++) {
            uint32_t joints[NOH_INFLUENCES_MAX];
            float weights[NOH_INFLUENCES_MAX], point[3];
            (void)noh_mesh_influences(&mesh, v, joints, weights);
            if (!noh_joint_is_below(&s->joints, skin.joints[joints[0]], head)) continue;
            noh_rig_vertex(&s->joints, &mesh, &skin, v, joints[0], point);
            for (int i = 0; i < 3; i++) {
                low[i] = !count || point[i] < low[i] ? point[i] : low[i];
                high[i] = !count || point[i] > high[i] ? point[i] : high[i];
            }
            count++;
        }
    }
    return count > 0;
}

/* In model space at rest: between the eyes, at the middle of the head's skin, or at the head joint. */
static void find_middle(const noh_ragdoll_source *s, const noh_gaze_rig *rig, uint32_t head, float middle[3])
{
    float a[3], b[3], unused[4];
    noh_ragdoll_bind(&s->joints, head, middle, unused);
    if (rig->eyes[0] != NOH_NONE) {
        noh_ragdoll_bind(&s->joints, rig->eyes[0], a, unused);
        noh_ragdoll_bind(&s->joints, rig->eyes[1], b, unused);
    } else if (!find_skin(s, head, a, b)) {
        return;
    }
    for (int i = 0; i < 3; i++) middle[i] = 0.5f * (a[i] + b[i]);
}

/* The front, in a joint's space at rest. */
static void ahead_of(const noh_ragdoll_source *s, uint32_t front, uint32_t joint, float ahead[3])
{
    static const float z[3] = { 0.0f, 0.0f, 1.0f };
    float way[3], unused[3], rotation[4];
    noh_quarter_turn(front, z, way);
    noh_ragdoll_bind(&s->joints, joint, unused, rotation);
    noh_quat_conjugate(rotation, rotation);
    noh_quat_rotate(rotation, way, ahead);
}

static void measure(const noh_ragdoll_source *s, uint32_t front, noh_gaze_rig *rig)
{
    const uint32_t head = rig->joints[rig->joint_count - 1u];
    float middle[3], at[3], first[3], rotation[4], unused[4];
    find_middle(s, rig, head, middle);
    noh_ragdoll_bind(&s->joints, rig->joints[0], first, unused);
    noh_ragdoll_bind(&s->joints, head, at, rotation);
    noh_sub3(middle, at, rig->middle);
    noh_quat_conjugate(rotation, rotation);
    noh_quat_rotate(rotation, rig->middle, rig->middle);
    ahead_of(s, front, head, rig->ahead);
    noh_sub3(middle, first, first);
    rig->size = noh_length3(first);
    rig->size = rig->size > 1e-6f ? rig->size : 1e-6f;
    rig->last = head;
    for (int e = 0; e < 2 && rig->eyes[0] != NOH_NONE; e++) {
        ahead_of(s, front, rig->eyes[e], rig->eyes_ahead[e]);
        rig->last = rig->eyes[e] > rig->last ? rig->eyes[e] : rig->last;
    }
}

noh_result noh_gaze_rig_find(const noh_ragdoll_source *source, uint32_t front, noh_gaze_rig *rig, noh_error *error)
{
    const uint32_t head = find_head(source);
    if (head == NOH_NONE) {
        return noh_fail(error, NOH_ERR_NOT_FOUND, "no joint name has the word 'head': fill in the gaze rig by hand", 0,
                        0);
    }
    memset(rig, 0, sizeof *rig);
    find_chain(source, head, rig);
    find_eyes(source, head, rig->eyes);
    measure(source, front, rig);
    return NOH_OK;
}

noh_result noh_gaze_rig_make(const noh_pack *pack, uint32_t skeleton, noh_gaze_rig *rig, noh_error *error)
{
    NOH_ASSERT(pack && rig);
    noh_ragdoll_source source = { .pack = pack, .skeleton = skeleton };
    const noh_result result = noh_pack_skeleton_at(pack, skeleton, &source.joints, NULL, error);
    if (result != NOH_OK) return result;
    return noh_gaze_rig_find(&source, noh_front_of(&source), rig, error);
}

/* ---- states ---- */

static int is_look(const noh_ik_look *look)
{
    const float square = noh_dot3(look->direction, look->direction);
    return look->follows <= 3u && square > 0.99f && square < 1.01f;
}

const char *noh_gaze_check(const noh_gaze *g)
{
    if (!noh_are_sound(g->point, 3) || !(g->near >= 0.0f && g->near < 1e12f)) {
        return "gaze: a point or a distance is not a number";
    }
    if (g->looks > 1u || g->begun > 1u) return "gaze: a flag is not 0 or 1";
    return !g->begun || (is_look(&g->head) && is_look(&g->eyes)) ? NULL : "gaze: a direction is not unit";
}

/* ---- a step ---- */

typedef struct face_now {
    float at[3], rotation[4], middle[3], ahead[3];
} face_now;

static void read_face(const noh_gaze_rig *rig, const noh_skeleton *skeleton, const noh_transform *local, face_now *n)
{
    noh_rig_joint(skeleton, local, rig->joints[rig->joint_count - 1u], n->at, n->rotation);
    noh_quat_rotate(n->rotation, rig->middle, n->middle);
    noh_madd3(n->middle, 1.0f, n->at, n->middle);
    noh_quat_rotate(n->rotation, rig->ahead, n->ahead);
    noh_normalize3(n->ahead, rig->ahead);
}

static void look_near(noh_gaze *g, float size, const float *toward, float seconds, int cut)
{
    const float length = toward ? noh_length3(toward) : 0.0f, least = 0.75f * size;
    const float goal = toward ? 1.0f / (length > least ? length : least) : 0.0f;
    g->near += (goal - g->near) * (cut ? 1.0f : 1.0f - noh_exp2(-seconds / NEAR_HALF_LIFE));
}

/* Spine, neck and head have moved the head: it turns the rest of the way, which moves the eyes once more. */
static void aim_head(const noh_gaze *g, const noh_gaze_rig *rig, const noh_skeleton *skeleton, noh_transform *local,
                     const float from[3])
{
    static const float up[3] = { 0.0f, 1.0f, 0.0f };
    face_now n;
    float way[3], by[4];
    read_face(rig, skeleton, local, &n);
    noh_sub3(from, n.middle, way);
    for (int i = 0; i < 3; i++) way[i] = g->head.direction[i] + g->near * way[i];
    noh_quat_between(n.ahead, way, up, by);
    noh_rig_turn(skeleton, local, rig->joints[rig->joint_count - 1u], by);
}

/* Aim each eye from its own place at one point. */
static void aim_eyes(const noh_gaze *g, const noh_gaze_rig *rig, const noh_skeleton *skeleton, noh_transform *local,
                     const face_now *n)
{
    static const float up[3] = { 0.0f, 1.0f, 0.0f };
    for (int e = 0; e < 2; e++) {
        const uint32_t joint = rig->eyes[e];
        float at[3], rotation[4], ahead[3], way[3], by[4];
        memcpy(local[joint].rotation, skeleton->bind_pose[joint].rotation, sizeof local[joint].rotation);
        noh_rig_joint(skeleton, local, joint, at, rotation);
        noh_quat_rotate(rotation, rig->eyes_ahead[e], ahead);
        noh_sub3(n->middle, at, way);
        for (int i = 0; i < 3; i++) way[i] = g->eyes.direction[i] + g->near * way[i];
        noh_quat_between(ahead, way, up, by);
        noh_rig_turn(skeleton, local, joint, by);
    }
}

static void turn_eyes(noh_gaze *g, const noh_gaze_rig *rig, const noh_skeleton *skeleton, noh_transform *local,
                      const float *target, float seconds, int begins)
{
    face_now n;
    float toward[3] = { 0.0f, 0.0f, 0.0f }, unused[4];
    read_face(rig, skeleton, local, &n);
    if (begins) noh_ik_look_init(&g->eyes, n.ahead);
    if (target) noh_sub3(target, n.middle, toward);
    noh_ik_look_step(&g->eyes, EYES_ANGLE_MAX, EYES_SPEED, n.ahead, target && g->head.follows ? toward : NULL, seconds,
                     unused);
    aim_eyes(g, rig, skeleton, local, &n);
}

void noh_gaze_step(noh_gaze *gaze, const noh_gaze_rig *rig, const noh_skeleton *skeleton, noh_transform *local,
                   const float *target, float seconds, int cut)
{
    face_now n;
    float toward[3] = { 0.0f, 0.0f, 0.0f }, turn[4], part[4];
    NOH_ASSERT(gaze && rig && skeleton && local && seconds >= 0.0f && rig->last < skeleton->joint_count);
    const int begins = cut || !gaze->begun, has_eyes = rig->eyes[0] != NOH_NONE;
    seconds = begins ? ENOUGH_SECONDS : seconds;
    gaze->begun = 1;
    read_face(rig, skeleton, local, &n);
    if (begins) {
        noh_ik_look_init(&gaze->head, n.ahead);
        noh_ik_look_init(&gaze->eyes, n.ahead);
    }
    if (target) noh_sub3(target, n.middle, toward);
    noh_ik_look_step(&gaze->head, HEAD_ANGLE_MAX, HEAD_SPEED, n.ahead, target ? toward : NULL, seconds, turn);
    look_near(gaze, rig->size, gaze->head.follows ? toward : NULL, seconds, begins);
    if (has_eyes) noh_ik_share(turn, HEAD_PART, turn);
    for (uint32_t i = 0; i < rig->joint_count; i++) {
        noh_ik_share(turn, rig->shares[i], part);
        noh_rig_turn(skeleton, local, rig->joints[i], part);
    }
    if (has_eyes) {
        turn_eyes(gaze, rig, skeleton, local, target, seconds, begins);
    } else {
        for (int i = 0; i < 2; i++) aim_head(gaze, rig, skeleton, local, n.middle);
    }
}
