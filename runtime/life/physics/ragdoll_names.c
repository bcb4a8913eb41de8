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

/* The first word that a name has (noh_name_has); first what is worn or carried. */
static const struct word {
    const char *text;
    part means;
} words[] = {
    { "bag", NONE },          { "pad", NONE },           { "armor", NONE },         { "forearm", FOREARM },
    { "lowerarm", FOREARM },  { "lowarm", FOREARM },     { "elbow", FOREARM },      { "upperarm", UPPER_ARM },
    { "uparm", UPPER_ARM },   { "shldr", UPPER_ARM },    { "thigh", THIGH },        { "upperleg", THIGH },
    { "upleg", THIGH },       { "lowerleg", SHIN },      { "lowleg", SHIN },        { "hippart", NONE },
    { "shoulderpart", NONE }, { "shin", SHIN },          { "calf", SHIN },          { "knee", SHIN },
    { "toe", NONE },          { "foot", FOOT },          { "ankle", FOOT },         { "finger", NONE },
    { "thumb", NONE },        { "hand", HAND },          { "wrist", HAND },         { "headtop", NONE },
    { "forehead", NONE },     { "head", HEAD },          { "neck", HEAD },          { "arm", UPPER_ARM },
    { "radius", FOREARM },    { "leg", SHIN },           { "shoulder", SHOULDER },  { "hip", HIP },
    { "femur", THIGH },       { "tibia", SHIN },         { "humerus", UPPER_ARM },  { "oberarm", UPPER_ARM },
    { "unterarm", FOREARM },  { "oberschenkel", THIGH }, { "unterschenkel", SHIN }, { "fuss", FOOT },
    { "hals", HEAD },         { "kopf", HEAD },
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

/* Blender has the side behind the name: .L; digits may have the width of a Japanese letter. */
static int is_own(const char *name, const char *own)
{
    for (; *own; own++, name++) {
        if (noh_name_begins(name, "\357\274") && name[2] - *own == '\220' - '0')
            name += 2;
        else if (*own != *name)
            break;
    }
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

static part part_of(const char *name)
{
    size_t w = 0;
    while (w < sizeof words / sizeof words[0] && !noh_name_has(name, words[w].text)) w++;
    return w < sizeof words / sizeof words[0] ? words[w].means : NONE;
}

/* The parts of all joints, two of them in a byte. */
typedef struct part_list {
    const noh_skeleton *joints;
    uint32_t present; /* bits of parts: of some joint */
    uint8_t halves[NOH_JOINTS_MAX / 2u];
} part_list;

static part part_at(const part_list *p, uint32_t joint)
{
    return (part)(p->halves[joint / 2u] >> (joint & 1u) * 4u & 15u);
}

static void set_part(part_list *p, uint32_t joint, part means)
{
    const uint32_t shift = (joint & 1u) * 4u;
    p->halves[joint / 2u] = (uint8_t)((p->halves[joint / 2u] & 15u << (4u - shift)) | (uint32_t)means << shift);
    p->present |= 1u << means;
}

/* The nearest joint above this one that is one of two parts, or NOH_JOINT_ROOT. */
static uint32_t nearest_above(const part_list *p, uint32_t joint, part a, part b)
{
    uint32_t up = p->joints->parents[joint];
    while (up != NOH_JOINT_ROOT && part_at(p, up) != a && part_at(p, up) != b) up = p->joints->parents[up];
    return up;
}

/* Joints named `weak` mean `means` if they are the nearest joint of both above one that means `below`. So 'Hips' and
 * collar bones named shoulders, which have thighs and upper arms below them, are not limbs; 'L_Hip' over 'L_Knee'
 * is. */
static void decide(part_list *p, part weak, part means, part below)
{
    for (uint32_t i = 0; i < p->joints->joint_count; i++) {
        const uint32_t up = part_at(p, i) == below ? nearest_above(p, i, weak, means) : NOH_JOINT_ROOT;
        if (up != NOH_JOINT_ROOT && part_at(p, up) == weak) set_part(p, up, means);
    }
    for (uint32_t i = 0; i < p->joints->joint_count; i++) {
        if (part_at(p, i) == weak) set_part(p, i, NONE);
    }
}

/* An arm below an arm and above a hand is a forearm. */
static void decide_forearms(part_list *p)
{
    for (uint32_t i = 0; i < p->joints->joint_count; i++) {
        const uint32_t up = part_at(p, i) == HAND ? nearest_above(p, i, UPPER_ARM, FOREARM) : NOH_JOINT_ROOT;
        if (up != NOH_JOINT_ROOT && nearest_above(p, up, UPPER_ARM, UPPER_ARM) != NOH_JOINT_ROOT) {
            set_part(p, up, FOREARM);
        }
    }
}

static int has_child(const noh_skeleton *k, uint32_t joint)
{
    uint32_t i = joint + 1u;
    while (i < k->joint_count && k->parents[i] != joint) i++;
    return i < k->joint_count;
}

/* Limbs whose joints have one name: arm, arm, arm. A leg and a knee are both shins by name. */
static void divide(part_list *p, part name, part first, part third)
{
    const part second = (part)(first + 1);
    const uint32_t thirds = p->present >> third & 1u;
    for (uint32_t i = 0; i < p->joints->joint_count; i++) {
        const uint32_t up = part_at(p, i) == name ? nearest_above(p, i, name, second) : NOH_JOINT_ROOT;
        if (up == NOH_JOINT_ROOT || nearest_above(p, i, third, third) != NOH_JOINT_ROOT) continue;
        if (part_at(p, up) == name && (name == first || nearest_above(p, up, first, first) == NOH_JOINT_ROOT)) {
            if (!has_child(p->joints, i)) continue;
            set_part(p, up, first);
            set_part(p, i, second);
        } else if (!thirds) {
            set_part(p, i, third);
        }
    }
}

static void find_parts(const noh_ragdoll_source *s, part_list *p)
{
    p->joints = &s->joints;
    p->present = 0;
    for (uint32_t i = 0; i < s->joints.joint_count; i++) {
        set_part(p, i, part_of(noh_name_english(noh_pack_joint_name(s->pack, s->skeleton, i))));
    }
    decide(p, HIP, THIGH, SHIN);
    decide(p, SHOULDER, UPPER_ARM, FOREARM);
    decide_forearms(p);
    if (!(p->present >> THIGH & 1u)) divide(p, SHIN, THIGH, FOOT);
    if (!(p->present & (1u << FOREARM | 1u << HAND))) divide(p, UPPER_ARM, UPPER_ARM, HAND);
}

/* The topmost joint of its kind in its chain: fingers' names contain "hand" too. */
static int is_first(const part_list *p, uint32_t joint, part means)
{
    return nearest_above(p, joint, means, means) == NOH_JOINT_ROOT;
}

/* The lowest common ancestor of all first joints of a kind; NOH_NONE if there are fewer than two. */
static uint32_t where_meet(const part_list *p, part means)
{
    uint32_t meet = NOH_NONE, count = 0;
    for (uint32_t i = 0; i < p->joints->joint_count; i++) {
        if (part_at(p, i) != means || !is_first(p, i, means)) continue;
        if (!count++) {
            meet = p->joints->parents[i];
            continue;
        }
        while (meet != NOH_NONE && meet != NOH_JOINT_ROOT && !noh_joint_is_above(p->joints, meet, i)) {
            meet = p->joints->parents[meet];
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

/* The trunk's joints have other names: arms of 3ds Max's biped begin at its neck, which a head is below. */
static void set_trunk(part_list *p, uint32_t pelvis, uint32_t spine, uint32_t chest)
{
    for (uint32_t up = pelvis; up != NOH_JOINT_ROOT; up = p->joints->parents[up]) set_part(p, up, NONE);
    if (spine != NOH_NONE) set_part(p, spine, SPINE);
    if (chest != NOH_NONE) set_part(p, chest, CHEST);
    set_part(p, pelvis, PELVIS);
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
    const noh_skeleton *k = &source->joints;
    uint32_t pelvis, spine = NOH_NONE, chest;
    part_list parts;
    *count = rows_of_pack(source, rows);
    if (*count) return NOH_OK;
    find_parts(source, &parts);
    pelvis = where_meet(&parts, THIGH);
    chest = where_meet(&parts, UPPER_ARM);
    if (pelvis != NOH_NONE && chest != NOH_NONE) pelvis = above_both(k, pelvis, chest);
    if (pelvis == NOH_NONE) {
        return noh_fail(error, NOH_ERR_NOT_FOUND,
                        "no two joints have the names of thighs: build the pack with --ragdoll FILE", 0, 0);
    }
    if (chest != NOH_NONE && (chest == pelvis || !noh_joint_is_above(k, pelvis, chest))) chest = NOH_NONE;
    if (chest != NOH_NONE) spine = next_towards(k, pelvis, chest);
    set_trunk(&parts, pelvis, spine, chest);
    for (uint32_t i = pelvis; i < k->joint_count && *count < NOH_RAGDOLL_BODIES_MAX; i++) {
        const part means = part_at(&parts, i);
        if (means != NONE && noh_joint_is_above(k, pelvis, i) && is_first(&parts, i, means)) {
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
