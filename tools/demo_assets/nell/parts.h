/* What Nell has besides skin: eyes, mouth, lashes, brows, hair and a sweater. */
#ifndef NELL_PARTS_H
#define NELL_PARTS_H

#include "mask/model.h"

enum { ON_LASH = REGION_COUNT, ON_BROW, ON_SCALP, ON_LOCK, ON_CLOTH };
enum { PART_HAIR = PART_WOOD, PART_CLOTH = PART_COUNT, NELL_PARTS };

V3 nell_ball_place(const Seed *seed, const Pose *pose);
V3 nell_ear_place(const Seed *seed);
V3 nell_teeth_place(const Seed *seed, const Pose *pose);
V3 nell_tongue_place(const Seed *seed, const Pose *pose);
V3 nell_bag_place(const Seed *seed, const Pose *pose);

/* Closed strokes: s runs along, 0 to 1; t is the angle around. */
void brows_build(Model *model);
V3 lash_place(const Seed *seed, const Pose *pose);
V3 brow_place(const Seed *seed, const Pose *pose);

void nell_hair_build(Model *model);
V3 scalp_place(const Seed *seed);
V3 lock_place(const Seed *seed);
/* 0 in the valleys between clumps, 1 on their ridges; of a seed on the scalp. */
double nell_hair_arch(const Seed *seed);
/* Distance past the hairline, metres, roughly: negative on bare skin. */
double nell_hair_past(double s, double t);

void sweater_build(Model *model);
V3 sweater_place(const Seed *seed);
/* Of the collar: 1 on its ribs, -1 in the grooves between them, 0 elsewhere. */
double sweater_rib(const Seed *seed);

/* A tube of `rings` rings with `segments` points each, between two end points; its seeds are `seed` with s and t. */
void stroke_build(Model *model, int part, Seed seed, int rings, int segments);

#endif
