/* springs_world.c: finds what the chains of springs touch in a world, before a step. */
#include "core/base/assert_internal.h"
#include "life/physics/contact_internal.h"
#include "life/physics/spring_internal.h"
#include "core/base/vector_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/low_core.h"
#include "noh/low_life.h"
#include "noh/modules.h"
#include "stage/modules/springs_internal.h"

#define STEP_SECONDS ((float)NOH_SPRING_STEP_TICKS / (float)NOH_TICKS_PER_SECOND)

/* From where springs swing to metres: p becomes base + metres * p, from the origin. */
typedef struct space {
    float metres, origin[3], base[3];
} space;

static space space_of(const noh_modifier_work *w, float metres)
{
    space s = { .metres = metres * w->place.scale };
    for (int i = 0; i < 3; i++) {
        const double home = w->home[i] * (double)metres;
        s.origin[i] = (float)home;
        s.base[i] = (float)(home - (double)s.origin[i]);
    }
    return s;
}

/* The steps of a call; one if it takes none, for what is shown between two steps. */
static float steps_of(const noh_spring *s, uint32_t ticks)
{
    const uint64_t steps = ((uint64_t)s->left + ticks) / NOH_SPRING_STEP_TICKS;
    return steps > NOH_SPRING_STEPS_MAX ? (float)NOH_SPRING_STEPS_MAX : steps ? (float)steps : 1.0f;
}

/* At least the way that a rotation from a to b carries a point at distance 1. */
static float swept(const float a[4], const float b[4])
{
    const float cosine = noh_abs(noh_quat_dot(a, b)), rest = 2.0f - 2.0f * cosine;
    return 2.0f * noh_sqrt(rest > 0.0f ? rest : 0.0f);
}

/* Describe a ball at each end whose reach covers all places that the end can get to. The reach is the sum of the way by
 * inertia and pulls, as much again for the correction of the bone's length, and the way of the carrier; it is at most
 * twice the chain's length plus the carrier's way. */
static void describe(const noh_spring_move *move, const space *s, uint32_t ticks, noh_world_body *balls)
{
    const noh_spring *spring = move->spring;
    const float count = steps_of(spring, ticks);
    const float turned = swept(move->carrier->rotation, spring->stepped.rotation) +
                         swept(spring->stepped.rotation, spring->turned);
    float by[3], length = 0.0f;
    noh_sub3(move->carrier->position, spring->stepped.position, by);
    const float carried = noh_length3(by) + noh_length3(spring->moved);
    float reach = carried;
    for (uint32_t i = 0; i < move->desc->joint_count; i++) {
        const noh_spring_joint *j = &move->desc->joints[i];
        const noh_spring_point *p = &noh_spring_const_points(spring)[i];
        noh_world_body *b = &balls[i];
        float at[3];
        noh_sub3(p->now, p->before, by);
        reach += 2.0f * count * (noh_length3(by) + count * STEP_SECONDS * (j->stiffness + noh_length3(j->gravity)));
        length += p->length;
        const float most = carried + 2.0f * length, way = reach + turned * length;
        noh_madd3(spring->stepped.position, 1.0f, p->now, at);
        noh_madd3(s->base, s->metres, at, b->capsule.from);
        memcpy(b->capsule.to, b->capsule.from, sizeof b->capsule.to);
        memcpy(b->origin, s->origin, sizeof b->origin);
        b->capsule.radius = s->metres * j->radius;
        b->reach = s->metres * (way < most ? way : most);
    }
}

/* Planes as springs have them. */
static void take(const noh_spring_move *move, const space *s, noh_touches *touches)
{
    float from[3];
    noh_madd3(s->base, s->metres, move->carrier->position, from);
    for (uint32_t i = 0; i < move->desc->joint_count; i++) {
        for (uint32_t k = 0; k < touches[i].count; k++) {
            noh_plane *p = &touches[i].at[k].plane;
            p->distance = (p->distance - noh_dot3(p->normal, from)) / s->metres;
        }
    }
}

void noh_springs_ask(const noh_modifier_work *w, const noh_springs_world *world, noh_spring_move *moves, uint32_t count)
{
    const space s = space_of(w, world->metres);
    uint32_t asked = 0, first = 0;
    for (uint32_t i = 0; i < count; i++) {
        describe(&moves[i], &s, w->ticks, world->balls + asked);
        moves[i].touches = world->touches + asked;
        asked += moves[i].desc->joint_count;
    }
    noh_touches_find(world->world, world->balls, asked, world->touches);
    for (uint32_t i = 0; i < count; i++) {
        take(&moves[i], &s, world->touches + first);
        first += moves[i].desc->joint_count;
    }
}
