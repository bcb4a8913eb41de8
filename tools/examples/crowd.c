/* crowd.c: a crowd that reacts. Twenty-four figures cross a square. Something bursts in its middle: figures
 * next to it are knocked down, near ones hurry away, far ones stop and turn to it. Then the fallen get up, and all walk
 * on. Prints what the crowd does, and saves a picture before, soon after, and at the end.
 *
 *   crowd FIGURE.noh [-o NAME]
 *
 * The pack has the clips walk, idle and get_up... (build/demo/puppet_falls.noh). Writes NAME0.png to NAME2.png
 * (default: crowd). Links EGL. */
#include <string.h>

#include "start.h"
#include "target.h"
#include "noh/body.h"
#include "noh/crowd.h"
#include "noh/modules.h"
#include "noh/noh_gl.h"

#define WIDTH 1280
#define HEIGHT 720
#define PEOPLE 24u
#define DOLLS 6u /* most that lie at one time */
#define FRAME_TICKS (NOH_TICKS_PER_SECOND / 60u)
#define FALL_M 1.3f
#define FLEE_M 2.4f
enum { BURST = 180, CALM = 480, END = 900 }; /* frames */
enum { BODY, ACTS };                         /* layers */

static noh_gl gl;
static noh_pack pack;
static noh_stage *stage;
static noh_crowd *crowd;
static noh_walkers *walkers;
static target picture;
static const float burst[3] = { 0.2f, 1.0f, 0.0f };

/* A block of its exact size; never freed. */
#define MADE(what, size, init) (!(memory = malloc(bytes = (size))) || (init) ? start_fail(&gl, what, &e) : 0)

static int open_all(void)
{
    static const noh_layer_desc layers[] = { { .name = "body", .mode = NOH_LAYER_BASE, .track_count = 3 },
                                             { .name = "acts", .mode = NOH_LAYER_OVER, .track_count = 2 } };
    static const noh_plane floor = { { 0.0f, 1.0f, 0.0f }, 0.0f };
    static const noh_world world = { .planes = &floor, .plane_count = 1, .friction = 0.6f };
    static const noh_kind_ragdoll dolls = { .count = DOLLS, .world = &world };
    static noh_stage_plan plan; /* the stage keeps it */
    noh_kind_desc kind = { .mesh = &pack, .actor_count = PEOPLE, .layers = layers, .layer_count = 2, .inertia = 1 };
    const noh_stage_desc desc = { .kinds = &kind, .kind_count = 1, .height_px = HEIGHT, .gpu = &noh_stage_on_gl };
    const noh_crowd_desc square = { .agent_max = PEOPLE, .origin = { -16.0f, -16.0f }, .extent = { 32.0f, 32.0f } };
    const noh_walkers_desc feet = { .walker_max = PEOPLE, .layer = BODY, .walk = "walk", .idle = "idle" };
    noh_error e = { NOH_ERR_MEMORY, "malloc", 0, 0 };
    size_t bytes;
    void *memory;
    kind.ragdoll = noh_ragdoll_module(&dolls);
    kind.root_axes = NOH_ROOT_X | NOH_ROOT_Z | NOH_ROOT_BY_GAME;
    if (noh_stage_plan_make(&desc, &gl.caps, &plan, &e)) return start_fail(&gl, "plan", &e);
    return MADE("stage", (size_t)plan.cpu_bytes, noh_stage_init(memory, bytes, &gl.device, &desc, &plan, &stage, &e)) ||
           MADE("crowd", noh_crowd_size(&square), noh_crowd_init(memory, bytes, &square, &crowd, &e)) ||
           MADE("walkers", noh_walkers_size(&feet), noh_walkers_init(memory, bytes, &feet, stage, &walkers, &e));
}

/* They come from two sides, in rows, and walk to the other side. */
static int enter(uint32_t i)
{
    const float side = i % 2u ? 1.0f : -1.0f, heading[2] = { 0.0f, -side };
    const float x = 0.31f * (float)(i - i % 2u) - 3.41f, z = side * (2.6f + 0.35f * (float)(i * 7u % 5u));
    const noh_crowd_agent agent = { { x, z }, { 0.0f, 0.0f }, { x, -4.0f * z }, 0.28f, 0.9f, 0, i };
    const noh_appearance look = { .tint = { 255, (uint8_t)(200u + 11u * (i % 6u)), (uint8_t)(170u + 17u * (i % 5u)),
                                            255 } };
    const noh_place place = { .position = { x, 0.0f, z } };
    noh_actor actor;
    noh_error e;
    return noh_stage_spawn(stage, 0, &place, &actor, &e) || noh_actor_set_appearance(stage, actor, &look, &e) ||
                   noh_crowd_add(crowd, i, &agent, &e) || noh_walkers_add(walkers, i, stage, actor, i, heading, &e)
               ? start_fail(&gl, "walker", &e)
               : 0;
}

/* The crowd is the game's: a reaction is a goal, a speed, or a direction to face. */
static void react(void)
{
    const uint32_t fell = noh_walkers_push(walkers, stage, burst, FALL_M, 110.0f);
    uint32_t near_by = 0;
    for (uint32_t i = 0; i < PEOPLE; i++) {
        noh_crowd_agent a;
        if (!noh_crowd_agent_at(crowd, i, &a)) continue;
        const float away[2] = { a.position[0] - burst[0], a.position[1] - burst[2] }, back[2] = { -away[0], -away[1] };
        if (away[0] * away[0] + away[1] * away[1] < FLEE_M * FLEE_M) {
            const float goal[2] = { a.position[0] + 4.0f * away[0], a.position[1] + 4.0f * away[1] };
            noh_crowd_set_goal(crowd, i, goal);
            noh_crowd_set_speed(crowd, i, 1.8f);
            near_by++;
        } else {
            noh_crowd_set_goal(crowd, i, a.position);
            noh_walkers_face(walkers, i, back);
        }
    }
    printf("%u fall, %u hurry away, %u turn to it\n", fell, near_by - fell, PEOPLE - near_by);
}

static int frame(const noh_stage_view *view)
{
    noh_error e = { NOH_OK, "", 0, 0 };
    (void)noh_walkers_tend(walkers, crowd, stage, ACTS, FRAME_TICKS, &e);
    (void)noh_crowd_step(crowd, FRAME_TICKS);
    return e.result || noh_walkers_step(walkers, crowd, stage, NULL, FRAME_TICKS, &e) ||
                   noh_stage_frame(stage, FRAME_TICKS, view, NULL, NULL, &e)
               ? start_fail(&gl, "frame", &e)
               : 0;
}

static int save(const char *name, int number)
{
    char path[256];
    noh_error e;
    target_clear(&gl.api, &picture);
    if (noh_stage_draw(stage, NOH_PASS_COLOR, 0, NULL, &e)) return start_fail(&gl, "draw", &e);
    snprintf(path, sizeof path, "%s%d.png", name, number);
    return target_save(&gl.api, &picture, path);
}

int main(int argc, char **argv)
{
    const char *name = argc > 3 && !strcmp(argv[2], "-o") ? argv[3] : "crowd";
    const float middle[3] = { 0.0f, 0.6f, 0.0f };
    uint32_t down = 0;
    noh_stage_view view;
    if (argc < 2 || start_pack(&gl, argv[1], &pack) || start_gl(&gl) || open_all()) return 2;
    for (uint32_t i = 0; i < PEOPLE; i++) {
        if (enter(i)) return 2;
    }
    target_make(&gl.api, WIDTH, HEIGHT, 0, &picture);
    noh_view_orbit(&view, middle, 0.5f, 0.4f, 9.5f, WIDTH, HEIGHT);
    for (int f = 0; f < END; f++) {
        if (f == BURST) react();
        for (uint32_t i = 0; f == CALM && i < PEOPLE; i++) {
            const float home[2] = { 0.31f * (float)(i - i % 2u) - 3.41f, i % 2u ? -9.0f : 9.0f };
            noh_crowd_set_goal(crowd, i, home);
            noh_crowd_set_speed(crowd, i, 0.9f);
        }
        if (frame(&view)) return 1;
        if ((f == BURST - 1 && save(name, 0)) || (f == BURST + 70 && save(name, 1))) return 1;
    }
    for (uint32_t i = 0; i < PEOPLE; i++) down += (uint32_t)noh_walkers_is_down(walkers, i);
    printf("%u are down\n", down);
    return save(name, 2);
}
