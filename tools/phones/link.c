/* link.c: compiles and links the programs of FOLDER that standard input names, and prints what the driver reports of
 * each as KHR_debug messages. It runs on the processor and the drivers of phones (phones.sh).
 *
 *   begin NAME        then the messages
 *   skip NAME WHY     the context lacks a stage
 *   fail NAME LOG     it does not compile or link */
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl32.h>
#include <GLES2/gl2ext.h>
#include <stdio.h>
#include <stdlib.h>

#define TEXT_BYTES (512u << 10)
#define LOG_BYTES 4096

static const char *folder;
static int has_geometry;

static void GL_APIENTRY print_message(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length,
                                      const GLchar *message, const void *user)
{
    (void)source, (void)type, (void)id, (void)severity, (void)length, (void)user;
    printf("%s\n", message);
}

static int open_context(void)
{
    static const EGLint wanted[] = { EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT,
                                     EGL_NONE };
    PFNEGLGETPLATFORMDISPLAYEXTPROC get = (PFNEGLGETPLATFORMDISPLAYEXTPROC)eglGetProcAddress(
        "eglGetPlatformDisplayEXT");
    EGLDisplay display = get ? get(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL) : EGL_NO_DISPLAY;
    EGLContext context = EGL_NO_CONTEXT;
    EGLConfig config;
    EGLint count = 0;
    if (!eglInitialize(display, NULL, NULL) || !eglBindAPI(EGL_OPENGL_ES_API)) return 0;
    if (!eglChooseConfig(display, wanted, &config, 1, &count) || !count) return 0;
    for (EGLint minor = 2; minor >= 0 && context == EGL_NO_CONTEXT; minor--) {
        const EGLint version[] = {
            EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, minor, EGL_CONTEXT_OPENGL_DEBUG, 1, EGL_NONE
        };
        context = eglCreateContext(display, config, EGL_NO_CONTEXT, version);
        has_geometry = minor == 2;
    }
    return eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context);
}

/* NULL: there is no such stage. */
static const char *read_text(const char *name, const char *stage)
{
    static char text[TEXT_BYTES];
    char path[512];
    snprintf(path, sizeof path, "%s/%s.%s", folder, name, stage);
    FILE *in = fopen(path, "rb");
    if (!in) return NULL;
    text[fread(text, 1, sizeof text - 1, in)] = 0;
    fclose(in);
    return text;
}

static void attach(GLuint program, GLenum type, const char *text)
{
    GLuint shader = glCreateShader(type);
    glShaderSource(shader, 1, &text, NULL);
    glCompileShader(shader);
    glAttachShader(program, shader);
    glDeleteShader(shader);
}

/* The last shader's log, or else the program's. */
static void print_log(const char *name, GLuint program)
{
    GLuint shaders[3];
    GLsizei count = 0, written = 0;
    char log[LOG_BYTES] = "";
    glGetAttachedShaders(program, 3, &count, shaders);
    for (GLsizei i = 0; i < count && !written; i++) glGetShaderInfoLog(shaders[i], sizeof log, &written, log);
    if (!written) glGetProgramInfoLog(program, sizeof log, &written, log);
    for (char *c = log; *c; c++) *c = *c == '\n' ? ' ' : *c;
    printf("fail %s %s\n", name, log);
}

static void link_program(const char *name)
{
    static const struct {
        const char *extension;
        GLenum type;
    } stages[] = { { "vert", GL_VERTEX_SHADER }, { "geom", GL_GEOMETRY_SHADER }, { "frag", GL_FRAGMENT_SHADER } };
    GLuint program = glCreateProgram();
    GLint linked = 0;
    if (read_text(name, "geom") && !has_geometry) {
        printf("skip %s no geometry shaders\n", name);
        return;
    }
    printf("begin %s\n", name);
    for (int i = 0; i < 3; i++) {
        const char *text = read_text(name, stages[i].extension);
        if (text) attach(program, stages[i].type, text);
    }
    glLinkProgram(program);
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    if (!linked) print_log(name, program);
    glDeleteProgram(program);
    fflush(stdout);
}

int main(int argc, char **argv)
{
    char name[256];
    if (argc != 2 || !open_context()) {
        fprintf(stderr, argc == 2 ? "link: no context\n" : "usage: link FOLDER <names\n");
        return 1;
    }
    folder = argv[1];
    PFNGLDEBUGMESSAGECALLBACKKHRPROC on = (PFNGLDEBUGMESSAGECALLBACKKHRPROC)eglGetProcAddress(
        "glDebugMessageCallbackKHR");
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    if (on) on(print_message, NULL);
    printf("gpu %s, %s\n", (const char *)glGetString(GL_RENDERER), (const char *)glGetString(GL_VERSION));
    while (scanf("%255s", name) == 1) link_program(name);
    printf("end\n");
    return 0;
}
