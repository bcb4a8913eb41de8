#include "clips.h"

#include "mask/targets.h"

#include <math.h>
#include <stddef.h>

const Clip *clip_number(int number)
{
    static const Clip *const clips[CLIP_COUNT] = { &clip_idle, &clip_walk, &clip_bow, &clip_look_round, &clip_dance };
    return clips[number];
}

const Clip *get_up_number(int number)
{
    static const Clip *const clips[GET_UP_COUNT] = { &clip_get_up_back, &clip_get_up_front };
    return clips[number];
}

double glide(const Key *keys, int count, double x)
{
    for (int i = 0; i + 1 < count; i++) {
        if (x < keys[i + 1].x) {
            return mix(keys[i].y, keys[i + 1].y, smooth(keys[i].x, keys[i + 1].x, x));
        }
    }
    return keys[count - 1].y;
}

double pace(double x, double soft)
{
    x = clamp(x, 0, 1);
    double from_end = x < 0.5 ? x : 1 - x, speed = 1 / (1 - soft);
    double way = from_end < soft ? 0.5 * speed * from_end * from_end / soft : speed * (from_end - 0.5 * soft);
    return x < 0.5 ? way : 1 - way;
}

double blink_at(double time_s, double at)
{
    return smooth(at - 0.09, at, time_s) * smooth(at + 0.20, at + 0.04, time_s);
}

void face_add(double *weights, const char *target, double amount)
{
    weights[target_find(target)] += amount;
}

/* A sleeve trails behind the hand: it hangs in the wind of the hand's movement. */
static V3 find_drift(V3 hang, V3 before, V3 after, double step_s)
{
    V3 velocity = v3_scale(v3_sub(after, before), 1 / step_s);
    return v3_unit(v3_add(hang, v3_scale(velocity, -0.22)));
}

Posed clip_frame(const Clip *clip, int frame)
{
    const double late_s = 0.10, span_s = 0.12;
    Stance first = clip->stance(0), last = clip->stance((double)clip->steps / CLIP_RATE_HZ);
    /* The last frame of a loop is the first one, at another position of the root. */
    double time_s = (double)(clip->once ? frame : frame % clip->steps) / CLIP_RATE_HZ;
    Stance stance = clip->stance(time_s);
    Stance before = clip->stance(time_s - late_s - span_s / 2), after = clip->stance(time_s - late_s + span_s / 2);
    V3 wrists[2][SIDES];
    stance_solve(&before, wrists[0]);
    stance_solve(&after, wrists[1]);
    for (int side = 0; side < SIDES; side++) {
        stance.drift[side] = find_drift(stance.hang, wrists[0][side], wrists[1][side], span_s);
    }
    Posed posed = stance_solve(&stance, NULL);
    if (frame == clip->steps && !clip->once) {
        posed.root = v3_add(posed.root, v3_sub(last.root, first.root));
    }
    return posed;
}
