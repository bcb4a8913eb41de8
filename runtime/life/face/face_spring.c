/* face_spring.c: a critically damped spring in closed form.
 *
 * x(t) = goal + (d + (v + omega d) t) e^(-omega t), with d and v the distance from the goal and the speed at the start:
 * the fastest way to a goal from rest without overshoot. As a function of the time since its start it can be evaluated
 * at any tick, however time is split into steps. */
#include "core/base/trig_internal.h"
#include "noh/face.h"
#include "life/face/face_internal.h"

#define SETTLED 90.0f /* omega t beyond which noh_exp2 gives 0: the value is then exactly the goal */

static float decay(float omega_t)
{
    return noh_exp2(-1.44269504f * omega_t);
}

float noh_face_spring_at(const noh_face_spring *s, uint32_t tick)
{
    const float t = noh_face_seconds(tick - s->start), d = s->from - s->goal;
    return s->goal + (d + (s->speed + s->omega * d) * t) * decay(s->omega * t);
}

static float speed_at(const noh_face_spring *s, uint32_t tick)
{
    const float t = noh_face_seconds(tick - s->start), d = s->from - s->goal;
    return (s->speed - s->omega * (s->speed + s->omega * d) * t) * decay(s->omega * t);
}

void noh_face_spring_to(noh_face_spring *s, uint32_t tick, float goal, float omega)
{
    const float from = noh_face_spring_at(s, tick), speed = speed_at(s, tick);
    s->from = from;
    s->speed = speed;
    s->goal = goal;
    s->omega = omega;
    s->start = tick;
}

/* (1 + omega t) e^(-omega t) is 0.05 at omega t = 4.744. */
float noh_face_omega(uint32_t ticks)
{
    return 4.744f / noh_face_seconds(ticks);
}

/* Ticks are modulo 2^32, a day: restart a spring at rest before its age wraps. Its values do not change. */
void noh_face_spring_settle(noh_face_spring *s, uint32_t tick)
{
    if (noh_face_seconds(tick - s->start) * s->omega > SETTLED) {
        s->from = s->goal;
        s->speed = 0.0f;
        s->start = tick;
    }
}
