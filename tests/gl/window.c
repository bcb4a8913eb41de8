/* window DRIVER: a window of the driver glfw, or of egl in a window of Xlib's, is cleared, read,
 * shown and asked for its size. glfw.sh runs it under a display.
 * Exit code 0, 1 (and the reason) or 77 (what it needs is missing). */
#include "platforms.h"

#include <stdio.h>
#include <string.h>

#define NOT_HERE 77
#define WIDTH 72u
#define HEIGHT 48u

/* ---- a window of Xlib's, without its headers ---- */

typedef struct xlib {
    void *display;
    unsigned long window;
    void (*resize)(void *display, unsigned long window, unsigned width, unsigned height);
    int (*sync)(void *display, int discard);
} xlib;

static int open_xlib(xlib *x)
{
    void *library = noh_library_open("libX11.so.6", NULL, 0);
    if (!library) return 0;
    void *(*open)(const char *) = (void *(*)(const char *))noh_library_proc(library, "XOpenDisplay");
    unsigned long (*root)(void *) = (unsigned long (*)(void *))noh_library_proc(library, "XDefaultRootWindow");
    unsigned long (*create)(void *, unsigned long, int, int, unsigned, unsigned, unsigned, unsigned long,
                            unsigned long) = (unsigned long (*)(void *, unsigned long, int, int, unsigned, unsigned,
                                                                unsigned, unsigned long,
                                                                unsigned long))noh_library_proc(library,
                                                                                                "XCreateSimpleWindow");
    int (*map)(void *, unsigned long) = (int (*)(void *, unsigned long))noh_library_proc(library, "XMapWindow");
    x->resize = (void (*)(void *, unsigned long, unsigned, unsigned))noh_library_proc(library, "XResizeWindow");
    x->sync = (int (*)(void *, int))noh_library_proc(library, "XSync");
    if (!open || !root || !create || !map || !x->resize || !x->sync) return 0;
    x->display = open(NULL);
    if (!x->display) return 0;
    x->window = create(x->display, root(x->display), 0, 0, WIDTH, HEIGHT, 0, 0, 0);
    map(x->display, x->window);
    x->sync(x->display, 0);
    return 1;
}

/* ---- what every window has to do ---- */

static int fail(const char *what)
{
    fprintf(stderr, "window: %s\n", what);
    return 1;
}

static int size_is(const noh_platform *p, noh_platform_context *c, uint32_t width, uint32_t height)
{
    uint32_t w = 0, h = 0;
    p->size(c, &w, &h);
    if (w != width || h != height) fprintf(stderr, "window: it is %u x %u\n", (unsigned)w, (unsigned)h);
    return w == width && h == height;
}

static int draw_and_show(const noh_platform *p, noh_platform_context *c, const noh_gl_api *gl)
{
    uint8_t pixel[4] = { 0, 0, 0, 0 };
    gl->Viewport(0, 0, (GLsizei)WIDTH, (GLsizei)HEIGHT);
    gl->ClearColor(1.0f, 0.0f, 1.0f, 1.0f);
    gl->Clear(GL_COLOR_BUFFER_BIT);
    gl->ReadPixels((GLint)WIDTH - 1, (GLint)HEIGHT - 1, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
    if (pixel[0] != 255 || pixel[1] != 0 || pixel[2] != 255)
        return fail("the default framebuffer does not hold what was cleared");
    if (p->present(c)) return fail("present fails");
    if (gl->GetError() != GL_NO_ERROR) return fail("a GL error is left");
    return 0;
}

static int check(const noh_platform *p, noh_platform_context *c, xlib *x)
{
    noh_gl_api gl;
    if (noh_gl_api_load(&gl, p->get_proc, c, NULL)) return fail("the function table cannot be filled");
    if (!size_is(p, c, WIDTH, HEIGHT)) return fail("it has not the size that was asked for");
    if (p->make_current(c)) return fail("it cannot be made current");
    int status = draw_and_show(p, c, &gl);
    if (!status && x) {
        x->resize(x->display, x->window, 2 * WIDTH, HEIGHT + 8);
        x->sync(x->display, 0);
        p->present(c);
        gl.Clear(GL_COLOR_BUFFER_BIT);
        if (!size_is(p, c, 2 * WIDTH, HEIGHT + 8)) return fail("it does not notice that it was resized");
        status = draw_and_show(p, c, &gl);
    }
    return status;
}

int main(int argument_count, char **arguments)
{
    const noh_platform *p = argument_count == 2 ? noh_platform_find(arguments[1]) : NULL;
    noh_platform_context *c = NULL;
    noh_platform_desc desc;
    char message[2048];
    xlib x;
    if (!p) return fail("usage: window glfw|egl");
    int wants_native = strcmp(p->name, "egl") == 0;
    memset(&desc, 0, sizeof desc);
    desc.width = WIDTH;
    desc.height = HEIGHT;
    desc.window = "noh";
    if (wants_native) {
        if (!open_xlib(&x)) return NOT_HERE;
        desc.native_display = x.display;
        desc.native_window = (void *)(uintptr_t)x.window;
    }
    if (p->create(&desc, &c, message, sizeof message)) {
        fprintf(stderr, "%s", message);
        return NOT_HERE;
    }
    int status = check(p, c, wants_native ? &x : NULL);
    p->destroy(c);
    return status;
}
