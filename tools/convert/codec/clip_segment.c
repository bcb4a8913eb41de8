/* clip_segment.c: one segment in a closed loop.
 *
 * Joints are coded parents first, each against its parents as they will be decoded: the target of a rotation is the raw
 * object-space rotation seen from the decoded parent, the target of a translation the raw position seen from there. A
 * parent's error becomes part of its child's target and is corrected instead of added to. Lossy codecs do the same
 * in time when they predict from decoded values (DPCM, video); here it is done along the skeleton. A rotation's target
 * is also turned a little (`correct`), so that the points it carries compensate the error of its own position, which it
 * cannot change.
 *
 * How exact a joint must be is not known in advance: the bound is on the object-space error of the whole chain, at
 * frames and between them. So the segment is fitted, measured as a whole, and fitted again with a smaller share of
 * the bound (`slack`) until it holds: first of the joints and frames that passed it, then, as another candidate, of
 * all. Four tunings are tried so, and the result of fewest bytes is kept. */
#include <stdlib.h>

#include "clip_encoder.h"

#define TRIES 16
#define SLACK_MIN 0.1
#define SAFETY 0.9995 /* of the bound; the rest is for rounding to single precision afterwards */
#define BETWEEN (ENC_PARTS - 1)
#define SPIN_W (-0.7) /* beyond this the components of a rotation grow without bound: it is stored raw */
#define TRANSLATION_SCALE_MIN 1e-9
#define RAW_TRIES 6  /* the last of TRIES: tracks that cause the error are stored raw, one by one */
#define TURN_MAX 4.0 /* of a correction, in what turns a whole shell by the bound */
/* A parent that has shrunk to less than this share of its size in the segment shows little of a translation, and what
 * would make up for its own error grows without bound. */
#define SHRUNK 0.25

enum { ROTATION, TRANSLATION, SCALE };

/* Whether a joint has to be fitted again: its slack changed; or whatever was there before does not count. */
enum { FRESH, STALE, STALE_ALL };

static space_local *lossy(const encoder *e, uint32_t joint, uint32_t f)
{
    return &e->loop->local[(size_t)joint * ENC_FRAMES_MAX + f];
}
static space_global *placed(const encoder *e, uint32_t joint, uint32_t f)
{
    return &e->loop->global[(size_t)joint * ENC_FRAMES_MAX + f];
}

static double *slack_of(const encoder *e, uint32_t joint)
{
    return &e->loop->slack[(size_t)joint * ENC_FRAMES_MAX];
}

static int is_raw(const encoder *e, uint32_t joint)
{
    return e->loop->all_raw || e->loop->raw[joint];
}

/* Of a whole track. */
static double least_slack(const encoder *e, uint32_t joint, uint32_t count)
{
    double least = 1.0;
    for (uint32_t f = 0; f < count; f++) least = slack_of(e, joint)[f] < least ? slack_of(e, joint)[f] : least;
    return least;
}

static const space_global *lossy_parent(const encoder *e, uint32_t joint, uint32_t f)
{
    const uint32_t p = e->joints[joint].parent;
    return p == ENC_NONE ? NULL : placed(e, p, f);
}

/* The data of a check. */
typedef struct judged {
    const enc_segment *segment;
    const enc_track *track;
    uint32_t joint;
    double limit;                  /* linear tracks: units */
    double limits[ENC_FRAMES_MAX]; /* rotations: of each frame, as shares of the bound */
    double (*targets)[3];          /* linear: absolute values */
} judged;

/* ---- rotations ---- */

/* The part of the bound that a joint may spend on its descendants: less at the root of long chains. */
static double rho_of(const encoder *e, uint32_t joint)
{
    const double depth = e->joints[joint].depth;
    return (e->tuning.rho_root + (e->tuning.rho_tip - e->tuning.rho_root) * (depth < 1.0 ? depth : 1.0)) *
           e->loop->rho_scale;
}

/* The distance of a joint's shell and rigid descendants from the raw clip, as a share of the allowed error. */
static double rotation_violation(const encoder *e, uint32_t joint, uint32_t frame, const space_global *g)
{
    const enc_joint *t = &e->joints[joint];
    const space_global *raw = enc_global(e, frame, joint);
    const double rho = rho_of(e, joint);
    double v = enc_error(e, joint, raw, g) / t->bound;
    for (uint32_t i = 0; i < t->point_count; i++) {
        const enc_point *point = &t->points[i];
        space_global at;
        double d;
        space_apply(g->m, point->offset, at.p);
        for (int k = 0; k < 3; k++) at.p[k] += g->p[k];
        if (point->still) {
            space_product(g->m, point->linear, at.m);
            d = enc_error(e, point->joint, enc_global(e, frame, point->joint), &at) / e->joints[point->joint].bound;
        } else {
            d = space_distance(at.p, enc_global(e, frame, point->joint)->p) / (e->joints[point->joint].bound * rho);
        }
        if (!(d <= v)) v = d;
    }
    return v;
}

static void read_rotation(const encoder *e, const uint8_t *frame, double q[4])
{
    if (e->wide) {
        float v[4];
        memcpy(v, frame, sizeof v);
        for (int i = 0; i < 4; i++) q[i] = (double)v[i];
    } else {
        int16_t v[4];
        memcpy(v, frame, sizeof v);
        for (int i = 0; i < 4; i++) q[i] = (double)v[i];
    }
    space_unit(q);
}

static double check_rotation(encoder *e, void *user, const uint8_t *frames, double *violations)
{
    judged *j = user;
    double worst = 0.0;
    for (uint32_t f = 0; f < j->segment->count; f++) {
        space_local *l = lossy(e, j->joint, f);
        space_global *g = placed(e, j->joint, f);
        read_rotation(e, frames + f * 16u, l->q);
        space_turn(lossy_parent(e, j->joint, f), l->q, l->s, g);
        violations[f] = rotation_violation(e, j->joint, j->segment->first + f, g) / j->limits[f];
        if (!(violations[f] <= worst)) worst = violations[f];
    }
    return worst;
}

/* Add one point to the sums: it lies at u from the joint and should move by -off. */
static void add_pull(double a[6], double b[3], const double u[3], const double off[3], double weight)
{
    const double uu = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
    a[0] += weight * (uu - u[0] * u[0]);
    a[1] += weight * (uu - u[1] * u[1]);
    a[2] += weight * (uu - u[2] * u[2]);
    a[3] -= weight * u[0] * u[1];
    a[4] -= weight * u[0] * u[2];
    a[5] -= weight * u[1] * u[2];
    b[0] -= weight * (u[1] * off[2] - u[2] * off[1]);
    b[1] -= weight * (u[2] * off[0] - u[0] * off[2]);
    b[2] -= weight * (u[0] * off[1] - u[1] * off[0]);
}

/* The small turn that best moves a joint's shell and what it carries back by its position's error.
 *
 * A turn by the small vector x moves a point at u by x cross u. The turn that brings all points nearest to -off, in the
 * sense of least squares, solves A x = b with A = sum of w (u.u I - u u^T) and b = -sum of w (u cross off): three
 * equations, by Cramer's rule. Where the points lie on a line the turn about it is not determined, and none is made. */
static void correct(const encoder *e, uint32_t joint, uint32_t frame, const double position[3], double q[4])
{
    const enc_joint *t = &e->joints[joint];
    const space_global *raw = enc_global(e, frame, joint);
    double a[6] = { 0 }, b[3] = { 0 }, off[3], x[3], det, most, size, turn[4], turned[4];
    for (int i = 0; i < 3; i++) off[i] = position[i] - raw->p[i];
    for (int k = 0; k < 3; k++) {
        const double s = t->shell[k], u[3] = { s * raw->m[k], s * raw->m[3 + k], s * raw->m[6 + k] };
        add_pull(a, b, u, off, e->tuning.shell_weight);
    }
    for (uint32_t i = 0; i < t->point_count; i++) {
        const double *p = enc_global(e, frame, t->points[i].joint)->p;
        const double u[3] = { p[0] - raw->p[0], p[1] - raw->p[1], p[2] - raw->p[2] };
        add_pull(a, b, u, off, 1.0);
    }
    det = a[0] * (a[1] * a[2] - a[5] * a[5]) - a[3] * (a[3] * a[2] - a[5] * a[4]) + a[4] * (a[3] * a[5] - a[1] * a[4]);
    if (!(det > 1e-9 * t->reach * t->reach * t->reach * t->reach * t->reach * t->reach)) return;
    x[0] = ((a[1] * a[2] - a[5] * a[5]) * b[0] + (a[4] * a[5] - a[3] * a[2]) * b[1] +
            (a[3] * a[5] - a[4] * a[1]) * b[2]) /
           det;
    x[1] = ((a[5] * a[4] - a[3] * a[2]) * b[0] + (a[0] * a[2] - a[4] * a[4]) * b[1] +
            (a[3] * a[4] - a[0] * a[5]) * b[2]) /
           det;
    x[2] = ((a[3] * a[5] - a[1] * a[4]) * b[0] + (a[3] * a[4] - a[0] * a[5]) * b[1] +
            (a[0] * a[1] - a[3] * a[3]) * b[2]) /
           det;
    most = TURN_MAX * t->bound / t->reach; /* points that lie close, as on what has shrunk, would ask for any turn */
    size = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
    for (int i = 0; i < 3; i++) turn[i] = x[i] * (size > most ? most / size : 1.0) / 2.0 * e->tuning.correction;
    turn[3] = 1.0;
    space_unit(turn);
    space_mul(turn, q, turned);
    memcpy(q, turned, sizeof turned);
}

/* The local rotation that frame f should have, in the raw clip's hemisphere. */
static void rotation_target(const encoder *e, uint32_t joint, uint32_t frame, uint32_t f, double q[4])
{
    const space_global *parent = lossy_parent(e, joint, f), *raw = enc_global(e, frame, joint);
    const space_local *local = enc_local(e, frame, joint);
    double inverse[4], turned[4];
    if (e->options.open_loop || (e->loop->all_raw && e->level >= 2)) {
        memcpy(q, local->q, sizeof local->q);
        return;
    }
    memcpy(turned, raw->q, sizeof turned);
    correct(e, joint, frame, placed(e, joint, f)->p, turned);
    if (parent) {
        space_conj(parent->q, inverse);
        space_mul(inverse, turned, q);
    } else {
        memcpy(q, turned, sizeof turned);
    }
    space_unit(q);
    if (space_dot(q, local->q) < 0.0) {
        for (int i = 0; i < 4; i++) q[i] = -q[i];
    }
}

static int keep_raw(encoder *e, enc_piece *piece, uint32_t count, uint32_t components, const double *values,
                    uint32_t stride)
{
    piece->raw = 1;
    free(piece->values);
    piece->values = enc_alloc(e, (size_t)count * components, sizeof *piece->values);
    if (!piece->values) return 1;
    for (uint32_t f = 0; f < count; f++) {
        for (uint32_t c = 0; c < components; c++) piece->values[f * components + c] = (float)values[f * stride + c];
    }
    return 0;
}

static void wild_reference(const encoder *e, uint32_t joint, const enc_segment *s, enc_piece *piece, float reference[4])
{
    piece->negative = (uint8_t)enc_quat_codes(enc_local(e, s->first + s->count / 2u, joint)->q, NOH_CLIP_WILD_BITS,
                                              piece->wild_codes);
    enc_quat_value(piece->wild_codes, NOH_CLIP_WILD_BITS, reference);
    for (int i = 0; i < 4 && piece->negative; i++) reference[i] = -reference[i];
}

/* A frame's allowance: the error that its parents leave it with plus some headroom, but at least the slack. */
static void rotation_limits(const encoder *e, judged *j, double (*q)[4])
{
    for (uint32_t f = 0; f < j->segment->count; f++) {
        space_global g = *placed(e, j->joint, f);
        double v;
        space_turn(lossy_parent(e, j->joint, f), q[f], lossy(e, j->joint, f)->s, &g);
        const double slack = slack_of(e, j->joint)[f];
        v = rotation_violation(e, j->joint, j->segment->first + f, &g);
        e->loop->floor[(size_t)j->joint * ENC_FRAMES_MAX + f] = v;
        v += e->tuning.headroom * slack;
        j->limits[f] = v > slack ? v : slack;
    }
}

/* ---- the error model that guides the search for coefficients ---- */

static void set_probe(enc_probe *p, const double base[3], const double arm[3], double shell, double allowed)
{
    memcpy(p->base, base, sizeof p->base);
    memcpy(p->arm, arm, sizeof p->arm);
    p->shell = shell;
    p->weight = 1.0 / (allowed * allowed);
}

/* A joint's shell and what it carries, as they would be with the raw rotation. */
static uint32_t find_probes(const encoder *e, uint32_t joint, uint32_t frame, const double position[3], enc_probe *out)
{
    const enc_joint *t = &e->joints[joint];
    const space_global *raw = enc_global(e, frame, joint);
    const double none[3] = { 0.0, 0.0, 0.0 }, rho = rho_of(e, joint);
    double x[3];
    uint32_t count = 0;
    for (int i = 0; i < 3; i++) x[i] = position[i] - raw->p[i];
    for (int k = 0; k < 3 && e->options.axes; k++) {
        const double arm[3] = { t->reach * raw->m[k], t->reach * raw->m[3 + k], t->reach * raw->m[6 + k] };
        set_probe(&out[count++], x, arm, 0.0, t->bound);
    }
    if (!e->options.axes) set_probe(&out[count++], x, none, t->reach, t->bound);
    for (uint32_t i = 0; i < t->point_count && count < ENC_PROBES; i++) {
        const enc_point *point = &t->points[i];
        const double *at = enc_global(e, frame, point->joint)->p, bound = e->joints[point->joint].bound;
        double arm[3], base[3];
        space_apply(raw->m, point->offset, arm);
        for (int k = 0; k < 3; k++) base[k] = position[k] + arm[k] - at[k];
        set_probe(&out[count++], base, arm, point->still ? e->joints[point->joint].reach : 0.0,
                  point->still ? bound : bound * rho);
    }
    return count;
}

/* How a small change of the components u turns a joint in object space: its rotation times
 * ((1 - s.s) I - 2 [s]x + 2 s s^T) / (1 + s.s)^2, s = u / 4. */
static void turns_by(const double m[9], const double u[3], const enc_track *track, double out[9])
{
    const double x = u[0] / 4.0, y = u[1] / 4.0, z = u[2] / 4.0, n = x * x + y * y + z * z, k = 1.0 / (1.0 + n);
    const double d = 1.0 - n;
    double t[9] = { d + 2.0 * x * x,   2.0 * (x * y + z), 2.0 * (x * z - y), 2.0 * (x * y - z), d + 2.0 * y * y,
                    2.0 * (y * z + x), 2.0 * (x * z + y), 2.0 * (y * z - x), d + 2.0 * z * z };
    double mix[9], mixed[9];
    for (int i = 0; i < 9; i++) {
        t[i] *= k * k;
        mix[i] = track->track.flags & NOH_CLIP_TRACK_MIX ? (double)track->track.mix[i] : i % 4 == 0 ? 1.0 : 0.0;
    }
    space_product(t, mix, mixed);
    space_product(m, mixed, out);
}

/* Returns NULL where there is no model: a joint that something scales, or that hardly has to hold anything. */
static const enc_model *model_of(encoder *e, const judged *j, double (*q)[4], double (*u)[3])
{
    enc_model *m = &e->loop->model;
    if (!e->tuning.searches || !e->joints[j->joint].turned) return NULL;
    for (uint32_t f = 0; f < j->segment->count; f++) {
        const uint32_t frame = j->segment->first + f;
        const space_global *raw = enc_global(e, frame, j->joint);
        space_global g = *placed(e, j->joint, f);
        double inverse[4], off[4];
        space_turn(lossy_parent(e, j->joint, f), q[f], lossy(e, j->joint, f)->s, &g);
        space_conj(raw->q, inverse);
        space_mul(g.q, inverse, off);
        for (int i = 0; i < 3; i++) m->turns[f][i] = off[3] < 0.0 ? -2.0 * off[i] : 2.0 * off[i];
        turns_by(g.m, u[f], j->track, m->turns_by[f]);
        m->weights[f] = 1.0 / (j->limits[f] * j->limits[f]);
        m->probe_count = find_probes(e, j->joint, frame, g.p, m->probes + (size_t)f * ENC_PROBES);
    }
    return m;
}

static int raw_rotation(encoder *e, judged *j, enc_piece *piece, double (*q)[4])
{
    uint8_t frames[ENC_FRAMES_MAX * 16u];
    double violations[ENC_FRAMES_MAX];
    if (keep_raw(e, piece, j->segment->count, 4, q[0], 4)) return 1;
    for (uint32_t f = 0; f < j->segment->count; f++)
        noh_clip_store_rotation(piece->values + 4u * f, e->wide, frames + 16u * f);
    check_rotation(e, j, frames, violations);
    return 0;
}

static int fit_rotation(encoder *e, uint32_t joint, const enc_segment *s, enc_track *track, enc_piece *piece)
{
    double q[ENC_FRAMES_MAX][4], u[ENC_FRAMES_MAX][3], reference[4], inverse[4];
    float single[4];
    judged j;
    int raw = is_raw(e, joint);
    j.segment = s;
    j.track = track;
    j.joint = joint;
    memcpy(single, track->track.reference, sizeof single);
    if (track->track.flags & NOH_CLIP_TRACK_WILD) wild_reference(e, joint, s, piece, single);
    for (int i = 0; i < 4; i++) reference[i] = (double)single[i];
    space_unit(reference);
    space_conj(reference, inverse);
    for (uint32_t f = 0; f < s->count; f++) {
        double r[4];
        rotation_target(e, joint, s->first + f, f, q[f]);
        space_mul(inverse, q[f], r);
        if (r[3] < SPIN_W) raw = 1;
        for (int i = 0; i < 3; i++) u[f][i] = 4.0 * r[i] / (1.0 + (r[3] > SPIN_W ? r[3] : SPIN_W));
    }
    rotation_limits(e, &j, q);
    piece->raw = 0;
    if (!raw) {
        const enc_goal goal = { single, u, check_rotation, &j, model_of(e, &j, q, u) };
        raw = enc_fit(e, track, piece, s->count, &goal);
    }
    return raw ? raw_rotation(e, &j, piece, q) : 0;
}

/* ---- translations, scales, floats ---- */

static double check_linear(encoder *e, void *user, const uint8_t *frames, double *violations)
{
    judged *j = user;
    double worst = 0.0;
    (void)e;
    for (uint32_t f = 0; f < j->segment->count; f++) {
        float v[3];
        double square = 0.0;
        memcpy(v, frames + f * 16u, sizeof v);
        for (int c = 0; c < 3; c++) {
            const double d = (double)v[c] - j->targets[f][c];
            square += d * d;
        }
        violations[f] = sqrt(square) / j->limit;
        if (!(violations[f] <= worst)) worst = violations[f];
    }
    return worst;
}

static double check_floats(encoder *e, void *user, const uint8_t *frames, double *violations)
{
    judged *j = user;
    double worst = 0.0;
    (void)e;
    for (uint32_t f = 0; f < j->segment->count; f++) {
        float v[3];
        memcpy(v, frames + f * 16u, sizeof v);
        violations[f] = 0.0;
        for (int c = 0; c < 3; c++) {
            const double d = fabs((double)v[c] - j->targets[f][c]) / (j->track->bounds[c] * SAFETY);
            if (!(d <= violations[f])) violations[f] = d;
        }
        if (!(violations[f] <= worst)) worst = violations[f];
    }
    return worst;
}

/* Code a linear track with absolute targets; `values` gets the decoded ones. */
static int fit_linear(encoder *e, judged *j, enc_track *track, enc_piece *piece, double (*targets)[3],
                      double (*values)[3])
{
    const uint32_t count = j->segment->count;
    const enc_check check = track->track.kind == NOH_CLIP_FLOATS ? check_floats : check_linear;
    double relative[ENC_FRAMES_MAX][3], violations[ENC_FRAMES_MAX];
    const enc_goal goal = { track->track.reference, relative, check, j, NULL };
    j->targets = targets;
    j->track = track;
    piece->raw = 0;
    for (uint32_t f = 0; f < count; f++) {
        for (int c = 0; c < 3; c++) relative[f][c] = targets[f][c] - (double)track->track.reference[c];
    }
    if (!(track->track.kind == NOH_CLIP_FLOATS ? e->loop->all_raw : is_raw(e, j->joint)) &&
        !enc_fit(e, track, piece, count, &goal)) {
        const noh_clip_basis *basis = &e->bases[count];
        float components[ENC_FRAMES_MAX][4];
        uint8_t frames[ENC_FRAMES_MAX * 16u];
        noh_clip_dequantise((const int32_t(*)[4])piece->coefs, piece->last, noh_clip_step(piece->step),
                            track->track.flags & NOH_CLIP_TRACK_MIX ? track->track.mix : NULL, components);
        noh_clip_synth_linear(basis, (const float(*)[4])components, piece->last, track->track.reference, frames, 16);
        for (uint32_t f = 0; f < count; f++) {
            float v[3];
            memcpy(v, frames + f * 16u, sizeof v);
            for (int c = 0; c < 3; c++) values[f][c] = (double)v[c];
        }
        if (track->track.kind != NOH_CLIP_FLOATS || check(e, j, frames, violations) <= 1.0) return 0;
    }
    if (keep_raw(e, piece, count, 3, targets[0], 3)) return 1;
    for (uint32_t f = 0; f < count; f++) {
        for (int c = 0; c < 3; c++) values[f][c] = (double)piece->values[3u * f + (uint32_t)c];
    }
    return 0;
}

static double column(const double m[9], int k)
{
    return sqrt(m[k] * m[k] + m[3 + k] * m[3 + k] + m[6 + k] * m[6 + k]);
}

static double largest_column(const double m[9])
{
    double worst = 0.0;
    for (int k = 0; k < 3; k++) {
        const double n = column(m, k);
        if (n > worst) worst = n;
    }
    return worst;
}

/* The translation that puts a joint where it belongs, seen from its decoded parent. `most`: the parent's scales, at
 * their largest in the segment; where it has shrunk far below them the raw translation is taken, by and by. */
static void translation_target(const encoder *e, uint32_t joint, uint32_t frame, const space_global *parent,
                               const double most[3], double target[3])
{
    const double *local = enc_local(e, frame, joint)->t;
    double inverse[9], d[3];
    if (!space_inverse(parent->m, inverse)) return;
    for (int i = 0; i < 3; i++) d[i] = enc_global(e, frame, joint)->p[i] - parent->p[i];
    space_apply(inverse, d, target);
    for (int k = 0; k < 3; k++) {
        const double part = column(parent->m, k) / (SHRUNK * most[k]);
        if (part < 1.0) target[k] = local[k] + (target[k] - local[k]) * part * part;
    }
}

static int fit_translation(encoder *e, uint32_t joint, const enc_segment *s, enc_track *track, enc_piece *piece)
{
    const int open = e->options.open_loop || (e->loop->all_raw && e->level >= 2);
    double targets[ENC_FRAMES_MAX][3], values[ENC_FRAMES_MAX][3], most[3] = { 0.0, 0.0, 0.0 }, scale = 0.0;
    judged j;
    j.segment = s;
    j.joint = joint;
    for (uint32_t f = 0; f < s->count && e->joints[joint].parent != ENC_NONE; f++) {
        for (int k = 0; k < 3; k++) {
            const double n = column(lossy_parent(e, joint, f)->m, k);
            if (n > most[k]) most[k] = n;
            if (n > scale) scale = n;
        }
    }
    for (uint32_t f = 0; f < s->count; f++) {
        const space_global *parent = lossy_parent(e, joint, f);
        memcpy(targets[f], enc_local(e, s->first + f, joint)->t, sizeof targets[f]);
        if (parent && !open) translation_target(e, joint, s->first + f, parent, most, targets[f]);
    }
    if (e->joints[joint].parent == ENC_NONE) scale = 1.0;
    j.limit = e->tuning.linear_part * e->joints[joint].bound * least_slack(e, joint, s->count) /
              (scale > TRANSLATION_SCALE_MIN ? scale : TRANSLATION_SCALE_MIN);
    if (fit_linear(e, &j, track, piece, targets, values)) return 1;
    for (uint32_t f = 0; f < s->count; f++) memcpy(lossy(e, joint, f)->t, values[f], sizeof values[f]);
    return 0;
}

static int fit_scale(encoder *e, uint32_t joint, const enc_segment *s, enc_track *track, enc_piece *piece)
{
    double targets[ENC_FRAMES_MAX][3], values[ENC_FRAMES_MAX][3], scale = 0.0;
    judged j;
    j.segment = s;
    j.joint = joint;
    for (uint32_t f = 0; f < s->count; f++) {
        const space_global *parent = lossy_parent(e, joint, f);
        const double n = parent ? largest_column(parent->m) : 1.0;
        if (n > scale) scale = n;
        memcpy(targets[f], enc_local(e, s->first + f, joint)->s, sizeof targets[f]);
    }
    j.limit = e->tuning.linear_part * e->joints[joint].bound * least_slack(e, joint, s->count) /
              (e->joints[joint].scale_lever * (scale > TRANSLATION_SCALE_MIN ? scale : TRANSLATION_SCALE_MIN));
    if (fit_linear(e, &j, track, piece, targets, values)) return 1;
    for (uint32_t f = 0; f < s->count; f++) memcpy(lossy(e, joint, f)->s, values[f], sizeof values[f]);
    return 0;
}

static int fit_floats(encoder *e, const enc_segment *s, enc_track *track, enc_piece *piece)
{
    double targets[ENC_FRAMES_MAX][3], values[ENC_FRAMES_MAX][3];
    judged j;
    j.segment = s;
    j.joint = 0;
    j.limit = 1.0;
    for (uint32_t f = 0; f < s->count; f++) {
        for (uint32_t c = 0; c < 3u; c++) {
            const uint32_t i = track->track.target + c;
            targets[f][c] = i < e->float_count ? (double)e->floats[(size_t)(s->first + f) * e->float_count + i] : 0.0;
        }
    }
    return fit_linear(e, &j, track, piece, targets, values);
}

/* ---- the whole segment ---- */

static int fit_joint(encoder *e, uint32_t joint, const enc_segment *s)
{
    const enc_joint *t = &e->joints[joint];
    for (uint32_t f = 0; f < s->count; f++) *lossy(e, joint, f) = t->rest;
    if (t->tracks[TRANSLATION] != ENC_NONE &&
        fit_translation(e, joint, s, &e->tracks[t->tracks[TRANSLATION]], &s->pieces[t->tracks[TRANSLATION]]))
        return 1;
    for (uint32_t f = 0; f < s->count; f++)
        space_place(lossy_parent(e, joint, f), lossy(e, joint, f)->t, placed(e, joint, f)->p);
    if (t->tracks[SCALE] != ENC_NONE &&
        fit_scale(e, joint, s, &e->tracks[t->tracks[SCALE]], &s->pieces[t->tracks[SCALE]]))
        return 1;
    if (t->tracks[ROTATION] != ENC_NONE)
        return fit_rotation(e, joint, s, &e->tracks[t->tracks[ROTATION]], &s->pieces[t->tracks[ROTATION]]);
    for (uint32_t f = 0; f < s->count; f++) {
        space_turn(lossy_parent(e, joint, f), lossy(e, joint, f)->q, lossy(e, joint, f)->s, placed(e, joint, f));
    }
    return 0;
}

/* The raw clip at the points between frames, before each frame of the segment. */
static void raw_between(encoder *e, const enc_segment *s)
{
    for (uint32_t f = s->first ? 0u : 1u; f < s->count; f++) {
        for (uint32_t part = 0; part < BETWEEN; part++) {
            space_global *pose = e->loop->raw_between + (size_t)(f * BETWEEN + part) * e->joint_count;
            for (uint32_t j = 0; j < e->joint_count; j++) {
                space_local l;
                space_between(enc_local(e, s->first + f - 1u, j), enc_local(e, s->first + f, j),
                              (double)(part + 1u) / ENC_PARTS, &l);
                space_compose(enc_parent(pose, e->joints[j].parent), &l, &pose[j]);
            }
        }
    }
}

/* The peak of the parabola through three errors at equal distances, where it lies among them. */
static double peak(double before, double here, double after)
{
    const double bend = 2.0 * here - before - after, slope = after - before;
    return bend > 0.0 && fabs(slope) < 2.0 * bend ? here + slope * slope / (8.0 * bend) : here;
}

/* Row `part` of a frame's errors: 0 at the frame, else `part` eighths after the frame before. */
static double *errors_of(const encoder *e, uint32_t f, uint32_t part)
{
    return e->loop->errors + (size_t)(f * ENC_PARTS + part) * e->joint_count;
}

/* Errors of the joints that have moved between frame f - 1 and frame f, as shares of their bounds. */
static void errors_between(const encoder *e, uint32_t f, uint32_t part)
{
    const size_t at = (size_t)(f * BETWEEN + part - 1u) * e->joint_count;
    const space_global *raw = e->loop->raw_between + at;
    space_global *pose = e->loop->between + at;
    double *errors = errors_of(e, f, part);
    for (uint32_t j = 0; j < e->joint_count; j++) {
        const space_local *before = f ? lossy(e, j, f - 1u) : &e->loop->before[j];
        space_local l;
        if (!e->loop->moved[j]) continue;
        space_between(before, lossy(e, j, f), (double)part / ENC_PARTS, &l);
        space_compose(enc_parent(pose, e->joints[j].parent), &l, &pose[j]);
        errors[j] = enc_error(e, j, &raw[j], &pose[j]) / e->joints[j].bound;
    }
}

/* How far each joint turns in the raw clip between frame f - 1 of the segment and frame f, its parents' turns added up,
 * by the chord of half the angle: at most a tenth too much. */
static void find_turns(const encoder *e, const enc_segment *s)
{
    for (uint32_t f = s->first ? 0u : 1u; f < s->count; f++) {
        double *turns = e->loop->turns + (size_t)f * e->joint_count;
        for (uint32_t j = 0; j < e->joint_count; j++) {
            const uint32_t parent = e->joints[j].parent, frame = s->first + f;
            const double dot = fabs(space_dot(enc_local(e, frame - 1u, j)->q, enc_local(e, frame, j)->q));
            turns[j] = (parent == ENC_NONE ? 0.0 : turns[parent]) + 2.2 * sqrt(2.0 * (dot < 1.0 ? 1.0 - dot : 0.0));
        }
    }
}

/* A wave that turns by `angle` from one point to the next is missed by at most angle^2 / 8 of its height between them,
 * and by a parabola through three points by much less. Half of it has held for spins of any speed. */
static double fast(double turn)
{
    const double angle = turn / ENC_PARTS;
    return 1.0 + angle * angle / 16.0;
}

/* ---- tracks that must be more exact ---- */

/* Whether a lower target changes a joint at frame f: it moves, and its parents leave it less than that. */
static int can_aim_lower(const encoder *e, uint32_t joint, uint32_t f)
{
    const enc_joint *t = &e->joints[joint];
    const double *floor = &e->loop->floor[(size_t)joint * ENC_FRAMES_MAX], *slack = slack_of(e, joint);
    if (!(slack[f] > SLACK_MIN)) return 0;
    if (t->tracks[TRANSLATION] != ENC_NONE || t->tracks[SCALE] != ENC_NONE) return 1;
    return t->tracks[ROTATION] != ENC_NONE && floor[f] < slack[f];
}

static void lower_slack_of(const encoder *e, uint32_t joint, uint32_t f, double violation)
{
    double *slack = &slack_of(e, joint)[f];
    if (!e->loop->stale[joint]) e->loop->stale[joint] = STALE;
    *slack *= violation > 2.0 ? 0.5 : 0.97 / violation;
    if (!(*slack >= SLACK_MIN)) *slack = SLACK_MIN;
}

/* The joint, or its nearest parent that can, aims at less, or where none can all of them, which have room above what
 * their parents leave them; late, it is stored raw, or if it is, the next one above. */
static void lower_slack(const encoder *e, uint32_t joint, uint32_t f, double violation)
{
    uint32_t who = joint;
    while (who != ENC_NONE && !can_aim_lower(e, who, f)) who = e->joints[who].parent;
    if (e->loop->gives_up) {
        if (who == ENC_NONE) who = joint;
        while (is_raw(e, who) && e->joints[who].parent != ENC_NONE) who = e->joints[who].parent;
        e->loop->raw[who] = 1;
    }
    if (who != ENC_NONE) {
        lower_slack_of(e, who, f, violation);
        return;
    }
    for (; joint != ENC_NONE; joint = e->joints[joint].parent) lower_slack_of(e, joint, f, violation);
}

/* A joint is off between frame f - 1 and f: of it and its parents the one that turns most there. */
static void blame_between(const encoder *e, const enc_segment *s, uint32_t joint, uint32_t f, double violation)
{
    uint32_t most = joint;
    double least = 2.0;
    if (violation <= SAFETY) return;
    for (uint32_t j = joint; j != ENC_NONE; j = e->joints[j].parent) {
        const uint32_t frame = s->first + f;
        const double dot = fabs(space_dot(enc_local(e, frame - 1u, j)->q, enc_local(e, frame, j)->q));
        if (can_aim_lower(e, j, f) && dot < least) {
            least = dot;
            most = j;
        }
    }
    lower_slack(e, most, f, violation);
    if (f) lower_slack(e, most, f - 1u, violation);
}

/* Measure the joints that have moved since they were measured last. */
static void measure_moved(const encoder *e, const enc_segment *s)
{
    for (uint32_t f = 0; f < s->count; f++) {
        double *here = errors_of(e, f, 0);
        for (uint32_t part = 1; part < ENC_PARTS && s->first + f > 0u; part++) errors_between(e, f, part);
        for (uint32_t j = 0; j < e->joint_count; j++) {
            if (e->loop->moved[j])
                here[j] = enc_error(e, j, enc_global(e, s->first + f, j), placed(e, j, f)) / e->joints[j].bound;
        }
    }
}

/* The largest error of a joint between frame f - 1 and frame f: between the points measured it is interpolated by
 * parabolas. */
static double worst_between(const encoder *e, uint32_t f, uint32_t j)
{
    const size_t stride = e->joint_count;
    const double *row = errors_of(e, f, 0) + j, spin = fast(e->loop->turns[(size_t)f * stride + j]);
    double a = f ? errors_of(e, f - 1u, 0)[j] : e->loop->errors_before[j], b = row[stride], worst = 0.0;
    for (uint32_t part = 1; part < ENC_PARTS; part++) {
        const double c = part + 1u < ENC_PARTS ? row[(part + 1u) * stride] : row[0], v = spin * peak(a, b, c);
        if (!(v <= worst)) worst = v;
        a = b;
        b = c;
    }
    return worst;
}

/* The largest error at frames and between, as a share of the joints' bounds. blames: lower the slack of joints that
 * exceed it. */
static double segment_error(const encoder *e, const enc_segment *s, int blames)
{
    double worst = 0.0;
    measure_moved(e, s);
    for (uint32_t f = 0; f < s->count; f++) {
        for (uint32_t j = 0; j < e->joint_count; j++) {
            const double here = errors_of(e, f, 0)[j], between = s->first + f > 0u ? worst_between(e, f, j) : 0.0;
            if (!(here <= worst)) worst = here;
            if (!(between <= worst)) worst = between;
            if (blames && here > SAFETY) lower_slack(e, j, f, here);
            if (blames) blame_between(e, s, j, f, between);
        }
    }
    return worst;
}

static int fit_all_floats(encoder *e, const enc_segment *s)
{
    for (uint32_t i = 0; i < e->track_count && e->tracks[i].track.kind == NOH_CLIP_FLOATS; i++) {
        if (fit_floats(e, s, &e->tracks[i], &s->pieces[i])) return 1;
    }
    return 0;
}

/* Fit the joints that are `stale`, and those whose parents have moved by that. A fit that gives what was there before
 * moves nothing, and what is below it stays. */
static int fit_stale(encoder *e, const enc_segment *s)
{
    const size_t locals = s->count * sizeof(space_local), globals = s->count * sizeof(space_global);
    for (uint32_t j = 0; j < e->joint_count; j++) {
        const uint32_t parent = e->joints[j].parent;
        e->loop->moved[j] = 0;
        if (!e->loop->stale[j] && (parent == ENC_NONE || !e->loop->moved[parent])) continue;
        memcpy(e->loop->local_before, lossy(e, j, 0), locals);
        memcpy(e->loop->global_before, placed(e, j, 0), globals);
        if (fit_joint(e, j, s)) return 1;
        e->loop->moved[j] = e->loop->stale[j] == STALE_ALL || memcmp(e->loop->local_before, lossy(e, j, 0), locals) ||
                            memcmp(e->loop->global_before, placed(e, j, 0), globals);
        e->loop->stale[j] = 0;
    }
    return 0;
}

static enc_piece *new_pieces(encoder *e, uint32_t count)
{
    enc_piece *pieces = enc_alloc(e, e->track_count, sizeof *pieces);
    for (uint32_t i = 0; pieces && i < e->track_count; i++) {
        pieces[i].coefs = enc_alloc(e, count, sizeof *pieces[i].coefs);
        if (!pieces[i].coefs) {
            enc_free_pieces(e, pieces);
            return NULL;
        }
    }
    return pieces;
}

void enc_free_pieces(const encoder *e, enc_piece *pieces)
{
    for (uint32_t i = 0; pieces && i < e->track_count; i++) {
        free(pieces[i].coefs);
        free(pieces[i].values);
    }
    free(pieces);
}

/* How a segment's slack is reduced until it holds: only for the tracks that cause the error, for all joints in all
 * frames, or for these tracks, stored raw in the last tries. Each way is tried when the ways before it failed. */
enum { APART, TOGETHER, GIVING_UP, WAYS };

static void all_stale(const encoder *e)
{
    memset(e->loop->stale, STALE_ALL, e->joint_count);
}

/* With the current tuning. */
static int fit_tuned(encoder *e, const enc_segment *s, int way, double *worst)
{
    const int apart = way != TOGETHER;
    double slack = 1.0;
    for (size_t i = 0; i < (size_t)e->joint_count * ENC_FRAMES_MAX; i++) e->loop->slack[i] = 1.0;
    memset(e->loop->raw, 0, e->joint_count);
    e->loop->rho_scale = 1.0;
    all_stale(e);
    for (int i = 0; i <= TRIES; i++) {
        e->loop->all_raw = (i == TRIES && e->level == 1) || e->level >= 2;
        e->loop->gives_up = way == GIVING_UP && i >= TRIES - RAW_TRIES;
        if (e->loop->all_raw) all_stale(e);
        if ((i == 0 || e->loop->all_raw) && fit_all_floats(e, s)) return 1;
        if (fit_stale(e, s)) return 1;
        *worst = segment_error(e, s, apart);
        if (*worst <= SAFETY || e->loop->all_raw || i == TRIES) break;
        slack *= *worst > 2.0 ? 0.5 : *worst > 1.02 ? 0.995 / *worst : 0.97;
        if (slack < SLACK_MIN) slack = SLACK_MIN;
        for (size_t k = 0; k < (size_t)e->joint_count * ENC_FRAMES_MAX && !apart; k++) e->loop->slack[k] = slack;
        if (i > (apart ? 12 : 3)) e->loop->rho_scale *= 0.85;
        if (i > (apart ? 12 : 3) || !apart) all_stale(e);
    }
    return 0;
}

/* Keep the data that the next segment needs. */
static void keep_end(encoder *e, const enc_segment *s, space_local *end)
{
    for (uint32_t j = 0; j < e->joint_count; j++) end[j] = *lossy(e, j, s->count - 1u);
    memcpy(e->loop->errors_end, errors_of(e, s->count - 1u, 0), e->joint_count * sizeof *e->loop->errors);
}

int enc_segment_fit(encoder *e, uint32_t index, double *worst)
{
    enc_segment *s = &e->segments[index];
    enc_piece *best = new_pieces(e, s->count);
    size_t least = SIZE_MAX;
    double w = 2.0;
    int failed;
    s->pieces = new_pieces(e, s->count);
    failed = !best || !s->pieces;
    *worst = 2.0;
    if (!failed) raw_between(e, s);
    if (!failed) find_turns(e, s);
    for (uint32_t t = 0; t < WAYS * e->tuning_count && !failed && (t == 0u || e->level < 2); t++) {
        const int way = (int)(t % WAYS);
        size_t bytes = 0;
        if ((way == TOGETHER && w <= 1.0) || (way == GIVING_UP && *worst <= 1.0)) continue;
        e->tuning = e->tunings[t / WAYS];
        failed = fit_tuned(e, s, way, &w) || enc_segment_cost(e, s, &bytes);
        if (!failed && (t == 0u || (w <= 1.0 && (bytes < least || *worst > 1.0)))) {
            enc_piece *swap = s->pieces;
            s->pieces = best;
            best = swap;
            least = bytes;
            *worst = w;
            keep_end(e, s, e->loop->end);
        }
    }
    enc_free_pieces(e, s->pieces);
    s->pieces = best;
    memcpy(e->loop->before, e->loop->end, e->joint_count * sizeof *e->loop->end);
    memcpy(e->loop->errors_before, e->loop->errors_end, e->joint_count * sizeof *e->loop->errors);
    for (uint32_t i = 0; i < e->track_count && !failed; i++) {
        if (!s->pieces[i].raw && s->pieces[i].last) e->tracks[i].step_guess = s->pieces[i].step;
    }
    return failed;
}
