#include "wild_text.h"

#include <ctype.h>
#include <string.h>

/* ---- seeds: "text" marks what fuzz_import gives to all readers of texts ---- */

#define BUFFER                                                                                                           \
    "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAM3MTD4AAAAAzczMPc3MTD4AAAAAzcxMPs3MTD4AAAAAmp" \
    "mZPs3MTD4AAAAAAAEAAAABAAAAAQAAAAEAAAAAAD8AAAA/AAAAAAAAAAAAAAA/AAAAPwAAAAAAAAAAAAAAPwAAAD8AAAAAAAAAAAAAAD8AAAA/AAAA" \
    "AAAAAAAAAAEAAgAAAAIAAwAAAAMAAQABAAMAAgAAAIA/AAAAAAAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAA" \
    "AAAAAAAIA/AACAPwAAAAAAAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAAAAAACAPwAAAAAAAIA/AAAAAAAA" \
    "AAAAAAAAAACAPwAAgD8AAIA/AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAMzMzPzMzMz8AAAAAAACAPw=="
#define MODEL                                                                                                                      \
    "\"scene\":0,\"scenes\":[{\"nodes\":[0,2]}],\"nodes\":["                                                                       \
    "{\"name\":\"hips\",\"translation\":[0,1,0],\"children\":[1]},"                                                                \
    "{\"name\":\"head\",\"translation\":[0,0.5,0],\"rotation\":[0,0,0,1],\"scale\":[1,1,1],"                                       \
    "\"extras\":{\"springs\":\"chain head\"}},"                                                                                    \
    "{\"name\":\"body\",\"mesh\":0,\"skin\":0}],"                                                                                  \
    "\"meshes\":[{\"name\":\"m\",\"primitives\":[{\"attributes\":{\"POSITION\":0,\"JOINTS_0\":2,\"WEIGHTS_0\":3},"                 \
    "\"indices\":4,\"material\":0,\"targets\":[{\"POSITION\":1}]}],\"weights\":[0.25],"                                            \
    "\"extras\":{\"targetNames\":[\"smile\"],\"recipe\":[\"joy-mouth smile 0.9\"]}}],"                                             \
    "\"skins\":[{\"joints\":[0,1],\"inverseBindMatrices\":5,\"skeleton\":0}],"                                                     \
    "\"animations\":[{\"name\":\"a\",\"samplers\":[{\"input\":6,\"output\":7,\"interpolation\":\"LINEAR\"},"                       \
    "{\"input\":6,\"output\":8,\"interpolation\":\"STEP\"},{\"input\":6,\"output\":9}],"                                           \
    "\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,\"path\":\"translation\"}},"                                              \
    "{\"sampler\":1,\"target\":{\"node\":1,\"path\":\"rotation\"}},{\"sampler\":2,\"target\":{\"node\":2,\"path\":\"weights\"}}]," \
    "\"extras\":{\"loop\":true,\"events\":[{\"time\":0.5,\"name\":\"step\",\"payload\":7,\"weightMin\":0.1}]}}],"                  \
    "\"materials\":[{\"name\":\"skin\",\"alphaMode\":\"MASK\",\"alphaCutoff\":0.5,\"doubleSided\":true,"                           \
    "\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,0.5,0.5,1],\"metallicFactor\":0,\"roughnessFactor\":0.5}}],"                 \
    "\"buffers\":[{\"byteLength\":400,\"uri\":\"data:application/octet-stream;base64," BUFFER "\"}],"                              \
    "\"bufferViews\":[{\"buffer\":0,\"byteOffset\":0,\"byteLength\":400},{\"buffer\":0,\"byteOffset\":112,"                        \
    "\"byteLength\":64,\"byteStride\":16}],"                                                                                       \
    "\"accessors\":["                                                                                                              \
    "{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,1]},"                     \
    "{\"bufferView\":0,\"byteOffset\":48,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"sparse\":{\"count\":1,"            \
    "\"indices\":{\"bufferView\":0,\"byteOffset\":176,\"componentType\":5123},\"values\":{\"bufferView\":0,\"byteOffset\":12}}},"  \
    "{\"bufferView\":0,\"byteOffset\":96,\"componentType\":5121,\"count\":4,\"type\":\"VEC4\"},"                                   \
    "{\"bufferView\":1,\"componentType\":5126,\"count\":4,\"type\":\"VEC4\"},"                                                     \
    "{\"bufferView\":0,\"byteOffset\":176,\"componentType\":5123,\"count\":12,\"type\":\"SCALAR\"},"                               \
    "{\"bufferView\":0,\"byteOffset\":200,\"componentType\":5126,\"count\":2,\"type\":\"MAT4\"},"                                  \
    "{\"bufferView\":0,\"byteOffset\":328,\"componentType\":5126,\"count\":2,\"type\":\"SCALAR\",\"min\":[0],\"max\":[1]},"        \
    "{\"bufferView\":0,\"byteOffset\":336,\"componentType\":5126,\"count\":2,\"type\":\"VEC3\"},"                                  \
    "{\"bufferView\":0,\"byteOffset\":360,\"componentType\":5126,\"count\":2,\"type\":\"VEC4\"},"                                  \
    "{\"bufferView\":0,\"byteOffset\":392,\"componentType\":5126,\"count\":2,\"type\":\"SCALAR\"}]"
#define VRM                                                                                                              \
    ",\"extensionsUsed\":[\"VRMC_vrm\",\"VRMC_springBone\"],\"extensions\":{\"VRMC_vrm\":{\"specVersion\":\"1.0\","      \
    "\"meta\":{\"name\":\"x\"},\"humanoid\":{\"humanBones\":{\"hips\":{\"node\":0},\"head\":{\"node\":1}}},"             \
    "\"lookAt\":{\"type\":\"expression\",\"offsetFromHeadBone\":[0,0.1,0],\"rangeMapHorizontalOuter\":"                  \
    "{\"inputMaxValue\":90,\"outputScale\":10}},\"expressions\":{\"preset\":{\"happy\":{\"isBinary\":true,"              \
    "\"overrideBlink\":\"block\",\"morphTargetBinds\":[{\"node\":2,\"index\":0,\"weight\":1}]}}}},"                      \
    "\"VRMC_springBone\":{\"specVersion\":\"1.0\",\"colliders\":[{\"node\":1,\"shape\":{\"sphere\":{\"offset\":[0,0,0]," \
    "\"radius\":0.1}}},{\"node\":0,\"shape\":{\"capsule\":{\"offset\":[0,0,0],\"radius\":0.1,\"tail\":[0,1,0]}}}],"      \
    "\"colliderGroups\":[{\"name\":\"g\",\"colliders\":[0,1]}],\"springs\":[{\"name\":\"s\",\"joints\":[{\"node\":0,"    \
    "\"hitRadius\":0.02,\"stiffness\":1,\"gravityPower\":0.5,\"gravityDir\":[0,-1,0],\"dragForce\":0.5},{\"node\":1}],"  \
    "\"colliderGroups\":[0]}]}}"

const wild_seed wild_seeds[] = {
    { "gltf", "{\"asset\":{\"version\":\"2.0\"}," MODEL "}" },
    { "vrm", "{\"asset\":{\"version\":\"2.0\"}," MODEL VRM "}" },
    { "bvh", "HIERARCHY\nROOT hips\n{\n OFFSET 0 0 0\n CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation "
             "Yrotation\n JOINT chest\n {\n  OFFSET 0 10 0\n  CHANNELS 3 Zrotation Xrotation Yrotation\n  End Site\n  "
             "{\n   OFFSET 0 5 0\n  }\n }\n}\nMOTION\nFrames: 3\nFrame Time: 0.033333\n0 90 0 0 0 0 1 2 3\n0 90 5 0 4 "
             "0 0 0 0\n0 90 10 0 8 0 -1 -2 -3\n" },
    { "obj",
      "o box\nmtllib none.mtl\nv 0 0 0\nv 1 0 0 0.5 0.5 0.5\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 1\nvt 0 0\nvt 1 0\nvt 1 "
      "1\nvn 0 0 1\nvn 0 1 0\ng side\nusemtl skin\ns 1\nf 1/1/1 2/2/1 3/3/1 4/1/1\nf 1//2 2//2 5//2\nf -1 -2 -3\nl 1 2\n" },
    { "csv", "Timecode,BlendShapeCount,EyeBlinkLeft,EyeBlinkRight,JawOpen\n10:30:00:00.000,3,0.012,0.011,0.250\n"
             "10:30:00:01.000,3,0.5,,1.0\n10:30:00:02.000,3,0,0,0\n" },
    { "trc",
      "PathFileType\t4\t(X/Y/Z)\ta.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\t"
      "OrigDataStartFrame\tOrigNumFrames\n100\t100\t3\t2\tmm\t100\t1\t3\nFrame#\tTime\tA\t\t\tB\t\t\n\t\tX1\tY1\tZ1\tX2"
      "\tY2\tZ2\n\n1\t0.00\t1\t2\t3\t4\t5\t6\n2\t0.01\t1.5\t2\t3\t\t\t\n3\t0.02\t2\t2\t3\t4\t5\t7\n" },
    { "events",
      "textwalk 0.00 left marker\nwalk 0.53 right marker\nwalk 0.02 step 1 min=0.25\n\"wave hand\" 1.5 sound 0xff\n"
      "walk 0.1 x 1.5e3\n" },
    { "graph",
      "textgraph hero\nnumber speed 0 6 initial=1\ninteger n 0 3\nenum mood calm wild initial=calm\ntrigger wave\n"
      "mask arms floats=0.5\n below chest weight=0.5\n joint hand\nclip stand idle\nclip walk sync=legs\nclip run "
      "sync=legs speed=1.5 start=0.1\nclip dance loop=ping-pong\nclip greet wave loop=once\nspace move stand 0 walk "
      "1.5 run 5 by=speed\nlayer both move dance mask=arms by=0.5\none-shot body both greet on=wave in=0.2 out=0.4 "
      "curve=smooth\n" },
    { "graph machine",
      "textgraph m\nnumber speed 0 6\ntrigger jump\nclip a\nclip b\nclip c loop=once\nclip d\nadd e c d "
      "by=speed reference=a\nmachine s a b e\nfrom a to b when speed above 1 fade=0.2\nfrom any to e when "
      "jump inertia=0.1 enter=keep\nfrom e to a when ending\n" },
    { "recipe",
      "textblink lidsClosed\naa jaw 0.8\naa \"lips wide\" 0.2\njoy-mouth grin 0.9\noverride joy-upper lids "
      "block\nbinary joy-upper\nexpression a b 0.5\nbinary a\njoint-head Head\ncorrective a b 0.5 c\nrange a -1 1\noppose a b\nshare a b c\nwrinkle "
      "a 3 0.5\n" },
    { "springs", "textcollider thigh* 0.09  0 0 0  0 -0.35 0\nchain skirt* stiffness 0.8 drag 0.3 gravity 0.4 radius "
                 "0.02\nchain ponytail1 to ponytail4 stiffness 0.3 end 0 1 0 hits head\n" },
    { "ragdoll",
      "textHips\nLeftUpLeg forward bend -20 95 side 40 twist 30 friction 5\nLeftLeg hinge backward bend 0 140 "
      "friction 5\nLeftFoot upward bend -35 20 side 15 twist 10 friction 2\n" },
    { "hair",
      "textjoint head\nskull 0 1.62 0 0.08 0.11 0.10\nhairline 40 80 110\ncomb 0 -0.5 -0.85\nlength 0.35 0.3\nlift "
      "0.012\naround 20\nrows 4\npoints 14\nstrips 200\nsegments 24\nwidth 0.004 0.003\ncurl 0.01 2\nscatter "
      "0.006\nroot 0.1 0.1 0.1\ngloss 1\npull 0.05 0.01\ndamping 3\nsphere 0 1.5 0 0.1\nseed 1\n" },
    { "place",
      "textarea 10 8 -10 -8\nagents 0.3 0.5 1.5\nwall -3 -2 3 -2 0.4\npost 8 3 0.6\nstep -9 -7 -6 -5 0.3\nspawn -9 "
      "-7 9 7\ngoal -7 0 2\ngoal 7 0\nneed rest 0.05\nneed fun 0.1\nobject bench rest 0.5 30\nslot -2 -3 180 15 "
      "sit\nslot 0 -3 90\nobject \"the drum\" fun 0.5 20\nslot 8 5 -90 2.5 dance bow 1.5 - 0.25\n" },
};
const size_t wild_seed_count = sizeof wild_seeds / sizeof *wild_seeds;

/* ---- tokens ---- */

#define TOKENS_MAX 4096u

typedef enum token_kind { NUMBER, WORD, QUOTED, OPEN, CLOSE, LINE_END, OTHER } token_kind;

typedef struct token {
    size_t at, count;
    token_kind kind;
} token;

typedef struct draft {
    char *text;
    size_t count, room;
    token tokens[TOKENS_MAX];
    size_t token_count;
    uint32_t state;
    int json;
} draft;

static uint32_t draw(draft *d, uint32_t below)
{
    d->state = d->state * 1664525u + 1013904223u; /* Knuth 3.3.4: the high bits are random */
    return (uint32_t)((uint64_t)(d->state >> 8) * below >> 24);
}

static int is_word(char c)
{
    return isalnum((unsigned char)c) || c == '_' || c == '-' || c == '+' || c == '.' || c == '*';
}

static int is_number(const char *s, size_t n)
{
    size_t i = n && (s[0] == '-' || s[0] == '+');
    return i < n && (isdigit((unsigned char)s[i]) || (s[i] == '.' && i + 1u < n && isdigit((unsigned char)s[i + 1u])));
}

static size_t token_end(const draft *d, size_t at, token_kind *kind)
{
    const char c = d->text[at];
    size_t end = at + 1u;
    *kind = c == '{' || c == '[' ? OPEN : c == '}' || c == ']' ? CLOSE : c == '\n' ? LINE_END : OTHER;
    if (c == '"') {
        while (end < d->count && d->text[end] != '"' && d->text[end] != '\n') end++;
        *kind = QUOTED;
        return end < d->count ? end + 1u : end;
    }
    if (!is_word(c)) return end;
    while (end < d->count && is_word(d->text[end])) end++;
    *kind = is_number(d->text + at, end - at) ? NUMBER : WORD;
    return end;
}

static void split(draft *d)
{
    d->token_count = 0;
    for (size_t at = 0; at < d->count && d->token_count < TOKENS_MAX;) {
        token_kind kind;
        const size_t end = token_end(d, at, &kind);
        if (kind != OTHER) d->tokens[d->token_count++] = (token){ at, end - at, kind };
        at = end;
    }
}

/* A random token of a kind; NULL: there is none. */
static const token *pick(draft *d, token_kind kind)
{
    size_t count = 0, which;
    for (size_t i = 0; i < d->token_count; i++) count += d->tokens[i].kind == kind;
    if (!count) return NULL;
    which = draw(d, (uint32_t)count);
    for (size_t i = 0;; i++) {
        if (d->tokens[i].kind == kind && which-- == 0) return &d->tokens[i];
    }
}

/* ---- edits ---- */

static void replace(draft *d, size_t at, size_t count, const char *with, size_t length)
{
    if (d->count - count + length > d->room) return;
    memmove(d->text + at + length, d->text + at + count, d->count - at - count);
    memcpy(d->text + at, with, length);
    d->count += length - count;
}

/* The same, by a part of the text itself. */
static void replace_by(draft *d, size_t at, size_t count, size_t from, size_t length)
{
    static char part[1u << 16];
    if (length > sizeof part) return;
    memcpy(part, d->text + from, length);
    replace(d, at, count, part, length);
}

static void wild_number(draft *d)
{
    static const char *const numbers[] = {
        "0", "-0", "1", "-1", "2", "3", "4", "5", "7", "8", "15", "16", "17", "31", "64", "127", "128", "255", "256",
        "257", "1000", "4096", "32767", "32768", "65535", "65536", "65537", "1000000", "16777215", "16777217",
        "2147483647", "2147483648", "-2147483648", "-2147483649", "4294967295", "4294967296", "-4294967296",
        "9007199254740993", "9223372036854775807", "9223372036854775808", "18446744073709551615",
        "18446744073709551616", "1e-46", "1e-38", "-1e-20", "0.5", "-0.5", "0.9999999", "1.0000001", "1e10", "-1e10",
        "1e20", "3.4e38", "-3.4e38", "1e39", "1e308", "-1e308", "1e-320", "5121", "5123", "5125", "5126",
        /* not in JSON */
        "nan", "inf", "-inf", "1e999", "0x7fffffff", "1e", "-", ".", "+1", "00012", "1,5"
    };
    const uint32_t count = sizeof numbers / sizeof *numbers - (d->json ? 11u : 0u);
    const token *t = pick(d, NUMBER);
    const char *with = numbers[draw(d, count)];
    if (t) replace(d, t->at, t->count, with, strlen(with));
}

/* By another token of the same kind, or, where the file is no JSON, of any. */
static void other_token(draft *d, token_kind kind)
{
    const token *t = pick(d, kind), *u = pick(d, !d->json && draw(d, 4) == 0 ? NUMBER : kind);
    if (t && u) replace_by(d, t->at, t->count, u->at, u->count);
}

static void long_word(draft *d)
{
    static const uint32_t lengths[] = { 15, 31, 32, 63, 64, 127, 255, 256, 1000, 5000 };
    char word[5000];
    const token *t = pick(d, d->json ? QUOTED : WORD);
    const uint32_t length = lengths[draw(d, 10)];
    memset(word, 'a' + (int)draw(d, 26), sizeof word);
    if (t && d->json) replace(d, t->at + 1u, t->count > 2u ? t->count - 2u : 0, word, length);
    if (t && !d->json) replace(d, t->at, t->count, word, length);
}

/* A group in brackets, with them. */
static int pick_group(draft *d, size_t *at, size_t *count)
{
    const token *t = pick(d, OPEN);
    int depth = 0;
    if (!t) return 0;
    *at = t->at;
    for (; t < d->tokens + d->token_count; t++) {
        depth += t->kind == OPEN ? 1 : t->kind == CLOSE ? -1 : 0;
        *count = t->at + 1u - *at;
        if (depth == 0) return 1;
    }
    return 0;
}

/* A group takes the place of another, or of a number, or becomes empty. */
static void move_group(draft *d)
{
    static const char *const empty[] = { "{}", "[]", "null", "true", "0", "\"\"" };
    size_t at, count, from, length;
    const token *t = pick(d, NUMBER);
    if (!pick_group(d, &at, &count) || !pick_group(d, &from, &length)) return;
    switch (draw(d, 4)) {
    case 0: {
        const char *with = empty[draw(d, 6)];
        replace(d, at, count, with, strlen(with));
        break;
    }
    case 1:
        if (t) replace_by(d, t->at, t->count, from, length);
        break;
    default: replace_by(d, at, count, from, length); break;
    }
}

static void pick_line(draft *d, size_t *at, size_t *count)
{
    const token *t = pick(d, LINE_END);
    size_t begin = t ? t->at : 0;
    while (begin && d->text[begin - 1u] != '\n') begin--;
    *at = begin;
    *count = t ? t->at + 1u - begin : 0;
}

static void move_line(draft *d)
{
    size_t at, count, from, length;
    pick_line(d, &at, &count);
    pick_line(d, &from, &length);
    switch (draw(d, 4)) {
    case 0: replace(d, at, count, "", 0); break;
    case 1: replace_by(d, at, count, from, length); break;
    case 2: replace_by(d, at, 0, from, length); break;
    default:
        for (uint32_t i = draw(d, 10) ? draw(d, 4) : draw(d, 400); i; i--) replace_by(d, at, 0, at, count);
    }
}

static void drop_token(draft *d)
{
    static const token_kind kinds[] = { NUMBER, WORD, QUOTED, OPEN, CLOSE };
    const token *t = pick(d, kinds[draw(d, 5)]);
    if (t) replace(d, t->at, t->count, "", 0);
}

size_t wild_text(char *text, size_t count, size_t room, uint32_t seed)
{
    static draft d;
    d.text = text;
    d.count = count;
    d.room = room;
    d.state = seed * 2654435769u + 1u;
    d.json = count && text[0] == '{';
    for (uint32_t edits = 1u + draw(&d, 4); edits; edits--) {
        split(&d);
        switch (draw(&d, 8)) {
        case 0: other_token(&d, d.json ? QUOTED : WORD); break;
        case 1: other_token(&d, NUMBER); break;
        case 2: long_word(&d); break;
        case 3:
        case 4:
            if (d.json)
                move_group(&d);
            else if (draw(&d, 4))
                move_line(&d);
            else
                drop_token(&d);
            break;
        default: wild_number(&d); break;
        }
    }
    return d.count;
}
