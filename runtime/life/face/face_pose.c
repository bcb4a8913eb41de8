/* face_pose.c: the visible pose at the face's clock. */
#include <string.h>

#include "core/base/math_internal.h"
#include "core/base/trig_internal.h"
#include "core/base/assert_internal.h"
#include "life/face/face_internal.h"
#include "noh/base.h"
#include "noh/face.h"
#include "noh/low_core.h"

#define IDLE_RAD (0.8f * NOH_DEGREE) /* small idle motions of the head */
#define SWAY 1.5f                    /* slow turns of the head, as a share of the small fast ones */
#define LIFT 0.03f                   /* the head on a full breath, as a share of the distance of the eyes */
#define BROWS 0.06f                  /* mean height of brows at rest; they move from 0 to twice as much */
#define BROWS_FOLLOW 0.15f           /* how far brows go up with the lids */
#define BROWS_SPEAK 0.5f
#define NOD (3.5f * NOH_DEGREE)

/* ---- the head ---- */

static float knot(const noh_face *face, uint32_t stream, uint32_t index)
{
    return 2.0f * noh_face_uniform(face->seed, stream, index) - 1.0f;
}

/* Small motions: random values of -1..1 a period apart, joined by a Catmull-Rom curve. Periods have no common multiple,
 * so that curves never reverse together. */
static float wave(const noh_face *face, uint32_t stream, uint32_t period)
{
    const uint64_t clock = (uint64_t)face->clock;
    const uint32_t n = (uint32_t)(clock / period);
    const float t = (float)(uint32_t)(clock % period) / (float)period;
    const float a = knot(face, stream, n), b = knot(face, stream, n + 1u), c = knot(face, stream, n + 2u),
                d = knot(face, stream, n + 3u);
    const float square = t * t, cube = square * t;
    return 0.5f * (2.0f * b + (c - a) * t + (2.0f * a - 5.0f * b + 4.0f * c - d) * square +
                   (3.0f * b - a - 3.0f * c + d) * cube);
}

static int is_still(const noh_face *face)
{
    return (face->flags & (NOH_FACE_CALM | NOH_FACE_NO_IDLE)) != 0;
}

static void turn_about(uint32_t axis, float angle, float q[4])
{
    float sine, cosine;
    noh_sin_cos(0.5f * angle, &sine, &cosine);
    memset(q, 0, 3 * sizeof *q);
    q[axis] = sine;
    q[3] = cosine;
}

void noh_face_head_rotation(const noh_face *face, float angles[3], float rotation[4])
{
    static const uint32_t periods[3] = { 62400u, 81600u, 100800u }, sways[3] = { 249600u, 297600u, 350400u };
    float part[4];
    for (uint32_t i = 0; i < 3; i++) {
        angles[i] = i < 2u ? noh_face_spring_at(&face->head[i], (uint32_t)face->clock) : 0.0f;
        if (is_still(face)) continue;
        angles[i] += IDLE_RAD *
                     (wave(face, NOH_FACE_IDLE + i, periods[i]) + SWAY * wave(face, NOH_FACE_SWAY + i, sways[i]));
    }
    angles[1] -= NOD * face->speech.nod;
    turn_about(1, angles[0], rotation);
    turn_about(0, -angles[1], part);
    noh_quat_mul(rotation, part, rotation);
    turn_about(2, angles[2], part);
    noh_quat_mul(rotation, part, rotation);
}

void noh_face_drift(const noh_face *face, const noh_face_desc *desc, float moved[3])
{
    static const uint32_t periods[3] = { 206400u, 158400u, 235200u };
    static const float shares[3] = { 0.03f, 0.01f, 0.03f };
    const float apart = desc->eyes[0][0] - desc->eyes[1][0];
    for (uint32_t i = 0; i < 3; i++) {
        moved[i] = is_still(face) ? 0.0f : shares[i] * apart * wave(face, NOH_FACE_DRIFT + i, periods[i]);
    }
    moved[1] += LIFT * apart * noh_face_breath(face);
}

void noh_face_whole(const noh_face *face, const noh_face_desc *desc, uint32_t ago, float rotation[4], float moved[3])
{
    noh_face then = *face;
    float angles[3];
    uint32_t now;
    then.clock = face->clock > (int64_t)ago ? face->clock - (int64_t)ago : 0;
    now = (uint32_t)then.clock;
    for (int i = 0; i < 2; i++) {
        if (now - then.head[i].start > UINT32_MAX / 2u) then.head[i].start = now; /* it had not begun */
    }
    if (now - then.breath_start > UINT32_MAX / 2u) then.breath_start = now;
    noh_face_head_rotation(&then, angles, rotation);
    noh_face_drift(&then, desc, moved);
}

/* ---- the eyes ---- */

/* Angles of an eye to the point it looks at, in the head's space. */
static void aim(const noh_face_desc *desc, const float rotation[4], const float point[3], int eye, float out[2])
{
    float back[4], way[3];
    noh_quat_conjugate(rotation, back);
    noh_quat_rotate(back, point, way);
    for (int i = 0; i < 3; i++) way[i] -= desc->eyes[eye][i];
    out[0] = noh_clamped(noh_atan2(way[0], way[2]), -NOH_EYE_YAW_MAX, NOH_EYE_YAW_MAX);
    out[1] = noh_clamped(noh_atan2(way[1], noh_sqrt(way[0] * way[0] + way[2] * way[2])), -NOH_EYE_DOWN_MAX,
                         NOH_EYE_UP_MAX);
}

static void aim_both(const noh_face *face, const noh_face_desc *desc, noh_face_pose *pose)
{
    float gaze[3], point[3], sy, cy, sp, cp;
    noh_face_gaze_from(face, desc, pose->head, gaze);
    noh_face_middle(desc, pose->head, point);
    noh_sin_cos(gaze[0], &sy, &cy);
    noh_sin_cos(gaze[1], &sp, &cp);
    point[0] += sy * cp / gaze[2];
    point[1] += sp / gaze[2];
    point[2] += cy * cp / gaze[2];
    aim(desc, pose->head, point, 0, pose->eyes[0]);
    aim(desc, pose->head, point, 1, pose->eyes[1]);
}

/* ---- the rest ---- */

/* In for two fifths of a breath, out for three fifths. */
float noh_face_breath(const noh_face *face)
{
    float t, sine, cosine;
    NOH_ASSERT(face);
    if (face->flags & (NOH_FACE_CALM | NOH_FACE_NO_BREATH)) {
        return 0.0f;
    }
    t = (float)((uint32_t)face->clock - face->breath_start) / (float)noh_face_breath_ticks(face, face->breaths);
    noh_sin_cos(3.14159265f * (t < 0.4f ? t / 0.4f : 1.0f - (t - 0.4f) / 0.6f), &sine, &cosine);
    return 0.5f - 0.5f * cosine;
}

static float brows_at(const noh_face *face, float lids_up)
{
    const float idle = is_still(face) ? 0.0f : BROWS + BROWS * wave(face, NOH_FACE_BROWS, 110400u);
    return noh_clamped(idle + BROWS_FOLLOW * lids_up + BROWS_SPEAK * face->speech.brows, 0.0f, 1.0f);
}

static void show_emotions(const noh_face *face, float emotions[NOH_EMOTION_COUNT])
{
    if (noh_face_is_four(face) && face->emotions[0].on) {
        emotions[face->emotions[0].emotion] = noh_clamped(noh_face_mood_at(face), 0.0f, 1.0f);
        return;
    }
    for (uint32_t i = 0; i < NOH_FACE_EMOTIONS_MAX; i++) {
        const noh_face_emotion *f = &face->emotions[i];
        if (f->on) {
            emotions[f->emotion] = noh_clamped(noh_face_spring_at(&f->amount, (uint32_t)face->clock), 0.0f, 1.0f);
        }
    }
}

void noh_face_pose_of(const noh_face *face, const noh_face_desc *desc, noh_face_pose *pose)
{
    float pitch;
    NOH_ASSERT(face && desc && pose);
    memset(pose, 0, sizeof *pose);
    noh_face_head_rotation(face, pose->head_angles, pose->head);
    aim_both(face, desc, pose);
    pitch = 0.5f * (pose->eyes[0][1] + pose->eyes[1][1]);
    pose->lids_down = noh_clamped(-pitch / NOH_EYE_DOWN_MAX, 0.0f, 1.0f);
    pose->lids_up = noh_clamped(pitch / NOH_EYE_UP_MAX, 0.0f, 1.0f);
    pose->blink = noh_face_blink_at(face);
    pose->breath = noh_face_breath(face);
    pose->brows = brows_at(face, pose->lids_up);
    show_emotions(face, pose->emotions);
}
