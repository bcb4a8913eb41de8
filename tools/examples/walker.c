/* walker.c: a figure walks and speaks, followed by a camera. Prints its footsteps, saves the last frame.
 *
 *   walker PACK [-o OUT.png]
 *
 * Links EGL. */
#include <string.h>

#include "start.h"
#include "target.h"
#include "noh/noh_gl.h"

static noh_gl gl;

static void on_key(void *user, noh_stage *stage, const noh_stage_event *event)
{
    (void)user, (void)stage;
    printf("%5.2f s  %s\n", (double)event->clock / NOH_TICKS_PER_SECOND, event->name);
}

int main(int argc, char **argv)
{
    static noh_pack pack;
    static noh_stage_plan plan;
    const noh_kind_desc kind = { .mesh = &pack, .actor_count = 1, .root_axes = NOH_ROOT_GROUND };
    const noh_stage_desc desc = { .kinds = &kind, .kind_count = 1, .height_px = 720, .gpu = &noh_stage_on_gl };
    const char *out = argc == 4 && !strcmp(argv[2], "-o") ? argv[3] : NULL;
    noh_stage *stage;
    noh_actor actor;
    noh_place place;
    noh_error e;
    target picture;
    void *memory;

    if (argc < 2 || start_pack(&gl, argv[1], &pack) || start_gl(&gl)) return 2;
    if (noh_stage_plan_make(&desc, &gl.caps, &plan, &e)) return start_fail(&gl, "plan", &e);
    memory = malloc((size_t)plan.cpu_bytes);
    if (!memory || noh_stage_init(memory, (size_t)plan.cpu_bytes, &gl.device, &desc, &plan, &stage, &e))
        return start_fail(&gl, "stage", &e);
    if (noh_stage_spawn(stage, 0, NULL, &actor, &e) || noh_actor_play(stage, actor, 0, "walk", NULL, &e))
        return start_fail(&gl, "actor", &e);
    (void)noh_actor_play(stage, actor, 1, "speak", NULL, NULL); /* if the pack has this clip */
    target_make(&gl.api, 960, 720, 0, &picture);
    for (int i = 0; i < 120; i++) {
        noh_stage_view view;
        (void)noh_actor_place(stage, actor, &place, NULL);
        place.position[1] += 0.78f;
        noh_view_orbit(&view, place.position, 0.6f, 0.1f, 3.0f, 960, 720);
        if (noh_stage_frame(stage, NOH_TICKS_PER_SECOND / 60, &view, on_key, NULL, &e))
            return start_fail(&gl, "frame", &e);
        target_clear(&gl.api, &picture); /* after the frame, which draws into the library's textures */
        if (noh_stage_draw(stage, NOH_PASS_COLOR, 0, NULL, &e)) return start_fail(&gl, "draw", &e);
    }
    (void)noh_actor_place(stage, actor, &place, NULL);
    printf("%.2f m from where it began, in %llu bytes and %llu on the GPU\n", (double)place.position[2],
           (unsigned long long)plan.cpu_bytes, (unsigned long long)noh_gl_ledger_bytes(&gl.ledger));
    return out && target_save(&gl.api, &picture, out);
}
