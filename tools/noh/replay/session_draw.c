/* session_draw.c: a random session by seed: inputs that a game might give. */
#include <string.h>

#include "session.h"

#define INPUT_CHANCE 6u /* one frame in INPUT_CHANCE has an input */

/* A linear congruential generator, whose high bits are used (Knuth, The Art of Computer Programming 2, 3.3.4). */
static uint32_t draw(uint32_t *state, uint32_t below)
{
    *state = *state * 1664525u + 1013904223u;
    return (uint32_t)((uint64_t)(*state >> 8) * below >> 24);
}

static float between(uint32_t *state, float low, float high)
{
    return low + (high - low) * (float)draw(state, 1000) / 1000.0f;
}

/* A random name of a sort; 0 where the pack has none. */
static int draw_name(const session_stage *stage, noh_name sort, uint32_t *state, char name[NOH_NAME_BYTES_MAX])
{
    uint32_t count = 0;
    while (noh_stage_name(stage->stage, 0, sort, count)) count++;
    if (!count) return 0;
    strncpy(name, noh_stage_name(stage->stage, 0, sort, draw(state, count)), NOH_NAME_BYTES_MAX - 1u);
    return 1;
}

static void draw_numbers(uint32_t *state, float *numbers, uint32_t count, float low, float high)
{
    for (uint32_t i = 0; i < count; i++) numbers[i] = between(state, low, high);
}

/* The arguments of an input; 0: the pack does not support it. */
static int draw_input(const session_stage *stage, uint32_t *state, session_input *in)
{
    static const char *const emotions[] = { "joy", "sadness", "surprise", "fear", "anger", "disgust", "contempt" };
    float *n = in->numbers;
    switch ((session_what)in->what) {
    case SESSION_PLAY:
        n[0] = (float)draw(state, 2);
        n[1] = (float)draw(state, 20000);
        n[2] = between(state, -0.5f, 2.0f);
        return draw_name(stage, NOH_NAME_CLIP, state, in->name);
    case SESSION_STOP: n[0] = (float)draw(state, 3), n[1] = (float)draw(state, 20000); return 1;
    case SESSION_GRAPH: n[1] = (float)draw(state, 20000); return draw_name(stage, NOH_NAME_GRAPH, state, in->name);
    case SESSION_PARAMETER:
        n[0] = between(state, -1.0f, 6.0f);
        return draw_name(stage, NOH_NAME_PARAMETER, state, in->name);
    case SESSION_FLOAT:
        draw_numbers(state, n, 2, 0.0f, 1.0f);
        if (draw(state, 3) == 0) n[1] = 0.0f;
        return draw_name(stage, NOH_NAME_FLOAT, state, in->name);
    case SESSION_LOOK: draw_numbers(state, n, 3, -3.0f, 3.0f); return stage->has_face;
    case SESSION_FEEL:
        n[0] = between(state, 0.0f, 1.0f);
        for (int i = 1; i < 4; i++) n[i] = (float)draw(state, 60000);
        strcpy(in->name, emotions[draw(state, 7)]);
        return stage->has_face;
    case SESSION_HIT:
        draw_numbers(state, n, 3, -1.0f, 1.5f);
        draw_numbers(state, n + 3, 3, -60.0f, 60.0f);
        return stage->has_ragdoll;
    case SESSION_RISE:
    case SESSION_KILL:
    case SESSION_REVIVE: return stage->has_ragdoll;
    case SESSION_VIEW:
        in->actor = 0;
        draw_numbers(state, n, 2, -1.0f, 1.0f);
        n[2] = between(state, 2.0f, 40.0f);
        return 1;
    case SESSION_TICKS: in->actor = 0, n[0] = (float)(400u + draw(state, 1600)); return 1;
    default: return 0;
    }
}

/* All come in at the start, and play the first clips. */
static int enter(session *s, const session_stage *stage, uint32_t *state)
{
    int failed = 0;
    for (uint32_t a = 0; a < s->actor_count && !failed; a++) {
        session_input in = { .what = SESSION_SPAWN, .actor = (uint16_t)a };
        in.numbers[0] = 1.5f * (float)a - 0.75f * (float)(s->actor_count - 1u);
        in.numbers[2] = between(state, -3.0f, 3.0f);
        failed = session_add(s, &in);
        in.what = SESSION_PLAY;
        if (!failed && draw_input(stage, state, &in)) failed = session_add(s, &in);
    }
    return failed;
}

int session_draw(session *s, const session_stage *stage, uint32_t frame_count, uint32_t seed)
{
    uint32_t state = seed;
    int failed;
    s->frame_count = frame_count;
    s->actor_count = stage->actor_count;
    failed = enter(s, stage, &state);
    for (uint32_t f = 1; f < frame_count && !failed; f++) {
        session_input in = { .frame = f };
        if (draw(&state, INPUT_CHANCE)) continue;
        in.actor = (uint16_t)draw(&state, s->actor_count);
        in.what = (uint8_t)(SESSION_PLAY + draw(&state, SESSION_WHATS - SESSION_PLAY));
        if (draw_input(stage, &state, &in)) failed = session_add(s, &in);
    }
    return failed;
}
