/* The parts of the body's cage, each grown from the last one's border. */
#ifndef PUPPET_PARTS_H
#define PUPPET_PARTS_H

#include "cage.h"

enum { TORSO_RING = 16, ARM_RING = 10, LEG_RING = 12 };

/* The open borders of the torso, by side. */
typedef struct {
    int arm[SIDES][ARM_RING]; /* from the top by way of the front */
    int leg[SIDES][LEG_RING]; /* from the front by way of the outside; the last three are the crotch */
    int neck[TORSO_RING];     /* from the front by way of the left */
} Borders;

void torso_build(Cage *cage, Borders *borders);
void head_build(Cage *cage, const int neck[TORSO_RING]);

/* `wrist` receives the border from which the hand grows. */
void sleeve_build(Cage *cage, int side, const int border[ARM_RING], int wrist[ARM_RING]);
void hand_build(Cage *cage, int side, const int wrist[ARM_RING]);

/* `ankle` receives the border from which the foot grows. */
void skirt_build(Cage *cage, int side, const int border[LEG_RING], int ankle[LEG_RING]);
void foot_build(Cage *cage, int side, const int ankle[LEG_RING]);

#endif
