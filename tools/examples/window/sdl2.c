/* sdl2.c: a figure plays a clip, in a window of SDL2: until the window is closed, or for FRAMES frames.
 *
 *   cc sdl2.c $(pkg-config --cflags --libs noh sdl2) -o walk && ./walk PACK [CLIP [FRAMES]] */
#include <SDL.h>
#include <noh/noh_gl.h>

static noh_gl gl;
static noh_pack pack;
static noh_stage_plan plan;
static noh_error e;

static noh_gl_proc get_proc(void *user, const char *name)
{
    (void)user;
    return (noh_gl_proc)SDL_GL_GetProcAddress(name);
}

static int fail(const char *what)
{
    SDL_Log("%s: %s (need %lu) %s", what, e.what ? e.what : SDL_GetError(), (unsigned long)e.need, gl.log);
    return 1;
}

int main(int argc, char **argv)
{
    const char *clip = argc > 2 ? argv[2] : "walk";
    const noh_kind_desc kind = { .mesh = &pack, .actor_count = 1, .root_axes = NOH_ROOT_GROUND };
    const noh_stage_desc desc = { .kinds = &kind, .kind_count = 1, .encode_srgb = 1, .gpu = &noh_stage_on_gl };
    const float grey[4] = { 0.16f, 0.17f, 0.2f, 1.0f }, far = 1.0f;
    size_t bytes = 0;
    void *file = argc > 1 ? SDL_LoadFile(argv[1], &bytes) : NULL;
    SDL_Window *window;
    noh_stage *stage;
    noh_stage_view view;
    noh_actor actor;
    float sphere[4];
    if (!file || noh_pack_open(file, bytes, &pack, &e)) return fail("walk PACK [CLIP [FRAMES]]");
    if (SDL_Init(SDL_INIT_VIDEO)) return fail("SDL");
    SDL_GL_SetAttribute(SDL_GL_CONTEXT_PROFILE_MASK, SDL_GL_CONTEXT_PROFILE_ES);
    SDL_GL_SetAttribute(SDL_GL_CONTEXT_MAJOR_VERSION, 3);
    window = SDL_CreateWindow("noh", 0, 0, 960, 720, SDL_WINDOW_OPENGL);
    if (!window || !SDL_GL_CreateContext(window) || noh_gl_open(&gl, get_proc, NULL, &e)) return fail("GL");
    if (noh_stage_plan_make(&desc, &gl.caps, &plan, &e) ||
        noh_stage_init(SDL_malloc(plan.cpu_bytes), plan.cpu_bytes, &gl.device, &desc, &plan, &stage, &e) ||
        noh_stage_spawn(stage, 0, NULL, &actor, &e) || noh_actor_play(stage, actor, 0, clip, NULL, &e))
        return fail("stage");
    for (int i = 0; !SDL_QuitRequested() && i < (argc > 3 ? SDL_atoi(argv[3]) : i + 1); i++) {
        (void)noh_actor_sphere(stage, actor, sphere, NULL); /* the camera follows a figure of any size */
        noh_view_orbit(&view, sphere, 0.6f, 0.1f, 2.6f * sphere[3], 960, 720);
        if (noh_stage_frame(stage, NOH_TICKS_PER_SECOND / 60, &view, NULL, NULL, &e)) return fail("frame");
        gl.api.Viewport(0, 0, 960, 720);
        gl.api.ClearBufferfv(0x1800 /* GL_COLOR */, 0, grey);
        gl.api.ClearBufferfv(0x1801 /* GL_DEPTH */, 0, &far);
        if (noh_stage_draw(stage, NOH_PASS_COLOR, 0, NULL, &e)) return fail("draw");
        SDL_GL_SwapWindow(window);
    }
    return 0;
}
