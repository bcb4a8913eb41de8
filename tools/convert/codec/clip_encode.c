/* clip_encode.c: drives the encoder.
 *
 * A clip is transform-coded like a picture, but the bound is on distances in object space instead of on each value:
 *
 *   prepare   double precision, quaternions in one hemisphere, object-space transforms of every frame
 *   analyse   which tracks are constant, what each joint's rotation carries, the reference and axes of each track
 *   basis     the transform that promises fewer bits for this clip
 *   segments  for each run of about 24 frames, parents first: a transform along time, quantised by the largest step
 *             whose decoded result keeps the object-space error within the bound (clip_segment.c, clip_fit.c)
 *   write     the coefficients, in prefix codes with tables trained on other clips (tools/clip_tables)
 *   certify   the bytes are decoded by the runtime's own code and measured, and only then returned
 *
 * So the certificate does not depend on the encoder's reasoning: a mistake shows there, and the clip is encoded again
 * at a more careful level:
 *
 *   level 0   everything that saves bytes
 *   level 1   rotations cached as floats, and almost nothing stored as constant
 *   level 2   constants to single precision, animated tracks raw
 *
 * Compare Arikan, "Compression of Motion Capture Databases" (2006), who bounds nothing per joint, and Nicholas
 * Frechette's Animation Compression Library, which measures at a shell of virtual points as this does. */
#include "clip_encode.h"

#include <stdio.h>
#include <stdlib.h>

#include "clip_encoder.h"

#define LEVELS 3
#define TIGHTEN 0.98
#define TIGHTEN_MAX 1.5
#define TIGHT_MIN 0.5
#define DEFAULT_ERROR_CM 0.01
#define DEFAULT_SHELL_CM 3.0
#define DEFAULT_FLOAT_ERROR 0.001
#define DEFAULT_SPLIT_HZ 100.0 /* below it few play half of the frames; a split costs up to a hundredth of the bytes */
#define SEGMENT_FRAMES_MIN 8u
#define SEGMENT_FRAMES_MAX 40u /* a single segment may be half as long again */
/* Segment lengths that are tried in addition to the usual ones: long segments are a few percent smaller where motion is
 * smooth (a cache takes more for them), short ones up to a sixth where it starts, stops or strikes. Clips of one or two
 * segments stay in a cache whole, longer clips are decoded as they play, which short segments must pay for. */
#define LONG_SEGMENT 40u
#define SHORT_SEGMENT 16u
#define SHORTEST_SEGMENT 10u
#define SHORT_PAYS 0.96 /* largest share of the bytes of longer ones */
#define USUAL_LENGTH 0u
#define LENGTH_OF_SMALLEST 0xffffffffu
#define FAST_HZ 60.0
#define EFFORT_USUAL 2u
#define EFFORT_MAX 3u
#define RAW_JOINT_BYTES 40u
#define RAW_FLOAT_BYTES 4u

/* In the order of enc_tuning: a search, the plain one, which now and then is smaller, and what else has been smaller
 * for some segments. */
static const enc_tuning tunings[] = {
    { 0.86, 0.9, 0.05, 0.65, 0.2, 0.5, 0.06, 8, 1, 1 }, { 0.82, 0.86, 0.05, 0.65, 0.2, 0.5, 0.06, 8, 0, 0 },
    { 0.82, 0.82, 0.1, 0.8, 0.35, 0.5, 0.1, 8, 1, 1 },  { 0.9, 0.94, 0.05, 0.75, 0.1, 0.5, 0.06, 8, 1, 1 },
    { 0.7, 0.9, 0.05, 0.65, 0.2, 0.5, 0.06, 8, 1, 1 },
};

typedef enum which_basis { BASIS_GUESSED, BASIS_OTHER, BASIS_OF_SMALLEST } which_basis;

/* The attempts, in this order. Each effort includes the attempts of the lower ones, so that it is never larger. */
typedef struct attempt {
    uint32_t effort;
    uint32_t first, count; /* tunings */
    uint32_t segment_frames;
    which_basis basis;
} attempt;
static const attempt attempts[] = {
    { 1, 1, 1, USUAL_LENGTH, BASIS_GUESSED },           { 2, 1, 1, USUAL_LENGTH, BASIS_OTHER },
    { 2, 1, 1, SHORT_SEGMENT, BASIS_GUESSED },          { 2, 1, 1, SHORTEST_SEGMENT, BASIS_GUESSED },
    { 2, 0, 2, LENGTH_OF_SMALLEST, BASIS_OF_SMALLEST }, { 3, 0, 5, LENGTH_OF_SMALLEST, BASIS_OF_SMALLEST },
    { 3, 0, 5, LONG_SEGMENT, BASIS_OF_SMALLEST },
};
#define ATTEMPTS (sizeof attempts / sizeof *attempts)

static int set_options(encoder *e, const clip_options *given)
{
    clip_options *o = &e->options;
    *o = *given;
    if (o->error_cm == 0.0) o->error_cm = DEFAULT_ERROR_CM;
    if (o->shell_cm == 0.0) o->shell_cm = DEFAULT_SHELL_CM;
    if (o->float_error == 0.0) o->float_error = DEFAULT_FLOAT_ERROR;
    if (!(o->error_cm >= 1e-6 && o->error_cm <= 400.0)) return enc_fail(e, "error_cm: 0.000001 to 400");
    if (!(o->shell_cm >= 1e-3 && o->shell_cm <= 1e5)) return enc_fail(e, "shell_cm: 0.001 to 100000");
    if (o->split_hz == 0.0) o->split_hz = DEFAULT_SPLIT_HZ;
    if (!(o->split_hz > 0.0)) return enc_fail(e, "split_hz: above 0");
    if (!(o->float_error > 0.0)) return enc_fail(e, "float_error: above 0");
    if (o->segment_frames && (o->segment_frames < SEGMENT_FRAMES_MIN || o->segment_frames > SEGMENT_FRAMES_MAX))
        return enc_fail(e, "segment_frames: 8 to 40");
    if (!(e->skeleton->unit_cm > 0.0)) return enc_fail(e, "unit_cm: above 0");
    e->unit_cm = e->skeleton->unit_cm;
    e->bound = o->error_cm * e->tight / e->unit_cm;
    if (o->effort > EFFORT_MAX) return enc_fail(e, "effort: 1 to 3");
    if (o->effort == 0u) o->effort = EFFORT_USUAL;
    if (!o->segment_frames) o->segment_frames = e->attempt_frames;
    e->tunings = tunings + e->attempt->first;
    e->tuning_count = e->attempt->count;
    return 0;
}

static int new_loop(encoder *e)
{
    enc_loop *l = enc_alloc(e, 1, sizeof *l);
    e->loop = l;
    if (!l) return 1;
    l->local = enc_alloc(e, (size_t)e->joint_count * ENC_FRAMES_MAX, sizeof *l->local);
    l->global = enc_alloc(e, (size_t)e->joint_count * ENC_FRAMES_MAX, sizeof *l->global);
    l->raw_between = enc_alloc(e, (size_t)e->joint_count * ENC_FRAMES_MAX * (ENC_PARTS - 1), sizeof *l->raw_between);
    l->before = enc_alloc(e, e->joint_count, sizeof *l->before);
    l->between = enc_alloc(e, (size_t)e->joint_count * ENC_FRAMES_MAX * (ENC_PARTS - 1), sizeof *l->between);
    l->local_before = enc_alloc(e, ENC_FRAMES_MAX, sizeof *l->local_before);
    l->global_before = enc_alloc(e, ENC_FRAMES_MAX, sizeof *l->global_before);
    l->stale = enc_alloc(e, e->joint_count, sizeof *l->stale);
    l->moved = enc_alloc(e, e->joint_count, sizeof *l->moved);
    l->end = enc_alloc(e, e->joint_count, sizeof *l->end);
    l->errors = enc_alloc(e, (size_t)e->joint_count * ENC_FRAMES_MAX * ENC_PARTS, sizeof *l->errors);
    l->errors_before = enc_alloc(e, e->joint_count, sizeof *l->errors);
    l->errors_end = enc_alloc(e, e->joint_count, sizeof *l->errors);
    l->slack = enc_alloc(e, (size_t)e->joint_count * ENC_FRAMES_MAX, sizeof *l->slack);
    l->floor = enc_alloc(e, (size_t)e->joint_count * ENC_FRAMES_MAX, sizeof *l->floor);
    l->turns = enc_alloc(e, (size_t)e->joint_count * ENC_FRAMES_MAX, sizeof *l->turns);
    l->raw = enc_alloc(e, e->joint_count, sizeof *l->raw);
    return !l->turns || !l->raw || !l->slack || !l->floor || !l->errors || !l->errors_before || !l->errors_end ||
           !l->end || !l->local || !l->global || !l->raw_between || !l->before || !l->between || !l->local_before ||
           !l->global_before || !l->stale || !l->moved;
}

static void free_segments(encoder *e)
{
    for (uint32_t s = 0; e->segments && s < e->segment_count; s++) {
        enc_free_pieces(e, e->segments[s].pieces);
    }
    free(e->segments);
}

static void free_encoder(encoder *e)
{
    free_segments(e);
    for (uint32_t j = 0; e->joints && j < e->joint_count; j++) free(e->joints[j].points);
    enc_free_bases(e);
    if (e->loop) {
        free(e->loop->local);
        free(e->loop->global);
        free(e->loop->raw_between);
        free(e->loop->before);
        free(e->loop->between);
        free(e->loop->local_before);
        free(e->loop->global_before);
        free(e->loop->stale);
        free(e->loop->moved);
        free(e->loop->end);
        free(e->loop->errors);
        free(e->loop->errors_before);
        free(e->loop->errors_end);
        free(e->loop->turns);
        free(e->loop->slack);
        free(e->loop->floor);
        free(e->loop->raw);
        free(e->loop);
    }
    free(e->joints);
    free(e->bind);
    free(e->local);
    free(e->global);
    free(e->floats);
    free(e->float_bounds);
    free(e->tracks);
}

/* The header holds the certificate, which is known only once the clip has been decoded: so the header is written twice.
 */
static int write_certified(encoder *e, byte_buffer *out, double *worst_part)
{
    clip_report *r = &e->report;
    clip_histogram *histogram = e->options.histogram;
    const size_t begin = out->count;
    uint32_t time_parts;
    e->options.histogram = NULL;
    if (enc_choose_splits(e) || enc_write(e, 0.0, 0.0, 0, 0, out)) return 1;
    if (enc_certify(e, out, begin, worst_part, &r->max_error_cm, &r->rms_error_cm, &r->max_error_joint, &time_parts))
        return 1;
    if (!(*worst_part <= 1.0)) return 0;
    out->count = begin;
    e->options.histogram = histogram;
    if (enc_write(e, r->max_error_cm, r->rms_error_cm, r->max_error_joint, time_parts, out)) return 1;
    r->bytes = out->count - begin;
    r->max_error_time_s = (double)time_parts / ENC_PARTS / e->clip->sample_rate_hz;
    r->segment_count = e->segment_count;
    r->wide = e->wide;
    r->raw_bytes = (size_t)e->frame_count * (e->joint_count * RAW_JOINT_BYTES + e->float_count * RAW_FLOAT_BYTES);
    return 0;
}

/* All attempts count alike, though the later ones take longer. */
static void report_progress(const encoder *e, uint32_t segments)
{
    const uint32_t before = (uint32_t)(e->attempt - attempts) * e->segment_count;
    uint32_t count = 0;
    while (count < ATTEMPTS && attempts[count].effort <= e->options.effort) count++;
    if (e->options.progress) e->options.progress(e->options.user, before + segments, count * e->segment_count);
}

/* One attempt. *worst_part is above 1 if the bound did not hold; `out` is then as before. *decoded: whether only
 * decoding showed it. */
static int encode_once(encoder *e, byte_buffer *out, double *worst_part, int *decoded)
{
    static const double drops[LEVELS] = { ENC_DROP, 0.01, 0.0 };
    const size_t begin = out->count;
    int failed;
    e->drop = drops[e->level];
    *worst_part = 0.0;
    *decoded = 0;
    if (enc_prepare(e) || enc_analyse(e) || enc_choose_basis(e) || new_loop(e)) return 1;
    for (uint32_t s = 0; s < e->segment_count; s++) {
        double worst;
        if (enc_segment_fit(e, s, &worst)) return 1;
        if (!(worst <= 1.0)) {
            *worst_part = worst;
            return 0;
        }
        report_progress(e, s + 1u);
    }
    *decoded = 1;
    failed = write_certified(e, out, worst_part);
    if (failed || !(*worst_part <= 1.0)) out->count = begin;
    return failed;
}

/* At the first level at which the bound holds. */
static int encode_attempt(encoder *e, const encoder *from, byte_buffer *out, clip_report *report)
{
    double worst_part = 2.0, tight = 1.0;
    int failed = 0, level = 0;
    while (level < LEVELS && !failed && !(worst_part <= 1.0)) {
        int decoded = 0;
        *e = *from;
        e->level = level;
        e->tight = tight;
        failed = set_options(e, &from->options) || encode_once(e, out, &worst_part, &decoded);
        if (!failed && worst_part <= 1.0) {
            *report = e->report;
            report->level = level;
            report->parabola = e->parabola;
        }
        if (decoded && level < LEVELS - 1 && worst_part < TIGHTEN_MAX && tight > TIGHT_MIN) {
            tight *= TIGHTEN /
                     worst_part; /* leave room for the rounding to single precision, which the loop does not see */
        } else {
            level++;
            tight = 1.0;
        }
        if (!failed && level == LEVELS && !(worst_part <= 1.0)) {
            (void)enc_fail(e, "the error bound is below single precision this far from the origin: raise the bound");
            failed = CLIP_TOO_FINE;
        }
        free_encoder(e);
    }
    return failed;
}

/* Whether an attempt may give something else than those before it. Long segments have paid at high rates only, short
 * ones at low rates. */
static int is_tried(const encoder *from, const attempt *a)
{
    const clip_options *o = &from->options;
    const raw_clip *c = from->clip;
    if (a->effort > (o->effort ? o->effort : EFFORT_USUAL)) return 0;
    if (a->segment_frames == USUAL_LENGTH || a->segment_frames == LENGTH_OF_SMALLEST) return 1;
    return !o->segment_frames && c->joint_count && c->frame_count > a->segment_frames &&
           (a->segment_frames == LONG_SEGMENT) == (c->sample_rate_hz > FAST_HZ);
}

/* least: bytes of the smallest attempt so far */
static int is_smaller(const attempt *a, size_t bytes, size_t least)
{
    const int is_short = a->segment_frames == SHORT_SEGMENT || a->segment_frames == SHORTEST_SEGMENT;
    return (double)bytes < (double)least * (is_short ? SHORT_PAYS : 1.0);
}

/* parabola: whether the smallest attempt so far has it */
static enc_basis basis_of(const attempt *a, uint32_t parabola)
{
    if (a->basis == BASIS_GUESSED) return ENC_BASIS_GUESSED;
    if (a->basis == BASIS_OTHER) parabola = !parabola;
    return parabola ? ENC_BASIS_PARABOLA : ENC_BASIS_COSINES;
}

int clip_encode(const raw_skeleton *skeleton, const raw_clip *clip, const clip_options *options, byte_buffer *out,
                clip_report *report, model_error *error)
{
    encoder *e = calloc(2, sizeof *e); /* their bases are too large for some stacks */
    encoder *from;
    byte_buffer best;
    uint32_t parabola = 0, segment_frames = USUAL_LENGTH; /* of the smallest so far */
    int failed = 0, found = 0;
    if (!e) {
        if (error) snprintf(error->what, sizeof error->what, "out of memory");
        return 1;
    }
    from = e + 1;
    memset(&best, 0, sizeof best);
    from->skeleton = skeleton;
    from->clip = clip;
    from->error = error;
    if (options) from->options = *options;
    for (size_t i = 0; i < ATTEMPTS && !failed; i++) {
        byte_buffer bytes;
        clip_report r;
        if (!is_tried(from, &attempts[i])) continue;
        from->attempt = &attempts[i];
        from->basis = basis_of(&attempts[i], parabola);
        from->attempt_frames = attempts[i].segment_frames == LENGTH_OF_SMALLEST ? segment_frames
                                                                                : attempts[i].segment_frames;
        memset(&bytes, 0, sizeof bytes);
        failed = encode_attempt(e, from, &bytes, &r);
        if (!failed && (!found || is_smaller(&attempts[i], bytes.count, best.count))) {
            byte_buffer swap = best;
            best = bytes;
            bytes = swap;
            if (report) *report = r;
            parabola = r.parabola;
            segment_frames = from->attempt_frames;
            found = 1;
        }
        buffer_free(&bytes);
    }
    if (!failed) buffer_append(out, best.bytes, best.count);
    buffer_free(&best);
    free(e);
    return failed ? failed : out->failed != 0;
}
