/* stage_face_open.c: the joints and targets of a kind's faces, and the calls that tell a face what to do. */
#include <string.h>

#include "core/base/assert_internal.h"
#include "core/base/quarter_internal.h"
#include "core/base/vector_internal.h"
#include "life/face/recipe_internal.h"
#include "motion/pose/skeleton_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/face.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "noh/pack.h"
#include "core/base/math_internal.h"
#include "core/base/name_internal.h"
#include "deform/pick/bounds_internal.h"
#include "stage/modules/stage_face_internal.h"
#include "life/face/face_internal.h"

/* ---- joints ---- */

#define NAME_BYTES 40u

/* Of a head that turns as a whole */
#define LONE_HEAD 10.0f /* its height is below that many times the distance of its eyes; a person's is 3.6, a body 27 */
#define LONE_YAW_RAD 0.8f
#define LONE_PITCH_RAD 0.5f
#define DRIFT_MAX 0.15f /* more than it drifts, as a share of the distance of its eyes */

#define LID 0.16f /* the way of a lid, as a share of the distance of its eyes */

/* By how much of that way a blink is off at each update rate: period^2 / 8 times its acceleration, as it shuts in 80 ms
 * along a cosine. */
static const float lids_off[NOH_UPDATE_RATE_COUNT] = { 0.0f, 0.1f, 0.43f, 1.0f };

/* Letters and digits alone, in lower case, behind the last ':' ("mixamorig:LeftEye"); "" where it is too long. */
static void plain_name(const char *name, char out[NAME_BYTES])
{
    uint32_t n = 0;
    for (; *name; name++) {
        const char c = *name >= 'A' && *name <= 'Z' ? (char)(*name + 32) : *name;
        if (c == ':') n = 0;
        if (!((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'))) continue;
        if (n + 1u >= NAME_BYTES) {
            n = 0;
            break;
        }
        out[n++] = c;
    }
    out[n] = '\0';
}

/* The channel of the pack's recipe whose row names the joint, then its usual names. The converter writes rows for
 * joints that the programs of artists call otherwise. */
static const char *const heads[] = { "joint-head", "head", NULL };
static const char *const necks[] = { "joint-neck", "neck", NULL };
static const char *const chests[] = { "joint-chest", "upperchest", "chest", NULL };
static const char *const left_eyes[] = { "joint-eye-left", "lefteye", "eyeleft", "eyel", "leye", NULL };
static const char *const right_eyes[] = { "joint-eye-right", "righteye", "eyeright", "eyer", "reye", NULL };

static uint32_t find_named(const noh_kind_desc *d, uint32_t joint_count, const char *name)
{
    for (uint32_t j = 0; j < joint_count; j++) {
        const char *own = noh_pack_joint_name(d->mesh, d->skeleton, j);
        if (own && noh_names_equal(own, name)) return j;
    }
    return NOH_NONE;
}

/* By the pack's recipe, else the first of the usual names that a joint has. */
static uint32_t find_usual(const noh_kind_desc *d, uint32_t joint_count, const char *const *usual)
{
    char plain[NAME_BYTES];
    for (uint32_t i = 0; i < d->mesh->recipe_row_count; i++) {
        const noh_recipe_row *row = &d->mesh->recipe_rows[i];
        uint32_t joint;
        if (!noh_names_equal(noh_pack_string(d->mesh, row->channel), *usual)) continue;
        joint = find_named(d, joint_count, noh_pack_string(d->mesh, row->target));
        if (joint != NOH_NONE) return joint;
    }
    while (*++usual) {
        for (uint32_t j = 0; j < joint_count; j++) {
            const char *name = noh_pack_joint_name(d->mesh, d->skeleton, j);
            if (!name) continue;
            plain_name(name, plain);
            if (noh_names_equal(plain, *usual)) return j;
        }
    }
    return NOH_NONE;
}

/* *out: the joint of that name, or of a usual one. 0: there is none of that name. */
static int open_joint(const noh_kind_desc *d, const noh_skeleton *skeleton, const char *name, const char *const *usual,
                      noh_stage_face_joint *out)
{
    float rotation[4];
    memset(out, 0, sizeof *out);
    out->joint = NOH_NONE;
    if (!skeleton->joint_count || (name && !name[0])) return 1;
    out->joint = name ? find_named(d, skeleton->joint_count, name) : find_usual(d, skeleton->joint_count, usual);
    if (out->joint == NOH_NONE) return !name;
    noh_stage_joint_in(skeleton, skeleton->bind_pose, out->joint, rotation, out->at);
    noh_quat_conjugate(rotation, out->axes);
    return 1;
}

/* Ignore a neck that is not an ancestor of the head, and eyes that are not descendants of the head. Without a head eyes
 * turn alone. */
static void drop_strays(const noh_skeleton *skeleton, noh_stage_face_kind *f)
{
    noh_stage_face_joint *others[] = { &f->neck, &f->chest, &f->eyes[0], &f->eyes[1] };
    const uint32_t head = f->head.joint;
    for (int i = 0; i < 4; i++) {
        const uint32_t other = others[i]->joint;
        const int is_eye = i >= 2;
        int hangs = is_eye;
        if (other == NOH_NONE) continue;
        if (head != NOH_NONE)
            hangs = is_eye ? noh_joint_is_below(skeleton, other, head) : noh_joint_is_below(skeleton, head, other);
        if (!hangs || other == head) others[i]->joint = NOH_NONE;
    }
    if (f->eyes[0].joint == NOH_NONE || f->eyes[1].joint == NOH_NONE) f->eyes[0].joint = f->eyes[1].joint = NOH_NONE;
}

/* ---- the desc ---- */

/* Where a face's front is, as in noh_feet_front, but by its eyes, whose sides are known, because it may have no legs:
 * across their line, if they are there as seen from the head's joint. */
static uint32_t front_of(const noh_stage_face_kind *f)
{
    const float(*eyes)[3] = f->desc.eyes;
    const uint32_t front = noh_quarter_of(eyes[1][2] - eyes[0][2], eyes[0][0] - eyes[1][0]);
    float ahead[3];
    noh_sub3(f->middle, f->head.at, ahead);
    noh_quarter_turn(4u - front, ahead, ahead);
    return f->head.joint != NOH_NONE && ahead[2] > 0.0f ? front : 0u;
}

/* From the axes of the model to a neck's. */
static void turn_face(noh_stage_face_kind *f, uint32_t front)
{
    const float rotation[3] = { 0.0f, 0.5f * NOH_PI * (float)front, 0.0f };
    float turn[4];
    noh_quat_from_rotation(rotation, turn);
    noh_stage_face_joint *joints[] = { &f->head, &f->neck, &f->chest, &f->eyes[0], &f->eyes[1] };
    for (uint32_t i = 0; i < 5u; i++) noh_quat_mul(joints[i]->axes, turn, joints[i]->axes);
    for (int e = 0; e < 2; e++) noh_quarter_turn(4u - front, f->desc.eyes[e], f->desc.eyes[e]);
}

/* Place the eyes relative to the joint where the head turns. Without a head, that point is below and behind the eyes by
 * human proportions, from the distance of the eyes. */
static void place_eyes(noh_stage_face_kind *f)
{
    float from[3], apart = 0.0f;
    for (int i = 0; i < 3; i++) {
        const float way = f->desc.eyes[0][i] - f->desc.eyes[1][i];
        f->middle[i] = 0.5f * (f->desc.eyes[0][i] + f->desc.eyes[1][i]);
        apart += way * way;
    }
    memcpy(from, f->middle, sizeof from);
    from[1] -= 1.4f * noh_sqrt(apart);
    from[2] -= 1.25f * noh_sqrt(apart);
    if (f->head.joint != NOH_NONE) memcpy(from, f->head.at, sizeof from);
    const uint32_t front = front_of(f);
    for (int i = 0; i < 3; i++) {
        f->desc.eyes[0][i] -= from[i];
        f->desc.eyes[1][i] -= from[i];
    }
    memcpy(f->head.at, from, sizeof from);
    if (front) turn_face(f, front);
}

static const char *bad_rules(const noh_face_rules *r)
{
    for (int i = 0; i < NOH_EMOTION_COUNT; i++) {
        if (r->mouth[i] > NOH_MOUTH_NONE || r->lids[i] > NOH_OVERRIDE_BLEND || r->eyes[i] > NOH_OVERRIDE_BLEND ||
            r->speech[i] > NOH_OVERRIDE_BLEND)
            return "rules of a kind's face: a value is not in its enumeration";
    }
    return r->binary >> NOH_EMOTION_COUNT ? "rules of a kind's face: `binary` has a bit of no emotion" : NULL;
}

static int has_overrides(const noh_face_rules *r)
{
    uint32_t any = r->binary;
    for (int i = 0; i < NOH_EMOTION_COUNT; i++) any |= (uint32_t)r->lids[i] | r->eyes[i] | r->speech[i];
    return any != 0;
}

/* 0: one that is named is not there. */
static int open_joints(const noh_kind_desc *d, const noh_skeleton *skeleton, noh_stage_face_kind *f)
{
    const noh_kind_face *from = d->face.desc;
    return open_joint(d, skeleton, from ? from->head : NULL, heads, &f->head) &&
           open_joint(d, skeleton, from ? from->neck : NULL, necks, &f->neck) &&
           open_joint(d, skeleton, from ? from->chest : NULL, chests, &f->chest) &&
           open_joint(d, skeleton, from ? from->eyes[0] : NULL, left_eyes, &f->eyes[0]) &&
           open_joint(d, skeleton, from ? from->eyes[1] : NULL, right_eyes, &f->eyes[1]);
}

int noh_stage_face_eye_joints(const noh_kind_desc *kind, float eyes[2][3], float *head)
{
    noh_skeleton skeleton;
    noh_stage_face_kind f;
    if (noh_pack_skeleton_at(kind->mesh, kind->skeleton, &skeleton, NULL, NULL) != NOH_OK ||
        !open_joints(kind, &skeleton, &f))
        return 0;
    drop_strays(&skeleton, &f);
    if (f.head.joint != NOH_NONE) *head = f.head.at[2];
    for (int e = 0; e < 2 && f.eyes[0].joint != NOH_NONE; e++) memcpy(eyes[e], f.eyes[e].at, sizeof f.eyes[e].at);
    return f.eyes[0].joint != NOH_NONE;
}

/* All but links and floats. Returns what is wrong. */
static const char *open_shared(const noh_kind_desc *d, const noh_kind_face *from, const noh_skeleton *skeleton,
                               noh_stage_face_kind *f)
{
    noh_face face;
    noh_error error = { NOH_OK, "", 0, 0 };
    float square = 0.0f;
    f->desc = from->face;
    f->rules = from->rules;
    if (!has_overrides(&f->rules)) {
        noh_face_rules_of_pack(d->mesh, &f->rules);
        memcpy(f->rules.mouth, from->rules.mouth, sizeof f->rules.mouth);
    }
    f->flags = from->flags;
    if (!open_joints(d, skeleton, f))
        return "face of a kind: the skeleton has no joint of a given name: noh info lists them";
    drop_strays(skeleton, f);
    for (int i = 0; i < 6; i++) square += f->desc.eyes[i / 3][i % 3] * f->desc.eyes[i / 3][i % 3];
    if (square == 0.0f && f->eyes[0].joint == NOH_NONE)
        return "face of a kind: it has no joints for the eyes: let noh_kind_find_eyes find them, and set "
               "noh_kind_face.face.eyes";
    for (int e = 0; square == 0.0f && e < 2; e++) memcpy(f->desc.eyes[e], f->eyes[e].at, sizeof f->desc.eyes[e]);
    place_eyes(f);
    if (f->head.joint == NOH_NONE) f->desc.head_yaw_max = f->desc.head_pitch_max = 1e-6f;
    if (noh_face_init(&face, &f->desc, 0, f->flags, &error) != NOH_OK) return error.what;
    return bad_rules(&f->rules);
}

static const char *bad(const noh_kind_desc *d, const void *desc)
{
    noh_skeleton skeleton;
    noh_stage_face_kind f;
    if (noh_pack_skeleton_at(d->mesh, d->skeleton, &skeleton, NULL, NULL) != NOH_OK) skeleton.joint_count = 0;
    return open_shared(d, desc, &skeleton, &f);
}

static uint32_t hash(const noh_kind_desc *d, const void *desc)
{
    const noh_kind_face *face = desc;
    const uint8_t *bytes = (const uint8_t *)&face->face;
    uint32_t sum = 2166136261u;
    (void)d;
    for (size_t i = 0; i < sizeof face->face; i++) sum = (sum ^ bytes[i]) * 16777619u;
    return sum;
}

/* ---- targets ---- */

/* Of the kind's meshes, the nth that has the target. */
static uint32_t find_in_pack(const void *user, const char *name, uint32_t nth)
{
    const noh_kind_desc *d = user;
    noh_stage_item items[NOH_STAGE_MESHES_MAX];
    const uint32_t count = noh_stage_items(d, items);
    for (uint32_t i = 0; i < count && i < NOH_STAGE_MESHES_MAX; i++) {
        noh_mesh mesh;
        if (noh_pack_mesh_at(d->mesh, items[i].mesh, &mesh, NULL) != NOH_OK) continue;
        if (noh_mesh_find_target(&mesh, name) != NOH_NONE && nth-- == 0) return i;
    }
    return NOH_NONE;
}

typedef struct recipe_list {
    noh_face_recipe own;
    const noh_face_recipe *usual[4];
    const noh_face_recipe *const *all; /* [count] */
    uint32_t count;
} recipe_list;

/* The recipes of a kind: the game's, else the pack's own and the built-in ones. */
static void list_recipes(const noh_kind_desc *d, recipe_list *list)
{
    const noh_kind_face *face = d->face.desc;
    const int given = face && face->recipes;
    list->own = noh_face_recipe_in_pack(d->mesh);
    list->usual[0] = &list->own;
    list->usual[1] = &noh_face_recipe_arkit;
    list->usual[2] = &noh_face_recipe_vrm;
    list->usual[3] = &noh_face_recipe_units;
    list->all = given ? face->recipes : list->usual;
    list->count = given ? face->recipe_count : 4u;
}

uint32_t noh_stage_face_bind(const noh_kind_desc *d, noh_face_find_fn find, const void *user, noh_face_link *links,
                             uint32_t link_max)
{
    recipe_list list;
    list_recipes(d, &list);
    return noh_face_recipe_bind_by(list.all, list.count, find, user, links, link_max);
}

/* An upper bound. */
static uint32_t count_links(const noh_kind_desc *d)
{
    return noh_stage_face_bind(d, find_in_pack, d, NULL, 0);
}

/* Floats of the set that the name moves, each once. Floats of the same name share one. */
static uint32_t find_in_kind(const void *user, const char *name, uint32_t nth)
{
    const noh_stage_kind *k = user;
    for (uint32_t m = 0; m < k->plan->mesh_count; m++) {
        const noh_stage_mesh *mesh = &k->meshes[m];
        const uint32_t target = noh_mesh_find_target(&mesh->mesh, name), at = mesh->first_float + target;
        if (target == NOH_NONE || at >= k->set.float_count || k->named.sources[at] != at) continue;
        if (nth-- == 0) return at;
    }
    for (uint32_t m = 0; m < k->plan->mesh_count; m++) { /* targets that no clip moves */
        const noh_stage_mesh *mesh = &k->meshes[m];
        const uint32_t target = noh_mesh_find_target(&mesh->mesh, name);
        const uint32_t source = target == NOH_NONE ? NOH_NONE : k->named.sources[mesh->first_float + target];
        if (source == NOH_NONE || source == mesh->first_float + target || source >= k->set.float_count) continue;
        for (uint32_t other = 0; other < k->plan->mesh_count; other++) {
            const uint32_t own = source - k->meshes[other].first_float;
            if (own < k->meshes[other].mesh.header->target_count) return NOH_NONE; /* it was found above */
        }
        return nth == 0 ? source : NOH_NONE;
    }
    return NOH_NONE;
}

/* Whether a pack's recipe says that an expression shows whole or not at all. */
static int is_binary(const noh_pack *pack, const char *expression)
{
    for (uint32_t i = 0; i < pack->recipe_row_count; i++) {
        const noh_recipe_row *row = &pack->recipe_rows[i];
        if (noh_names_equal(noh_pack_string(pack, row->channel), "binary") &&
            noh_names_equal(noh_pack_string(pack, row->target), expression))
            return 1;
    }
    return 0;
}

/* Overrides by expressions of a pack; k NULL: only their number, an upper bound. */
static uint32_t bind_overrides(const noh_pack *pack, const noh_stage_kind *k, noh_face_link *overrides)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < pack->recipe_row_count; i++) {
        const char *name = noh_pack_string(pack, pack->recipe_rows[i].target);
        noh_override how = NOH_OVERRIDE_NONE;
        const uint32_t user = noh_recipe_overrides(pack, &pack->recipe_rows[i], &how);
        uint32_t at;
        if (user == NOH_NONE || how == NOH_OVERRIDE_NONE || noh_face_channel_find(name) != NOH_NONE) continue;
        at = k ? find_in_kind(k, name, 0) : 0;
        if (at == NOH_NONE) continue;
        if (k) {
            overrides[count].channel = (uint16_t)user;
            overrides[count].target = (uint16_t)at;
            overrides[count].weight = is_binary(pack, name) ? NOH_STAGE_WHOLE : (float)how;
        }
        count++;
    }
    return count;
}

static uint32_t find_float(const noh_stage_kind *k, const char *name)
{
    const uint32_t hash = noh_hash_name(name);
    for (uint32_t f = 0; k->bank && f < k->set.float_count; f++) {
        if (k->named.name_hashes[f] == hash && k->named.sources[f] == f) return f;
    }
    return NOH_NONE;
}

static void find_lids(noh_stage_face_kind *f)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < NOH_IDENTITY_CLOSINGS; i++) f->lids[i] = NOH_NONE;
    for (uint32_t l = 0; l < f->link_count && count < NOH_IDENTITY_CLOSINGS; l++) {
        uint32_t known = 0;
        if (f->links[l].channel > NOH_CHANNEL_BLINK_RIGHT) continue;
        while (known < count && f->lids[known] != f->links[l].target) known++;
        if (known == count) f->lids[count++] = f->links[l].target;
    }
}

/* The height of a kind's meshes at rest, model units. */
static float height_of(const noh_stage_kind *k)
{
    float box[6], own[6];
    noh_box_empty(box);
    for (uint32_t m = 0; m < k->plan->mesh_count; m++) {
        const noh_stage_mesh *mesh = &k->meshes[m];
        noh_mesh_box(&mesh->mesh, mesh->skinned ? NULL : mesh->node_world, NULL, own);
        for (int i = 0; i < 6 && mesh->skinned; i++) own[i] *= mesh->bind_stretch;
        noh_box_unite(box, own, box);
    }
    return box[4] - box[1];
}

/* Let a head without a joint turn as a whole: with eyes so far apart it cannot be a body. */
static void open_turns(noh_stage_kind *k, const noh_kind_face *from, noh_stage_face_kind *f)
{
    const float apart = f->desc.eyes[0][0] - f->desc.eyes[1][0];
    float way[3];
    if (f->head.joint != NOH_NONE || from->head || !(height_of(k) < LONE_HEAD * apart)) return;
    f->desc.head_yaw_max = from->face.head_yaw_max > 0.0f ? from->face.head_yaw_max : LONE_YAW_RAD;
    f->desc.head_pitch_max = from->face.head_pitch_max > 0.0f ? from->face.head_pitch_max : LONE_PITCH_RAD;
    k->modules[NOH_SLOT_FACE].turns = 1;
    for (int i = 0; i < 3; i++) way[i] = k->reach[i] - f->head.at[i];
    memcpy(k->reach, f->head.at, sizeof f->head.at);
    k->reach[3] += noh_sqrt(noh_dot3(way, way)) + DRIFT_MAX * apart;
}

static noh_face_link *carve(noh_arena *arena, uint32_t links)
{
    (void)noh_arena_carve(arena, sizeof(noh_stage_face_kind), 16);
    return noh_arena_carve(arena, links * sizeof(noh_face_link), 16);
}

static noh_result measure(const noh_kind_desc *d, const void *desc, const noh_stage_needs *n, noh_module_needs *needs,
                          noh_error *error)
{
    noh_arena arena = noh_arena_measure();
    (void)desc, (void)n, (void)error;
    (void)carve(&arena, count_links(d) + bind_overrides(d->mesh, NULL, NULL));
    needs->kind_bytes = arena.used;
    needs->actor_bytes = sizeof(noh_stage_face);
    return NOH_OK;
}

/* As clips of masks and of VRM have them, and avatars with ARKit's names. */
static const char *const shutting[2] = { "blink", "eyesClosed" };

/* In the order of noh_face_speech. */
static const char *const speaks[4] = { "speech-brows", "speech-nod", "speech-blink", "speech-away" };

/* Emotions that show another's targets share its rules, if the rules are the pack's and not the game's. */
static void share_rules(const noh_stage_kind *k, const noh_kind_face *from, noh_stage_face_kind *f)
{
    recipe_list list;
    if (has_overrides(&from->rules)) return;
    list_recipes(k->desc, &list);
    noh_face_share_rules(k->desc->mesh, noh_face_taken(list.all, list.count, find_in_kind, k), &f->rules);
}

static noh_result init(noh_stage_kind *k, const void *desc, noh_error *error)
{
    noh_stage_face_kind *f = k->modules[NOH_SLOT_FACE].shared;
    noh_arena arena = noh_arena_over((uint8_t *)f, SIZE_MAX);
    const uint32_t most = count_links(k->desc);
    const char *what;
    memset(f, 0, sizeof *f);
    f->links = carve(&arena, most + bind_overrides(k->desc->mesh, NULL, NULL));
    what = open_shared(k->desc, desc, &k->skeleton, f);
    if (what) return noh_fail(error, NOH_ERR_ARG, what, 0, 0);
    share_rules(k, desc, f);
    f->link_count = noh_stage_face_bind(k->desc, find_in_kind, k, f->links, most);
    f->link_count = f->link_count < most ? f->link_count : most;
    f->override_count = (uint16_t)bind_overrides(k->desc->mesh, k, f->links + f->link_count);
    for (uint32_t l = 0; l < f->link_count; l++) {
        const uint32_t channel = f->links[l].channel;
        f->lids_follow |= channel == NOH_CHANNEL_LIDS_DOWN;
        f->looks_down |= channel == NOH_CHANNEL_EYES + 1u || channel == NOH_CHANNEL_EYES + 5u;
    }
    find_lids(f);
    for (int i = 0; i < 2; i++) f->shuts[i] = find_in_kind(k, shutting[i], 0);
    open_turns(k, desc, f);
    for (int r = 0; r < NOH_UPDATE_RATE_COUNT; r++) {
        k->modules[NOH_SLOT_FACE].error_m[r] = lids_off[r] * LID * (f->desc.eyes[0][0] - f->desc.eyes[1][0]);
    }
    f->speech = find_float(k, "speech");
    f->lips_shut = find_float(k, "lips-shut");
    for (int i = 0; i < 4; i++) f->speaks[i] = find_float(k, speaks[i]);
    return NOH_OK;
}

/* ---- a face ---- */

static void begin(const noh_stage *s, const noh_stage_kind *k, uint32_t index, uint32_t seed)
{
    const noh_stage_face_kind *shared = noh_stage_face_kind_of(k);
    noh_stage_face *f = noh_stage_face_of(k, index);
    memset(f, 0, sizeof *f);
    (void)noh_face_init(&f->face, &shared->desc, seed, shared->flags, NULL);
    f->clock = s->head->clock;
    f->begun = 1;
}

static void spawn(const noh_stage *s, const noh_stage_kind *k, uint32_t index, noh_actor actor)
{
    begin(s, k, index, actor.id);
}

static void shift(noh_stage_kind *k, const float by[3])
{
    for (uint32_t a = 0; a < k->desc->actor_count; a++) {
        float *point = noh_stage_face_of(k, a)->point;
        for (int i = 0; i < 3 && k->actors[a].alive; i++) point[i] -= by[i];
    }
}

/* What the arithmetic of a face cannot stand: counts and enumerations out of range, values that are not finite. */
static int is_sound(const noh_face *f)
{
    const noh_face_speech *s = &f->speech;
    int good = noh_are_sound(&s->brows, sizeof *s / sizeof(float)) && NOH_ARE_SOUND(noh_face, f, from, head);
    for (int i = 0; i < 2; i++) good = good && NOH_ARE_SOUND(noh_face_spring, &f->head[i], from, start);
    for (uint32_t i = 0; i < NOH_FACE_EMOTIONS_MAX; i++) {
        const noh_face_emotion *e = &f->emotions[i];
        good = good && NOH_ARE_SOUND(noh_face_spring, &e->amount, from, start) && noh_are_sound(&e->fade_omega, 1);
        if (e->emotion >= NOH_EMOTION_COUNT || e->on > 1u || e->holds > 1u) return 0;
    }
    return good && f->clock >= 0 && f->activity < NOH_ACTIVITY_COUNT && f->flags <= NOH_FACE_FLAGS && f->gaze <= 2u &&
           f->blinking <= 2u && (f->gaze != 2u || f->gaze_ticks);
}

static noh_result check(const noh_stage_kind *k, const void *state, noh_error *error)
{
    const noh_stage_face *f = state;
    (void)k;
    return !noh_are_sound(f->point, 3) || !NOH_ARE_SOUND(noh_stage_face, f, visemes, looks) ||
                   f->looks > NOH_LOOKS_AT_ACTOR || f->says > 1u || f->begun > 1u || f->fresh > 1u ||
                   !is_sound(&f->face)
               ? noh_fail(error, NOH_ERR_DATA, "state: bad face of an actor", 0, 0)
               : NOH_OK;
}

noh_module noh_face_module(const noh_kind_face *face)
{
    static const noh_module_type faces = {
        .slot = NOH_SLOT_FACE,
        .kind_name = "faces",
        .hash = hash,
        .bad = bad,
        .measure = measure,
        .init = init,
        .spawn = spawn,
        .shift = shift,
        .check = check,
        .modify = noh_stage_run_face,
        .turn = noh_stage_turn_head,
    };
    return (noh_module){ face ? &faces : NULL, face };
}

/* ---- calls ---- */

static const char no_face[] = "the actor's kind has no face: set noh_kind_desc.face";

noh_stage_face *noh_stage_change_face(noh_stage *s, noh_actor actor, noh_stage_kind **kind, noh_result *result,
                                      noh_error *error)
{
    noh_stage_actor *a;
    *result = noh_stage_change(s, actor, &a, kind, error);
    if (*result != NOH_OK) return NULL;
    if (!noh_stage_face_kind_of(*kind)) {
        *result = noh_fail(error, NOH_ERR_ARG, no_face, 0, 0);
        return NULL;
    }
    return noh_stage_face_of(*kind, noh_stage_index(*kind, a));
}

noh_result noh_actor_look_at(noh_stage *stage, noh_actor actor, const float point[3], noh_error *error)
{
    noh_stage_kind *k;
    noh_result result;
    noh_stage_face *f = noh_stage_change_face(stage, actor, &k, &result, error);
    if (!f) return result;
    if (point && !noh_is_number3(point)) {
        return noh_fail(error, NOH_ERR_ARG, "point to look at: not within 10^12", 0, 0);
    }
    f->looks = point ? NOH_LOOKS_AT_POINT : NOH_LOOKS_AHEAD;
    f->fresh = 1;
    for (int i = 0; i < 3; i++) f->point[i] = point ? point[i] : 0.0f;
    return NOH_OK;
}

noh_result noh_actor_look_at_actor(noh_stage *stage, noh_actor actor, noh_actor other, noh_error *error)
{
    noh_stage_kind *k;
    noh_result result;
    noh_stage_face *f = noh_stage_change_face(stage, actor, &k, &result, error);
    if (!f) return result;
    if (!noh_stage_actor_of(stage, other, NULL)) return noh_stage_gone(error, other);
    f->fresh = f->fresh || f->looks != NOH_LOOKS_AT_ACTOR || f->target != other.id;
    f->looks = NOH_LOOKS_AT_ACTOR;
    f->target = other.id;
    return NOH_OK;
}

noh_result noh_actor_set_emotion(noh_stage *stage, noh_actor actor, const char *emotion, float amount,
                                 uint32_t onset_ticks, uint32_t hold_ticks, uint32_t fade_ticks, noh_error *error)
{
    noh_stage_kind *k;
    noh_result result;
    noh_stage_face *f = noh_stage_change_face(stage, actor, &k, &result, error);
    NOH_ASSERT(emotion);
    return f ? noh_face_set_emotion(&f->face, noh_emotion_of_name(emotion), amount, onset_ticks, hold_ticks, fade_ticks,
                                    error)
             : result;
}

noh_result noh_actor_set_activity(noh_stage *stage, noh_actor actor, noh_activity activity, noh_error *error)
{
    noh_stage_kind *k;
    noh_result result;
    noh_stage_face *f = noh_stage_change_face(stage, actor, &k, &result, error);
    if (!f) return result;
    if ((unsigned)activity >= NOH_ACTIVITY_COUNT) return noh_fail(error, NOH_ERR_ARG, "no such activity", activity, 0);
    noh_face_set_activity(&f->face, activity);
    return NOH_OK;
}

noh_result noh_actor_set_visemes(noh_stage *stage, noh_actor actor, const float *visemes, noh_error *error)
{
    noh_stage_kind *k;
    noh_result result;
    noh_stage_face *f = noh_stage_change_face(stage, actor, &k, &result, error);
    if (!f) return result;
    for (uint32_t i = 0; visemes && i < NOH_VISEME_COUNT; i++) {
        if (!(visemes[i] >= 0.0f && visemes[i] <= 1.0f))
            return noh_fail(error, NOH_ERR_ARG, "a viseme is not in 0..1", i, 0);
    }
    f->says = visemes != NULL;
    for (uint32_t i = 0; i < NOH_VISEME_COUNT; i++) f->visemes[i] = visemes ? visemes[i] : 0.0f;
    return NOH_OK;
}

noh_result noh_actor_set_face_flags(noh_stage *stage, noh_actor actor, uint32_t flags, noh_error *error)
{
    noh_stage_kind *k;
    noh_result result;
    noh_stage_face *f = noh_stage_change_face(stage, actor, &k, &result, error);
    if (!f) return result;
    if (flags > NOH_FACE_FLAGS) return noh_fail(error, NOH_ERR_ARG, "flags of a face: unknown bits", 0, 0);
    noh_face_set_flags(&f->face, flags);
    return NOH_OK;
}

noh_result noh_actor_seed_face(noh_stage *stage, noh_actor actor, uint32_t seed, noh_error *error)
{
    noh_stage_kind *k;
    noh_result result;
    noh_stage_face *f = noh_stage_change_face(stage, actor, &k, &result, error);
    if (f) begin(stage, k, noh_stage_index(k, noh_stage_actor_of(stage, actor, NULL)), seed);
    return result;
}

noh_result noh_actor_blink(noh_stage *stage, noh_actor actor, noh_error *error)
{
    noh_stage_kind *k;
    noh_result result;
    noh_stage_face *f = noh_stage_change_face(stage, actor, &k, &result, error);
    if (f) noh_face_blink(&f->face);
    return result;
}

noh_result noh_actor_face(const noh_stage *stage, noh_actor actor, noh_face_pose *pose, noh_error *error)
{
    noh_stage_kind *k;
    const noh_stage_actor *a = noh_stage_actor_of(stage, actor, &k);
    NOH_ASSERT(pose);
    if (!a) return noh_stage_gone(error, actor);
    if (!noh_stage_face_kind_of(k)) return noh_fail(error, NOH_ERR_ARG, no_face, 0, 0);
    noh_face_pose_of(&noh_stage_face_of(k, noh_stage_index(k, a))->face, &noh_stage_face_kind_of(k)->desc, pose);
    return NOH_OK;
}
