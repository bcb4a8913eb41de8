/* clip_prepare.c: the raw clip in double precision and in object space. */
#include <stdio.h>
#include <stdlib.h>

#include "clip_encoder.h"

#define SHELL_SCALE_MIN 1e-6
#define SEGMENT_FRAMES 24u      /* of a segment, and ... */
#define SEGMENT_FRAMES_FAST 32u /* ... and the most, where a third of a second has more */
#define SEGMENT_S (1.0 / 3.0)

int enc_fail(encoder *e, const char *what)
{
    if (e->error) {
        snprintf(e->error->what, sizeof e->error->what, "%s", what);
        snprintf(e->error->where, sizeof e->error->where, "clip \"%s\"", e->clip->name ? e->clip->name : "");
    }
    return 1;
}

void *enc_alloc(encoder *e, size_t count, size_t size)
{
    void *p = calloc(count ? count : 1u, size);
    if (!p) enc_fail(e, "out of memory");
    return p;
}

static int numbers(const float *v, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (!(v[i] - v[i] == 0.0f)) return 0;
    }
    return 1;
}

static int check(encoder *e)
{
    const raw_clip *c = e->clip;
    const size_t samples = (size_t)c->frame_count * c->joint_count;
    const double micro = floor(c->sample_rate_hz * (double)NOH_CLIP_MICRO + 0.5);
    if (c->joint_count && c->joint_count != e->skeleton->joint_count)
        return enc_fail(e, "clip and skeleton have different numbers of joints");
    if (c->joint_count > NOH_CLIP_JOINTS_MAX) return enc_fail(e, "more joints than the format holds (4096)");
    if (c->frame_count == 0u || c->frame_count > NOH_CLIP_FRAMES_MAX)
        return enc_fail(e, "frames: at least 1, at most 1048576");
    if (!(micro >= 1.0 && micro <= 4294967295.0)) return enc_fail(e, "frames per second: above 0, at most 4294");
    if (c->float_count > NOH_CLIP_GROUPS_MAX || e->float_count > NOH_CLIP_FLOATS_MAX)
        return enc_fail(e, "more floats than the format holds (4096 in 1024 groups)");
    if (samples && !(numbers(c->rotations, samples * 4u) && numbers(c->translations, samples * 3u) &&
                     numbers(c->scales, samples * 3u))) {
        return enc_fail(e, "a value that is not a number");
    }
    for (uint32_t g = 0; g < c->float_count; g++) {
        if (!numbers(c->floats[g].values, (size_t)c->frame_count * c->floats[g].width))
            return enc_fail(e, "a value that is not a number");
    }
    return 0;
}

static int prepare_floats(encoder *e)
{
    const raw_clip *c = e->clip;
    uint32_t first = 0;
    e->floats = enc_alloc(e, (size_t)e->frame_count * e->float_count, sizeof *e->floats);
    e->float_bounds = enc_alloc(e, e->float_count, sizeof *e->float_bounds);
    if (!e->floats || !e->float_bounds) return 1;
    for (uint32_t g = 0; g < c->float_count; g++) {
        const raw_floats *group = &c->floats[g];
        for (uint32_t i = 0; i < group->width; i++) {
            const double radius = group->radius ? fabs((double)group->radius[i]) : 0.0;
            double bound = group->radius ? e->options.error_cm / (radius > 1e-6 ? radius : 1e-6)
                                         : e->options.float_error;
            if (bound > 1.0)
                bound = 1.0; /* programs may read a weight that moves nothing, so it keeps some precision */
            e->float_bounds[first + i] = bound;
            for (uint32_t f = 0; f < e->frame_count; f++) {
                e->floats[(size_t)f * e->float_count + first + i] = group->values[(size_t)f * group->width + i];
            }
        }
        first += group->width;
    }
    return 0;
}

/* Frame f of a joint; its quaternion in the hemisphere of the frame before. */
static void prepare_local(encoder *e, uint32_t f, uint32_t j)
{
    const size_t at = (size_t)f * e->joint_count + j;
    space_local *l = enc_local(e, f, j);
    for (int i = 0; i < 4; i++) l->q[i] = (double)e->clip->rotations[4u * at + (size_t)i];
    for (int i = 0; i < 3; i++) l->t[i] = (double)e->clip->translations[3u * at + (size_t)i];
    for (int i = 0; i < 3; i++) l->s[i] = (double)e->clip->scales[3u * at + (size_t)i];
    space_unit(l->q);
    if (f && space_dot(l->q, enc_local(e, f - 1u, j)->q) < 0.0) {
        for (int i = 0; i < 4; i++) l->q[i] = -l->q[i];
    }
}

/* The shell is a distance in the bind pose's world: below a node of scale 0.01 it is a hundred of the joint's own
 * units. A joint that the bind pose scales to nothing has no such distance; its own unit is taken. */
static int prepare_shells(encoder *e)
{
    space_global *bind = enc_alloc(e, e->joint_count, sizeof *bind);
    if (!bind) return 1;
    for (uint32_t j = 0; j < e->joint_count; j++) {
        enc_joint *t = &e->joints[j];
        space_local l;
        for (int i = 0; i < 4; i++) l.q[i] = (double)e->bind[j].rotation[i];
        for (int i = 0; i < 3; i++) l.t[i] = (double)e->bind[j].translation[i];
        for (int i = 0; i < 3; i++) l.s[i] = (double)e->bind[j].scale[i];
        space_compose(enc_parent(bind, t->parent), &l, &bind[j]);
        t->reach = e->options.shell_cm;
        if (e->options.reach_cm && e->options.reach_cm[j] > t->reach) t->reach = e->options.reach_cm[j];
        t->reach /= e->unit_cm;
        for (int k = 0; k < 3; k++) {
            const double *m = bind[j].m, n = sqrt(m[k] * m[k] + m[3 + k] * m[3 + k] + m[6 + k] * m[6 + k]);
            t->shell[k] = n > SHELL_SCALE_MIN && n < 1.0 / SHELL_SCALE_MIN ? t->reach / n : t->reach;
        }
    }
    free(bind);
    return 0;
}

static int is_one(const double scale[3])
{
    return scale[0] == 1.0 && scale[1] == 1.0 && scale[2] == 1.0;
}

/* Whether a joint is scaled by nothing above it and in no frame; the decoder then has its scale as it is. */
static int is_turned(const encoder *e, uint32_t j)
{
    const uint32_t parent = e->joints[j].parent;
    const float *scale = e->bind[j].scale;
    if (parent != ENC_NONE && !e->joints[parent].turned) return 0;
    if (scale[0] != 1.0f || scale[1] != 1.0f || scale[2] != 1.0f) return 0;
    for (uint32_t f = 0; f < e->frame_count; f++) {
        if (!is_one(enc_local(e, f, j)->s)) return 0;
    }
    return 1;
}

static int prepare_joints(encoder *e)
{
    const size_t samples = (size_t)e->frame_count * e->joint_count;
    e->local = enc_alloc(e, samples, sizeof *e->local);
    e->global = enc_alloc(e, samples, sizeof *e->global);
    e->joints = enc_alloc(e, e->joint_count, sizeof *e->joints);
    e->bind = enc_alloc(e, e->joint_count, sizeof *e->bind);
    if (!e->local || !e->global || !e->joints || !e->bind) return 1;
    for (uint32_t j = 0; j < e->joint_count; j++) {
        const raw_joint *r = &e->skeleton->joints[j];
        if (r->parent != ENC_NONE && r->parent >= j) return enc_fail(e, "a joint comes before its parent");
        e->joints[j].parent = r->parent;
        noh_clip_quat_unit(r->rotation, e->bind[j].rotation);
        memcpy(e->bind[j].translation, r->translation, sizeof r->translation);
        memcpy(e->bind[j].scale, r->scale, sizeof r->scale);
        if (!numbers(r->translation, 3) || !numbers(r->scale, 3))
            return enc_fail(e, "a bind pose that is not a number");
    }
    if (prepare_shells(e)) return 1;
    for (uint32_t f = 0; f < e->frame_count; f++) {
        space_global *pose = enc_global(e, f, 0);
        for (uint32_t j = 0; j < e->joint_count; j++) {
            prepare_local(e, f, j);
            space_compose(enc_parent(pose, e->joints[j].parent), enc_local(e, f, j), &pose[j]);
        }
    }
    for (uint32_t j = 0; j < e->joint_count; j++) e->joints[j].turned = is_turned(e, j);
    return 0;
}

/* Frames that follow each other faster are more alike: what a segment costs whatever its length is shared by more. (40
 * are 2 % smaller than 32 on captured motion at 120 Hz, and take a quarter more memory in a cache; floats alone, which
 * are few bytes in a file and many in a cache, stay with 24.) */
static uint32_t segment_frames(const encoder *e)
{
    const double frames = e->clip->joint_count ? e->clip->sample_rate_hz * SEGMENT_S : 0.0;
    if (e->options.segment_frames) return e->options.segment_frames;
    if (frames > SEGMENT_FRAMES_FAST) return SEGMENT_FRAMES_FAST;
    return frames > SEGMENT_FRAMES ? (uint32_t)frames : SEGMENT_FRAMES;
}

static int prepare_segments(encoder *e)
{
    const uint32_t wanted = segment_frames(e);
    uint32_t count = (e->frame_count + wanted / 2u) / wanted;
    if (count == 0u) count = 1;
    while ((e->frame_count + count - 1u) / count > ENC_FRAMES_MAX) count++;
    e->segment_count = count;
    e->single = count == 1u;
    e->segments = enc_alloc(e, count, sizeof *e->segments);
    if (!e->segments) return 1;
    for (uint32_t s = 0; s < count; s++) {
        const uint32_t first = (uint32_t)((uint64_t)s * e->frame_count / count);
        e->segments[s].first = first;
        e->segments[s].count = (uint32_t)((uint64_t)(s + 1u) * e->frame_count / count) - first;
    }
    return 0;
}

int enc_prepare(encoder *e)
{
    e->joint_count = e->clip->joint_count;
    e->frame_count = e->clip->frame_count;
    e->group_count = e->clip->float_count;
    e->float_count = 0;
    for (uint32_t g = 0; g < e->clip->float_count; g++) {
        if (e->clip->floats[g].width > NOH_CLIP_FLOATS_MAX)
            return enc_fail(e, "more floats than the format holds (4096)");
        e->float_count += e->clip->floats[g].width;
    }
    return check(e) || prepare_segments(e) || prepare_floats(e) || prepare_joints(e);
}
