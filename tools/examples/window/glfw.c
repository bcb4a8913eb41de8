/* glfw.c: a figure plays a clip, in a window of GLFW: until the window is closed, or for FRAMES frames.
 *
 *   cc glfw.c $(pkg-config --cflags --libs noh glfw3) -o walk && ./walk PACK [CLIP [FRAMES]] */
#include <stdio.h>
#include <stdlib.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <noh/noh_gl.h>

static noh_gl gl;
static noh_pack pack;
static noh_stage_plan plan;
static noh_error e;

static noh_gl_proc get_proc(void *user, const char *name)
{
    (void)user;
    return glfwGetProcAddress(name);
}

static int fail(const char *what)
{
    const char *why = e.what;
    if (!why) (void)glfwGetError(&why);
    return fprintf(stderr, "%s: %s (need %lu) %s\n", what, why ? why : "", (unsigned long)e.need, gl.log), 1;
}

int main(int argc, char **argv)
{
    const char *clip = argc > 2 ? argv[2] : "walk";
    const noh_kind_desc kind = { .mesh = &pack, .actor_count = 1, .root_axes = NOH_ROOT_GROUND };
    const noh_stage_desc desc = { .kinds = &kind, .kind_count = 1, .encode_srgb = 1, .gpu = &noh_stage_on_gl };
    float grey[4] = { 0.16f, 0.17f, 0.2f, 1.0f }, far = 1.0f, sphere[4];
    FILE *in = argc > 1 ? fopen(argv[1], "rb") : NULL;
    void *file = malloc(64 << 20);
    noh_stage *stage;
    noh_stage_view view;
    noh_actor actor;
    if (!in || noh_pack_open(file, fread(file, 1, 64 << 20, in), &pack, &e)) return fail("walk PACK [CLIP [FRAMES]]");
    if (!glfwInit()) return fail("GLFW");
    glfwWindowHint(GLFW_CLIENT_API, GLFW_OPENGL_ES_API);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    GLFWwindow *window = glfwCreateWindow(960, 720, "noh", NULL, NULL);
    glfwMakeContextCurrent(window);
    if (!window || noh_gl_open(&gl, get_proc, NULL, &e)) return fail("GL");
    if (noh_stage_plan_make(&desc, &gl.caps, &plan, &e) ||
        noh_stage_init(malloc(plan.cpu_bytes), plan.cpu_bytes, &gl.device, &desc, &plan, &stage, &e) ||
        noh_stage_spawn(stage, 0, NULL, &actor, &e) || noh_actor_play(stage, actor, 0, clip, NULL, &e))
        return fail("stage");
    for (int i = 0; !glfwWindowShouldClose(window) && i < (argc > 3 ? atoi(argv[3]) : i + 1); i++, glfwPollEvents()) {
        (void)noh_actor_sphere(stage, actor, sphere, NULL); /* the camera follows a figure of any size */
        noh_view_orbit(&view, sphere, 0.6f, 0.1f, 2.6f * sphere[3], 960, 720);
        if (noh_stage_frame(stage, NOH_TICKS_PER_SECOND / 60, &view, NULL, NULL, &e)) return fail("frame");
        gl.api.Viewport(0, 0, 960, 720);
        gl.api.ClearBufferfv(0x1800 /* GL_COLOR */, 0, grey);
        gl.api.ClearBufferfv(0x1801 /* GL_DEPTH */, 0, &far);
        if (noh_stage_draw(stage, NOH_PASS_COLOR, 0, NULL, &e)) return fail("draw");
        glfwSwapBuffers(window);
    }
}
