/* figure_fall.c: a figure that is pushed, falls and gets up. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "figure.h"

#define STEP_TICKS (NOH_TICKS_PER_SECOND / 60u)
#define PUSH_STEP 30      /* half a second */
#define WAIT_STEPS 240    /* for one that does not come to rest */
#define STAY_STEPS 12     /* it lies so long */
#define RISES_MAX 16u     /* clips to get up by */
#define PUSH_HEIGHT 0.75f /* of the highest joint */

int figure_read_push(const char *text, float impulse[3])
{
    char end;
    const int count = sscanf(text, "%f,%f,%f%c", &impulse[0], &impulse[1], &impulse[2], &end);
    for (int i = 0; i < 3 && count == 3; i++) {
        if (!(impulse[i] >= -1e5f && impulse[i] <= 1e5f)) return tool_usage("--push: at most 100000 newton seconds");
    }
    return count == 3 ? 0 : tool_usage("--push wants X,Y,Z, newton seconds, not '%s'", text);
}

void figure_want_fall(figure *f)
{
    static const noh_plane floor_plane = { { 0.0f, 1.0f, 0.0f }, 0.0f };
    static const noh_world ground = { .planes = &floor_plane, .plane_count = 1, .friction = 0.6f };
    static const noh_kind_ragdoll ragdoll = { .count = 1, .world = &ground };
    if (!f->desc.falls || f->kinds[0].skeleton == NOH_NONE) return;
    f->kinds[0].ragdoll = &ragdoll;
    f->kinds[0].inertia = 1;
}

static int push(const figure *f, const float impulse[3])
{
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_skeleton skeleton;
    noh_place place;
    float *joints = figure_joints(f, 0, &skeleton), point[3], top = 0.0f;
    if (!joints || noh_actor_place(f->stage, f->actors[0], &place, &error)) {
        free(joints);
        return tool_fail(f->desc.file->path, "nothing of it can fall: it has no skeleton");
    }
    for (uint32_t i = 0; i < skeleton.joint_count; i++) {
        if (joints[12 * i + 7] > top) top = joints[12 * i + 7];
    }
    free(joints);
    memcpy(point, place.position, sizeof point);
    point[1] = PUSH_HEIGHT * top;
    return noh_actor_hit(f->stage, f->actors[0], point, impulse, &error) ? tool_fail_error(f->desc.file->path, &error)
                                                                         : 0;
}

/* By the clips whose names say so, if it has any. */
static int get_up(const figure *f)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    const char *clips[RISES_MAX], *name;
    noh_get_up how = { .clips = clips };
    for (uint32_t i = 0; (name = noh_stage_name(f->stage, 0, NOH_NAME_CLIP, i)) != NULL; i++) {
        if (strncmp(name, "get_up", 6) == 0 && how.clip_count < RISES_MAX) clips[how.clip_count++] = name;
    }
    if (!how.clip_count) return 0;
    return noh_actor_get_up(f->stage, f->actors[0], &how, NULL, &error) ? tool_fail_error(f->desc.file->path, &error)
                                                                        : 0;
}

int figure_fall(figure *f, const float impulse[3], double seconds)
{
    const noh_look own = f->look;
    const int steps = (int)(seconds * 60.0 + 0.5);
    noh_look posed = own;
    int lies = 0, status;
    posed.posed = 1;
    status = figure_set_look(f, &posed);
    for (int i = 0; i < steps && !status; i++) {
        noh_error error = { NOH_OK, "", 0, 0 };
        const noh_body_state body = noh_actor_body(f->stage, f->actors[0]);
        if (i == PUSH_STEP) status = push(f, impulse);
        lies += body == NOH_BODY_LIES;
        if (!status && (lies == STAY_STEPS || (body == NOH_BODY_FALLS && i == PUSH_STEP + WAIT_STEPS))) {
            lies = STAY_STEPS + 1;
            status = get_up(f);
        }
        if (!status && noh_stage_frame(f->stage, STEP_TICKS, NULL, NULL, NULL, &error))
            status = tool_fail_error(f->desc.file->path, &error);
    }
    return status ? status : figure_set_look(f, &own);
}
