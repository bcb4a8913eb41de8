/* ragdoll_names.c: bodies of a ragdoll from the pack's table, or from the names of joints. */
#include "core/base/name_internal.h"
#include "core/base/trig_internal.h"
#include "life/physics/ragdoll_rig_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/format.h"
#include "noh/low_life.h"
#include "noh/low_motion.h"
#include "noh/pack.h"

/* A hip is a thigh, and a shoulder an upper arm, if no joint below it is; an arm below an upper arm is a forearm. */
typedef enum part {
    NONE,
    HEAD,
    UPPER_ARM,
    FOREARM,
    HAND,
    THIGH,
    SHIN,
    FOOT,
    PELVIS,
    SPINE,
    CHEST,
    PARTS,
    HIP,
    SHOULDER
} part;

#define DEGREES(a) ((a) * (NOH_PI / 180.0f))

/* Fields as in a row. */
static const struct abilities {
    uint32_t hinge, toward;
    float bend_min, bend_max, side, twist, friction;
} abilities[PARTS] = {
    [HEAD] = { 0, NOH_RAGDOLL_FORWARD, DEGREES(-30.0f), DEGREES(35.0f), DEGREES(30.0f), DEGREES(40.0f), 3.0f },
    [UPPER_ARM] = { 0, NOH_RAGDOLL_FORWARD, DEGREES(-50.0f), DEGREES(90.0f), DEGREES(60.0f), DEGREES(45.0f), 4.0f },
    [FOREARM] = { 1, NOH_RAGDOLL_FORWARD, 0.0f, DEGREES(145.0f), 0.0f, 0.0f, 3.0f },
    [HAND] = { 0, NOH_RAGDOLL_FORWARD, DEGREES(-40.0f), DEGREES(40.0f), DEGREES(20.0f), DEGREES(30.0f), 1.0f },
    [THIGH] = { 0, NOH_RAGDOLL_FORWARD, DEGREES(-20.0f), DEGREES(95.0f), DEGREES(40.0f), DEGREES(30.0f), 5.0f },
    [SHIN] = { 1, NOH_RAGDOLL_BACKWARD, 0.0f, DEGREES(140.0f), 0.0f, 0.0f, 5.0f },
    [FOOT] = { 0, NOH_RAGDOLL_UPWARD, DEGREES(-35.0f), DEGREES(20.0f), DEGREES(15.0f), DEGREES(10.0f), 2.0f },
    [PELVIS] = { 0, NOH_RAGDOLL_FORWARD, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f },
    [SPINE] = { 0, NOH_RAGDOLL_FORWARD, DEGREES(-15.0f), DEGREES(25.0f), DEGREES(15.0f), DEGREES(15.0f), 5.0f },
    [CHEST] = { 0, NOH_RAGDOLL_FORWARD, DEGREES(-15.0f), DEGREES(25.0f), DEGREES(15.0f), DEGREES(15.0f), 5.0f },
};

/* The first word that a name contains, as letters alone: 'upper_arm.L' contains "upperarm". */
static const struct word {
    const char *text;
    part means;
} words[] = {
    { "forearm", FOREARM },    { "lowerarm", FOREARM }, { "lowarm", FOREARM },  { "elbow", FOREARM },
    { "upperarm", UPPER_ARM }, { "uparm", UPPER_ARM },  { "shldr", UPPER_ARM }, { "thigh", THIGH },
    { "upperleg", THIGH },     { "upleg", THIGH },      { "lowerleg", SHIN },   { "lowleg", SHIN },
    { "shin", SHIN },          { "calf", SHIN },        { "knee", SHIN },       { "toe", NONE },
    { "foot", FOOT },          { "ankle", FOOT },       { "finger", NONE },     { "thumb", NONE },
    { "hand", HAND },          { "wrist", HAND },       { "headtop", NONE },    { "head", HEAD },
    { "neck", HEAD },          { "armature", NONE },    { "arm", UPPER_ARM },   { "leg", SHIN },
    { "shoulder", SHOULDER },  { "hip", HIP },
};

/* MikuMikuDance's bones, without their sides, in UTF-8. */
/* clang-format off */
static const struct translation {
    char own[13], english[9];
} translations[] = {
    { "\351\246\226", "neck" },
    { "\351\240\255", "head" },
    { "\343\202\273\343\203\263\343\202\277\343\203\274", "hips" },
    { "\344\270\212\345\215\212\350\272\253", "spine" },
    { "\344\270\212\345\215\212\350\272\253\062", "spine1" },
    { "\344\270\212\345\215\212\350\272\253\063", "spine2" },
    { "\350\202\251", "shoulder" },
    { "\350\205\225", "upperarm" },
    { "\343\201\262\343\201\230", "forearm" },
    { "\346\211\213\351\246\226", "hand" },
    { "\350\266\263", "thigh" },
    { "\343\201\262\343\201\226", "shin" },
    { "\350\266\263\351\246\226", "foot" },
    { "\343\201\244\343\201\276\345\205\210", "toe" },
};
/* clang-format on */

/* Blender has the side behind the name: .L */
static int is_own(const char *name, const char *own)
{
    while (*own && *own == *name) own++, name++;
    return !*own && (!*name || *name == '.' || *name == '_');
}

const char *noh_name_english(const char *name)
{
    const char *own = name;
    if (noh_name_begins(own, NOH_LEFT_IN_JAPANESE) || noh_name_begins(own, NOH_RIGHT_IN_JAPANESE)) own += 3;
    for (size_t i = 0; (unsigned char)*own >= 0x80u && i < sizeof translations / sizeof translations[0]; i++) {
        if (is_own(own, translations[i].own)) return translations[i].english;
    }
    return name;
}

static char lower(char c)
{
    return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

static int is_letter(char c)
{
    return lower(c) >= 'a' && lower(c) <= 'z';
}

/* Whether `name`, from here on and ignoring all but letters, begins with the word. */
static int begins_with(const char *name, const char *word)
{
    while (*word && *name) {
        if (is_letter(*name)) {
            if (lower(*name) != *word) return 0;
            word++;
        }
        name++;
    }
    return !*word;
}

static part part_of(const char *name)
{
    for (size_t w = 0; w < sizeof words / sizeof words[0]; w++) {
        for (const char *at = name; *at; at++) {
            if (is_letter(*at) && begins_with(at, words[w].text)) return words[w].means;
        }
    }
    return NONE;
}

static part name_at(const noh_ragdoll_source *s, uint32_t joint)
{
    return part_of(noh_name_english(noh_pack_joint_name(s->pack, s->skeleton, joint)));
}

/* Whether some joint of kind `below` has this joint as its nearest ancestor among the names `weak` and `means`. So
 * 'Hips' and collar bones named shoulders, which have thighs and upper arms below them, are not limbs; 'L_Hip' over
 * 'L_Knee' is. */
static int is_nearest_above(const noh_ragdoll_source *s, uint32_t joint, part weak, part means, part below)
{
    for (uint32_t i = joint + 1u; i < s->joints.joint_count; i++) {
        uint32_t up = s->joints.parents[i];
        if (name_at(s, i) != below) continue;
        while (up != NOH_JOINT_ROOT && up > joint && name_at(s, up) != weak && name_at(s, up) != means) {
            up = s->joints.parents[up];
        }
        if (up == joint) return 1;
    }
    return 0;
}

/* Whether a joint above this one is of a kind, by what tells the kind of a joint. */
static int is_below(const noh_ragdoll_source *s, uint32_t joint, part (*kind_at)(const noh_ragdoll_source *, uint32_t),
                    part means)
{
    uint32_t up = s->joints.parents[joint];
    while (up != NOH_JOINT_ROOT && kind_at(s, up) != means) up = s->joints.parents[up];
    return up != NOH_JOINT_ROOT;
}

static part part_at(const noh_ragdoll_source *s, uint32_t joint)
{
    const part name = name_at(s, joint);
    if (name == HIP) return is_nearest_above(s, joint, HIP, THIGH, SHIN) ? THIGH : NONE;
    if (name == SHOULDER) return is_nearest_above(s, joint, SHOULDER, UPPER_ARM, FOREARM) ? UPPER_ARM : NONE;
    if (name != UPPER_ARM || !is_below(s, joint, name_at, UPPER_ARM)) return name;
    return is_nearest_above(s, joint, UPPER_ARM, FOREARM, HAND) ? FOREARM : name;
}

/* The topmost joint of its kind in its chain: fingers' names contain "hand" too. */
static int is_first(const noh_ragdoll_source *s, uint32_t joint, part means)
{
    return !is_below(s, joint, part_at, means);
}

/* The lowest common ancestor of all first joints of a kind; NOH_NONE if there are fewer than two. */
static uint32_t where_meet(const noh_ragdoll_source *s, part means)
{
    uint32_t meet = NOH_NONE, count = 0;
    for (uint32_t i = 0; i < s->joints.joint_count; i++) {
        if (part_at(s, i) != means || !is_first(s, i, means)) continue;
        if (!count++) {
            meet = s->joints.parents[i];
            continue;
        }
        while (meet != NOH_NONE && meet != NOH_JOINT_ROOT && !noh_joint_is_above(&s->joints, meet, i)) {
            meet = s->joints.parents[meet];
        }
    }
    return count > 1 && meet != NOH_JOINT_ROOT ? meet : NOH_NONE;
}

/* The lowest joint above both: the pelvis itself, or what it hangs from next to the spine; the pelvis if there is
 * none. */
static uint32_t above_both(const noh_skeleton *k, uint32_t pelvis, uint32_t chest)
{
    uint32_t at = pelvis;
    while (at != NOH_JOINT_ROOT && !noh_joint_is_above(k, at, chest)) at = k->parents[at];
    return at == NOH_JOINT_ROOT ? pelvis : at;
}

/* The child of `from` on the way to `to`. */
static uint32_t next_towards(const noh_skeleton *k, uint32_t from, uint32_t to)
{
    while (k->parents[to] != from) to = k->parents[to];
    return to;
}

typedef struct trunk {
    uint32_t pelvis, spine, chest;
} trunk;

static part part_in(const noh_ragdoll_source *s, const trunk *t, uint32_t joint)
{
    if (joint == t->pelvis) return PELVIS;
    if (joint == t->chest) return CHEST;
    if (joint == t->spine) return SPINE;
    const part means = part_at(s, joint);
    return means != NONE && noh_joint_is_above(&s->joints, t->pelvis, joint) && is_first(s, joint, means) ? means
                                                                                                          : NONE;
}

/* ---- a table in the pack ---- */

/* The first joint with that name; NOH_NONE if the skeleton has none. */
static uint32_t joint_of(const noh_ragdoll_source *s, const noh_pack_ragdoll_row *row)
{
    const char *name = noh_pack_string(s->pack, row->joint);
    for (uint32_t i = 0; i < s->joints.joint_count; i++) {
        if (noh_names_equal(noh_pack_joint_name(s->pack, s->skeleton, i), name)) return i;
    }
    return NOH_NONE;
}

/* The pack's rows by increasing joint. Returns 0 if it has none, or the skeleton lacks a joint. */
static uint32_t rows_of_pack(const noh_ragdoll_source *s, noh_ragdoll_row *rows)
{
    for (uint32_t i = 0; i < s->pack->ragdoll_row_count; i++) {
        const noh_pack_ragdoll_row *from = &s->pack->ragdoll_rows[i];
        const uint32_t joint = joint_of(s, from);
        uint32_t at = i;
        if (joint == NOH_NONE) return 0;
        while (at > 0 && rows[at - 1u].joint > joint) {
            rows[at] = rows[at - 1u];
            at--;
        }
        rows[at] = (noh_ragdoll_row){ joint,          from->hinge, from->toward, from->bend_min,
                                      from->bend_max, from->side,  from->twist,  from->friction };
    }
    return s->pack->ragdoll_row_count;
}

noh_result noh_ragdoll_find_rows(const noh_ragdoll_source *source, noh_ragdoll_row *rows, uint32_t *count,
                                 noh_error *error)
{
    trunk t;
    *count = rows_of_pack(source, rows);
    if (*count) return NOH_OK;
    t = (trunk){ where_meet(source, THIGH), NOH_NONE, where_meet(source, UPPER_ARM) };
    if (t.pelvis != NOH_NONE && t.chest != NOH_NONE) t.pelvis = above_both(&source->joints, t.pelvis, t.chest);
    if (t.pelvis == NOH_NONE) {
        return noh_fail(error, NOH_ERR_NOT_FOUND,
                        "no two joints have the names of thighs: build the pack with --ragdoll FILE", 0, 0);
    }
    if (t.chest != NOH_NONE && (t.chest == t.pelvis || !noh_joint_is_above(&source->joints, t.pelvis, t.chest))) {
        t.chest = NOH_NONE;
    }
    if (t.chest != NOH_NONE) t.spine = next_towards(&source->joints, t.pelvis, t.chest);
    for (uint32_t i = 0; i < source->joints.joint_count && *count < NOH_RAGDOLL_BODIES_MAX; i++) {
        const part means = part_in(source, &t, i);
        if (means != NONE) {
            const struct abilities *a = &abilities[means];
            const noh_ragdoll_row row = { i,           a->hinge, a->toward, a->bend_min,
                                          a->bend_max, a->side,  a->twist,  a->friction };
            rows[(*count)++] = row;
        }
    }
    return NOH_OK;
}

uint32_t noh_ragdoll_row_above(const noh_ragdoll_source *source, const noh_ragdoll_row *rows, uint32_t count,
                               uint32_t joint)
{
    for (uint32_t up = source->joints.parents[joint]; up != NOH_JOINT_ROOT; up = source->joints.parents[up]) {
        for (uint32_t i = 0; i < count; i++) {
            if (rows[i].joint == up) return i;
        }
    }
    return NOH_NONE;
}
