/* game_physics.h: the physics of a game that knows the same shapes as a noh_world: planes for bodies, all shapes for
 * rays. It counts what it is asked, and hashes it in order; with `threads` set it does neither. */
#ifndef TESTS_GAME_PHYSICS_H
#define TESTS_GAME_PHYSICS_H

#include "noh/body.h"

#include <stdint.h>

typedef struct game_physics {
    noh_world_physics table;
    const noh_world *shapes;
    uint32_t rays, touches, batches; /* asked so far */
    uint32_t hash;                   /* of all bodies asked about, in order */
    int spoils;                      /* 1: adds answers that must not count */
} game_physics;

/* The world then has no shapes of its own: it asks for them. */
noh_world game_world(game_physics *game, const noh_world *shapes);

#endif
