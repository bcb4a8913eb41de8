/* states.c: a figure stands, walks, hurries and bows, by the parameters of an animation graph in its pack.
 *
 *   states PACK [-o OUT.png]
 *
 * The graph has a number `speed`, in metres a second, and a trigger `bow` (tools/demo_assets/puppet/moves.graph).
 * Prints its steps and what its node `bows` plays; saves the bow. Links EGL. */
#include <string.h>

#include "start.h"
#include "target.h"
#include "noh/noh_gl.h"

static noh_gl gl;

static void on_key(void *user, noh_stage *stage, const noh_stage_event *event)
{
    (void)user, (void)stage;
    if (event->weight > 0.5f) printf("%5.2f s  %s\n", (double)event->clock / NOH_TICKS_PER_SECOND, event->name);
}

/* The figure stands, walks off, hurries, comes to rest and bows. */
static float speed_at(int frame)
{
    return frame < 60 ? 0.0f : frame < 150 ? 0.5f : frame < 240 ? 0.9f : 0.0f;
}

int main(int argc, char **argv)
{
    static noh_pack pack;
    static noh_stage_plan plan;
    const noh_kind_desc kind = {
        .mesh = &pack, .actor_count = 1, .root_axes = NOH_ROOT_GROUND, .graphs = noh_graph_module("*")
    };
    const noh_stage_desc desc = { .kinds = &kind, .kind_count = 1, .height_px = 360, .gpu = &noh_stage_on_gl };
    const char *out = argc == 4 && !strcmp(argv[2], "-o") ? argv[3] : NULL, *graph, *was = "", *is;
    uint32_t speed, bow, bows;
    float now = 0.0f;
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
    graph = noh_stage_name(stage, 0, NOH_NAME_GRAPH, 0); /* names are looked up once */
    speed = noh_stage_find(stage, 0, NOH_NAME_PARAMETER, "speed");
    bow = noh_stage_find(stage, 0, NOH_NAME_PARAMETER, "bow");
    bows = noh_stage_find(stage, 0, NOH_NAME_MACHINE, "bows");
    if (noh_stage_spawn(stage, 0, NULL, &actor, &e) || noh_actor_play_graph(stage, actor, 0, graph, NULL, &e))
        return start_fail(&gl, "actor", &e);
    target_make(&gl.api, 480, 360, 0, &picture);
    for (int i = 0; i < 400; i++) {
        noh_stage_view view;
        now += (speed_at(i) - now) * 0.08f; /* accelerate smoothly */
        if (noh_actor_set_parameter(stage, actor, speed, now, &e) ||
            (i == 300 && noh_actor_set_parameter(stage, actor, bow, 1.0f, &e)))
            return start_fail(&gl, "parameter", &e);
        (void)noh_actor_place(stage, actor, &place, NULL);
        place.position[1] += 0.78f;
        noh_view_orbit(&view, place.position, 0.9f, 0.1f, 3.0f, 480, 360);
        if (noh_stage_frame(stage, NOH_TICKS_PER_SECOND / 60, &view, on_key, NULL, &e))
            return start_fail(&gl, "frame", &e);
        target_clear(&gl.api, &picture); /* after the frame, which draws into the library's textures */
        if (noh_stage_draw(stage, NOH_PASS_COLOR, 0, NULL, &e)) return start_fail(&gl, "draw", &e);
        is = noh_actor_state(stage, actor, bows);
        if (is && strcmp(is, was) != 0) printf("%5.2f s  %s\n", i / 60.0, is);
        was = is ? is : was;
    }
    (void)noh_actor_place(stage, actor, &place, NULL);
    printf("%.2f m from where it began, in %llu bytes and %llu on the GPU\n", (double)place.position[2],
           (unsigned long long)plan.cpu_bytes, (unsigned long long)noh_gl_ledger_bytes(&gl.ledger));
    return out && target_save(&gl.api, &picture, out);
}
