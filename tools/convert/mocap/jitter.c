#include "jitter.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/base/angle.h"
#include "convert/clips/raw_set.h"
#include "track.h"

#define DEGREE (3.14159265358979323846 / 180.0)
#define FRAMES_LEAST 16u
#define NORMAL_MEDIAN 0.67448975019608171 /* of the absolute value of a normal number */
#define MOST 4.0                          /* times the noise: how far a sample is moved */

typedef struct filter {
    mocap_track track;
    double *scratch; /* [frame_count + 2 pad] one component with what lies before and after it */
    double *out;     /* [frame_count][width] */
    uint32_t pad;
    int loop;
} filter;

/* ---- how strong ---- */

/* The noise of one component, by its differences of an order, which are sqrt(sum of squared binomials) times as large.
 */
static double noise_by(const filter *f, uint32_t component, uint32_t order, double growth)
{
    const uint32_t count = f->track.frame_count - order;
    for (uint32_t i = 0; i < f->track.frame_count; i++) {
        f->scratch[i] = f->track.x[(size_t)i * f->track.width + component];
    }
    for (uint32_t k = 0; k < order; k++) {
        for (uint32_t i = 0; i + 1u + k < f->track.frame_count; i++) f->scratch[i] = f->scratch[i + 1u] - f->scratch[i];
    }
    for (uint32_t i = 0; i < count; i++) f->scratch[i] = fabs(f->scratch[i]);
    return mocap_rank(f->scratch, count, count / 2u) / (NORMAL_MEDIAN * growth);
}

/* The noise of all components together; 0: all of it is motion. */
static double noise_of(const filter *f)
{
    double sixth = 0.0, fourth = 0.0;
    for (uint32_t i = 0; i < f->track.width; i++) {
        const double a = noise_by(f, i, 6u, sqrt(924.0)), b = noise_by(f, i, 4u, sqrt(70.0));
        sixth += a * a;
        fourth += b * b;
    }
    return sixth > 0.36 * fourth ? sqrt(sixth) : 0.0;
}

/* ---- filtering ---- */

/* One way over `count` numbers, in place; it starts at rest on the first. */
static void butterworth(double *x, uint32_t count, double cutoff, int backward)
{
    double sine, cosine, k, a0, b[3], a[2];
    angle_sin_cos_degrees(180.0 * cutoff, &sine, &cosine);
    k = sine / cosine;
    a0 = 1.0 + sqrt(2.0) * k + k * k;
    b[0] = b[2] = k * k / a0;
    b[1] = 2.0 * b[0];
    a[0] = 2.0 * (k * k - 1.0) / a0;
    a[1] = (1.0 - sqrt(2.0) * k + k * k) / a0;
    double x1 = x[backward ? count - 1u : 0], x2 = x1, y1 = x1, y2 = x1;
    for (uint32_t i = 0; i < count; i++) {
        double *at = x + (backward ? count - 1u - i : i);
        const double y = b[0] * *at + b[1] * x1 + b[2] * x2 - a[0] * y1 - a[1] * y2;
        x2 = x1;
        x1 = *at;
        y2 = y1;
        y1 = y;
        *at = y;
    }
}

/* Frames before the first and after the last: the loop, or the motion turned about its end. */
static double sample(const filter *f, int64_t frame, uint32_t component)
{
    const int64_t last = (int64_t)f->track.frame_count - 1;
    int64_t at = frame;
    double about = 0.0;
    int mirrored = 0;
    if (f->loop) {
        at = ((frame % last) + last) % last; /* the last frame equals the first */
    } else if (frame < 0 || frame > last) {
        at = frame < 0 ? -frame : 2 * last - frame;
        about = f->track.x[(size_t)(frame < 0 ? 0 : last) * f->track.width + component];
        mirrored = 1;
    }
    const double x = f->track.x[(size_t)at * f->track.width + component];
    return mirrored ? 2.0 * about - x : x;
}

/* At a cut-off in cycles per sample, as both passes together have it. */
static void pass(filter *f, double cutoff)
{
    /* Two passes halve the power twice: each has its own cut-off higher by (sqrt(2) - 1)^(-1/4). */
    const double own = cutoff * 1.2465206;
    const uint32_t count = f->track.frame_count, whole = count + 2u * f->pad;
    for (uint32_t c = 0; c < f->track.width; c++) {
        for (uint32_t i = 0; i < whole; i++) f->scratch[i] = sample(f, (int64_t)i - f->pad, c);
        butterworth(f->scratch, whole, own, 0);
        butterworth(f->scratch, whole, own, 1);
        for (uint32_t i = 0; i < count; i++) f->out[(size_t)i * f->track.width + c] = f->scratch[i + f->pad];
    }
}

/* How far f->out is from what there was: root mean square, a sample counting up to `most`, since hits stay (take). */
static double residual(const filter *f, double most)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < f->track.frame_count; i++) {
        double square = 0.0;
        for (size_t at = (size_t)i * f->track.width; at < (size_t)(i + 1u) * f->track.width; at++) {
            square += (f->out[at] - f->track.x[at]) * (f->out[at] - f->track.x[at]);
        }
        sum += fmin(square, most * most);
    }
    return sqrt(sum / f->track.frame_count);
}

/* The lowest cut-off that removes no more than the noise; 0: none. f->out is its output. */
static double lowest_cutoff(filter *f, double noise)
{
    double best = 0.0;
    for (double cutoff = 0.35; cutoff > 0.005; cutoff /= 1.15) {
        pass(f, cutoff);
        if (residual(f, MOST * noise) > 1.1 * noise * sqrt(1.0 - 2.0 * cutoff)) break;
        best = cutoff;
    }
    if (best > 0.0) pass(f, best);
    return best;
}

/* Take f->out, but move no sample by more than `most`. */
static void take(filter *f, double most)
{
    for (uint32_t i = 0; i < f->track.frame_count; i++) {
        double *x = f->track.x + (size_t)i * f->track.width;
        const double *y = f->out + (size_t)i * f->track.width;
        double square = 0.0, share;
        for (uint32_t c = 0; c < f->track.width; c++) square += (y[c] - x[c]) * (y[c] - x[c]);
        share = square > most * most ? most / sqrt(square) : 1.0;
        for (uint32_t c = 0; c < f->track.width; c++) x[c] += share * (y[c] - x[c]);
    }
    if (f->loop) {
        memcpy(f->track.x + (size_t)(f->track.frame_count - 1u) * f->track.width, f->track.x,
               f->track.width * sizeof *f->track.x);
    }
}

static void filter_track(filter *f, const raw_skeleton *skeleton, raw_clip *clip, jitter_report *report)
{
    const int turns = f->track.kind == MOCAP_ROTATION;
    /* a unit quaternion moves by half of the angle */
    const double unit = turns ? 2.0 / DEGREE : skeleton->unit_cm, noise = noise_of(f);
    double cutoff;
    if (noise * unit < (turns ? JITTER_LEAST_DEGREES : JITTER_LEAST_CM)) return;
    cutoff = lowest_cutoff(f, noise);
    if (cutoff == 0.0) return;
    take(f, MOST * noise);
    mocap_track_write(&f->track, 0, clip->frame_count, clip);
    report->tracks++;
    if (turns) report->degrees = fmax(report->degrees, noise * unit);
    if (!turns) report->cm = fmax(report->cm, noise * unit);
    cutoff *= clip->sample_rate_hz;
    report->cutoff_hz = report->cutoff_hz > 0.0 ? fmin(report->cutoff_hz, cutoff) : cutoff;
}

/* ---- how far it went ---- */

static int measure(const raw_skeleton *skeleton, const raw_clip *before, const raw_clip *after, jitter_report *report)
{
    double *a = malloc((size_t)skeleton->joint_count * 24u * sizeof *a), *b;
    double sum = 0.0;
    if (!a) return 1;
    b = a + (size_t)skeleton->joint_count * 12u;
    for (uint32_t f = 0; f < after->frame_count; f++) {
        raw_pose_object(skeleton, before, f, a);
        raw_pose_object(skeleton, after, f, b);
        for (uint32_t j = 0; j < skeleton->joint_count; j++) {
            double square = 0.0;
            for (uint32_t i = 9; i < 12; i++)
                square += (a[12u * j + i] - b[12u * j + i]) * (a[12u * j + i] - b[12u * j + i]);
            square *= skeleton->unit_cm * skeleton->unit_cm;
            sum += square;
            report->worst_cm = fmax(report->worst_cm, sqrt(square));
        }
    }
    report->moved_cm = sqrt(sum / after->frame_count / skeleton->joint_count);
    free(a);
    return 0;
}

static int filter_all(filter *f, const raw_skeleton *skeleton, raw_clip *clip, jitter_report *report)
{
    const size_t joints = (size_t)clip->frame_count * clip->joint_count;
    const uint32_t before = report->tracks;
    raw_clip was = *clip;
    int failed;
    was.rotations = malloc(joints * 4u * sizeof(float));
    was.translations = malloc(joints * 3u * sizeof(float));
    failed = !was.rotations || !was.translations;
    if (!failed) {
        memcpy(was.rotations, clip->rotations, joints * 4u * sizeof(float));
        memcpy(was.translations, clip->translations, joints * 3u * sizeof(float));
        for (uint32_t t = 0; t < 2u * clip->joint_count; t++) {
            mocap_track_read(clip, t / 2u, t % 2u ? MOCAP_TRANSLATION : MOCAP_ROTATION, &f->track);
            filter_track(f, skeleton, clip, report);
        }
        if (report->tracks > before) failed = measure(skeleton, &was, clip, report);
    }
    free(was.rotations);
    free(was.translations);
    return failed;
}

int jitter_filter(const raw_skeleton *skeleton, raw_clip *clip, jitter_report *report)
{
    filter f = { .loop = clip->loop };
    int failed;
    report->moved_cm = 0.0;
    if (clip->frame_count < FRAMES_LEAST || !clip->joint_count) return 0;
    f.pad = clip->frame_count - 1u < 64u ? clip->frame_count - 1u : 64u;
    f.scratch = malloc((clip->frame_count + 2u * f.pad) * sizeof *f.scratch);
    f.out = malloc((size_t)clip->frame_count * 4u * sizeof *f.out);
    failed = mocap_track_alloc(clip, &f.track) || !f.scratch || !f.out || filter_all(&f, skeleton, clip, report);
    mocap_track_free(&f.track);
    free(f.scratch);
    free(f.out);
    return failed;
}
