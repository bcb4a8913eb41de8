/* joint_match.c: finds each joint's counterpart, then rewrites the frames. */
#include "joint_match.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/base/byte_buffer.h"
#include "convert/base/input_file.h"
#include "convert/base/names.h"
#include "convert/base/quat.h"
#include "convert/base/text_scan.h"
#include "convert/model/model.h"

#define LISTED 5u          /* names of each kind in a report */
#define LENGTHS_EQUAL 0.05 /* bones that differ by less are not mentioned */

typedef struct matcher {
    raw_set *set;
    const raw_skeleton *to;
    uint32_t *counterpart; /* [to->joint_count] joint of the set, or MODEL_NONE */
    uint8_t *taken;        /* [joints of the set] */
    uint32_t found;
} matcher;

/* ---- names ---- */

static const char *without_namespace(const char *name)
{
    const char *colon = name ? strrchr(name, ':') : NULL;
    return colon ? colon + 1 : name ? name : "";
}

static uint32_t find_joint(const raw_skeleton *s, const char *name)
{
    for (uint32_t j = 0; j < s->joint_count; j++) {
        if (s->joints[j].name && strcmp(s->joints[j].name, name) == 0) return j;
    }
    for (uint32_t j = 0; j < s->joint_count; j++) {
        if (strcmp(without_namespace(s->joints[j].name), without_namespace(name)) == 0) return j;
    }
    return MODEL_NONE;
}

static void pair(matcher *m, uint32_t ours, uint32_t theirs)
{
    if (m->counterpart[ours] != MODEL_NONE || m->taken[theirs]) return;
    m->counterpart[ours] = theirs;
    m->taken[theirs] = 1;
    m->found++;
}

static int pair_line(matcher *m, text_scan *scan, text_word word)
{
    text_word other;
    char *theirs, *ours, shown[TEXT_SHOWN];
    uint32_t a, b;
    int failed = 0;
    if (text_take_on_line(scan, &other)) return 1;
    if (!other.size) return text_fail(scan, word.line, "a line needs two names: the file's and the pack's");
    theirs = text_copy(word);
    ours = text_copy(other);
    if (!theirs || !ours) {
        failed = model_fail_memory(scan->error);
    } else {
        a = find_joint(&m->set->skeleton, theirs);
        b = find_joint(m->to, ours);
        if (b == MODEL_NONE) {
            failed = text_fail(scan, word.line, "the pack has no joint '%s'", text_show(other, shown));
        } else if (a != MODEL_NONE) { /* one file of names serves many clips */
            pair(m, b, a);
        }
    }
    free(theirs);
    free(ours);
    return failed;
}

static int pair_by_file(matcher *m, const char *path, model_error *error)
{
    size_t bytes;
    char *text = input_read_text(path, &bytes, error);
    text_scan scan;
    text_word word;
    int failed = 0;
    if (!text) return input_fail_at(path, error);
    text_start(&scan, text, bytes, error);
    do {
        failed = text_take_on_line(&scan, &word) || (word.size && pair_line(m, &scan, word));
    } while (!failed && text_next_line(&scan));
    free(text);
    return failed ? input_fail_at(path, error) : 0;
}

static void pair_by_name(matcher *m)
{
    for (uint32_t j = 0; j < m->to->joint_count; j++) {
        const uint32_t theirs = m->to->joints[j].name ? find_joint(&m->set->skeleton, m->to->joints[j].name)
                                                      : MODEL_NONE;
        if (theirs != MODEL_NONE) pair(m, j, theirs);
    }
}

/* ---- meanings ---- */

#define REST_ALIKE 0.9962 /* cosine of 5 degrees, half of the angle by which rest poses may differ */

static void rest_rotation(const raw_skeleton *s, uint32_t joint, double out[4])
{
    const double none[4] = { 0.0, 0.0, 0.0, 1.0 };
    memcpy(out, none, sizeof none);
    for (; joint != MODEL_NONE; joint = s->joints[joint].parent) {
        const float *r = s->joints[joint].rotation;
        const double own[4] = { (double)r[0], (double)r[1], (double)r[2], (double)r[3] };
        double q[4];
        quat_multiply(own, out, q);
        memcpy(out, q, sizeof q);
    }
}

/* Poses are taken over as they are, which is right where joints rest at the same angles alone. */
static int rest_alike(const matcher *m, uint32_t ours, uint32_t theirs)
{
    double a[4], b[4];
    rest_rotation(m->to, ours, a);
    rest_rotation(&m->set->skeleton, theirs, b);
    return fabs(a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]) > REST_ALIKE;
}

/* Joints that the table of names knows as the same bone of a person: hips, mixamorig:Hips and pelvis. 1: out of memory.
 */
static int pair_by_meaning(matcher *m)
{
    const raw_skeleton *s = &m->set->skeleton;
    char(*ours)[NOH_NAME_BYTES_MAX] = calloc(m->to->joint_count, sizeof *ours);
    if (!ours) return 1;
    for (uint32_t j = 0; j < m->to->joint_count; j++) {
        if (m->to->joints[j].name) (void)names_find(NAME_JOINT, m->to->joints[j].name, ours[j], NULL);
    }
    for (uint32_t k = 0; k < s->joint_count; k++) {
        char theirs[NOH_NAME_BYTES_MAX];
        if (m->taken[k] || !s->joints[k].name || !names_find(NAME_JOINT, s->joints[k].name, theirs, NULL)) continue;
        for (uint32_t j = 0; j < m->to->joint_count && !m->taken[k]; j++) {
            if (strcmp(ours[j], theirs) == 0 && rest_alike(m, j, k)) pair(m, j, k);
        }
    }
    free(ours);
    return 0;
}

/* ---- places ---- */

typedef struct place {
    double q[4], t[3], s; /* s: even scale */
} place;

static const place nowhere = { { 0.0, 0.0, 0.0, 1.0 }, { 0.0, 0.0, 0.0 }, 1.0 };

static place place_of(const float *q, const float *t, const float *s, double unit)
{
    place p = nowhere;
    for (int i = 0; i < 4; i++) p.q[i] = (double)q[i];
    for (int i = 0; i < 3; i++) p.t[i] = unit * (double)t[i];
    quat_normalize(p.q);
    p.s = ((double)s[0] + (double)s[1] + (double)s[2]) / 3.0;
    return p;
}

static void turn(const double q[4], const double v[3], double out[3])
{
    double m[9];
    quat_columns(q, m);
    for (int i = 0; i < 3; i++) out[i] = m[i] * v[0] + m[3 + i] * v[1] + m[6 + i] * v[2];
}

static place below(const place *parent, const place *child)
{
    place p;
    turn(parent->q, child->t, p.t);
    for (int i = 0; i < 3; i++) p.t[i] = parent->t[i] + parent->s * p.t[i];
    quat_multiply(parent->q, child->q, p.q);
    quat_normalize(p.q);
    p.s = parent->s * child->s;
    return p;
}

static place inverse(const place *p)
{
    const double back[4] = { -p->q[0], -p->q[1], -p->q[2], p->q[3] };
    place o;
    memcpy(o.q, back, sizeof back);
    o.s = p->s != 0.0 ? 1.0 / p->s : 1.0;
    turn(o.q, p->t, o.t);
    for (int i = 0; i < 3; i++) o.t[i] *= -o.s;
    return o;
}

/* ---- frames ---- */

/* The transform of a joint of the set in a frame, below one of its parents; MODEL_NONE: in the file's space. */
static place below_parent(const raw_skeleton *s, const raw_clip *c, uint32_t frame, uint32_t joint, uint32_t parent)
{
    place p = nowhere;
    for (; joint != parent && joint != MODEL_NONE; joint = s->joints[joint].parent) {
        const size_t at = (size_t)frame * c->joint_count + joint;
        const place own = place_of(c->rotations + 4u * at, c->translations + 3u * at, c->scales + 3u * at, 1.0);
        p = below(&own, &p);
    }
    return p;
}

static int has_above(const raw_skeleton *s, uint32_t joint, uint32_t parent)
{
    while (joint != MODEL_NONE && joint != parent) joint = s->joints[joint].parent;
    return joint == parent;
}

/* A joint of `to` that the set has, in the set's unit: below its nearest parent that the set has too, and beyond the
 * parents in between, which keep the bind pose. */
static place place_in_frame(const matcher *m, const raw_clip *c, uint32_t frame, uint32_t joint)
{
    const raw_skeleton *theirs = &m->set->skeleton;
    const double unit = m->to->unit_cm / theirs->unit_cm;
    uint32_t up = m->to->joints[joint].parent, parent;
    place between = nowhere, p;
    for (; up != MODEL_NONE && m->counterpart[up] == MODEL_NONE; up = m->to->joints[up].parent) {
        const raw_joint *r = &m->to->joints[up];
        const place own = place_of(r->rotation, r->translation, r->scale, unit);
        between = below(&own, &between);
    }
    parent = up == MODEL_NONE ? MODEL_NONE : m->counterpart[up];
    if (has_above(theirs, m->counterpart[joint], parent)) {
        p = below_parent(theirs, c, frame, m->counterpart[joint], parent);
    } else { /* the two hang together otherwise there */
        const place own = below_parent(theirs, c, frame, m->counterpart[joint], MODEL_NONE);
        const place above = below_parent(theirs, c, frame, parent, MODEL_NONE), back = inverse(&above);
        p = below(&back, &own);
    }
    between = inverse(&between);
    return below(&between, &p);
}

/* Whether a joint hangs from the same joint in both. */
static int same_parent(const matcher *m, uint32_t joint)
{
    const uint32_t ours = m->to->joints[joint].parent, theirs = m->set->skeleton.joints[m->counterpart[joint]].parent;
    return (ours == MODEL_NONE && theirs == MODEL_NONE) ||
           (ours != MODEL_NONE && theirs != MODEL_NONE && m->counterpart[ours] == theirs);
}

static void fill_joint(const matcher *m, const raw_clip *from, raw_clip *to, uint32_t frame, uint32_t joint)
{
    const size_t at = (size_t)frame * to->joint_count + joint;
    const uint32_t other = m->counterpart[joint];
    const raw_joint *r = &m->to->joints[joint];
    float *q = to->rotations + 4u * at, *t = to->translations + 3u * at, *s = to->scales + 3u * at;
    if (other == MODEL_NONE) {
        memcpy(q, r->rotation, sizeof r->rotation);
        memcpy(s, r->scale, sizeof r->scale);
        for (int i = 0; i < 3; i++)
            t[i] = (float)((double)r->translation[i] * m->to->unit_cm / m->set->skeleton.unit_cm);
    } else if (same_parent(m, joint)) {
        const size_t own = (size_t)frame * from->joint_count + other;
        memcpy(q, from->rotations + 4u * own, 4u * sizeof *q);
        memcpy(t, from->translations + 3u * own, 3u * sizeof *t);
        memcpy(s, from->scales + 3u * own, 3u * sizeof *s);
    } else {
        const place p = place_in_frame(m, from, frame, joint);
        for (int i = 0; i < 4; i++) q[i] = (float)p.q[i];
        for (int i = 0; i < 3; i++) t[i] = (float)p.t[i];
        for (int i = 0; i < 3; i++) s[i] = (float)p.s;
    }
}

static int refit_clip(const matcher *m, raw_clip *clip)
{
    raw_clip to = *clip;
    if (!clip->joint_count) return 0;
    to.rotations = to.translations = to.scales = NULL;
    if (raw_clip_alloc(&to, clip->frame_count, m->to->joint_count)) {
        free(to.rotations);
        free(to.translations);
        free(to.scales);
        return 1;
    }
    for (uint32_t f = 0; f < clip->frame_count; f++) {
        for (uint32_t j = 0; j < m->to->joint_count; j++) fill_joint(m, clip, &to, f, j);
    }
    free(clip->rotations);
    free(clip->translations);
    free(clip->scales);
    *clip = to;
    return 0;
}

/* ---- messages ---- */

/* "what: 'a', 'b' and 3 more" of the joints that have no counterpart. */
static void list_left(byte_buffer *out, const raw_skeleton *s, const uint32_t *counterpart, const uint8_t *taken,
                      const char *what)
{
    uint32_t left = 0;
    for (uint32_t j = 0; j < s->joint_count; j++) {
        if (counterpart ? counterpart[j] != MODEL_NONE : taken[j]) continue;
        left++;
        if (left == 1) buffer_print(out, "%s", what);
        if (left <= LISTED)
            buffer_print(out, "%s '%.40s'", left == 1 ? "" : ",", s->joints[j].name ? s->joints[j].name : "");
    }
    if (left > LISTED) buffer_print(out, " and %u more", left - LISTED);
}

/* The largest share by which the set's bind pose has a bone longer or shorter. */
static double lengths_apart(const matcher *m)
{
    const double unit = m->set->skeleton.unit_cm / m->to->unit_cm;
    double worst = 0.0;
    for (uint32_t j = 0; j < m->to->joint_count; j++) {
        double ours = 0.0, theirs = 0.0;
        if (m->counterpart[j] == MODEL_NONE || m->to->joints[j].parent == MODEL_NONE || !same_parent(m, j)) continue;
        for (int i = 0; i < 3; i++) {
            ours += pow((double)m->to->joints[j].translation[i], 2.0);
            theirs += pow(unit * (double)m->set->skeleton.joints[m->counterpart[j]].translation[i], 2.0);
        }
        if (ours > 0.0) worst = fmax(worst, fabs(sqrt(theirs / ours) - 1.0));
    }
    return worst;
}

static char *write_report(const matcher *m)
{
    const double apart = lengths_apart(m);
    byte_buffer out;
    memset(&out, 0, sizeof out);
    buffer_print(&out, "%u of its %u joints were found by name", m->found, m->set->skeleton.joint_count);
    list_left(&out, m->to, m->counterpart, NULL, "; these keep the bind pose:");
    list_left(&out, &m->set->skeleton, NULL, m->taken, "; these were left out:");
    if (apart > LENGTHS_EQUAL)
        buffer_print(&out, "; bones differ in length by up to %.0f %%, and the pack's lengths are kept", 100.0 * apart);
    buffer_append(&out, "", 1);
    return out.failed ? NULL : (char *)out.bytes;
}

/* ---- all of it ---- */

static int is_whole(const matcher *m)
{
    int whole = m->found == m->to->joint_count && m->found == m->set->skeleton.joint_count;
    for (uint32_t j = 0; j < m->to->joint_count && whole; j++) whole = same_parent(m, j);
    return whole;
}

static joint_match fit(matcher *m, const joint_match_options *options, char **report, model_error *error)
{
    if (options->names && pair_by_file(m, options->names, error)) return JOINTS_FAILED;
    pair_by_name(m);
    if (!is_whole(m) && pair_by_meaning(m)) return (void)model_fail_memory(error), JOINTS_FAILED;
    if (!is_whole(m) &&
        !(options->partial && (2u * m->found >= m->to->joint_count || 2u * m->found >= m->set->skeleton.joint_count)))
        return JOINTS_DIFFER;
    *report = write_report(m);
    if (!*report) return (void)model_fail_memory(error), JOINTS_FAILED;
    for (uint32_t c = 0; c < m->set->clip_count; c++) {
        if (refit_clip(m, &m->set->clips[c])) return (void)model_fail_memory(error), JOINTS_FAILED;
    }
    if (raw_skeleton_take(&m->set->skeleton, m->to)) return (void)model_fail_memory(error), JOINTS_FAILED;
    return JOINTS_MATCHED;
}

joint_match joint_match_set(raw_set *set, const raw_skeleton *to, const joint_match_options *options, char **report,
                            model_error *error)
{
    matcher m = { set, to, NULL, NULL, 0 };
    joint_match result;
    *report = NULL;
    m.counterpart = malloc(((size_t)to->joint_count + 1u) * sizeof *m.counterpart);
    m.taken = calloc((size_t)set->skeleton.joint_count + 1u, 1);
    if (!m.counterpart || !m.taken) {
        free(m.counterpart);
        free(m.taken);
        return (void)model_fail_memory(error), JOINTS_FAILED;
    }
    for (uint32_t j = 0; j < to->joint_count; j++) m.counterpart[j] = MODEL_NONE;
    result = to->joint_count && set->skeleton.joint_count ? fit(&m, options, report, error) : JOINTS_DIFFER;
    free(m.counterpart);
    free(m.taken);
    return result;
}
