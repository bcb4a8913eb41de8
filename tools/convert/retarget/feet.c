#include "feet.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/clips/raw_set.h"
#include "convert/mocap/track.h"

enum { SOURCE, TARGET };

#define STRIDE_LEAST 0.25 /* of a leg's length: slides are shares of strides that are at least so long */
#define GOES_SHARE 0.15 /* of a leg's length: a foot that goes so far while in contact does not stand */
#define LET_GO_S 0.2    /* that a foot takes from where it stood to where it swings */
#define BENT 0.26       /* sine of a bend that has a side */
#define AGAINST 0.087   /* sine of 5 degrees */

/* Places of both clips in all frames. */
typedef struct places {
    double *at[2]; /* [frames][NOH_BONES][3] */
    double *rest[2];
    uint8_t *down[2]; /* [frames] a foot, left and right, stands */
    uint32_t frames;
} places;

static uint16_t joint_of(const retarget_pair *p, int which, uint32_t bone)
{
    return p->bones[which][bone];
}

static int is_common(const retarget_pair *p, uint32_t bone)
{
    return joint_of(p, SOURCE, bone) != NOH_JOINT_ROOT && joint_of(p, TARGET, bone) != NOH_JOINT_ROOT;
}

static void keep(const retarget_pair *p, int which, const double *pose, double *out)
{
    for (uint32_t b = 0; b < NOH_BONES; b++) {
        const uint16_t joint = joint_of(p, which, b);
        if (joint != NOH_JOINT_ROOT) memcpy(out + 3u * b, pose + 12u * (size_t)joint + 9u, 3u * sizeof *out);
    }
}

static void places_free(places *x)
{
    for (int i = 0; i < 2; i++) {
        free(x->at[i]);
        free(x->rest[i]);
        free(x->down[i]);
    }
}

static int places_of_clip(const retarget_pair *p, int which, places *x)
{
    const raw_skeleton *s = p->skeletons[which];
    double *pose = malloc((size_t)s->joint_count * 12u * sizeof *pose);
    x->at[which] = calloc((size_t)x->frames * NOH_BONES, 3u * sizeof *x->at[which]);
    x->rest[which] = calloc(NOH_BONES, 3u * sizeof *x->rest[which]);
    x->down[which] = calloc(x->frames, 1);
    if (!pose || !x->at[which] || !x->rest[which] || !x->down[which]) {
        free(pose);
        return 1;
    }
    raw_pose_object(s, NULL, 0, pose);
    keep(p, which, pose, x->rest[which]);
    for (uint32_t f = 0; f < x->frames && p->clips[which]; f++) {
        raw_pose_object(s, p->clips[which], f, pose);
        keep(p, which, pose, x->at[which] + (size_t)f * NOH_BONES * 3u);
    }
    free(pose);
    return 0;
}

static const double *place(const places *x, int which, uint32_t frame, uint32_t bone)
{
    return x->at[which] + ((size_t)frame * NOH_BONES + bone) * 3u;
}

static double distance(const double *a, const double *b, int flat)
{
    const double d[3] = { a[0] - b[0], flat ? 0.0 : a[1] - b[1], a[2] - b[2] };
    return sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
}

static double rest_length(const places *x, int which, uint32_t upper)
{
    const double *r = x->rest[which] + 3u * upper;
    return distance(r, r + 3, 0) + distance(r + 3, r + 6, 0);
}

/* ---- standing ---- */

static int is_of(const raw_skeleton *s, uint32_t above, uint32_t joint)
{
    while (joint != MODEL_NONE && joint != above) joint = s->joints[joint].parent;
    return joint == above;
}

/* Whether a foot of the source stands in a frame, as contacts.h has it. */
static int is_in_contact(const retarget_pair *p, uint32_t side, uint32_t frame)
{
    const uint16_t foot = joint_of(p, SOURCE, NOH_BONE_FOOT + side * NOH_BONE_RIGHT);
    for (uint32_t i = 0; p->stands && foot != NOH_JOINT_ROOT && i < contacts_feet(p->stands); i++) {
        const uint32_t joint = contacts_joint(p->stands, i);
        const int own = is_of(p->skeletons[SOURCE], foot, joint) || is_of(p->skeletons[SOURCE], joint, foot);
        if (own && contacts_stands(p->stands, i, frame)) return 1;
    }
    return 0;
}

/* The bone of a foot that is held: the toes, or the foot where one figure has no toes. */
static uint32_t held(const retarget_pair *p, uint32_t side)
{
    const uint32_t toes = NOH_BONE_TOES + side * NOH_BONE_RIGHT;
    return is_common(p, toes) ? toes : NOH_BONE_FOOT + side * NOH_BONE_RIGHT;
}

/* Frames in which a foot stands in one place: in clips that walk on the spot, feet in contact go back. */
static void find_down(const retarget_pair *p, uint32_t side, places *x)
{
    const double most = GOES_SHARE * rest_length(x, SOURCE, NOH_BONE_UPPER_LEG + side * NOH_BONE_RIGHT);
    const uint32_t bone = held(p, side);
    for (uint32_t first = 0, end; first < x->frames; first = end) {
        const int is_down = is_in_contact(p, side, first);
        for (end = first + 1u; end < x->frames && is_in_contact(p, side, end) == is_down;) end++;
        if (is_down && distance(place(x, SOURCE, first, bone), place(x, SOURCE, end - 1u, bone), 1) < most) {
            memset(x->down[side] + first, 1, end - first);
        }
    }
}

static int places_make(const retarget_pair *p, places *x)
{
    memset(x, 0, sizeof *x);
    x->frames = p->clips[SOURCE]->frame_count;
    if (places_of_clip(p, SOURCE, x) || places_of_clip(p, TARGET, x)) {
        places_free(x);
        return 1;
    }
    for (uint32_t side = 0; side < 2; side++) find_down(p, side, x);
    return 0;
}

/* Heights of feet over where they rest, in all frames or in those in which they stand. Returns their count. */
static uint32_t heights_of_feet(const retarget_pair *pair, const places *x, int standing, double *heights)
{
    uint32_t count = 0;
    for (uint32_t side = 0; side < 2; side++) {
        const uint32_t bone = held(pair, side);
        for (uint32_t f = 0; f < x->frames && is_common(pair, bone); f++) {
            if (standing && !x->down[side][f]) continue;
            heights[count++] = place(x, SOURCE, f, bone)[1] - x->rest[SOURCE][3u * bone + 1u];
        }
    }
    return count;
}

int feet_ground(const retarget_pair *pair, double *ground)
{
    places x;
    double *heights;
    uint32_t count;
    *ground = 0.0;
    if (places_make(pair, &x)) return 1;
    heights = malloc(2u * (size_t)x.frames * sizeof *heights);
    count = heights ? heights_of_feet(pair, &x, 1, heights) : 0;
    if (count) {
        *ground = mocap_rank(heights, count, count / 5u);                    /* rather low: heels go up */
    } else if (heights && (count = heights_of_feet(pair, &x, 0, heights))) { /* in the air, but not below the ground */
        *ground = fmin(0.0, mocap_rank(heights, count, count / 20u));
    }
    places_free(&x);
    free(heights);
    return !heights;
}

/* ---- locks ---- */

/* Offsets of one foot in frames [first, end), in which it stands. At an end of the clip it stays where it is there, so
 * that a loop goes on. */
static void hold(const places *x, uint32_t bone, uint32_t side, uint32_t first, uint32_t end, float (*out)[2][3])
{
    double anchor[3] = { 0.0, 0.0, 0.0 };
    for (uint32_t i = 0; i < 3; i += 2) {
        if (first == 0 || end == x->frames) {
            anchor[i] = place(x, TARGET, first == 0 ? 0 : end - 1u, bone)[i];
            continue;
        }
        for (uint32_t f = first; f < end; f++) anchor[i] += place(x, TARGET, f, bone)[i] / (double)(end - first);
    }
    for (uint32_t f = first; f < end; f++) {
        for (uint32_t i = 0; i < 3; i += 2) out[f][side][i] += (float)(anchor[i] - place(x, TARGET, f, bone)[i]);
    }
}

/* Frames [first, end) in which a foot swings: out of the hold before, into the one after. */
static void let_go(uint32_t side, uint32_t first, uint32_t end, uint32_t frames, double rate, float (*out)[2][3])
{
    const double length = fmin(LET_GO_S * rate, (double)(end - first));
    for (uint32_t f = first; f < end; f++) {
        for (uint32_t i = 0; i < 3; i += 2) {
            const double after = (double)(f - first + 1u) / length, before = (double)(end - f) / length;
            double sum = 0.0;
            if (first && after < 1.0)
                sum += (double)out[first - 1u][side][i] * (1.0 - after * after * (3.0 - 2.0 * after));
            if (end < frames && before < 1.0)
                sum += (double)out[end][side][i] * (1.0 - before * before * (3.0 - 2.0 * before));
            out[f][side][i] = (float)sum;
        }
    }
}

int feet_lock(const retarget_pair *pair, float (*out)[2][3])
{
    places x;
    if (!pair->stands) return 0;
    if (places_make(pair, &x)) return 1;
    for (uint32_t side = 0; side < 2; side++) {
        for (int pass = 0; pass < 2; pass++) { /* holds first: swings end in them */
            for (uint32_t first = 0, end; first < x.frames; first = end) {
                const int is_down = x.down[side][first];
                for (end = first + 1u; end < x.frames && x.down[side][end] == is_down;) end++;
                if (is_down && !pass) hold(&x, held(pair, side), side, first, end, out);
                if (!is_down && pass) let_go(side, first, end, x.frames, pair->clips[SOURCE]->sample_rate_hz, out);
            }
        }
    }
    places_free(&x);
    return 0;
}

/* ---- figures ---- */

static double measure_slide(const retarget_pair *p, const places *x)
{
    double slide = 0.0, stride = 0.0;
    uint32_t runs = 0, strides = 0;
    for (uint32_t side = 0; side < 2; side++) {
        const uint32_t bone = held(p, side);
        uint32_t last = MODEL_NONE;
        for (uint32_t f = 0; f < x->frames; f++) {
            if (!x->down[side][f]) continue;
            if (f && x->down[side][f - 1u]) {
                slide += distance(place(x, TARGET, f, bone), place(x, TARGET, f - 1u, bone), 1);
                continue;
            }
            if (last != MODEL_NONE) stride += distance(place(x, TARGET, f, bone), place(x, TARGET, last, bone), 1);
            strides += last != MODEL_NONE;
            last = f;
            runs++;
        }
    }
    if (!strides) return 0.0;
    /* A foot that shifts its weight in place has next to no stride. */
    stride = fmax(stride / (double)strides, STRIDE_LEAST * rest_length(x, TARGET, NOH_BONE_UPPER_LEG));
    return slide / (double)runs / stride;
}

static double measure_penetration(const retarget_pair *p, const places *x, int which, double ground, double *scratch)
{
    for (uint32_t f = 0; f < x->frames; f++) {
        scratch[f] = 0.0;
        for (uint32_t i = 0; i < 4; i++) {
            const uint32_t bone = (i & 1u ? NOH_BONE_TOES : NOH_BONE_FOOT) + (i >> 1) * NOH_BONE_RIGHT;
            if (!is_common(p, bone)) continue;
            scratch[f] = fmax(scratch[f], x->rest[which][3u * bone + 1u] + ground - place(x, which, f, bone)[1]);
        }
    }
    return mocap_rank(scratch, x->frames, (uint32_t)(0.95 * (double)(x->frames - 1u)));
}

static double measure_reach(const retarget_pair *p, const places *x, const double facing[2])
{
    double sum = 0.0;
    uint32_t count = 0;
    for (uint32_t side = 0; side < 2; side++) {
        const uint32_t upper = NOH_BONE_UPPER_ARM + side * NOH_BONE_RIGHT;
        if (!is_common(p, upper) || !is_common(p, upper + 1u) || !is_common(p, upper + 2u)) continue;
        const double ratio = rest_length(x, TARGET, upper) / rest_length(x, SOURCE, upper);
        for (uint32_t f = 0; f < x->frames; f++) {
            const double *a = place(x, SOURCE, f, upper), *b = place(x, TARGET, f, upper);
            const double u[3] = { a[6] - a[0], a[7] - a[1], a[8] - a[2] };
            const double want[3] = { ratio * (facing[0] * u[0] + facing[1] * u[2]), ratio * u[1],
                                     ratio * (facing[0] * u[2] - facing[1] * u[0]) };
            const double have[3] = { b[6] - b[0], b[7] - b[1], b[8] - b[2] };
            sum += distance(want, have, 0);
            count++;
        }
    }
    return count ? sum / count : 0.0;
}

/* The axis of a limb's bend, as long as its sine. */
static void bend_of(const double *limb, double out[3])
{
    double u[3], v[3];
    for (int i = 0; i < 3; i++) {
        u[i] = limb[3 + i] - limb[i];
        v[i] = limb[6 + i] - limb[3 + i];
    }
    const double size = sqrt((u[0] * u[0] + u[1] * u[1] + u[2] * u[2]) * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]));
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        out[i] = size > 0.0 ? (u[j] * v[k] - u[k] * v[j]) / size : 0.0;
    }
}

static double measure_against(const retarget_pair *p, const places *x, const double facing[2])
{
    uint32_t against = 0, count = 0;
    for (uint32_t limb = 0; limb < 4; limb++) {
        const uint32_t upper = (limb & 1u ? NOH_BONE_UPPER_ARM : NOH_BONE_UPPER_LEG) + (limb >> 1) * NOH_BONE_RIGHT;
        if (!is_common(p, upper) || !is_common(p, upper + 1u) || !is_common(p, upper + 2u)) continue;
        for (uint32_t f = 0; f < x->frames; f++) {
            double a[3], b[3];
            bend_of(place(x, SOURCE, f, upper), a);
            bend_of(place(x, TARGET, f, upper), b);
            const double size = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
            if (size < BENT) continue;
            count++;
            against += (facing[0] * a[0] + facing[1] * a[2]) * b[0] + a[1] * b[1] +
                           (facing[0] * a[2] - facing[1] * a[0]) * b[2] <
                       -AGAINST * size;
        }
    }
    return count ? (double)against / count : 0.0;
}

int feet_measure(const retarget_pair *pair, const double facing[2], double ground, retarget_figures *out)
{
    const double cm = pair->skeletons[TARGET]->unit_cm;
    places x;
    double *scratch;
    if (places_make(pair, &x)) return 1;
    scratch = malloc((size_t)x.frames * sizeof *scratch);
    if (scratch) {
        out->slide = measure_slide(pair, &x);
        out->penetration_cm = measure_penetration(pair, &x, TARGET, 0.0, scratch) * cm;
        out->source_penetration_cm = measure_penetration(pair, &x, SOURCE, ground, scratch) *
                                     pair->skeletons[SOURCE]->unit_cm;
        out->reach_cm = measure_reach(pair, &x, facing) * cm;
        out->against = measure_against(pair, &x, facing);
    }
    free(scratch);
    places_free(&x);
    return !scratch;
}
