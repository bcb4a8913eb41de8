#include "stance.h"

#include <math.h>

/* In the scene: where each joint lies and how it is turned. */
typedef struct {
    V3 place[JOINT_COUNT];
    Quat turn[JOINT_COUNT];
} World;

Stance stance_calm(void)
{
    Stance stance = { .hips = { 0, -0.024, -0.012 },
                      .hips_turn = { 0.06, 0, 0 },
                      .waist = { 0.05, 0, 0 },
                      .head = { -0.09, 0, 0 },
                      .hang = { 0, -1, 0 } };
    HandStance hand = { .wrist = { 0.255, -0.215, 0.195 },
                        .elbow = { 0.85, -0.15, -0.50 },
                        .roll = 0.15,
                        .bend = 0.12,
                        .curl = 0.38,
                        .thumb = 0.60 };
    for (int side = 0; side < SIDES; side++) {
        FootStance foot = { .place = { side_sign(side) * 0.098, 0, -0.012 }, .heading = side_sign(side) * 0.10 };
        stance.feet[side] = foot;
        stance.hands[side] = hand;
        stance.drift[side] = v3(0, -1, 0);
    }
    return stance;
}

static V3 bind_bone(int from, int to)
{
    return v3_sub(joint_place(to), joint_place(from));
}

/* Places a joint at the end of its parent's bone. */
static void hang(World *world, int joint, Quat turn)
{
    int parent = joint_parent(joint);
    V3 bone = quat_rotate(world->turn[parent], bind_bone(parent, joint));
    world->place[joint] = v3_add(world->place[parent], bone);
    world->turn[joint] = turn;
}

static void hang_turned(World *world, int joint, Quat local)
{
    hang(world, joint, quat_multiply(world->turn[joint_parent(joint)], local));
}

/* A vector of the left side, seen in a mirror for the right; a turn's axis looks the other way
 * there, as its sense is reversed too. */
static V3 mirrored(V3 v, int side)
{
    v.x *= side_sign(side);
    return v;
}

static V3 mirrored_axis(V3 axis, int side)
{
    return v3(axis.x, axis.y * side_sign(side), axis.z * side_sign(side));
}

/* --- two bones --- */

typedef struct {
    int upper, lower, end;
    V3 bend; /* where the middle joint points in the bind pose */
} Limb;

/* Turn the upper and the lower bone so that the end lies at `target`, or as near as it can, and the middle joint points
 * to `bend`. */
static void reach(World *world, const Limb *limb, V3 target, V3 bend)
{
    V3 bone1 = bind_bone(limb->upper, limb->lower), bone2 = bind_bone(limb->lower, limb->end);
    double length1 = v3_length(bone1), length2 = v3_length(bone2), whole = length1 + length2;
    V3 way = v3_sub(target, world->place[limb->upper]);
    double distance = clamp(v3_length(way), 0.3 * whole, 0.9995 * whole);
    way = v3_unit(way);
    V3 side = v3_unit(v3_sub(bend, v3_scale(way, v3_dot(bend, way))));
    double along = (length1 * length1 - length2 * length2 + distance * distance) / (2 * distance);
    double out = sqrt(fmax(length1 * length1 - along * along, 0));
    V3 posed1 = v3_add(v3_scale(way, along), v3_scale(side, out));
    V3 posed2 = v3_sub(v3_scale(way, distance), posed1);
    world->turn[limb->upper] = quat_align(v3_unit(bone1), limb->bend, v3_unit(posed1), side);
    hang(world, limb->lower, quat_align(v3_unit(bone2), limb->bend, v3_unit(posed2), side));
}

/* --- parts --- */

static void pose_trunk(World *world, const Stance *s)
{
    world->place[ROOT] = s->root;
    world->turn[ROOT] = quat_about(v3(0, 1, 0), s->heading);
    hang_turned(world, HIPS, quat_turn(s->hips_turn));
    world->place[HIPS] = v3_add(world->place[HIPS], quat_rotate(world->turn[ROOT], s->hips));
    hang_turned(world, SPINE, quat_turn(v3_scale(s->waist, 0.45)));
    hang_turned(world, CHEST, quat_turn(v3_scale(s->waist, 0.55)));
    hang_turned(world, NECK, quat_turn(v3_scale(s->head, 0.40)));
    hang_turned(world, HEAD, quat_turn(v3_scale(s->head, 0.60)));
    hang_turned(world, JAW, quat_about(v3(1, 0, 0), s->jaw));
}

static void pose_leg(World *world, const FootStance *foot, int side)
{
    Limb leg = { side_joint(side, THIGH), side_joint(side, SHIN), side_joint(side, FOOT), { 0, 0, 1 } };
    Quat heading = quat_about(v3(0, 1, 0), foot->heading);
    Quat turn = quat_multiply(heading, quat_about(v3(1, 0, 0), -foot->pitch));
    V3 ankle = joint_place(leg.end), toes = joint_place(side_joint(side, TOES));
    /* A raised heel turns about the ball of the foot, raised toes about the heel. */
    V3 pivot = foot->pitch < 0 ? toes : v3(ankle.x, 0, ankle.z - 0.035);
    V3 lifted = v3_add(v3_sub(pivot, v3(ankle.x, 0, ankle.z)),
                       quat_rotate(quat_about(v3(1, 0, 0), -foot->pitch), v3_sub(ankle, pivot)));
    V3 target = v3_add(foot->place, quat_rotate(heading, lifted));
    V3 ahead = quat_rotate(heading, v3(0.10 * side_sign(side), sin(foot->knee), cos(foot->knee)));
    hang_turned(world, leg.upper, quat_none());
    reach(world, &leg, target, ahead);
    hang(world, leg.end, turn);
    hang(world, side_joint(side, TOES), foot->pitch < 0 ? heading : turn);
    hang_turned(world, side_joint(side, SKIRT), quat_none());
}

static void pose_fingers(World *world, const HandStance *hand, int side)
{
    static const int fingers[4] = { INDEX, MIDDLE, RING, LITTLE };
    V3 along = v3_unit(bind_bone(side_joint(LEFT, FOREARM), side_joint(LEFT, HAND)));
    V3 across = mirrored_axis(v3(0, 0, 1), side), thick = mirrored_axis(v3_cross(v3(0, 0, 1), along), side);
    for (int i = 0; i < 4; i++) {
        double curl = hand->curl * (1 + 0.10 * i);
        hang_turned(world, side_joint(side, fingers[i]), quat_about(across, -1.35 * curl));
        hang_turned(world, side_joint(side, fingers[i] + 1), quat_about(across, -1.75 * curl));
    }
    Quat under = quat_about(mirrored_axis(along, side), 0.5 * hand->thumb);
    hang_turned(world, side_joint(side, THUMB), quat_multiply(under, quat_about(thick, 0.6 * hand->thumb)));
    hang_turned(world, side_joint(side, THUMB_TIP), quat_about(thick, 0.5 * hand->thumb));
}

/* The bag of the sleeve turns with the forearm, then back towards where it would hang. It keeps away from the hand;
 * where the forearm itself hangs down it follows the forearm, because cloth twists little. */
static void pose_sleeve(World *world, V3 drift, int side)
{
    const double along_max = 0.64, turn_max = 1.15;
    int forearm = side_joint(side, FOREARM);
    Quat arm = world->turn[forearm];
    V3 along = v3_unit(quat_rotate(arm, bind_bone(forearm, side_joint(side, HAND))));
    V3 bag = quat_rotate(arm, v3(0, -1, 0));
    double ahead = v3_dot(drift, along);
    if (ahead > along_max) {
        V3 across = v3_add(v3_sub(drift, v3_scale(along, ahead)), v3_scale(bag, 3 * (ahead - along_max)));
        across = v3_unit(v3_sub(across, v3_scale(along, v3_dot(across, along))));
        drift = v3_add(v3_scale(along, along_max), v3_scale(across, sqrt(1 - along_max * along_max)));
    }
    hang(world, side_joint(side, SLEEVE), quat_multiply(quat_between(bag, drift, turn_max), arm));
}

static void pose_arm(World *world, const Stance *s, int side)
{
    Limb arm = { side_joint(side, UPPER_ARM), side_joint(side, FOREARM), side_joint(side, HAND), { 0, 0, -1 } };
    const HandStance *hand = &s->hands[side];
    Quat chest = world->turn[CHEST];
    V3 target = v3_add(world->place[CHEST], quat_rotate(chest, mirrored(hand->wrist, side)));
    /* The collar bone takes a share of the arm's raising and turning. */
    V3 rest = v3_unit(bind_bone(arm.upper, arm.end));
    V3 way = v3_sub(mirrored(hand->wrist, side), v3_sub(joint_place(arm.upper), joint_place(CHEST)));
    V3 share = v3_unit(v3_add(v3_scale(rest, 2), v3_unit(way)));
    hang_turned(world, side_joint(side, SHOULDER), quat_between(rest, share, 0.5));
    hang_turned(world, arm.upper, quat_none());
    reach(world, &arm, target, quat_rotate(chest, mirrored(hand->elbow, side)));
    V3 along = v3_unit(bind_bone(arm.lower, arm.end));
    Quat roll = quat_about(along, side_sign(side) * hand->roll);
    Quat bend = quat_about(mirrored_axis(v3(0, 0, 1), side), -hand->bend);
    hang_turned(world, arm.end, quat_multiply(roll, bend));
    pose_fingers(world, hand, side);
    pose_sleeve(world, s->drift[side], side);
}

Posed stance_solve(const Stance *stance, V3 wrists[SIDES])
{
    World world;
    Posed posed;
    pose_trunk(&world, stance);
    for (int side = 0; side < SIDES; side++) {
        pose_leg(&world, &stance->feet[side], side);
        pose_arm(&world, stance, side);
        if (wrists) {
            wrists[side] = world.place[side_joint(side, HAND)];
        }
    }
    for (int joint = 0; joint < JOINT_COUNT; joint++) {
        int parent = joint_parent(joint);
        posed.turn[joint] = parent < 0 ? world.turn[joint]
                                       : quat_multiply(quat_inverse(world.turn[parent]), world.turn[joint]);
    }
    posed.root = stance->root;
    posed.hips = v3_add(joint_place(HIPS), stance->hips);
    return posed;
}
