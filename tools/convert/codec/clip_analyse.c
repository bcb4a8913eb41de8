/* clip_analyse.c: which tracks of each joint are animated, how far their errors are felt, and what their values are
 * relative to.
 *
 * A track whose whole range moves no point by more than a small share of the bound is stored as a constant. An error of
 * a rotation moves everything below the joint: its "lever" is the farthest such point that no animated joint in between
 * can correct. Animated rotations are stored relative to a reference (their mean, or the bind pose where that is near),
 * as three numbers that grow in proportion to the angle. If the three are correlated, as in a hinge that is not aligned
 * with an axis, they are rotated to the axes of their covariance (`find_mix`), which leaves fewer coefficients to
 * store. */
#include <stdlib.h>

#include "clip_encoder.h"

#define SAMPLES 50u  /* frames that levers are judged by */
#define WILD_RAD 2.2 /* radians from the mean: a rotation that goes farther stores a reference with each segment */
#define NEAR_BIND_RAD 1.2
/* in units of 0.01 cm of bound: with longer levers the 16 bits of cached rotations would show */
#define WIDE_LEVER 125.0
#define CONSTANT_PART 0.04 /* share of the bound that the coding of a constant may take */
#define MIX_COST_BITS 39.0 /* 27 bits of header and nearly half as much again, so that it pays */
#define LOOSE 1e300

enum { ROTATION, TRANSLATION, SCALE };

static uint32_t stride_of(const encoder *e)
{
    return e->frame_count > SAMPLES ? e->frame_count / SAMPLES : 1u;
}

/* The largest scale that a joint's parents give it. */
static double parent_scale(const encoder *e, uint32_t joint)
{
    const uint32_t p = e->joints[joint].parent;
    double worst = p == ENC_NONE ? 1.0 : 0.0;
    for (uint32_t f = 0; p != ENC_NONE && f < e->frame_count; f += stride_of(e)) {
        const double *m = enc_global(e, f, p)->m;
        for (int k = 0; k < 3; k++) {
            const double n = sqrt(m[k] * m[k] + m[3 + k] * m[3 + k] + m[6 + k] * m[6 + k]);
            if (n > worst) worst = n;
        }
    }
    return worst;
}

static const double *part(const space_local *l, int what)
{
    return what == SCALE ? l->s : l->t;
}

/* The middle of a linear track's range; returns the range. */
static double linear_range(const encoder *e, uint32_t joint, int what, double middle[3])
{
    double range = 0.0;
    for (int i = 0; i < 3; i++) {
        double low = LOOSE, high = -LOOSE;
        for (uint32_t f = 0; f < e->frame_count; f++) {
            const double v = part(enc_local(e, f, joint), what)[i];
            if (v < low) low = v;
            if (v > high) high = v;
        }
        middle[i] = low + (high - low) / 2.0;
        if (high - low > range) range = high - low;
    }
    return range;
}

/* The mean rotation; returns the largest angle from it, 0..2 pi, signs as unwrapped. */
static double rotation_range(const encoder *e, uint32_t joint, double mean[4])
{
    double worst = 0.0;
    memset(mean, 0, 4 * sizeof *mean);
    for (uint32_t f = 0; f < e->frame_count; f++) {
        for (int i = 0; i < 4; i++) mean[i] += enc_local(e, f, joint)->q[i];
    }
    space_unit(mean);
    for (uint32_t f = 0; f < e->frame_count; f++) {
        const double *q = enc_local(e, f, joint)->q;
        double angle = space_angle(mean, q);
        if (space_dot(mean, q) < 0.0) angle = 6.28318530717958647693 - angle;
        if (angle > worst) worst = angle;
    }
    return worst;
}

/* Returns 1 when out of memory. */
static int find_modes(encoder *e)
{
    double *lever = enc_alloc(e, e->joint_count, sizeof *lever);
    double value[4];
    if (!lever) return 1;
    for (uint32_t j = e->joint_count; j-- > 0u;) {
        enc_joint *t = &e->joints[j];
        const double scale = parent_scale(e, j);
        double radius;
        t->bound = e->bound;
        if (e->options.joint_error_cm && e->options.joint_error_cm[j] > 0.0)
            t->bound = e->options.joint_error_cm[j] * e->tight / e->unit_cm;
        radius = lever[j] > t->reach ? lever[j] : t->reach;
        t->lever = radius;
        t->modes[TRANSLATION] = linear_range(e, j, TRANSLATION, value) * scale > e->drop * t->bound
                                    ? NOH_CLIP_MODE_ANIMATED
                                    : NOH_CLIP_MODE_CONSTANT;
        t->modes[SCALE] = linear_range(e, j, SCALE, value) * scale * radius > e->drop * t->bound
                              ? NOH_CLIP_MODE_ANIMATED
                              : NOH_CLIP_MODE_CONSTANT;
        t->modes[ROTATION] = rotation_range(e, j, value) * radius > e->drop * t->bound ? NOH_CLIP_MODE_ANIMATED
                                                                                       : NOH_CLIP_MODE_CONSTANT;
        if (t->parent != ENC_NONE && (t->modes[TRANSLATION] != NOH_CLIP_MODE_ANIMATED || e->options.open_loop)) {
            for (uint32_t f = 0; f < e->frame_count; f += stride_of(e)) {
                double d = space_distance(enc_global(e, f, j)->p, enc_global(e, f, t->parent)->p);
                if (e->options.open_loop || t->modes[ROTATION] != NOH_CLIP_MODE_ANIMATED)
                    d += radius > t->reach ? radius : 0.0;
                if (d > lever[t->parent]) lever[t->parent] = d;
            }
        }
    }
    free(lever);
    return 0;
}

/* Whether `joint` moves rigidly with `carrier`: all joints between them are constant. */
static int carried(const encoder *e, uint32_t carrier, uint32_t joint)
{
    while (joint != carrier) {
        const enc_joint *t = &e->joints[joint];
        const enc_joint *p;
        if (t->modes[TRANSLATION] == NOH_CLIP_MODE_ANIMATED || t->parent == ENC_NONE) return 0;
        joint = t->parent;
        p = &e->joints[joint];
        if (joint != carrier &&
            (p->modes[ROTATION] == NOH_CLIP_MODE_ANIMATED || p->modes[SCALE] == NOH_CLIP_MODE_ANIMATED))
            return 0;
        if (joint < carrier) return 0;
    }
    return 1;
}

static double point_radius(const encoder *e, uint32_t carrier, uint32_t joint)
{
    double radius = 0.0;
    for (uint32_t f = 0; f < e->frame_count; f += stride_of(e)) {
        const double d = space_distance(enc_global(e, f, joint)->p, enc_global(e, f, carrier)->p);
        if (d > radius) radius = d;
    }
    return radius;
}

/* Where a carried joint lies in its carrier's space. A joint whose own rotation or scale changes is a point there; of
 * any other the linear part is known, too. */
static void place_point(const encoder *e, uint32_t carrier, enc_point *point)
{
    const enc_joint *t = &e->joints[point->joint];
    uint32_t j = point->joint;
    double v[3] = { 0.0, 0.0, 0.0 };
    point->still = t->modes[ROTATION] != NOH_CLIP_MODE_ANIMATED && t->modes[SCALE] != NOH_CLIP_MODE_ANIMATED;
    memset(point->linear, 0, sizeof point->linear);
    for (int i = 0; i < 3; i++) point->linear[4 * i] = 1.0;
    for (; j != carrier; j = e->joints[j].parent) {
        space_global g;
        space_turn(NULL, e->joints[j].rest.q, e->joints[j].rest.s, &g);
        space_apply(g.m, v, g.p);
        for (int i = 0; i < 3; i++) v[i] = g.p[i] + e->joints[j].rest.t[i];
        if (point->still) {
            double m[9];
            space_product(g.m, point->linear, m);
            memcpy(point->linear, m, sizeof m);
        }
    }
    memcpy(point->offset, v, sizeof v);
}

/* The radius of a joint's descendants around it, shells included. */
static double scale_radius(const encoder *e, uint32_t joint)
{
    double radius = e->joints[joint].reach;
    for (uint32_t j = joint + 1u; j < e->joint_count; j++) {
        uint32_t p = j;
        while (p != ENC_NONE && p > joint) p = e->joints[p].parent;
        if (p == joint) {
            const double r = point_radius(e, joint, j) + e->joints[j].reach;
            if (r > radius) radius = r;
        }
    }
    return radius;
}

/* The points that a joint's rotation must keep in place; when there are too many, the farthest. */
static int find_points(encoder *e, uint32_t carrier)
{
    enc_joint *t = &e->joints[carrier];
    double radii[ENC_RIG_MAX];
    t->points = enc_alloc(e, ENC_RIG_MAX, sizeof *t->points);
    if (!t->points) return 1;
    t->point_count = 0;
    t->lever = t->reach;
    if (t->modes[SCALE] == NOH_CLIP_MODE_ANIMATED) t->scale_lever = scale_radius(e, carrier);
    for (uint32_t j = carrier + 1u; j < e->joint_count; j++) {
        uint32_t at = t->point_count;
        double radius;
        if (!carried(e, carrier, j)) continue;
        radius = point_radius(e, carrier, j);
        if (radius > t->lever) t->lever = radius;
        if (at == ENC_RIG_MAX) {
            at = 0;
            for (uint32_t i = 1; i < ENC_RIG_MAX; i++) {
                if (radii[i] < radii[at]) at = i;
            }
            if (radii[at] >= radius) continue;
        } else {
            t->point_count++;
        }
        radii[at] = radius;
        t->points[at].joint = j;
        place_point(e, carrier, &t->points[at]);
    }
    return 0;
}

/* ---- constants ---- */

static void constant_rotation(encoder *e, uint32_t joint)
{
    enc_joint *t = &e->joints[joint];
    double mean[4], bind[4], allowed = CONSTANT_PART * t->bound / t->lever;
    rotation_range(e, joint, mean);
    for (int i = 0; i < 4; i++) bind[i] = (double)e->bind[joint].rotation[i];
    if (space_angle(bind, mean) * t->lever <= e->drop * t->bound + 1e-300) {
        t->modes[ROTATION] = NOH_CLIP_MODE_BIND;
        memcpy(t->rest.q, bind, sizeof bind);
        space_unit(t->rest.q);
        return;
    }
    for (uint32_t width = NOH_CLIP_CONSTANT_BITS; width < NOH_CLIP_CONSTANT_BITS + 16u; width++) {
        float q[4];
        enc_quat_codes(mean, width, t->constant_codes);
        enc_quat_value(t->constant_codes, width, q);
        for (int i = 0; i < 4; i++) t->rest.q[i] = (double)q[i];
        space_unit(t->rest.q);
        t->constant_width = width;
        if (e->level < 2 && space_angle(t->rest.q, mean) <= allowed) break;
    }
}

static float cut_float(double v, uint32_t width)
{
    float f = (float)v;
    uint32_t word;
    memcpy(&word, &f, sizeof word);
    if (width < 32u) {
        const uint32_t low = 32u - width, half = 1u << (low - 1u);
        if ((word & 0x7f800000u) < 0x7f000000u) word += half; /* to nearest; a carry into the exponent is right */
        word &= ~(((uint32_t)1 << low) - 1u);
    }
    memcpy(&f, &word, sizeof f);
    return f;
}

static void constant_linear(encoder *e, uint32_t joint, int what, double lever)
{
    static const uint8_t widths[4] = { 16, 20, 24, 32 };
    enc_joint *t = &e->joints[joint];
    double middle[3], *rest = what == SCALE ? t->rest.s : t->rest.t, worst = 0.0;
    const float *bind = what == SCALE ? e->bind[joint].scale : e->bind[joint].translation;
    linear_range(e, joint, what, middle);
    for (int i = 0; i < 3; i++) {
        const double d = fabs((double)bind[i] - middle[i]);
        if (d > worst) worst = d;
    }
    if (worst * lever <= e->drop * t->bound) {
        t->modes[what] = NOH_CLIP_MODE_BIND;
        for (int i = 0; i < 3; i++) rest[i] = (double)bind[i];
        return;
    }
    for (uint32_t c = 0; c < 4u; c++) {
        worst = 0.0;
        for (int i = 0; i < 3; i++) {
            rest[i] = (double)cut_float(middle[i], widths[c]);
            if (fabs(rest[i] - middle[i]) > worst) worst = fabs(rest[i] - middle[i]);
        }
        t->linear_width[what - 1] = c;
        if (e->level < 2 && worst * lever <= CONSTANT_PART * t->bound) break;
    }
}

static void find_constants(encoder *e, uint32_t joint)
{
    enc_joint *t = &e->joints[joint];
    const double scale = parent_scale(e, joint);
    const space_local *first = enc_local(e, 0, joint);
    t->rest = *first;
    if (t->modes[ROTATION] != NOH_CLIP_MODE_ANIMATED) constant_rotation(e, joint);
    if (t->modes[TRANSLATION] != NOH_CLIP_MODE_ANIMATED) constant_linear(e, joint, TRANSLATION, scale);
    if (t->modes[SCALE] != NOH_CLIP_MODE_ANIMATED) constant_linear(e, joint, SCALE, scale * t->lever);
}

/* ---- tracks ---- */

static int guess_step(double size)
{
    const int id = (int)floor(4.0 * (NOH_CLIP_STEP_TOP - log2(size > 1e-30 ? size : 1e-30)) + 0.5);
    return id < 0 ? 0 : id > (int)NOH_CLIP_STEP_IDS - 1 ? (int)NOH_CLIP_STEP_IDS - 1 : id;
}

static enc_track *new_track(encoder *e, noh_clip_kind kind, uint32_t target)
{
    enc_track *t = &e->tracks[e->track_count++];
    memset(t, 0, sizeof *t);
    t->track.kind = (uint8_t)kind;
    t->track.target = (uint16_t)target;
    return t;
}

/* Negate a joint's rotations in the whole clip if the first is outside its reference's hemisphere. */
static void align_clip(encoder *e, uint32_t joint, const double reference[4])
{
    double sum = 0.0;
    for (uint32_t f = 0; f < e->frame_count; f++) sum += space_dot(reference, enc_local(e, f, joint)->q);
    if (sum >= 0.0) return;
    for (uint32_t f = 0; f < e->frame_count; f++) {
        double *q = enc_local(e, f, joint)->q;
        for (int i = 0; i < 4; i++) q[i] = -q[i];
    }
}

static void rotation_reference(encoder *e, enc_track *t, uint32_t joint)
{
    double mean[4], bind[4], reference[4];
    const double range = rotation_range(e, joint, mean);
    for (int i = 0; i < 4; i++) bind[i] = (double)e->bind[joint].rotation[i];
    if (range > WILD_RAD) {
        t->track.flags = NOH_CLIP_TRACK_WILD;
        return;
    }
    memcpy(t->track.reference, e->bind[joint].rotation, sizeof t->track.reference);
    if (!(e->single && space_angle(bind, mean) < NEAR_BIND_RAD && range < NEAR_BIND_RAD)) {
        t->explicit_reference = 1;
        enc_quat_codes(mean, NOH_CLIP_REFERENCE_BITS, t->reference_codes);
        enc_quat_value(t->reference_codes, NOH_CLIP_REFERENCE_BITS, t->track.reference);
    }
    for (int i = 0; i < 4; i++) reference[i] = (double)t->track.reference[i];
    align_clip(e, joint, reference);
}

static void linear_reference(encoder *e, enc_track *t, uint32_t joint, int what)
{
    const float *bind = what == SCALE ? e->bind[joint].scale : e->bind[joint].translation;
    double middle[3], off = 0.0;
    const double range = linear_range(e, joint, what, middle);
    for (int i = 0; i < 3; i++) {
        const double d = fabs((double)bind[i] - middle[i]);
        if (d > off) off = d;
    }
    memcpy(t->track.reference, bind, 3u * sizeof *bind);
    if (off > (e->single ? 16.0 : 1.0) * range) {
        t->explicit_reference = 1;
        for (int i = 0; i < 3; i++) t->track.reference[i] = cut_float(middle[i], 16u);
    }
}

static void joint_tracks(encoder *e, uint32_t joint)
{
    static const struct {
        int what;
        noh_clip_kind kind;
    } order[3] = { { TRANSLATION, NOH_CLIP_TRANSLATION }, { SCALE, NOH_CLIP_SCALE }, { ROTATION, NOH_CLIP_ROTATION } };
    enc_joint *t = &e->joints[joint];
    for (int i = 0; i < 3; i++) {
        const int what = order[i].what;
        enc_track *track;
        t->tracks[what] = ENC_NONE;
        if (t->modes[what] != NOH_CLIP_MODE_ANIMATED) continue;
        t->tracks[what] = e->track_count;
        track = new_track(e, order[i].kind, joint);
        if (what == ROTATION) {
            rotation_reference(e, track, joint);
            track->step_guess = guess_step(t->bound / sqrt(t->lever * t->lever * 0.8 + 0.44 * t->reach * t->reach));
        } else {
            linear_reference(e, track, joint, what);
            track->step_guess = guess_step(t->bound * 0.5 / (what == SCALE ? t->scale_lever : 1.0));
        }
    }
}

static void float_tracks(encoder *e)
{
    for (uint32_t f = 0; f < e->float_count; f += 3u) {
        enc_track *t = new_track(e, NOH_CLIP_FLOATS, f);
        t->track.flags = NOH_CLIP_TRACK_MIX;
        t->track.mix[0] = 1.0f;
        for (uint32_t i = 0; i < 3u; i++) {
            t->bounds[i] = e->float_bounds[f + i < e->float_count ? f + i : f];
            t->scale_ids[i] = guess_step(t->bounds[i]) - guess_step(t->bounds[0]);
            if (t->scale_ids[i] < -64) t->scale_ids[i] = -64;
            if (t->scale_ids[i] > 127) t->scale_ids[i] = 127;
            t->track.mix[4u * i] = noh_clip_step((uint32_t)(4 * NOH_CLIP_STEP_TOP + t->scale_ids[i]));
        }
        t->step_guess = guess_step(t->bounds[0]);
    }
}

/* ---- mixed axes ---- */

/* Eigenvectors of a symmetric matrix in the columns of v, by Jacobi rotations: each one zeroes an element off the
 * diagonal and shrinks the sum of their squares, so a few sweeps reach single precision (Golub and Van Loan, Matrix
 * Computations, 8.5). */
static void eigen3(double a[9], double v[9])
{
    memset(v, 0, 9 * sizeof *v);
    v[0] = v[4] = v[8] = 1.0;
    for (int sweep = 0; sweep < 30; sweep++) {
        for (int p = 0; p < 2; p++) {
            for (int q = p + 1; q < 3; q++) {
                const double off = a[3 * p + q];
                double theta, t, c, s;
                if (fabs(off) < 1e-300) continue;
                theta = (a[4 * q] - a[4 * p]) / (2.0 * off);
                t = (theta >= 0.0 ? 1.0 : -1.0) / (fabs(theta) + sqrt(theta * theta + 1.0));
                c = 1.0 / sqrt(t * t + 1.0);
                s = t * c;
                for (int k = 0; k < 3; k++) {
                    const double x = a[3 * k + p], y = a[3 * k + q];
                    a[3 * k + p] = c * x - s * y;
                    a[3 * k + q] = s * x + c * y;
                }
                for (int k = 0; k < 3; k++) {
                    const double x = a[3 * p + k], y = a[3 * q + k], m = v[3 * k + p], n = v[3 * k + q];
                    a[3 * p + k] = c * x - s * y;
                    a[3 * q + k] = s * x + c * y;
                    v[3 * k + p] = c * m - s * n;
                    v[3 * k + q] = s * m + c * n;
                }
            }
        }
    }
}

/* A rotation matrix to a quaternion. */
static void matrix_quat(const double m[9], double q[4])
{
    const double w = 1.0 + m[0] + m[4] + m[8], x = 1.0 + m[0] - m[4] - m[8], y = 1.0 - m[0] + m[4] - m[8],
                 z = 1.0 - m[0] - m[4] + m[8];
    if (w >= x && w >= y && w >= z) {
        q[0] = m[7] - m[5];
        q[1] = m[2] - m[6];
        q[2] = m[3] - m[1];
        q[3] = w;
    } else if (x >= y && x >= z) {
        q[0] = x;
        q[1] = m[1] + m[3];
        q[2] = m[2] + m[6];
        q[3] = m[7] - m[5];
    } else if (y >= z) {
        q[0] = m[1] + m[3];
        q[1] = y;
        q[2] = m[5] + m[7];
        q[3] = m[2] - m[6];
    } else {
        q[0] = m[2] + m[6];
        q[1] = m[5] + m[7];
        q[2] = z;
        q[3] = m[3] - m[1];
    }
    space_unit(q);
}

/* An estimate of frame f of a joint's track, in the track's components. */
static void rough_components(const encoder *e, const enc_track *t, uint32_t f, double u[3])
{
    const space_local *l = enc_local(e, f, t->track.target);
    if (t->track.kind == NOH_CLIP_ROTATION) {
        double reference[4], inverse[4], r[4];
        for (int i = 0; i < 4; i++) reference[i] = (double)t->track.reference[i];
        space_conj(reference, inverse);
        space_mul(inverse, l->q, r);
        for (int i = 0; i < 3; i++) u[i] = 4.0 * r[i] / (1.0 + (r[3] > -0.9 ? r[3] : -0.9));
    } else {
        memcpy(u, part(l, t->track.kind == NOH_CLIP_SCALE ? SCALE : TRANSLATION), 3 * sizeof *u);
    }
}

static void find_mix(encoder *e, enc_track *t)
{
    const double step = (double)noh_clip_step((uint32_t)t->step_guess), floor_square = step * step * 2.0 / 3.0;
    double c[9] = { 0 }, diagonal[3], v[9], sorted[9], q[4], gain = 0.0, last[3];
    int order[3] = { 0, 1, 2 };
    float quat[4];
    if (t->track.flags & NOH_CLIP_TRACK_WILD || e->frame_count < 9u) return;
    rough_components(e, t, 0, last);
    for (uint32_t f = 1; f < e->frame_count; f++) {
        double u[3], d[3];
        rough_components(e, t, f, u);
        for (int i = 0; i < 3; i++) d[i] = u[i] - last[i];
        for (int i = 0; i < 9; i++) c[i] += d[i / 3] * d[i % 3] / (double)(e->frame_count - 1u);
        memcpy(last, u, sizeof u);
    }
    for (int i = 0; i < 3; i++) diagonal[i] = c[4 * i];
    eigen3(c, v);
    for (int i = 0; i < 3; i++)
        gain += log2(diagonal[i] + floor_square) - log2((c[4 * i] > 0.0 ? c[4 * i] : 0.0) + floor_square);
    if (gain / 2.0 * (double)e->frame_count <= MIX_COST_BITS) return;
    for (int i = 0; i < 2; i++) { /* the axis with the largest variance first */
        for (int k = i + 1; k < 3; k++) {
            if (c[4 * order[k]] > c[4 * order[i]]) {
                const int o = order[i];
                order[i] = order[k];
                order[k] = o;
            }
        }
    }
    for (int i = 0; i < 9; i++) sorted[i] = v[3 * (i / 3) + order[i % 3]];
    if (sorted[0] * (sorted[4] * sorted[8] - sorted[5] * sorted[7]) -
            sorted[1] * (sorted[3] * sorted[8] - sorted[5] * sorted[6]) +
            sorted[2] * (sorted[3] * sorted[7] - sorted[4] * sorted[6]) <
        0.0) {
        for (int i = 0; i < 3; i++) sorted[3 * i + 2] = -sorted[3 * i + 2];
    }
    matrix_quat(sorted, q);
    enc_quat_codes(q, NOH_CLIP_MIX_BITS, t->mix_codes);
    enc_quat_value(t->mix_codes, NOH_CLIP_MIX_BITS, quat);
    noh_clip_mix_matrix(quat, t->track.mix);
    t->track.flags |= NOH_CLIP_TRACK_MIX;
}

/* Each joint's place in the longest chain of rotating joints through it: 0 at the root, 1 at the tip. */
static int find_depths(encoder *e)
{
    uint32_t *above = enc_alloc(e, e->joint_count, sizeof *above), *below = enc_alloc(e, e->joint_count, sizeof *below);
    if (above && below) {
        for (uint32_t j = e->joint_count; j-- > 0u;) {
            const enc_joint *t = &e->joints[j];
            const uint32_t here = below[j] + (t->modes[ROTATION] == NOH_CLIP_MODE_ANIMATED);
            if (t->parent != ENC_NONE && here > below[t->parent]) below[t->parent] = here;
        }
        for (uint32_t j = 0; j < e->joint_count; j++) {
            enc_joint *t = &e->joints[j];
            double all;
            if (t->parent != ENC_NONE)
                above[j] = above[t->parent] + (e->joints[t->parent].modes[ROTATION] == NOH_CLIP_MODE_ANIMATED);
            all = (double)above[j] + (double)below[j] - 1.0;
            t->depth = (double)above[j] / (all > 1.0 ? all : 1.0);
        }
    }
    free(above);
    free(below);
    return !above || !below;
}

int enc_analyse(encoder *e)
{
    double lever = 0.0;
    if (find_modes(e)) return 1;
    for (uint32_t j = 0; j < e->joint_count; j++) find_constants(e, j);
    for (uint32_t j = 0; j < e->joint_count; j++) {
        enc_joint *t = &e->joints[j];
        if (t->modes[ROTATION] == NOH_CLIP_MODE_ANIMATED || t->modes[SCALE] == NOH_CLIP_MODE_ANIMATED) {
            if (find_points(e, j)) return 1;
        }
        if (t->modes[ROTATION] == NOH_CLIP_MODE_ANIMATED && t->lever * e->bound / t->bound > lever)
            lever = t->lever * e->bound / t->bound;
    }
    e->wide = e->level > 0 || lever > WIDE_LEVER * e->bound / 0.01;
    if (find_depths(e)) return 1;
    e->tracks = enc_alloc(e, 3u * (size_t)e->joint_count + (e->float_count + 2u) / 3u, sizeof *e->tracks);
    if (!e->tracks) return 1;
    e->track_count = 0;
    float_tracks(e);
    for (uint32_t j = 0; j < e->joint_count; j++) joint_tracks(e, j);
    for (uint32_t i = 0; i < e->track_count; i++) {
        if (e->tracks[i].track.kind != NOH_CLIP_FLOATS) find_mix(e, &e->tracks[i]);
    }
    return 0;
}
