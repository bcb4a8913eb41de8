/* clip_open.c: checks and expands the header. One parser runs twice, first to measure (its pointers are NULL and it
 * only counts), then into the caller's memory, so that size and use cannot disagree.
 *
 * A clip is untrusted bytes. Every count in the header is checked against a limit before it bounds a loop; past the end
 * the bit reader returns zeros, which read_sizes detects. The segments' sizes must fill the clip exactly. The contents
 * of segments need no check, because any bits decode to some frames, in bounds (clip_decode_internal.h). */
#include <string.h>

#include "core/base/assert_internal.h"
#include "motion/clip/clip_codec_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"
#include "motion/clip/clip_internal.h"
#include "motion/clip/clip_synth_internal.h"

#define NANO_CM 1e-7
#define MICRO_CM 1e-4
#define ROTATION_NARROW 8u /* bytes in the cache */
#define ROTATION_WIDE 16u
#define LINEAR_BYTES 12u
#define FRAME_ALIGN 16u
#define TRIPLE 3u
#define SCALE_BIAS 128

typedef struct parser {
    noh_bits bits;
    const noh_clip_desc *desc;
    noh_clip *clip;
    /* destination of the expansion; NULL while measuring */
    noh_clip_track *tracks;
    noh_clip_prefix *prefixes;
    uint32_t *rotation_offsets;
    noh_clip_linear *linears;
    uint32_t *offsets, *firsts;
    noh_transform *pose;
    noh_clip_group *groups;
    uint32_t track_count;
    uint32_t size_width;
    noh_error *error;
} parser;

static noh_result fail(parser *p, noh_result result, const char *what, uint64_t need)
{
    return noh_fail(p->error, result, what, noh_bits_position(&p->bits) / 8u, need);
}

static double read_ratio(noh_bits *b)
{
    const uint32_t exponent = noh_bits_get(b, 4u), mantissa = noh_bits_get(b, 16u);
    return (double)mantissa * (double)(1u << exponent) / (double)NOH_CLIP_ERROR_ONE;
}

static noh_result read_counts(parser *p)
{
    noh_bits *b = &p->bits;
    noh_clip_info *info = &p->clip->info;
    if (noh_bits_get(b, 8u) != NOH_CLIP_VERSION)
        return fail(p, NOH_ERR_VERSION, "the clip has another format version: rebuild its pack", NOH_CLIP_VERSION);
    info->flags = noh_bits_get(b, 8u);
    if (info->flags & ~NOH_CLIP_FLAGS_ALL) return fail(p, NOH_ERR_DATA, "the clip has unknown flags", info->flags);
    info->joint_count = noh_bits_varint(b);
    info->frame_count = noh_bits_varint(b);
    if (info->joint_count > NOH_CLIP_JOINTS_MAX)
        return fail(p, NOH_ERR_LIMIT, "the clip has more joints than NOH_CLIP_JOINTS_MAX", info->joint_count);
    if (info->joint_count != p->desc->joint_count)
        return fail(p, NOH_ERR_ARG, "the clip's joint count differs from the skeleton's", info->joint_count);
    if (info->frame_count == 0u || info->frame_count > NOH_CLIP_FRAMES_MAX)
        return fail(p, NOH_ERR_LIMIT, "the clip has no frames, or more than NOH_CLIP_FRAMES_MAX", info->frame_count);
    if (noh_bits_get(b, 1u)) {
        const uint32_t hertz = noh_bits_varint(b);
        info->sample_rate_uhz = hertz <= 0xffffffffu / NOH_CLIP_MICRO ? hertz * NOH_CLIP_MICRO : 0u;
    } else {
        info->sample_rate_uhz = noh_bits_get(b, 32u);
    }
    if (info->sample_rate_uhz == 0u) return fail(p, NOH_ERR_DATA, "the clip's sample rate is 0 or above 32 bits", 0);
    info->segment_count = noh_bits_varint(b);
    if (info->segment_count == 0u || info->segment_count > info->frame_count)
        return fail(p, NOH_ERR_DATA, "the clip has no segments, or more than frames", info->segment_count);
    info->segment_frames_max = (info->frame_count + info->segment_count - 1u) / info->segment_count;
    if (info->segment_frames_max > NOH_CLIP_SEGMENT_FRAMES_MAX)
        return fail(p, NOH_ERR_LIMIT, "a segment of the clip is longer than NOH_CLIP_SEGMENT_FRAMES_MAX",
                    info->segment_frames_max);
    p->size_width = info->segment_count > 1u ? noh_bits_get(b, 5u) : 0u;
    return NOH_OK;
}

static void read_certificate(parser *p)
{
    noh_bits *b = &p->bits;
    noh_clip_info *info = &p->clip->info;
    const double per_frame = 1e6 / (double)info->sample_rate_uhz;
    info->error_cm = (double)noh_bits_varint(b) * NANO_CM;
    info->shell_cm = (double)noh_bits_varint(b) * MICRO_CM;
    info->max_error_cm = read_ratio(b) * info->error_cm;
    info->rms_error_cm = read_ratio(b) * info->error_cm;
    info->max_error_joint = noh_bits_varint(b);
    info->max_error_time_s = (double)noh_bits_varint(b) * per_frame / (double)NOH_CLIP_TIME_PARTS;
    info->duration_ticks = (uint64_t)(info->frame_count - 1u) * NOH_CLIP_TICKS_PER_SECOND * NOH_CLIP_MICRO /
                           info->sample_rate_uhz;
}

static noh_clip_group read_group(noh_bits *b, uint32_t first)
{
    noh_clip_group group;
    group.name_hash = noh_bits_get(b, 32u);
    group.node = noh_bits_varint(b) - 1u;
    group.first = first;
    group.width = noh_bits_varint(b);
    return group;
}

static noh_result read_groups(parser *p)
{
    noh_clip_info *info = &p->clip->info;
    info->group_count = noh_bits_varint(&p->bits);
    info->float_count = 0;
    if (info->group_count > NOH_CLIP_GROUPS_MAX)
        return fail(p, NOH_ERR_LIMIT, "the clip has more float groups than NOH_CLIP_GROUPS_MAX", info->group_count);
    for (uint32_t g = 0; g < info->group_count; g++) {
        const noh_clip_group group = read_group(&p->bits, info->float_count);
        if (group.width > NOH_CLIP_FLOATS_MAX - info->float_count)
            return fail(p, NOH_ERR_LIMIT, "the clip has more floats than NOH_CLIP_FLOATS_MAX", group.width);
        info->float_count += group.width;
        if (p->groups) p->groups[g] = group;
    }
    return NOH_OK;
}

static void read_quat(parser *p, uint32_t width, float q[4])
{
    uint32_t codes[3];
    const uint32_t left_out = noh_clip_read_quat_codes(&p->bits, width, codes);
    noh_clip_quat_expand(codes, left_out, width, q);
}

/* Three floats stored as their highest `width` bits. NaN and infinity are rejected. */
static noh_result read_floats(parser *p, uint32_t width, float v[3])
{
    for (uint32_t i = 0; i < 3u; i++) {
        const uint32_t word = noh_bits_get(&p->bits, width) << (32u - width);
        if ((word & 0x7f800000u) == 0x7f800000u) return fail(p, NOH_ERR_DATA, "a value of the clip is not finite", 0);
        memcpy(&v[i], &word, sizeof v[i]);
    }
    return NOH_OK;
}

/* Store a track, or only count it. Rotations and linear tracks are numbered separately: a cached frame has all tracks
 * of one kind in a row, so that sampling is a loop over neighbours. */
static void add_track(parser *p, const noh_clip_track *track)
{
    noh_clip *clip = p->clip;
    noh_clip_track t = *track;
    const int rotation = t.kind == NOH_CLIP_ROTATION;
    t.entry = (uint16_t)(rotation ? clip->rotation_count++ : clip->linear_count++);
    if (p->tracks) {
        p->tracks[p->track_count] = t;
        if (rotation) {
            p->rotation_offsets[t.entry] = (uint32_t)(t.target * sizeof(noh_transform));
        } else {
            p->linears[t.entry].joint = t.target;
            p->linears[t.entry].kind = t.kind;
        }
    }
    p->track_count++;
}

/* The floats of a triple may have very different ranges: the second and third have their own steps, relative to the
 * first. They are stored as the diagonal of the mix matrix, so decoding floats uses the same path as mixed axes. */
static void read_scales(parser *p, noh_clip_track *t)
{
    for (uint32_t i = 0; i < 2u; i++) {
        const int32_t id = (int32_t)noh_bits_get(&p->bits, 8u) - SCALE_BIAS;
        /* 2^(-id / 4), through the steps around size 1 */
        t->mix[4u + 4u * i] = noh_clip_step(
            (uint32_t)(4 * NOH_CLIP_STEP_TOP + (id < -4 * NOH_CLIP_STEP_TOP ? -4 * NOH_CLIP_STEP_TOP : id)));
    }
    t->mix[0] = 1.0f;
    t->flags = NOH_CLIP_TRACK_MIX;
}

static noh_result read_reference(parser *p, noh_clip_track *t, const float *bind)
{
    const uint32_t components = t->kind == NOH_CLIP_ROTATION ? 4u : 3u;
    if (t->flags & NOH_CLIP_TRACK_WILD) return NOH_OK;
    if (noh_bits_get(&p->bits, 1u) == 0u) {
        for (uint32_t i = 0; bind && i < components; i++) t->reference[i] = bind[i];
        return NOH_OK;
    }
    if (t->kind == NOH_CLIP_ROTATION) {
        read_quat(p, NOH_CLIP_REFERENCE_BITS, t->reference);
        return NOH_OK;
    }
    return read_floats(p, 16u, t->reference);
}

static noh_result read_track(parser *p, noh_clip_kind kind, uint32_t target, const float *bind)
{
    noh_clip_track t;
    noh_result r;
    memset(&t, 0, sizeof t);
    t.kind = (uint8_t)kind;
    t.target = (uint16_t)target;
    if (p->clip->info.segment_count > 1u) t.step = (int16_t)noh_bits_get(&p->bits, 8u);
    if (kind == NOH_CLIP_FLOATS) read_scales(p, &t);
    if (kind == NOH_CLIP_ROTATION && noh_bits_get(&p->bits, 1u)) t.flags = NOH_CLIP_TRACK_WILD;
    r = read_reference(p, &t, bind);
    if (r != NOH_OK) return r;
    if (kind != NOH_CLIP_FLOATS && noh_bits_get(&p->bits, 1u)) {
        float q[4];
        read_quat(p, NOH_CLIP_MIX_BITS, q);
        noh_clip_mix_matrix(q, t.mix);
        t.flags |= NOH_CLIP_TRACK_MIX;
    }
    add_track(p, &t);
    return NOH_OK;
}

static noh_result read_subtrack(parser *p, noh_clip_kind kind, uint32_t mode, uint32_t joint, float *value)
{
    static const uint8_t widths[4] = { 16, 20, 24, 32 };
    if (mode == NOH_CLIP_MODE_ANIMATED) return read_track(p, kind, joint, value);
    if (mode != NOH_CLIP_MODE_CONSTANT) return NOH_OK;
    if (kind == NOH_CLIP_ROTATION) {
        read_quat(p, NOH_CLIP_CONSTANT_BITS + noh_bits_get(&p->bits, 4u), value);
        return NOH_OK;
    }
    return read_floats(p, widths[noh_bits_get(&p->bits, 2u)], value);
}

/* Most joints of most clips only rotate: one bit marks them. Other joints mark each of rotation, translation and scale
 * as bind, constant or animated. */
static noh_result read_joint(parser *p, uint32_t joint)
{
    uint32_t rotation = NOH_CLIP_MODE_ANIMATED, translation = NOH_CLIP_MODE_BIND, scale = NOH_CLIP_MODE_BIND;
    noh_transform t = p->desc->bind[joint];
    noh_result r;
    noh_clip_quat_unit(p->desc->bind[joint].rotation, t.rotation);
    if (noh_bits_get(&p->bits, 1u)) {
        rotation = NOH_CLIP_MODE_BIND;
        if (noh_bits_get(&p->bits, 1u)) {
            rotation = noh_bits_get(&p->bits, 2u);
            translation = noh_bits_get(&p->bits, 2u);
            scale = p->clip->info.flags & NOH_CLIP_FLAG_SCALE ? noh_bits_get(&p->bits, 2u) : NOH_CLIP_MODE_BIND;
        }
    }
    if (rotation > NOH_CLIP_MODE_ANIMATED || translation > NOH_CLIP_MODE_ANIMATED || scale > NOH_CLIP_MODE_ANIMATED) {
        return fail(p, NOH_ERR_DATA, "a track of the clip has an unknown mode", 0);
    }
    r = read_subtrack(p, NOH_CLIP_TRANSLATION, translation, joint, t.translation);
    if (r == NOH_OK) r = read_subtrack(p, NOH_CLIP_SCALE, scale, joint, t.scale);
    if (r == NOH_OK) r = read_subtrack(p, NOH_CLIP_ROTATION, rotation, joint, t.rotation);
    if (p->pose) p->pose[joint] = t;
    return r;
}

/* Tracks are in joint order, so the first n joints need the first tracks, rotations and linear tracks: a LOD level that
 * poses a prefix of the skeleton decodes and samples just those. */
static void keep_prefix(parser *p, uint32_t joint)
{
    if (p->prefixes) {
        noh_clip_prefix *prefix = &p->prefixes[joint];
        prefix->tracks = (uint16_t)p->track_count;
        prefix->rotations = (uint16_t)p->clip->rotation_count;
        prefix->linears = (uint16_t)p->clip->linear_count;
    }
}

static noh_result read_tracks(parser *p)
{
    noh_clip_info *info = &p->clip->info;
    p->track_count = 0;
    p->clip->rotation_count = p->clip->linear_count = 0;
    for (uint32_t f = 0; f < info->float_count; f += TRIPLE) {
        const noh_result r = read_track(p, NOH_CLIP_FLOATS, f, NULL);
        if (r != NOH_OK) return r;
    }
    for (uint32_t j = 0; j < info->joint_count; j++) {
        noh_result r;
        keep_prefix(p, j);
        r = read_joint(p, j);
        if (r != NOH_OK) return r;
    }
    keep_prefix(p, info->joint_count);
    info->track_count = p->track_count;
    return NOH_OK;
}

/* The segments must fill the block exactly. */
static noh_result read_sizes(parser *p)
{
    const noh_clip_info *info = &p->clip->info;
    noh_bits sizes = p->bits;
    const size_t sizes_bits = (size_t)p->size_width * (info->segment_count > 1u ? info->segment_count : 0u);
    const size_t begin = (noh_bits_position(&p->bits) + sizes_bits + 7u) / 8u;
    size_t at = begin;
    if (noh_bits_overrun(&p->bits) || begin > p->desc->byte_count)
        return fail(p, NOH_ERR_DATA, "the clip ends in its header", begin);
    for (uint32_t s = 0; s < info->segment_count; s++) {
        const size_t bytes = info->segment_count > 1u ? noh_bits_get(&sizes, p->size_width)
                                                      : p->desc->byte_count - begin;
        if (p->offsets) p->offsets[s] = (uint32_t)at;
        if (p->firsts) p->firsts[s] = (uint32_t)((uint64_t)s * info->frame_count / info->segment_count);
        if (bytes > p->desc->byte_count - at)
            return fail(p, NOH_ERR_DATA, "a segment reaches beyond the end of the clip", s);
        at += bytes;
    }
    if (p->offsets) p->offsets[info->segment_count] = (uint32_t)at;
    if (p->firsts) p->firsts[info->segment_count] = info->frame_count;
    return at == p->desc->byte_count ? NOH_OK : fail(p, NOH_ERR_DATA, "the clip has bytes after its last segment", at);
}

/* The sum of the whole-number weights of two frames: the largest number, up to NOH_CLIP_WEIGHT_MAX, that divides a
 * frame so that every tick and every eighth of a frame is a multiple. At 30 Hz a frame is 1,600 ticks, and 32,000 parts
 * contain both. With g = gcd(48,000 Hz, sample rate), both in micro-hertz, ticks lie at multiples of 1 / (48,000 Hz /
 * g) of a frame; doubling that divisor until 8 divides it includes the eighths. At sample rates for which it is too
 * large, a time is off by less than 1/65,000 of a frame. */
static uint32_t weight_one(uint32_t sample_rate_uhz)
{
    const uint64_t second = (uint64_t)NOH_CLIP_TICKS_PER_SECOND * NOH_CLIP_MICRO;
    uint64_t a = second, b = sample_rate_uhz, step;
    while (b) {
        const uint64_t rest = a % b;
        a = b;
        b = rest;
    }
    step = second / a; /* of a frame, ticks are multiples of 1 / step */
    while (step % NOH_CLIP_WEIGHT_PARTS) {
        step *= 2u;
    }
    if (step > NOH_CLIP_WEIGHT_MAX) {
        step = NOH_CLIP_WEIGHT_PARTS;
    }
    return (uint32_t)(NOH_CLIP_WEIGHT_MAX / step * step);
}

/* A rate of 119.88 counts as twice 60. */
static uint32_t is_halved(const noh_clip_desc *desc, uint32_t sample_rate_uhz)
{
    return desc->sample_rate_needed &&
           (uint64_t)sample_rate_uhz * 100u >= 2u * 99u * (uint64_t)desc->sample_rate_needed * NOH_CLIP_MICRO;
}

static noh_result parse(parser *p)
{
    noh_clip *clip = p->clip;
    noh_result r;
    p->bits = noh_bits_over(p->desc->bytes, 0, p->desc->byte_count);
    r = read_counts(p);
    if (r != NOH_OK) return r;
    read_certificate(p);
    r = read_groups(p);
    if (r == NOH_OK) r = read_tracks(p);
    if (r == NOH_OK) r = read_sizes(p);
    if (r != NOH_OK) return r;
    clip->linear_offset = (clip->rotation_count + NOH_CLIP_GROUP - 1u) / NOH_CLIP_GROUP * NOH_CLIP_GROUP *
                          (clip->info.flags & NOH_CLIP_FLAG_WIDE ? ROTATION_WIDE : ROTATION_NARROW);
    clip->weight_one = weight_one(clip->info.sample_rate_uhz);
    clip->frame_bytes = (clip->linear_offset + clip->linear_count * LINEAR_BYTES + FRAME_ALIGN - 1u) &
                        ~(FRAME_ALIGN - 1u);
    clip->segments_per_frame = ((uint64_t)clip->info.segment_count << 32) / clip->info.frame_count;
    clip->info.halved = is_halved(p->desc, clip->info.sample_rate_uhz);
    clip->info.segment_bytes_max = (size_t)clip->frame_bytes *
                                   noh_clip_slots(clip->info.segment_frames_max, clip->info.halved);
    return NOH_OK;
}

static void carve(noh_arena *arena, const noh_clip *clip, parser *p)
{
    const noh_clip_info *info = &clip->info;
    p->pose = noh_arena_carve(arena, info->joint_count * sizeof *p->pose, 4u);
    p->tracks = noh_arena_carve(arena, info->track_count * sizeof *p->tracks, 4u);
    p->groups = noh_arena_carve(arena, info->group_count * sizeof *p->groups, 4u);
    p->offsets = noh_arena_carve(arena, ((size_t)info->segment_count + 1u) * sizeof *p->offsets, 4u);
    p->firsts = noh_arena_carve(arena, ((size_t)info->segment_count + 1u) * sizeof *p->firsts, 4u);
    p->rotation_offsets = noh_arena_carve(arena, clip->rotation_count * sizeof *p->rotation_offsets, 4u);
    p->prefixes = noh_arena_carve(arena, ((size_t)info->joint_count + 1u) * sizeof *p->prefixes, 2u);
    p->linears = noh_arena_carve(arena, clip->linear_count * sizeof *p->linears, 2u);
}

static noh_result measure(const noh_clip_desc *desc, noh_clip *clip, parser *p, size_t *size, noh_error *error)
{
    noh_arena arena = noh_arena_measure();
    noh_result r;
    memset(clip, 0, sizeof *clip);
    memset(p, 0, sizeof *p);
    p->desc = desc;
    p->clip = clip;
    p->error = error;
    if (!desc->bytes || (desc->joint_count && !desc->bind))
        return noh_fail(error, NOH_ERR_ARG,
                        desc->bytes ? "bind of a clip desc is NULL, and joint_count is not 0"
                                    : "bytes of a clip desc is NULL",
                        0, 0);
    if (desc->byte_count > 0x7fffffffu)
        return noh_fail(error, NOH_ERR_LIMIT, "byte_count of a clip desc is 2 GiB or more", 0, desc->byte_count);
    r = parse(p);
    if (r != NOH_OK) return r;
    (void)noh_arena_carve(&arena, sizeof *clip, 16u);
    carve(&arena, clip, p);
    *size = arena.used;
    return NOH_OK;
}

noh_result noh_clip_measure(const noh_clip_desc *desc, noh_clip_info *info, size_t *bytes, noh_error *error)
{
    noh_clip clip;
    parser p;
    const noh_result r = measure(desc, &clip, &p, bytes, error);
    if (r == NOH_OK) *info = clip.info;
    return r;
}

size_t noh_clip_size(const noh_clip_desc *desc, noh_error *error)
{
    noh_clip_info info;
    size_t size = 0;
    return noh_clip_measure(desc, &info, &size, error) == NOH_OK ? size : 0u;
}

noh_clip_group_reader noh_clip_groups_of(const noh_clip_desc *desc)
{
    noh_clip_group_reader reader;
    noh_clip clip;
    parser p;
    memset(&clip, 0, sizeof clip);
    memset(&p, 0, sizeof p);
    p.desc = desc;
    p.clip = &clip;
    p.bits = noh_bits_over(desc->bytes, 0, desc->byte_count);
    (void)read_counts(&p); /* the clip was measured: this succeeds */
    read_certificate(&p);
    reader.left = noh_bits_varint(&p.bits);
    reader.first = 0;
    reader.bits = p.bits;
    return reader;
}

int noh_clip_next_group(noh_clip_group_reader *reader, noh_clip_group *group)
{
    if (reader->left == 0u) return 0;
    *group = read_group(&reader->bits, reader->first);
    reader->first += group->width;
    reader->left--;
    return 1;
}

noh_result noh_clip_init(void *memory, size_t bytes, const noh_clip_desc *desc, noh_clip **out, noh_error *error)
{
    noh_clip measured, *clip;
    noh_arena arena;
    parser p;
    size_t size = 0;
    noh_result r = measure(desc, &measured, &p, &size, error);
    if (!r) r = noh_arena_open(&arena, memory, bytes, size, error);
    if (r) return r;
    clip = noh_arena_carve(&arena, sizeof *clip, 16u);
    *clip = measured;
    carve(&arena, &measured, &p);
    p.clip = clip;
    (void)parse(&p); /* the same bytes as before: it succeeds */
    clip->bytes = desc->bytes;
    clip->pose = p.pose;
    clip->tracks = p.tracks;
    clip->groups = p.groups;
    clip->segment_offsets = p.offsets;
    clip->segment_firsts = p.firsts;
    clip->prefixes = p.prefixes;
    clip->rotation_offsets = p.rotation_offsets;
    clip->linears = p.linears;
    *out = clip;
    return NOH_OK;
}

void noh_clip_info_of(const noh_clip *clip, noh_clip_info *info)
{
    *info = clip->info;
}

noh_clip_group noh_clip_group_at(const noh_clip *clip, uint32_t index)
{
    NOH_ASSERT(index < clip->info.group_count);
    return clip->groups[index];
}

/* ticks / 48,000 Hz * sample rate, as quotient and remainder of integers: no time is rounded before it is split into
 * frame and fraction. Frames seldom lie at whole ticks (90 Hz: every third); a frame is shown at the tick nearest to
 * it, so that a player at the clip's own frame times gets the exact frames, within the bound, and not interpolated
 * ones. */
uint32_t noh_clip_frame_at(const noh_clip *clip, int64_t ticks, float *fraction)
{
    const uint64_t unit = (uint64_t)NOH_CLIP_TICKS_PER_SECOND * NOH_CLIP_MICRO;
    const uint32_t last = clip->info.frame_count - 1u;
    const uint64_t tick = clip->info.sample_rate_uhz; /* where a frame is `unit` */
    uint64_t position, rest;
    *fraction = 0.0f;
    if (ticks <= 0) return 0;
    if ((uint64_t)ticks >= clip->info.duration_ticks) return last; /* so that the product fits */
    position = (uint64_t)ticks * tick;
    rest = position % unit;
    if (position / unit >= last) return last;
    if (2u * rest <= tick) return (uint32_t)(position / unit);
    if (2u * (unit - rest) <= tick) return (uint32_t)(position / unit) + 1u;
    *fraction = (float)rest / (float)unit;
    return (uint32_t)(position / unit);
}
