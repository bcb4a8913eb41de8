/* feet.c: planted feet, heights of feet and pelvis, and the legs that follow.
 *
 * All of it is in world space. A foot is moved as a whole: turned about its lowest part by its lean, along the ground
 * to stay planted, and up by `shift`. */
#include "core/base/trig_internal.h"
#include "life/reach/feet_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/low_life.h"
#include "noh/low_motion.h"

#include "core/base/assert_internal.h"
#include "core/base/vector_internal.h"

/* Lengths are in leg lengths, speeds in leg lengths per second, times in seconds. */
#define REACH_UP 0.6f
#define REACH_DOWN 0.9f
#define STAND_LIFT 0.045f /* a foot lower and slower than this in its clip is planted */
#define STAND_SPEED 0.35f
#define LEAVE_LIFT 0.09f /* a foot higher, faster or farther off than this is released */
#define LEAVE_SPEED 1.2f
#define LEAVE_DRIFT 0.23f
#define LEAVE_DRIFT_STANDING 0.31f /* of a foot that stands in its clip */
#define PART_MARGIN 0.006f         /* lower than the lowest part by this much: becomes the lowest */
#define LEVEL_MIN 0.643f           /* the cosine of 50 degrees: steeper ground is no place to stand on */
#define LAND_HALF_LIFE 0.015f
#define LEAN_HALF_LIFE 0.04f
#define DRIFT_HALF_LIFE 0.05f
#define ROWS 4
#define AHEAD 0.06f       /* twice */
#define HEIGHT_RATE 35.0f /* rates of springs, 1/s */
#define PELVIS_RATE 12.0f
#define PELVIS_ACCELERATION 20.0f
#define PELVIS_MARGIN 0.01f
#define STANDS 0.5f
#define PELVIS_BRAKE 0.7f /* share of it for braking, so that the rest brakes in time */
#define STRAIGHT 0.9995f

static const float up[3] = { 0.0f, 1.0f, 0.0f }, side_axis[3] = { 1.0f, 0.0f, 0.0f };

typedef struct step {
    const noh_feet_rig *rig;
    const noh_skeleton *skeleton;
    noh_transform *local;
    const noh_feet_place *place;
    const noh_ground *ground;
    float leg, floor; /* in world units */
    float seconds;
    int cut;
} step;

/* A leg as in its clip. */
typedef struct leg_now {
    const noh_feet_leg *leg;
    float hip[3], knee[3], ankle[3];
    float modelled[3]; /* direction of the knee in the model */
    float rotation[4]; /* of the foot */
    float points[NOH_FEET_POINTS][3], parts[3][3];
    float shift;
    float soon; /* shift for the lowest ground that it reaches soon; `shift` if it is planted */
} leg_now;

/* The ground under a foot. */
typedef struct under {
    float need; /* shift that brings all points of the sole out of the ground */
    float normal[3];
    int has_ground;
} under;

/* ---- joints ---- */

/* Transform a point from a joint's space to the world, with the joint's rotation there. */
static void joint_at(const step *s, uint32_t joint, const float *offset, float rotation[4], float at[3])
{
    const noh_transform *local = s->local;
    memcpy(rotation, local[joint].rotation, 4 * sizeof *rotation);
    memcpy(at, local[joint].translation, 3 * sizeof *at);
    if (offset) {
        float turned[3];
        noh_quat_rotate(rotation, offset, turned);
        noh_madd3(at, 1.0f, turned, at);
    }
    for (uint32_t above = s->skeleton->parents[joint]; above != NOH_JOINT_ROOT; above = s->skeleton->parents[above]) {
        for (int i = 0; i < 3; i++) at[i] *= local[above].scale[i];
        noh_quat_rotate(local[above].rotation, at, at);
        noh_madd3(at, 1.0f, local[above].translation, at);
        noh_quat_mul(local[above].rotation, rotation, rotation);
    }
    for (int i = 0; i < 3; i++) at[i] *= s->place->scale;
    noh_quat_rotate(s->place->rotation, at, at);
    noh_madd3(at, 1.0f, s->place->position, at);
    noh_quat_mul(s->place->rotation, rotation, rotation);
    noh_quat_normalize(rotation);
}

/* The rotation of a joint's parent. */
static void carrier_of(const step *s, uint32_t joint, float rotation[4])
{
    const uint32_t above = s->skeleton->parents[joint];
    float unused[3];
    if (above == NOH_JOINT_ROOT) {
        memcpy(rotation, s->place->rotation, 4 * sizeof *rotation);
    } else {
        joint_at(s, above, NULL, rotation, unused);
    }
}

/* Set a joint's rotation in the world. */
static void set_rotation(const step *s, uint32_t joint, const float rotation[4])
{
    float carrier[4];
    carrier_of(s, joint, carrier);
    noh_quat_conjugate(carrier, carrier);
    noh_quat_mul(carrier, rotation, s->local[joint].rotation);
    noh_quat_normalize(s->local[joint].rotation);
}

static void turn_joint(const step *s, uint32_t joint, const float by[4])
{
    float rotation[4], unused[3];
    joint_at(s, joint, NULL, rotation, unused);
    noh_quat_mul(by, rotation, rotation);
    set_rotation(s, joint, rotation);
}

static void read_leg(const step *s, const noh_feet_leg *leg, leg_now *n)
{
    float thigh[4], unused[4];
    n->leg = leg;
    joint_at(s, leg->thigh, NULL, thigh, n->hip);
    joint_at(s, leg->shin, NULL, unused, n->knee);
    joint_at(s, leg->foot, NULL, n->rotation, n->ankle);
    noh_quat_rotate(thigh, leg->knee, n->modelled);
    for (int i = 0; i < (int)NOH_FEET_POINTS; i++) {
        joint_at(s, leg->points[i].joint, leg->points[i].at, unused, n->points[i]);
    }
    for (int p = 0; p < 3; p++) {
        const float *a = n->points[2 * p], *b = n->points[2 * p + 1];
        for (int i = 0; i < 3; i++) n->parts[p][i] = 0.5f * (a[i] + b[i]);
        n->parts[p][1] = a[1] < b[1] ? a[1] : b[1];
    }
}

/* ---- the ground under a foot ---- */

/* Transform a point by the foot's motion, without its shift. */
static void carry(const noh_foot *f, const leg_now *n, const float point[3], float out[3])
{
    const float *about = n->parts[f->part];
    float lean[4];
    noh_quat_between(up, f->normal, side_axis, lean);
    noh_sub3(point, about, out);
    noh_quat_rotate(lean, out, out);
    noh_madd3(out, 1.0f, about, out);
    out[0] += f->moved[0];
    out[2] += f->moved[1];
}

/* The ray on which the ground under a point of a sole is looked for. */
static noh_ray ray_down(const step *s, const noh_foot *f, const float at[3], const float ahead[2])
{
    const float high = f->height > s->floor ? f->height : s->floor, top = high + REACH_UP * s->leg;
    const noh_ray ray = { { at[0] + ahead[0], top, at[2] + ahead[1] },
                          { 0.0f, -1.0f, 0.0f },
                          top - s->floor + REACH_DOWN * s->leg };
    return ray;
}

/* Add the ground under a point of a sole to the result. height: of the point */
static void take_ground(const noh_ray *ray, const noh_world_hit *hit, float height, under *u)
{
    if (hit->distance < 0.0f) return;
    const float need = ray->from[1] - hit->distance - height;
    u->need = need > u->need ? need : u->need;
    u->has_ground = 1;
    if (hit->normal[1] > LEVEL_MIN) noh_madd3(u->normal, 1.0f, hit->normal, u->normal);
}

/* The ground under a sole that is `ahead` of its place: under its six points, or also between them, where edges of
 * steps may lie. */
static under look_down(const step *s, const noh_foot *f, const leg_now *n, const float ahead[2], int rows)
{
    under u = { -1e30f, { 0.0f, 0.0f, 0.0f }, 0 };
    float at[NOH_GROUND_RAYS_MAX][3];
    noh_ray rays[NOH_GROUND_RAYS_MAX];
    noh_world_hit hits[NOH_GROUND_RAYS_MAX];
    uint32_t count = NOH_FEET_POINTS;
    memset(rays, 0, sizeof rays);
    for (uint32_t i = 0; i < NOH_FEET_POINTS; i++) carry(f, n, n->points[i], at[i]);
    for (uint32_t i = 0; i < NOH_FEET_POINTS - 2u; i++) {
        for (int row = 1; row < rows; row++) {
            float way[3];
            noh_sub3(at[i + 2u], at[i], way);
            noh_madd3(at[i], (float)row / (float)rows, way, at[count++]);
        }
    }
    for (uint32_t i = 0; i < count; i++) rays[i] = ray_down(s, f, at[i], ahead);
    noh_ground_below_all(s->ground, rays, count, hits);
    for (uint32_t i = 0; i < count; i++) take_ground(&rays[i], &hits[i], at[i][1], &u);
    noh_normalize3(u.normal, up);
    return u;
}

/* ---- planting ---- */

static float decay(float seconds, float half_life)
{
    return noh_exp2(-seconds / half_life);
}

/* Critically damped, exact for steps of any length. */
static void follow(float *x, float *speed, float goal, float rate, float seconds)
{
    const float off = *x - goal, part = (*speed + rate * off) * seconds;
    const float shrink = noh_exp2(-1.44269504f * rate * seconds);
    *x = goal + (off + part) * shrink;
    *speed = (*speed - rate * part) * shrink;
}

/* Move towards a goal, with an acceleration of at most `most`, braking in time; slower near the goal, by the rate. */
static void drive(float *x, float *speed, float goal, float most, float seconds)
{
    const float time = seconds < 1.0f ? seconds : 1.0f;
    const int pieces = 1 + (int)(time * 240.0f);
    const float h = time / (float)pieces;
    for (int i = 0; i < pieces; i++) {
        const float off = goal - *x, far = off < 0.0f ? -off : off;
        const float brake = noh_sqrt(2.0f * PELVIS_BRAKE * most * far), near = PELVIS_RATE * far;
        const float size = brake < near ? brake : near, wanted = off < 0.0f ? -size : size;
        const float change = wanted - *speed, limit = most * h;
        *speed += change > limit ? limit : change < -limit ? -limit : change;
        *x += *speed * h;
    }
}

static float length2(float x, float z)
{
    return noh_sqrt(x * x + z * z);
}

/* Find the foot's lowest part; when it changes, the foot continues from where it is. */
static void find_part(const step *s, noh_foot *f, const leg_now *n)
{
    uint32_t lowest = f->part;
    float at[3];
    for (uint32_t p = 0; p < 3; p++) {
        const float margin = lowest == f->part ? PART_MARGIN * s->leg : 0.0f;
        if (n->parts[p][1] < n->parts[lowest][1] - margin) lowest = p;
    }
    if (lowest == f->part) return;
    carry(f, n, n->parts[lowest], at);
    f->part = lowest;
    f->moved[0] = at[0] - n->parts[lowest][0];
    f->moved[1] = at[2] - n->parts[lowest][2];
    f->held[0] = at[0];
    f->held[1] = at[2];
}

/* The speed of the lowest part, along the ground. */
static void speed_of(const step *s, const noh_foot *f, const leg_now *n, float speed[2])
{
    speed[0] = s->seconds > 0.0f ? (n->parts[f->part][0] - f->was[f->part][0]) / s->seconds : 0.0f;
    speed[1] = s->seconds > 0.0f ? (n->parts[f->part][2] - f->was[f->part][2]) / s->seconds : 0.0f;
}

static void move_held(noh_foot *f, const leg_now *n)
{
    f->moved[0] = f->held[0] - n->parts[f->part][0];
    f->moved[1] = f->held[1] - n->parts[f->part][2];
}

typedef enum keeping { AS_ITS_CLIP = 0, STANDS_THERE, IS_KEPT, SWINGS } keeping;

/* A foot that the caller's placement keeps still is where its clip has it. */
static void let_go(noh_foot *f)
{
    f->is_held = 0;
    f->moved[0] = f->moved[1] = 0.0f;
}

static void stand(const step *s, noh_foot *f, const leg_now *n, keeping keeps)
{
    float speed[2];
    if (f->is_held) move_held(f, n);
    find_part(s, f, n);
    if (keeps >= IS_KEPT) let_go(f);
    speed_of(s, f, n, speed);
    const float fast = length2(speed[0], speed[1]) / s->leg, lift = (n->parts[f->part][1] - s->floor) / s->leg;
    if (f->is_held) {
        const float drift = length2(f->moved[0], f->moved[1]) / s->leg;
        f->is_held = f->has_ground && lift < LEAVE_LIFT && (fast < LEAVE_SPEED || keeps == STANDS_THERE) &&
                     drift < (keeps == STANDS_THERE ? LEAVE_DRIFT_STANDING : LEAVE_DRIFT);
    } else {
        const float keep = decay(s->seconds, DRIFT_HALF_LIFE);
        f->moved[0] *= keep;
        f->moved[1] *= keep;
        f->is_held = f->has_ground && lift < STAND_LIFT && (fast < STAND_SPEED || keeps == STANDS_THERE) &&
                     keeps != SWINGS;
        f->held[0] = n->parts[f->part][0] + f->moved[0];
        f->held[1] = n->parts[f->part][2] + f->moved[1];
    }
    f->stands += ((float)f->is_held - f->stands) * (1.0f - decay(s->seconds, LAND_HALF_LIFE));
}

static void lean(const step *s, noh_foot *f, const under *u)
{
    const float part = s->cut ? 1.0f : 1.0f - decay(s->seconds, LEAN_HALF_LIFE);
    for (int i = 0; i < 3; i++) f->normal[i] += (u->normal[i] - f->normal[i]) * part;
    noh_normalize3(f->normal, up);
}

/* The highest ground that a foot reaches soon, and the lowest, for the pelvis. */
static float need_ahead(const step *s, const noh_foot *f, leg_now *n, float need)
{
    float speed[2];
    n->soon = need;
    speed_of(s, f, n, speed);
    for (int i = 1; i <= 2 && !f->is_held && s->seconds > 0.0f && !s->cut; i++) {
        const float ahead[2] = { speed[0] * AHEAD * (float)i, speed[1] * AHEAD * (float)i };
        const under u = look_down(s, f, n, ahead, 1);
        need = u.has_ground && u.need > need ? u.need : need;
        n->soon = u.has_ground && u.need < n->soon ? u.need : n->soon;
    }
    return need;
}

/* How far the foot is moved up: to its clip's height above the ground, or planted on it. */
static void raise(const step *s, noh_foot *f, leg_now *n)
{
    static const float here[2] = { 0.0f, 0.0f };
    under u = look_down(s, f, n, here, 1);
    lean(s, f, &u);
    u = look_down(s, f, n, here, ROWS);
    f->has_ground = (uint32_t)u.has_ground;
    const float lift = n->parts[f->part][1] - s->floor, over = lift > 0.0f ? lift : 0.0f;
    const float goal = u.has_ground ? s->floor + need_ahead(s, f, n, u.need) + over : s->floor;
    if (s->cut) {
        f->height = goal;
        f->speed = 0.0f;
    }
    follow(&f->height, &f->speed, goal, HEIGHT_RATE, s->seconds);
    n->shift = f->height - s->floor;
    if (!u.has_ground) {
        n->soon = n->shift;
        return;
    }
    n->shift += (u.need - n->shift) * f->stands;
    n->shift = n->shift > u.need ? n->shift : u.need;
    n->soon = f->is_held || n->soon > n->shift ? n->shift : n->soon;
}

static void begin_foot(const step *s, noh_foot *f, const leg_now *n)
{
    memset(f, 0, sizeof *f);
    f->normal[1] = 1.0f;
    f->height = s->floor;
    for (uint32_t p = 1; p < 3; p++) {
        if (n->parts[p][1] < n->parts[f->part][1]) f->part = p;
    }
}

/* ---- the pelvis ---- */

static void target_of(const noh_foot *f, const leg_now *n, float target[3])
{
    carry(f, n, n->ankle, target);
    target[1] += n->shift;
}

/* The greatest height of the pelvis above the floor of the clip at which a leg reaches its target. */
static float highest(const noh_foot *f, const leg_now *n)
{
    float target[3], upper[3], lower[3];
    target_of(f, n, target);
    noh_sub3(n->knee, n->hip, upper);
    noh_sub3(n->ankle, n->knee, lower);
    const float reach = STRAIGHT * (noh_length3(upper) + noh_length3(lower));
    const float level = length2(target[0] - n->hip[0], target[2] - n->hip[2]);
    const float room = reach * reach - level * level;
    return target[1] + (room > 0.0f ? noh_sqrt(room) : 0.0f) - n->hip[1];
}

/* The pelvis follows the foot that is lowest or soon will be: it is on its way when the foot comes down. A foot in the
 * air does not pull it; only a planted one pulls it down immediately. */
static float move_pelvis(const step *s, noh_feet *feet, const leg_now *now)
{
    float goal = 0.0f;
    uint32_t known = 0;
    for (uint32_t i = 0; i < s->rig->leg_count; i++) {
        if (!feet->feet[i].has_ground) continue;
        goal = !known++ || now[i].soon < goal ? now[i].soon : goal;
    }
    for (uint32_t i = 0; i < s->rig->leg_count; i++) { /* before a leg is straight: then it is pulled immediately */
        const float most = highest(&feet->feet[i], &now[i]) - PELVIS_MARGIN * s->leg;
        if (feet->feet[i].has_ground && feet->feet[i].stands > STANDS && most < goal) goal = most;
    }
    goal += s->floor;
    if (s->cut) {
        feet->pelvis = goal;
        feet->speed = 0.0f;
    }
    const float was = feet->pelvis;
    drive(&feet->pelvis, &feet->speed, goal, PELVIS_ACCELERATION * s->leg, s->seconds);
    const float free = feet->pelvis;
    for (uint32_t i = 0; i < s->rig->leg_count; i++) {
        const float over = feet->pelvis - s->floor - highest(&feet->feet[i], &now[i]);
        if (feet->feet[i].has_ground && feet->feet[i].stands > STANDS && over > 0.0f) feet->pelvis -= over;
    }
    const float pulled = s->seconds > 0.0f && !s->cut ? (feet->pelvis - was) / s->seconds : 0.0f;
    if (feet->pelvis < free) feet->speed = pulled < feet->speed ? pulled : feet->speed;
    return feet->pelvis - s->floor;
}

/* ---- legs ---- */

static void move_top(const step *s, float by)
{
    float *at = s->local[s->rig->top].translation, back[4], way[3];
    noh_quat_conjugate(s->place->rotation, back);
    noh_quat_rotate(back, up, way);
    noh_madd3(at, by / s->place->scale, way, at);
}

/* Direction of the knee: where it is bent; a leg that gets shorter than in its clip may have been straight, and bends
 * as in the model. */
static void find_pole(const step *s, const leg_now *n, const noh_ik_limb *limb, const float target[3], float pole[3])
{
    float along[3], way[3];
    noh_sub3(target, limb->start, way);
    const float now = noh_length3(way);
    noh_sub3(n->ankle, n->hip, along);
    const float shorter = (noh_length3(along) - now) / (0.02f * s->leg);
    noh_normalize3(along, up);
    noh_sub3(n->knee, n->hip, way);
    noh_reject3(way, along, pole);
    if (shorter > 0.0f) noh_madd3(pole, 0.03f * s->leg * (shorter < 1.0f ? shorter : 1.0f), n->modelled, pole);
}

static void bend_leg(const step *s, const noh_foot *f, leg_now *n, float by)
{
    noh_ik_limb limb = { { 0.0f }, { 0.0f }, { 0.0f }, 0.0f, 0.0f, 0.0f };
    noh_ik_bend bend;
    float target[3], leaned[4], pole[3];
    target_of(f, n, target);
    memcpy(limb.start, n->hip, sizeof n->hip);
    memcpy(limb.middle, n->knee, sizeof n->knee);
    memcpy(limb.end, n->ankle, sizeof n->ankle);
    limb.start[1] += by;
    limb.middle[1] += by;
    limb.end[1] += by;
    find_pole(s, n, &limb, target, pole);
    noh_ik_two_bone(&limb, target, pole, 1.0f, &bend);
    turn_joint(s, n->leg->thigh, bend.start);
    turn_joint(s, n->leg->shin, bend.middle);
    noh_quat_between(up, f->normal, side_axis, leaned);
    noh_quat_mul(leaned, n->rotation, leaned);
    set_rotation(s, n->leg->foot, leaned);
}

/* ---- all ---- */

void noh_feet_shift(noh_feet *feet, const float by[3])
{
    NOH_ASSERT(feet && by);
    for (uint32_t l = 0; l < NOH_FEET_LEGS_MAX; l++) {
        noh_foot *f = &feet->feet[l];
        f->height -= by[1];
        for (int k = 0; k < 9; k++) f->was[k / 3][k % 3] -= by[k % 3];
        f->held[0] -= by[0];
        f->held[1] -= by[2];
    }
    feet->pelvis -= by[1];
}

void noh_feet_init(noh_feet *feet)
{
    NOH_ASSERT(feet);
    memset(feet, 0, sizeof *feet);
}

const char *noh_feet_check(const noh_feet *feet)
{
    int good = noh_are_sound(&feet->pelvis, 1) && noh_are_sound(&feet->speed, 1);
    for (uint32_t i = 0; i < NOH_FEET_LEGS_MAX; i++) {
        const noh_foot *f = &feet->feet[i];
        const float square = noh_dot3(f->normal, f->normal);
        good = good && noh_are_sound(f->was[0], 9) && noh_are_sound(&f->height, 1) && noh_are_sound(&f->speed, 1) &&
               noh_are_sound(f->moved, 2) && noh_are_sound(f->held, 2);
        if (f->part > 2u || f->is_held > 1u || f->has_ground > 1u || !(f->stands >= 0.0f && f->stands <= 1.0f)) {
            return "feet: the planted part, its share or a flag is out of range";
        }
        if (!(square == 0.0f || (square > 0.99f && square < 1.01f))) return "feet: a normal is not unit";
    }
    return good && feet->begun <= 1u && feet->kept <= NOH_FEET_LEGS_MAX
               ? NULL
               : "feet: a number is out of range, or a flag is not 0 or 1";
}

static void step_foot(const step *s, noh_foot *f, leg_now *n, keeping keeps)
{
    if (s->cut) {
        begin_foot(s, f, n);
    } else if (s->seconds > 0.0f) {
        stand(s, f, n, keeps);
    }
    raise(s, f, n);
    if (s->cut || s->seconds > 0.0f) memcpy(f->was, n->parts, sizeof f->was);
}

void noh_feet_step(noh_feet *feet, const noh_feet_rig *rig, const noh_skeleton *skeleton, noh_transform *local,
                   const noh_feet_place *place, const noh_ground *ground, float seconds, int cut)
{
    leg_now now[NOH_FEET_LEGS_MAX];
    NOH_ASSERT(feet && rig && skeleton && local && place && ground && place->scale > 0.0f && seconds >= 0.0f);
    NOH_ASSERT(rig->leg_count <= NOH_FEET_LEGS_MAX && rig->last < skeleton->joint_count);
    const step s = { rig,     skeleton,           local, place, ground, rig->length * place->scale, place->position[1],
                     seconds, cut || !feet->begun };
    feet->begun = 1;
    for (uint32_t i = 0; i < rig->leg_count; i++) {
        read_leg(&s, &rig->legs[i], &now[i]);
        const keeping alone = place->stands >> i & 1u ? STANDS_THERE : AS_ITS_CLIP;
        step_foot(&s, &feet->feet[i], &now[i], !feet->kept ? alone : feet->kept == i + 1u ? IS_KEPT : SWINGS);
    }
    const float by = move_pelvis(&s, feet, now);
    move_top(&s, by);
    for (uint32_t i = 0; i < rig->leg_count; i++) bend_leg(&s, &feet->feet[i], &now[i], by);
}
