/* session_input.c: the inputs of a session, each as a call of the stage. */
#include <math.h>
#include <string.h>

#include "session.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/modules.h"
#include "noh/noh.h"

const session_form session_forms[SESSION_WHATS] = {
    { "spawn", 0, 3 },     { "despawn", 0, 0 }, { "play", 1, 3 },   { "stop", 0, 2 }, { "graph", 1, 2 },
    { "parameter", 1, 1 }, { "float", 1, 2 },   { "look", 0, 3 },   { "feel", 1, 4 }, { "hit", 0, 6 },
    { "rise", 0, 0 },      { "kill", 0, 0 },    { "revive", 0, 0 }, { "view", 0, 3 }, { "ticks", 0, 1 },
};

/* A whole number, as of ticks or layers, from a file; other values are clamped to the nearest. */
static uint32_t whole(float value, float most)
{
    return value >= 0.0f ? (uint32_t)(value < most ? value : most) : 0u;
}

static noh_result spawn(session_stage *s, const session_input *in, noh_error *error)
{
    const noh_appearance posed = { .posed = 1 };
    const noh_place place = { { in->numbers[0], 0.0f, in->numbers[1] }, { 0.0f, in->numbers[2], 0.0f, 1.0f }, 1.0f };
    const noh_result result = noh_stage_spawn(s->stage, 0, &place, &s->actors[in->actor], error);
    return result ? result : noh_actor_set_appearance(s->stage, s->actors[in->actor], &posed, error);
}

static noh_result play(session_stage *s, const session_input *in, noh_error *error)
{
    noh_play play = { .fade_ticks = whole(in->numbers[1], 1e6f) };
    play.speed = (int32_t)(65536.0f * fminf(fmaxf(in->numbers[2], -16.0f), 16.0f));
    return noh_actor_play(s->stage, s->actors[in->actor], whole(in->numbers[0], 255.0f), in->name, &play, error);
}

static noh_result graph(session_stage *s, const session_input *in, noh_error *error)
{
    const noh_play play = { .fade_ticks = whole(in->numbers[1], 1e6f) };
    return noh_actor_play_graph(s->stage, s->actors[in->actor], whole(in->numbers[0], 255.0f), in->name, &play, error);
}

static noh_result feel(session_stage *s, const session_input *in, noh_error *error)
{
    const float *n = in->numbers;
    return noh_actor_set_emotion(s->stage, s->actors[in->actor], in->name, n[0], whole(n[1], 1e7f), whole(n[2], 1e7f),
                                 whole(n[3], 1e7f), error);
}

static noh_result apply(session_stage *s, const session_input *in, noh_error *error)
{
    const noh_actor actor = s->actors[in->actor];
    const float *n = in->numbers;
    switch ((session_what)in->what) {
    case SESSION_SPAWN: return spawn(s, in, error);
    case SESSION_DESPAWN: return noh_stage_despawn(s->stage, actor, error);
    case SESSION_PLAY: return play(s, in, error);
    case SESSION_STOP: return noh_actor_stop(s->stage, actor, whole(n[0], 255.0f), whole(n[1], 1e6f), error);
    case SESSION_GRAPH: return graph(s, in, error);
    case SESSION_PARAMETER:
        return noh_actor_set_parameter(s->stage, actor, noh_stage_find(s->stage, 0, NOH_NAME_PARAMETER, in->name), n[0],
                                       error);
    case SESSION_FLOAT:
        return noh_actor_hold_float(s->stage, actor, noh_stage_find(s->stage, 0, NOH_NAME_FLOAT, in->name), n[0], n[1],
                                    error);
    case SESSION_LOOK: return noh_actor_look_at(s->stage, actor, n, error);
    case SESSION_FEEL: return feel(s, in, error);
    case SESSION_HIT: return noh_actor_hit(s->stage, actor, n, n + 3, error);
    case SESSION_RISE: return noh_actor_get_up(s->stage, actor, NULL, NULL, error);
    case SESSION_KILL: return noh_actor_kill(s->stage, actor, error);
    case SESSION_REVIVE: return noh_actor_revive(s->stage, actor, error);
    case SESSION_VIEW: memcpy(s->view, n, sizeof s->view); return NOH_OK;
    case SESSION_TICKS: s->ticks = whole(n[0], (float)NOH_TICKS_PER_SECOND); return NOH_OK;
    case SESSION_WHATS: break;
    }
    return NOH_ERR_ARG;
}

void session_do(session_stage *s, const session_input *input, uint32_t index)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    const uint32_t result = (uint32_t)apply(s, input, &error);
    s->returned = noh_crc32c(s->returned, &result, sizeof result);
    if (!result) return;
    if (!s->refused++) {
        s->first_refused = index;
        s->refused_error = error;
    }
}
