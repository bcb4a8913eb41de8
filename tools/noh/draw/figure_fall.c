/* figure_fall.c: a figure that is pushed, falls and gets up. */
#include <stdio.h>
#include <string.h>

#include "cli/message.h"
#include "figure.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "noh/pack.h"

#define STEP_TICKS (NOH_TICKS_PER_SECOND / 60u)
#define PUSH_STEP 30 /* half a second */

int figure_read_push(const char *text, float impulse[3])
{
    char end;
    const int count = sscanf(text, "%f,%f,%f%c", &impulse[0], &impulse[1], &impulse[2], &end);
    for (int i = 0; i < 3 && count == 3; i++) {
        if (!(impulse[i] >= -1e5f && impulse[i] <= 1e5f))
            return tool_usage("--push must be at most 100000 newton seconds");
    }
    return count == 3 ? 0 : tool_usage("--push must be X,Y,Z in newton seconds, not '%s'", text);
}

int figure_can_fall(const noh_pack *pack, noh_error *why)
{
    static noh_ragdoll_rig rig;
    const noh_kind_desc kind = { .mesh = pack, .skeleton = pack->runs[NOH_CHUNK_SKELETON].count ? 0 : NOH_NONE };
    return noh_kind_can_fall(&kind, &rig, why) == NOH_OK;
}

void figure_want_fall(figure *f)
{
    static const noh_plane floor_plane = { { 0.0f, 1.0f, 0.0f }, 0.0f };
    static const noh_world ground = { .planes = &floor_plane, .plane_count = 1, .friction = 0.6f };
    static const noh_kind_ragdoll ragdoll = { .count = 1, .world = &ground };
    if (!f->desc.falls || f->kinds[0].skeleton == NOH_NONE) return;
    f->kinds[0].ragdoll = noh_ragdoll_module(&ragdoll);
    f->kinds[0].inertia = 1;
}

/* Without get_up clips it stays down. */
static int can_rise(const figure *f)
{
    const char *name;
    for (uint32_t i = 0; (name = noh_stage_name(f->stage, 0, NOH_NAME_CLIP, i)) != NULL; i++) {
        if (strncmp(name, NOH_GET_UP_CLIPS, sizeof NOH_GET_UP_CLIPS - 1u) == 0) return 1;
    }
    return 0;
}

static int step_fall(const figure *f, noh_fall *fall, const float *impulse)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_result result = NOH_OK;
    if (impulse) result = noh_actor_push(f->stage, f->actors[0], NULL, impulse, &error);
    if (!result && can_rise(f)) result = noh_fall_step(fall, f->stage, f->actors[0], 0, STEP_TICKS, &error);
    if (!result) result = noh_stage_frame(f->stage, STEP_TICKS, NULL, NULL, NULL, &error);
    return result ? tool_fail_error(f->desc.file->path, &error) : 0;
}

int figure_fall(figure *f, const float impulse[3], double seconds)
{
    const noh_appearance own = f->look;
    const int steps = (int)(seconds * 60.0 + 0.5);
    noh_fall fall = { 0, 0, 0 };
    noh_appearance posed = own;
    int status;
    posed.posed = 1;
    status = figure_set_look(f, &posed);
    for (int i = 0; i < steps && !status; i++) status = step_fall(f, &fall, i == PUSH_STEP ? impulse : NULL);
    return status ? status : figure_set_look(f, &own);
}
