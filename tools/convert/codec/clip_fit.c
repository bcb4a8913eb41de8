/* clip_fit.c: one track of one segment, quantised with the largest step that its check allows.
 *
 * The track's components are transformed by an orthonormal DCT along time: a smooth clip has nearly all of its
 * energy in the first coefficients, and the rest quantise to zero. All coefficients share one step: the transform is
 * orthonormal, so an error in any of them has the same energy in time. Each step is judged by decoding with the
 * runtime's own arithmetic and asking `check`, so nothing is assumed about how the error depends on the step.
 *
 * Steps (quarters of an octave) are tried from large to small, starting two octaves above what the last segment took.
 * A step that just fails gets a few more attempts: the targets of the frames out of bounds are pushed against their
 * error, which makes the quantiser round some coefficients the other way. */
#include <stdlib.h>

#include "clip_encoder.h"

#define IDS_ABOVE 8 /* larger steps than the guess that are tried: two octaves */
#define IDS_RAISE 4
#define HOPELESS 1.8 /* a violation that nudging cannot repair */
#define HOPELESS_SEARCH 3.0
#define NEARLY 0.97
#define PUSH 0.5
/* a finer step that fails too must reduce the violation at least to this share per octave */
#define WORTH_AN_OCTAVE 0.9
#define FRAME_BYTES 16u /* of a frame as `check` sees it */

int enc_quat_codes(const double q[4], uint32_t width, uint32_t codes[4])
{
    const double mid = (double)((1u << (width - 1u)) - 1u);
    uint32_t largest = 0, k = 0;
    double sign;
    for (uint32_t i = 1; i < 4u; i++) {
        if (fabs(q[i]) > fabs(q[largest])) largest = i;
    }
    sign = q[largest] < 0.0 ? -1.0 : 1.0;
    for (uint32_t i = 0; i < 4u; i++) {
        double v;
        if (i == largest) continue;
        v = floor(sign * q[i] * mid * 1.41421356237309504880 + 0.5);
        codes[k++] = (uint32_t)(int32_t)((v > mid ? mid : v < -mid ? -mid : v) + mid);
    }
    codes[3] = largest;
    return sign < 0.0;
}

void enc_quat_value(const uint32_t codes[4], uint32_t width, float q[4])
{
    noh_clip_quat_expand(codes, codes[3], width, q);
}

/* Components into the track's mixed axes. */
static void into_axes(const enc_track *t, double v[3])
{
    const float *m = t->track.mix;
    const double a = v[0], b = v[1], c = v[2];
    if (t->track.kind == NOH_CLIP_FLOATS) {
        for (int i = 0; i < 3; i++) v[i] /= (double)m[4 * i];
    } else if (t->track.flags & NOH_CLIP_TRACK_MIX) {
        for (int i = 0; i < 3; i++) v[i] = (double)m[i] * a + (double)m[3 + i] * b + (double)m[6 + i] * c;
    }
}

/* Add the effect of a change of one frame's components, in mixed axes, to the spectrum. */
static void add_frame(const encoder *e, uint32_t n, uint32_t f, const double x[3], double (*out)[3])
{
    const double *b = e->transforms[n] + f;
    for (uint32_t k = 0; k < n; k++, b += n) {
        out[k][0] += *b * x[0];
        out[k][1] += *b * x[1];
        out[k][2] += *b * x[2];
    }
}

/* The orthonormal transform of three components, in the track's mixed axes. Rows are even and odd in turn. */
static void forward(const encoder *e, const enc_track *t, uint32_t n, double (*x)[3], double (*out)[3])
{
    double sums[2][(ENC_FRAMES_MAX + 1u) / 2u][3];
    const uint32_t half = n / 2u;
    const double *b = e->transforms[n];
    for (uint32_t f = 0; f < half; f++) {
        for (int c = 0; c < 3; c++) {
            sums[0][f][c] = x[f][c] + x[n - 1u - f][c];
            sums[1][f][c] = x[f][c] - x[n - 1u - f][c];
        }
    }
    for (int c = 0; c < 3 && n % 2u; c++) {
        sums[0][half][c] = x[half][c];
        sums[1][half][c] = 0.0;
    }
    for (uint32_t k = 0; k < n; k++, b += n) {
        const double(*s)[3] = (const double(*)[3])sums[k % 2u];
        double a[3] = { 0.0, 0.0, 0.0 };
        for (uint32_t f = 0; f < half + n % 2u; f++) {
            a[0] += b[f] * s[f][0];
            a[1] += b[f] * s[f][1];
            a[2] += b[f] * s[f][2];
        }
        into_axes(t, a);
        memcpy(out[k], a, sizeof a);
    }
}

/* Returns 0 if a coefficient exceeds the format's limit. */
static int quantise(const encoder *e, double (*spectrum)[3], uint32_t n, double step, enc_piece *piece)
{
    uint32_t last = 0;
    for (uint32_t k = 0; k < n; k++) {
        for (int c = 0; c < 3; c++) {
            const double v = floor(fabs(spectrum[k][c]) / step + 0.5 - (k ? e->tuning.dead_zone : 0.0));
            if (!(v < (double)(1u << (NOH_CLIP_MAGNITUDE_BITS - 1u)))) return 0;
            piece->coefs[k][c] = spectrum[k][c] < 0.0 ? -(int32_t)v : (int32_t)v;
            if (v > 0.0) last = k + 1u;
        }
    }
    piece->last = (uint8_t)last;
    return 1;
}

typedef struct attempt {
    encoder *e;
    enc_track *track;
    enc_piece *piece;
    uint32_t count;
    const float *reference;
    const enc_model *model;
    double whole[ENC_FRAMES_MAX][3]; /* the spectrum of the targets before nudging, which does not depend on the step */
    float components[ENC_FRAMES_MAX][4];
    uint8_t frames[ENC_FRAMES_MAX * FRAME_BYTES];
} attempt;

/* Decode the coefficients as the runtime does. */
static void decode(attempt *a, int id)
{
    const noh_clip_basis *basis = &a->e->bases[a->count];
    const float step = noh_clip_step((uint32_t)id);
    const int32_t(*coefs)[4] = (const int32_t(*)[4])a->piece->coefs;
    const float(*components)[4] = (const float(*)[4])a->components;
    noh_clip_dequantise(coefs, a->piece->last, step,
                        a->track->track.flags & NOH_CLIP_TRACK_MIX ? a->track->track.mix : NULL, a->components);
    if (a->track->track.kind == NOH_CLIP_ROTATION) {
        noh_clip_synth_rotation(basis, components, a->piece->last, a->reference, a->e->wide, a->frames, FRAME_BYTES);
    } else {
        noh_clip_synth_linear(basis, components, a->piece->last, a->reference, a->frames, FRAME_BYTES);
    }
    a->piece->step = (uint8_t)id;
}

static int try_spectrum(attempt *a, double (*spectrum)[3], int id)
{
    if (!quantise(a->e, spectrum, a->count, (double)noh_clip_step((uint32_t)id), a->piece)) return 0;
    decode(a, id);
    return 1;
}

/* Push the targets of frames out of bounds against their error. */
static void nudge(attempt *a, double (*targets)[3], double (*spectrum)[3], const double *violations)
{
    const float zero[3] = { 0.0f, 0.0f, 0.0f };
    uint8_t decoded[ENC_FRAMES_MAX * FRAME_BYTES];
    noh_clip_synth_linear(&a->e->bases[a->count], (const float(*)[4])a->components, a->piece->last, zero, decoded,
                          FRAME_BYTES);
    for (uint32_t f = 0; f < a->count; f++) {
        float u[3];
        double push[3];
        if (violations[f] <= NEARLY) continue;
        memcpy(u, decoded + f * FRAME_BYTES, sizeof u);
        for (int c = 0; c < 3; c++) push[c] = PUSH * (targets[f][c] - (double)u[c]);
        into_axes(a->track, push);
        add_frame(a->e, a->count, f, push, spectrum);
    }
}

/* Returns whether the step holds; *first is the violation before any nudge. */
static int try_nudged(attempt *a, double (*targets)[3], int id, enc_check check, void *user, double *first)
{
    double spectrum[ENC_FRAMES_MAX][3], violations[ENC_FRAMES_MAX];
    *first = INFINITY;
    memcpy(spectrum, a->whole, a->count * sizeof *spectrum);
    for (int i = 0; i <= a->e->tuning.nudges; i++) {
        double v;
        if (!try_spectrum(a, spectrum, id)) return 0;
        v = check(a->e, user, a->frames, violations);
        if (i == 0) *first = v;
        if (v <= 1.0) return 1;
        if (!(v <= HOPELESS) || i == a->e->tuning.nudges) return 0;
        nudge(a, targets, spectrum, violations);
    }
    return 0;
}

/* The same with a search for coefficients. */
static int try_searched(attempt *a, int id, enc_check check, void *user, double *first)
{
    double violations[ENC_FRAMES_MAX];
    *first = INFINITY;
    if (!try_spectrum(a, a->whole, id)) return 0;
    *first = check(a->e, user, a->frames, violations);
    if (!(*first <= HOPELESS_SEARCH)) return 0;
    if (*first <= 1.0 && !a->e->tuning.thins) return 1;
    if (!enc_search(a->e, a->model, a->count, a->whole, a->piece, (double)noh_clip_step((uint32_t)id))) return 0;
    decode(a, id);
    return check(a->e, user, a->frames, violations) <= 1.0;
}

static int clamp_id(int id)
{
    return id < 0 ? 0 : id >= (int)NOH_CLIP_STEP_IDS ? (int)NOH_CLIP_STEP_IDS - 1 : id;
}

/* Ids to skip after a violation: errors grow with the step, so after a large violation the next step that may hold is
 * far away. */
static int stride_after(double violation)
{
    const double octaves = violation > HOPELESS && violation < 1e30 ? log2(violation / HOPELESS) : 0.0;
    return 1 + (int)(4.0 * octaves);
}

/* Find the largest step that holds and fill the piece. If none does, returns 0 and the id of the least violation. */
static int search(attempt *a, double (*targets)[3], enc_check check, void *user, int *best)
{
    const int guess = a->track->step_guess;
    int start = clamp_id(guess - IDS_ABOVE), id = start;
    double least = INFINITY;
    *best = clamp_id(guess);
    while (id < (int)NOH_CLIP_STEP_IDS) {
        double v;
        if ((a->model && try_searched(a, id, check, user, &v)) || try_nudged(a, targets, id, check, user, &v)) {
            if (id != start || start == 0 || a->piece->last == 0u)
                return 1; /* no larger step holds, or none is needed */
            start = id = clamp_id(start - IDS_RAISE);
            continue;
        }
        if (v < least * WORTH_AN_OCTAVE) {
            least = v;
            *best = id;
        }
        id += stride_after(v);
    }
    return 0;
}

int enc_fit(encoder *e, enc_track *track, enc_piece *piece, uint32_t count, const enc_goal *goal)
{
    double violations[ENC_FRAMES_MAX];
    attempt a;
    int best;
    a.e = e;
    a.track = track;
    a.piece = piece;
    a.count = count;
    a.reference = goal->reference;
    a.model = goal->model;
    forward(e, track, count, goal->targets, a.whole);
    if (!search(&a, goal->targets, goal->check, goal->user, &best) && !try_spectrum(&a, a.whole, best)) return 1;
    goal->check(e, goal->user, a.frames, violations);
    return 0;
}
