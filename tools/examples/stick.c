/* stick.c: a figure goes wherever a stick points, by motion matching.
 *
 *   stick PACK CLIPS [-o OUT]
 *
 * CLIPS is a pack with a table (noh build --match), such as build/demo/roam.noh for the puppet. The stick points ahead,
 * then back, to the left and nowhere, for two seconds each. Prints how fast the figure goes there; saves OUT0.png and
 * so on, half a second after each push. Links EGL. */
#include <string.h>

#include "start.h"
#include "target.h"
#include "noh/low_life.h"
#include "noh/modules.h"
#include "noh/noh_gl.h"

static noh_gl gl;

/* Of a vector along an axis. */
static float length(float x, float z)
{
    return (x < 0.0f ? -x : x) + (z < 0.0f ? -z : z);
}

int main(int argc, char **argv)
{
    static const float pushes[][2] = {
        { 0.0f, 0.9f }, { 0.0f, -0.9f }, { 0.9f, 0.0f }, { 0.0f, 0.0f }
    }; /* x, z: m/s */
    static noh_pack pack, clips;
    static noh_stage_plan plan;
    static noh_kind_feet feet; /* standing feet stay where they are */
    static const noh_plane floor_plane = { { 0.0f, 1.0f, 0.0f }, 0.0f };
    static const noh_world world = { .planes = &floor_plane, .plane_count = 1 };
    noh_modifier on_ground;
    noh_kind_desc kind = { .mesh = &pack, .clips = &clips, .actor_count = 1, .inertia = 1 };
    const noh_stage_desc desc = { .kinds = &kind, .kind_count = 1, .height_px = 360, .gpu = &noh_stage_on_gl };
    const char *out = argc == 5 && !strcmp(argv[3], "-o") ? argv[4] : NULL;
    noh_ragdoll_source source = { .pack = &pack, .metres = 1.0f };
    noh_match_goal goal = { { 0 }, { 0 }, NULL };
    noh_place place, before;
    noh_stage *stage;
    noh_actor actor;
    noh_error e;
    target picture;
    void *memory;

    if (argc < 3 || start_pack(&gl, argv[1], &pack) || start_pack(&gl, argv[2], &clips) || start_gl(&gl)) return 2;
    if (noh_pack_skeleton_at(&pack, 0, &source.joints, NULL, &e) || noh_feet_rig_make(&source, &feet.rig, &e))
        return start_fail(&gl, "feet", &e);
    feet.ground.world = &world;
    on_ground = noh_feet_modifier(&feet);
    kind.modifiers = &on_ground, kind.modifier_count = 1;
    kind.root_axes = NOH_ROOT_GROUND;
    kind.match = noh_match_module(NULL);
    if (noh_stage_plan_make(&desc, &gl.caps, &plan, &e)) return start_fail(&gl, "plan", &e);
    memory = malloc((size_t)plan.cpu_bytes);
    if (!memory || noh_stage_init(memory, (size_t)plan.cpu_bytes, &gl.device, &desc, &plan, &stage, &e))
        return start_fail(&gl, "stage", &e);
    if (noh_stage_spawn(stage, 0, NULL, &actor, &e)) return start_fail(&gl, "actor", &e);
    target_make(&gl.api, 480, 360, 0, &picture);
    for (int i = 0; i < 480; i++) {
        const float *push = pushes[i / 120];
        noh_stage_view view;
        goal.velocity[0] = push[0], goal.velocity[2] = push[1];
        (void)noh_actor_place(stage, actor, &before, NULL);
        if (i % 120 == 0 && noh_actor_match(stage, actor, &goal, &e)) return start_fail(&gl, "match", &e);
        memcpy(&place, &before, sizeof place);
        place.position[1] += 0.78f;
        noh_view_orbit(&view, place.position, 0.9f, 0.1f, 3.0f, 480, 360);
        if (noh_stage_frame(stage, NOH_TICKS_PER_SECOND / 60, &view, NULL, NULL, &e))
            return start_fail(&gl, "frame", &e);
        target_clear(&gl.api, &picture);
        if (noh_stage_draw(stage, NOH_PASS_COLOR, 0, NULL, &e)) return start_fail(&gl, "draw", &e);
        (void)noh_actor_place(stage, actor, &place, NULL);
        if (i % 120 == 119) {
            const float x = (place.position[0] - before.position[0]) * 60.0f, asked = length(push[0], push[1]);
            const float z = (place.position[2] - before.position[2]) * 60.0f;
            printf("%.1f s: asked for %.1f m/s, goes %.1f\n", (i + 1) / 60.0, (double)asked,
                   (double)(asked > 0.0f ? (x * push[0] + z * push[1]) / asked : length(x, z)));
        }
        if (out && i % 120 == 30) {
            char name[1024];
            snprintf(name, sizeof name, "%s%d.png", out, i / 120);
            if (target_save(&gl.api, &picture, name)) return 1;
        }
    }
    printf("%llu bytes and %llu on the GPU\n", (unsigned long long)plan.cpu_bytes,
           (unsigned long long)noh_gl_ledger_bytes(&gl.ledger));
    return 0;
}
