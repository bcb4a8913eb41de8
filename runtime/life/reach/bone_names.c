/* bone_names.c: names of a person's bones in many programs. */
#include <string.h>

#include "life/physics/ragdoll_rig_internal.h"
#include "life/reach/bone_names_internal.h"
#include "noh/low_motion.h"

/* Names of Unity (HumanBodyBones), Mixamo, Unreal and MetaHuman, Character Creator, Daz Genesis, 3ds Max's biped, MPFB
 * and MakeHuman, Rigify. The first key that fits is taken. */
/* clang-format off */
const noh_bone_name noh_bone_names[NOH_BONE_NAMES] = {
    { "hips", "hips pelvis hip ccbasehip" },
    { "spine", "spine spine01 abdomenlower abdomen lowerback ccbasewaist" },
    { "chest", "chest spine02 spine1 chestlower ccbasespine01" },
    { "upperChest", "upperchest spine03 spine2 chestupper ccbasespine02" },
    { "neck", "neck neck01 neck1 necklower ccbasenecktwist01" },
    { "head", "head" },
    { "*Shoulder", "shoulder clavicle collar shoulder01" },
    { "*UpperArm", "upperarm arm shldr shldrbend upperarm01 biceps uparm humerus" },
    { "*LowerArm", "lowerarm forearm forearmbend lowerarm01 elbow lowarm radius" },
    { "*Hand", "hand wrist" },
    { "*UpperLeg", "upperleg upleg thigh thighbend upperleg01 femur" },
    { "*LowerLeg", "lowerleg leg calf shin lowerleg01 knee lowleg tibia" },
    { "*Foot", "foot ankle" },
    { "*Toes", "toes toebase ball toe toe0" },
    { "*ThumbMetacarpal", "thumbmetacarpal handthumb1 thumb01 thumb1 thumbproximal" },
    { "*ThumbProximal", "thumbproximal handthumb2 thumb02 thumb2 thumbintermediate" },
    { "*ThumbDistal", "thumbdistal handthumb3 thumb03 thumb3" },
    { "*IndexProximal", "indexproximal handindex1 index01 index1" },
    { "*IndexIntermediate", "indexintermediate handindex2 index02 index2" },
    { "*IndexDistal", "indexdistal handindex3 index03 index3" },
    { "*MiddleProximal", "middleproximal handmiddle1 middle01 middle1 mid1" },
    { "*MiddleIntermediate", "middleintermediate handmiddle2 middle02 middle2 mid2" },
    { "*MiddleDistal", "middledistal handmiddle3 middle03 middle3 mid3" },
    { "*RingProximal", "ringproximal handring1 ring01 ring1" },
    { "*RingIntermediate", "ringintermediate handring2 ring02 ring2" },
    { "*RingDistal", "ringdistal handring3 ring03 ring3" },
    { "*LittleProximal", "littleproximal handpinky1 pinky01 pinky1" },
    { "*LittleIntermediate", "littleintermediate handpinky2 pinky02 pinky2" },
    { "*LittleDistal", "littledistal handpinky3 pinky03 pinky3" },
};
/* clang-format on */

const char noh_bone_strips[] =
    "mixamorig jbipc jbip jadjc jadj jsec ccbase bip001 bip01 def org valvebipedbip01 character1 "
    "armature genesis8female genesis8male genesis9";

/* ---- keys ---- */

static int is_small(char c)
{
    return c >= 'a' && c <= 'z';
}

static int is_capital(char c)
{
    return c >= 'A' && c <= 'Z';
}

static int is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static int is_in_word(char c)
{
    return is_small(c) || is_capital(c) || is_digit(c) || (unsigned char)c >= 0x80u;
}

/* Without a namespace, the node of "node.target", and the number of a copy. */
static const char *core_of(const char *name, size_t *bytes)
{
    const char *at = name, *end = name, *dot = NULL;
    size_t behind, digits = 0;
    for (; *end; end++) {
        if ((*end == ':' || *end == '|') && end[1]) at = end + 1;
    }
    for (const char *c = at; c < end; c++) dot = *c == '.' ? c : dot;
    *bytes = (size_t)(end - at);
    if (!dot) return at;
    behind = (size_t)(end - dot) - 1u;
    while (is_digit(dot[1u + digits])) digits++;
    if (dot > at && behind == 3u && digits == 3u) {
        *bytes = (size_t)(dot - at);
    } else if (behind > 2u && !digits) {
        *bytes = behind;
        at = dot + 1;
    }
    return at;
}

/* A word ends at a separator, before a capital behind a small letter, and before a capital and a small letter behind a
 * capital: L Eye in LEye. */
static size_t word_length(const char *at, size_t left)
{
    size_t n = 0;
    while (n < left && is_in_word(at[n])) {
        if (n && is_capital(at[n]) && (is_small(at[n - 1]) || (n + 1 < left && is_small(at[n + 1])))) break;
        n++;
    }
    return n;
}

/* The word without a side that it is, or has at one end: what is left of it, from `from`. */
static size_t take_side(const char *word, size_t length, char *side, size_t *from)
{
    static const char words[4][6] = { "left", "right", NOH_LEFT_IN_JAPANESE, NOH_RIGHT_IN_JAPANESE };
    *from = 0;
    if (*side) return length;
    if (length == 1 && (*word == 'l' || *word == 'r')) {
        *side = *word;
        return 0;
    }
    for (size_t i = 0; i < 4; i++) {
        const size_t bytes = i < 2 ? 4u + i : 3u;
        const int first = length >= bytes && memcmp(word, words[i], bytes) == 0;
        const int last = !first && length >= bytes && memcmp(word + length - bytes, words[i], bytes) == 0;
        if (!(first || last) || (length > bytes && length < bytes + 3u)) continue;
        *side = "lr"[i & 1u];
        *from = first ? bytes : 0;
        return length - bytes;
    }
    return length;
}

char noh_name_key(const char *name, char key[NOH_NAME_BYTES_MAX])
{
    size_t left, count = 0;
    const char *at = core_of(name, &left);
    const char *english;
    char side = 0;
    while (left) {
        const size_t length = word_length(at, left);
        if (length && count + length < NOH_NAME_BYTES_MAX - 1u) {
            size_t from, rest;
            for (size_t i = 0; i < length; i++) {
                key[count + i] = is_capital(at[i]) ? (char)(at[i] - 'A' + 'a') : at[i];
            }
            rest = take_side(key + count, length, &side, &from);
            for (size_t i = 0; i < rest; i++) key[count + i] = key[count + from + i];
            count += rest;
        }
        at += length ? length : 1u;
        left -= length ? length : 1u;
    }
    key[count] = '\0';
    english = noh_name_english(key);
    if (english != key) {
        for (count = 0; (key[count] = english[count]) != '\0';) count++;
    }
    return side;
}

/* The bound also keeps compilers from calling strlen, which a game may not have. */
static size_t length_of(const char *key)
{
    size_t n = 0;
    while (n < NOH_NAME_BYTES_MAX && key[n]) n++;
    return n;
}

int noh_name_cut(char *key, const char *part, size_t part_bytes)
{
    const size_t length = length_of(key), rest = length - part_bytes;
    if (!part_bytes || part_bytes >= length) return 0;
    if (memcmp(key, part, part_bytes) == 0) {
        for (size_t i = 0; i <= rest; i++) key[i] = key[part_bytes + i];
        return 1;
    }
    if (memcmp(key + rest, part, part_bytes) != 0) return 0;
    key[rest] = '\0';
    return 1;
}

/* ---- bones ---- */

/* The next of some keys, and behind it. NULL: there is none. */
static const char *next_key(const char *keys, size_t *bytes)
{
    while (*keys == ' ') keys++;
    for (*bytes = 0; keys[*bytes] && keys[*bytes] != ' ';) ++*bytes;
    return *bytes ? keys : NULL;
}

static uint32_t row_of(const char *key, char side)
{
    const size_t length = length_of(key);
    for (uint32_t i = 0; i < NOH_BONE_NAMES; i++) {
        size_t bytes;
        if ((noh_bone_names[i].vrm[0] == '*') != (side != 0)) continue;
        for (const char *own = noh_bone_names[i].keys; (own = next_key(own, &bytes)) != NULL; own += bytes) {
            if (bytes == length && memcmp(own, key, bytes) == 0) return i;
        }
    }
    return NOH_BONE_NAMES;
}

static int strip(char *key)
{
    size_t bytes;
    for (const char *part = noh_bone_strips; (part = next_key(part, &bytes)) != NULL; part += bytes) {
        if (noh_name_cut(key, part, bytes)) return 1;
    }
    return 0;
}

uint32_t noh_bone_of(const char *name)
{
    char key[NOH_NAME_BYTES_MAX];
    const char side = noh_name_key(name, key);
    uint32_t row = row_of(key, side);
    while (row == NOH_BONE_NAMES && strip(key)) row = row_of(key, side);
    if (row == NOH_BONE_NAMES) return NOH_BONES;
    return NOH_BONE_HIPS + row + (side == 'r' ? (uint32_t)NOH_BONE_RIGHT : 0u);
}

static int is_above(const uint16_t *parents, uint32_t above, uint32_t joint)
{
    while (joint != NOH_JOINT_ROOT && joint != above) joint = parents[joint];
    return joint != NOH_JOINT_ROOT;
}

/* Whether a joint is of one side's limb: the other side is known, and none of its bones hang from the joint. */
static int is_own(const uint16_t *parents, uint16_t joint, const uint16_t other[3])
{
    int known = 0;
    for (uint32_t i = 0; i < 3; i++) {
        if (is_above(parents, joint, other[i])) return 0;
        known |= other[i] != NOH_JOINT_ROOT;
    }
    return known && joint != NOH_JOINT_ROOT;
}

/* The middle bone without a name of its own is what the last one hangs from. The first one is as many joints above the
 * middle one as that is above the last; where these are not the limb's, as of a leg above a knee, the middle one was
 * the first. */
static void find_limb(const uint16_t *parents, uint16_t limb[3], const uint16_t other[3])
{
    const uint16_t below = limb[2] == NOH_JOINT_ROOT ? limb[1] : parents[limb[2]];
    if (limb[1] == NOH_JOINT_ROOT && below != NOH_JOINT_ROOT && below != limb[0] &&
        (limb[0] == NOH_JOINT_ROOT ? is_own(parents, below, other) : is_above(parents, limb[0], below))) {
        limb[1] = below;
    }
    if (limb[0] != NOH_JOINT_ROOT || limb[1] == NOH_JOINT_ROOT || !is_above(parents, limb[1], below)) return;
    uint16_t at = parents[limb[1]];
    for (uint16_t joint = below; joint != limb[1] && at != NOH_JOINT_ROOT; joint = parents[joint]) at = parents[at];
    if (is_own(parents, at, other)) {
        limb[0] = at;
    } else if (below != limb[1]) {
        limb[0] = limb[1];
        limb[1] = below;
    }
}

void noh_bones_find_trunk(const uint16_t *parents, uint16_t *bones)
{
    for (uint32_t side = 0; side <= NOH_BONE_RIGHT; side += NOH_BONE_RIGHT) {
        uint16_t *const own = bones + side, *const other = bones + (NOH_BONE_RIGHT - side);
        find_limb(parents, own + NOH_BONE_UPPER_ARM, other + NOH_BONE_UPPER_ARM);
        find_limb(parents, own + NOH_BONE_UPPER_LEG, other + NOH_BONE_UPPER_LEG);
    }
    const uint16_t left = bones[NOH_BONE_UPPER_LEG], right = bones[NOH_BONE_UPPER_LEG + NOH_BONE_RIGHT];
    uint16_t at = left == NOH_JOINT_ROOT || right == NOH_JOINT_ROOT ? NOH_JOINT_ROOT : parents[left];
    while (at != NOH_JOINT_ROOT && !is_above(parents, at, right)) at = parents[at];
    if (at != NOH_JOINT_ROOT && !is_above(parents, bones[NOH_BONE_HIPS], at)) bones[NOH_BONE_HIPS] = at;
    if (bones[NOH_BONE_ROOT] != NOH_JOINT_ROOT || bones[NOH_BONE_HIPS] == NOH_JOINT_ROOT) return;
    for (at = parents[bones[NOH_BONE_HIPS]]; at != NOH_JOINT_ROOT; at = parents[at]) bones[NOH_BONE_ROOT] = at;
}
