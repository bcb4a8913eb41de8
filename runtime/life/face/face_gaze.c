/* face_gaze.c: where the eyes look, and how far the head turns with them.
 *
 * A gaze is a direction from the midpoint of the eyes (yaw, pitch) and 1 / distance; each eye then aims at that point
 * from its own centre, so the eyes converge on near points. A gaze holds, waits for its latency, or moves in a saccade.
 * Saccades last 21 ms and 2.2 ms per degree (Carpenter, Movements of the Eyes, 1988), along the fifth-order polynomial
 * of least jerk. When the eyes would turn farther than is comfortable, the head takes four fifths of the rest, as a
 * slower spring; the eyes keep their aim while it moves.
 *
 * Without commands a face looks away now and then: distance and direction follow Lee, Badler and Badler, "Eyes Alive",
 * SIGGRAPH 2002, as does the time of eye contact while talking or listening. */
#include "core/base/math_internal.h"
#include "core/base/trig_internal.h"
#include "noh/face.h"
#include "noh/low_core.h"
#include "life/face/face_internal.h"

#define HEAD_FROM (17.5f * NOH_DEGREE) /* eyes turned farther than this turn the head too */
#define HEAD_SHARE 0.8f
#define HEAD_TICKS 24000u /* 0.5 s to 95 % of the way */
#define TREMOR_RAD (0.08f * NOH_DEGREE)
#define BEHIND (160.0f * NOH_DEGREE)
#define TURN (360.0f * NOH_DEGREE)
#define BIG_SHIFT (20.0f * NOH_DEGREE) /* more likely with a blink than without */

/* ---- the gaze ---- */

void noh_face_middle(const noh_face_desc *desc, const float rotation[4], float middle[3])
{
    for (int i = 0; i < 3; i++) {
        middle[i] = 0.5f * (desc->eyes[0][i] + desc->eyes[1][i]);
    }
    noh_quat_rotate(rotation, middle, middle);
}

/* For a target behind, the yaw continues over the shoulder to which the head has turned, instead of swinging from side
 * to side with every small motion. */
static float over_shoulder(float yaw, float head)
{
    if (yaw < -BEHIND && head > 0.0f) return yaw + TURN;
    return yaw > BEHIND && head < 0.0f ? yaw - TURN : yaw;
}

static void goal_from(const noh_face *face, const noh_face_desc *desc, const float head[4], float gaze[3])
{
    float way[3], across;
    noh_face_middle(desc, head, way);
    for (int i = 0; i < 3; i++) {
        way[i] = face->target[i] - way[i];
    }
    across = noh_sqrt(way[0] * way[0] + way[2] * way[2]);
    gaze[0] = over_shoulder(noh_atan2(way[0], way[2]), face->head[0].goal) + face->away[0] + face->tremor[0];
    gaze[1] = noh_atan2(way[1], across) + face->away[1] + face->tremor[1];
    gaze[2] = 1.0f / noh_sqrt(noh_dot3(way, way));
}

void noh_face_gaze_goal(const noh_face *face, const noh_face_desc *desc, float gaze[3])
{
    float angles[3], rotation[4];
    noh_face_head_rotation(face, angles, rotation);
    goal_from(face, desc, rotation, gaze);
}

/* 10 t^3 - 15 t^4 + 6 t^5 */
static float least_jerk(float t)
{
    return t * t * t * (10.0f + t * (6.0f * t - 15.0f));
}

void noh_face_gaze_from(const noh_face *face, const noh_face_desc *desc, const float head[4], float gaze[3])
{
    float part;
    if (face->gaze == NOH_GAZE_WAIT) {
        for (int i = 0; i < 3; i++) gaze[i] = face->from[i];
        return;
    }
    goal_from(face, desc, head, gaze);
    if (face->gaze == NOH_GAZE_MOVE) {
        part = least_jerk((float)((uint32_t)face->clock - face->gaze_start) / (float)face->gaze_ticks);
        for (int i = 0; i < 3; i++) gaze[i] = face->from[i] + (gaze[i] - face->from[i]) * part;
    }
}

void noh_face_gaze_at(const noh_face *face, const noh_face_desc *desc, float gaze[3])
{
    float angles[3], rotation[4];
    noh_face_head_rotation(face, angles, rotation);
    noh_face_gaze_from(face, desc, rotation, gaze);
}

static void direction(const float gaze[3], float way[3])
{
    float sy, cy, sp, cp;
    noh_sin_cos(gaze[0], &sy, &cy);
    noh_sin_cos(gaze[1], &sp, &cp);
    way[0] = sy * cp;
    way[1] = sp;
    way[2] = cy * cp;
}

/* The angle by the chord, which is precise where an arc cosine is not. */
float noh_face_angle(const float a[3], const float b[3])
{
    float u[3], v[3], d[3], half;
    direction(a, u);
    direction(b, v);
    for (int i = 0; i < 3; i++) d[i] = u[i] - v[i];
    half = 0.5f * noh_sqrt(noh_dot3(d, d));
    return 2.0f * noh_atan2(half, noh_sqrt(half < 1.0f ? 1.0f - half * half : 0.0f));
}

/* ---- shifts ---- */

uint32_t noh_face_latency(const noh_face *face)
{
    return noh_face_ticks(0.15f + 0.10f * noh_face_uniform(face->seed, NOH_FACE_LATENCY, face->glances));
}

void noh_face_gaze_shift(noh_face *face, const float from[3], uint32_t latency)
{
    for (int i = 0; i < 3; i++) face->from[i] = from[i];
    face->gaze = NOH_GAZE_WAIT;
    face->gaze_start = (uint32_t)face->clock;
    face->gaze_ticks = latency;
}

/* How far the two eyes turn towards each other between two distances. */
static float vergence(const noh_face_desc *desc, float from, float to)
{
    const float apart = desc->eyes[0][0] - desc->eyes[1][0], change = from - to;
    return (change < 0.0f ? -change : change) * (apart < 0.0f ? -apart : apart);
}

static void begin_saccade(noh_face *face, const noh_face_desc *desc)
{
    float goal[3], angle, turn;
    noh_face_head_follow(face, desc);
    noh_face_gaze_goal(face, desc, goal);
    angle = noh_face_angle(face->from, goal);
    turn = vergence(desc, face->from[2], goal[2]);
    turn = turn > angle ? turn : angle;
    face->gaze = NOH_GAZE_MOVE;
    face->gaze_start = (uint32_t)face->clock;
    face->gaze_ticks = noh_face_ticks(0.021f + 0.0022f / NOH_DEGREE * turn);
    if (angle > BIG_SHIFT && !(face->flags & (NOH_FACE_CALM | NOH_FACE_NO_BLINK | NOH_FACE_FOUR)) &&
        noh_face_uniform(face->seed, NOH_FACE_WITH_GAZE, face->glances) < 0.6f) {
        noh_face_blink_pull(face);
    }
}

void noh_face_gaze_event(noh_face *face, const noh_face_desc *desc)
{
    if (face->gaze == NOH_GAZE_WAIT) {
        begin_saccade(face, desc);
    } else {
        face->gaze = NOH_GAZE_HOLD;
    }
}

/* ---- the head ---- */

/* How far the head turns for a gaze of `angle`: part of the angle beyond HEAD_FROM, and all that the eyes cannot
 * reach. */
static float head_goal(float angle, float eye_max, float head_max)
{
    const float size = angle < 0.0f ? -angle : angle;
    float goal = size > HEAD_FROM ? HEAD_SHARE * (size - HEAD_FROM) : 0.0f;
    goal = size - goal > eye_max ? size - eye_max : goal;
    goal = goal < head_max ? goal : head_max;
    return angle < 0.0f ? -goal : goal;
}

void noh_face_head_follow(noh_face *face, const noh_face_desc *desc)
{
    const float omega = noh_face_omega(HEAD_TICKS);
    const uint32_t now = (uint32_t)face->clock;
    float goal[3], yaw, pitch;
    noh_face_gaze_goal(face, desc, goal);
    yaw = head_goal(goal[0], NOH_EYE_YAW_MAX, noh_face_or(desc->head_yaw_max, 75.0f * NOH_DEGREE));
    pitch = head_goal(goal[1], goal[1] < 0.0f ? NOH_EYE_DOWN_MAX : NOH_EYE_UP_MAX,
                      noh_face_or(desc->head_pitch_max, 40.0f * NOH_DEGREE));
    if (yaw != face->head[0].goal) noh_face_spring_to(&face->head[0], now, yaw, omega);
    if (pitch != face->head[1].goal) noh_face_spring_to(&face->head[1], now, pitch, omega);
}

/* ---- spontaneous gaze ---- */

/* Mean seconds of a look at the target and of one away from it: at rest as in listening, and talking. */
static const float looks[NOH_ACTIVITY_COUNT][2] = { { 7.92f, 0.43f }, { 3.13f, 0.93f }, { 0.25f, 0.25f } };

static int is_away(const noh_face *face)
{
    return face->away[0] != 0.0f || face->away[1] != 0.0f;
}

void noh_face_glance_schedule(noh_face *face)
{
    const float u = noh_face_uniform(face->seed, NOH_FACE_GLANCE, face->glances);
    float s = noh_face_log_normal(u, looks[face->activity][is_away(face)],
                                  face->activity == NOH_ACTIVITY_READ ? 0.25f : 0.7f);
    s = s < 0.2f ? 0.2f : s < 60.0f ? s : 60.0f;
    face->next_glance = (uint32_t)face->clock + noh_face_ticks(s);
}

/* A glance aside. Its size, -6.9 ln(P / 15.7) degrees with P uniform over 0..15, and the shares of the eight
 * directions, counter-clockwise from the face's left, are from "Eyes Alive". */
static void look_aside(noh_face *face)
{
    static const float shares[8] = { 15.5f, 6.5f, 17.7f, 7.4f, 16.8f, 7.9f, 20.4f, 7.8f };
    const float most = face->activity == NOH_ACTIVITY_TALK ? 27.5f : 22.7f;
    float u = noh_face_uniform(face->seed, NOH_FACE_GLANCE_SIZE, face->glances);
    float size = -6.9f * 0.69314718f * noh_log2(15.0f * u / 15.7f), sine, cosine;
    uint32_t way = 0;
    size = (size < most ? size : most) * NOH_DEGREE;
    u = 100.0f * noh_face_uniform(face->seed, NOH_FACE_GLANCE_WAY, face->glances);
    while (way < 7u && u >= shares[way]) u -= shares[way++];
    noh_sin_cos_turn(way << 29, &sine, &cosine);
    face->away[0] = size * cosine;
    face->away[1] = size * sine;
}

/* Twelve lines of eight fixations each, two degrees apart, from the reader's left to right, then the next line. */
static void read_on(noh_face *face)
{
    const uint32_t at = face->glances % 96u, line = at / 8u, column = at % 8u;
    face->away[0] = (7.0f - 2.0f * (float)column) * NOH_DEGREE;
    face->away[1] = (4.0f - 0.7f * (float)line) * NOH_DEGREE;
}

/* A glance that is due while the eyes move to something else is skipped. */
void noh_face_glance(noh_face *face, const noh_face_desc *desc)
{
    float now[3];
    face->glances++;
    if (face->gaze != NOH_GAZE_HOLD) {
        noh_face_glance_schedule(face);
        return;
    }
    noh_face_gaze_at(face, desc, now);
    noh_face_gaze_shift(face, now, 0);
    if (face->activity == NOH_ACTIVITY_READ) {
        read_on(face);
    } else if (is_away(face)) {
        face->away[0] = face->away[1] = 0.0f;
    } else {
        look_aside(face);
    }
    noh_face_glance_schedule(face);
}

void noh_face_look_aside(noh_face *face, const noh_face_desc *desc, int aside)
{
    if (is_away(face) != aside) noh_face_glance(face, desc);
}

/* Microsaccades. Human ones are 0.1 to 0.5 degrees, once or twice per second; these stay below 0.1 degrees, so that a
 * held gaze keeps a reliable aim. */
void noh_face_tremor(noh_face *face)
{
    const uint32_t n = face->tremors++;
    const float size = TREMOR_RAD * noh_face_uniform(face->seed, NOH_FACE_TREMOR_WAY, 2u * n);
    float sine, cosine;
    noh_sin_cos(6.2831853f * noh_face_uniform(face->seed, NOH_FACE_TREMOR_WAY, 2u * n + 1u), &sine, &cosine);
    face->tremor[0] = size * cosine;
    face->tremor[1] = size * sine;
    face->next_tremor = (uint32_t)face->clock +
                        noh_face_ticks(0.5f + 0.5f * noh_face_uniform(face->seed, NOH_FACE_TREMOR, n));
}
