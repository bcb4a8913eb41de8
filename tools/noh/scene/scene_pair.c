/* scene_pair.c: a scene posed by two clips: blended, or in a transition from one to the other. */
#include <string.h>

#include "cli/message.h"
#include "scene.h"

/* A player that has both clips. */
static int find_pair(scene *s, const pack_file *file, const scene_pair *pair, scene_player **player, uint32_t clips[2])
{
    double seconds;
    int status = scene_clip_seconds(s, file, pair->from, &seconds);
    if (!status) status = scene_clip_seconds(s, file, pair->to, &seconds);
    for (uint32_t i = 0; i < s->player_count && !status; i++) {
        scene_player *p = &s->players[i];
        if (p->bank) {
            clips[0] = noh_clip_bank_find(p->bank, pair->from);
            clips[1] = noh_clip_bank_find(p->bank, pair->to);
            if (clips[0] < p->bank->clips.clip_count && clips[1] < p->bank->clips.clip_count) {
                *player = p;
                return 0;
            }
        }
    }
    return status ? status
                  : tool_fail(file->path, "clips '%s' and '%s' move different skeletons", pair->from, pair->to);
}

static int start(scene_player *p, uint32_t track, uint32_t clip, int64_t position_ticks, float weight)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_track_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.clip = clip;
    desc.position_ticks = position_ticks;
    if (noh_controller_start(p->controllers[0], &p->bank->clips, track, &desc, &error)) {
        return tool_fail_error("clip", &error);
    }
    noh_controller_set_weight(p->controllers[0], track, weight); /* 0 in a desc would mean 1 */
    return 0;
}

/* Both clips at the same phase. */
static int pose_blend(scene_player *p, const scene_pair *pair, const uint32_t clips[2], double phase)
{
    const noh_clip_entry *m = p->bank->clips.clips;
    int status = 0;
    for (uint32_t i = 0; i < 2 && !status; i++) {
        status = start(p, i, clips[i], (int64_t)(phase * m[clips[i]].duration_ticks + 0.5),
                       i ? (float)pair->weight : 1.0f - (float)pair->weight);
    }
    return status;
}

static int pose_transition(scene_player *p, const scene_pair *pair, const uint32_t clips[2], double time_s)
{
    const noh_clip_set *set = &p->bank->clips;
    noh_controller *c = p->controllers[0];
    noh_error error = { NOH_OK, "", 0, 0 };
    const uint32_t over = (uint32_t)noh_ticks_from_seconds(pair->over_s);
    const double before_s = time_s < pair->lead_s ? time_s : pair->lead_s;
    int status = start(p, 0, clips[0], 0, 1.0f);
    noh_controller_step(c, set, (uint32_t)noh_ticks_from_seconds(before_s), NULL, NULL);
    if (status || time_s < pair->lead_s) {
        return status;
    }
    if (pair->mix == SCENE_MIX_INERTIA) {
        if (noh_controller_inertia_capture(c, set, &p->scratch, &error)) return tool_fail_error("clip", &error);
        status = start(p, 0, clips[1], 0, 1.0f);
        if (!status && noh_controller_inertia_begin(c, set, &p->scratch, over, &error))
            return tool_fail_error("clip", &error);
    } else {
        status = start(p, 1, clips[1], 0, 0.0f);
        if (!status && noh_controller_cross_fade(c, set, 0, 1, 1.0f, over, NOH_CURVE_SMOOTHSTEP, &error))
            return tool_fail_error("clip", &error);
    }
    noh_controller_step(c, set, (uint32_t)noh_ticks_from_seconds(time_s - pair->lead_s), NULL, NULL);
    return status;
}

int scene_set_pair(scene *s, const pack_file *file, const scene_pair *pair, double time)
{
    scene_player *p = NULL;
    uint32_t clips[2];
    int status = find_pair(s, file, pair, &p, clips);
    if (!status) status = scene_reset_player(p);
    if (!status)
        status = pair->mix == SCENE_MIX_BLEND ? pose_blend(p, pair, clips, time)
                                              : pose_transition(p, pair, clips, time);
    if (!status) scene_pose_player(s, p);
    return status;
}
