/* face_gl.c: a face smiles, morphed on the GPU: EGL without a display, a pack, three accumulation layers, one picture.
 *
 *   face_gl PACK [TARGET] [-o OUT.ppm]        default: smile, face_gl.ppm
 *
 * Links EGL. A game provides the context and the blocks of memory. */
#include <stdio.h>
#include <string.h>

#include <EGL/egl.h>

#include "egl_context.h"
#include "noh/low_gl.h"

#define SIZE 512
#define ALIGNED_16 __attribute__((aligned(16))) /* required of every block for noh */

typedef struct face {
    noh_gl_api gl;
    noh_gl_caps caps;
    noh_gl_ledger ledger; /* GPU bytes in use */
    noh_pack pack;
    noh_mesh mesh;
    noh_gl_mesh gl_mesh;
    noh_gl_morph *morph;
    noh_gl_renderer renderer;
    noh_gl_texture pictures[64];
} face;

static unsigned char file[8u << 20] ALIGNED_16, memory[1u << 20] ALIGNED_16, programs[1u << 12] ALIGNED_16;
static unsigned char pixels[SIZE][SIZE][4];
static char shader_log[2048];

static int fail(const char *what, const noh_error *error)
{
    fprintf(stderr, "%s: %s\n%s", what, error->what, shader_log);
    return 1;
}

static void open_target(const noh_gl_api *gl)
{
    static const GLenum formats[2] = { GL_SRGB8_ALPHA8, GL_DEPTH_COMPONENT24 };
    static const GLenum places[2] = { GL_COLOR_ATTACHMENT0, GL_DEPTH_ATTACHMENT };
    static const GLfloat grey[4] = { 0.02f, 0.02f, 0.02f, 1.0f }, far_away = 1.0f;
    GLuint names[2], framebuffer;
    gl->GenRenderbuffers(2, names);
    gl->GenFramebuffers(1, &framebuffer);
    gl->BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    for (int i = 0; i < 2; i++) {
        gl->BindRenderbuffer(GL_RENDERBUFFER, names[i]);
        gl->RenderbufferStorage(GL_RENDERBUFFER, formats[i], SIZE, SIZE);
        gl->FramebufferRenderbuffer(GL_FRAMEBUFFER, places[i], GL_RENDERBUFFER, names[i]);
    }
    gl->Viewport(0, 0, SIZE, SIZE);
    gl->ClearBufferfv(GL_COLOR, 0, grey);
    gl->ClearBufferfv(GL_DEPTH, 0, &far_away);
}

/* View along -z, without perspective, with the mesh's box in the middle of the picture, lit from the upper left. */
static noh_gl_camera look_at(const noh_mesh *mesh)
{
    const float *low = mesh->header->bounds_min, *high = mesh->header->bounds_max;
    const float scale = 1.75f / (high[1] - low[1]);
    noh_gl_camera camera;
    memset(&camera, 0, sizeof camera);
    for (int i = 0; i < 3; i++) {
        camera.view_projection[5 * i] = i == 2 ? -scale : scale;
        camera.view_projection[12 + i] = -0.5f * (low[i] + high[i]) * camera.view_projection[5 * i];
        camera.eye[i] = i == 2 ? high[2] + 1.0f : 0.5f * (low[i] + high[i]);
    }
    camera.view_projection[15] = 1.0f;
    camera.key[0] = -0.4f, camera.key[1] = 0.4f, camera.key[2] = 0.824621f;
    return camera;
}

/* All GL objects of a mesh with morph targets; noh_gl_morph chooses a path. */
static int open_face(face *f)
{
    noh_gl_device device = { &f->gl, &f->caps, &f->ledger, shader_log, sizeof shader_log };
    noh_gl_morph_desc morph;
    noh_gl_renderer_desc draws;
    noh_error error;
    memset(&morph, 0, sizeof morph);
    memset(&draws, 0, sizeof draws);
    morph.meshes = draws.meshes = &f->mesh;
    morph.mesh_count = draws.mesh_count = 1;
    if (noh_gl_mesh_create(&f->gl, &f->ledger, &f->mesh, &f->gl_mesh, &error)) return fail("mesh", &error);
    if (noh_gl_morph_init(memory, sizeof memory, &device, &morph, &f->morph, &error)) return fail("morphs", &error);
    draws.layers_uint = noh_gl_morph_binding_of(f->morph, 0).is_uint;
    if (noh_gl_renderer_create(&device, &draws, programs, sizeof programs, &f->renderer, &error))
        return fail("renderer", &error);
    for (uint32_t i = 0; i < f->pack.runs[NOH_CHUNK_TEXTURE].count && i < 64u; i++) {
        noh_texture texture;
        (void)noh_pack_texture_at(&f->pack, i, &texture, NULL);
        if (noh_gl_picture_create(&f->gl, &f->ledger, &texture, &f->pictures[i], &error))
            return fail("texture", &error);
    }
    return 0;
}

static void draw(face *f)
{
    static const float world[12] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0 };
    const noh_gl_camera camera = look_at(&f->mesh);
    const noh_gl_morph_binding morph = noh_gl_morph_binding_of(f->morph, 0);
    open_target(&f->gl);
    noh_gl_draw_begin(&f->renderer, &camera);
    for (int pass = NOH_DRAW_OPAQUE; pass <= NOH_DRAW_BLENDED; pass++) {
        noh_gl_draw_mesh(&f->renderer, &f->gl_mesh, world, &morph, NULL, NULL, f->pictures, pass);
    }
    noh_gl_draw_end(&f->renderer);
    f->gl.ReadPixels(0, 0, SIZE, SIZE, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
}

static int save(const char *path)
{
    FILE *out = fopen(path, "wb");
    if (!out) return 1;
    fprintf(out, "P6\n%d %d\n255\n", SIZE, SIZE);
    for (int i = 0; i < SIZE * SIZE; i++) fwrite(pixels[SIZE - 1 - i / SIZE][i % SIZE], 3, 1, out);
    return fclose(out) != 0;
}

int main(int argc, char **argv)
{
    static face f;
    static float weights[NOH_TARGETS_MAX];
    const char *target = argc > 2 && argv[2][0] != '-' ? argv[2] : "smile";
    const char *out = argc > 2 && !strcmp(argv[argc - 2], "-o") ? argv[argc - 1] : "face_gl.ppm";
    FILE *in = argc > 1 ? fopen(argv[1], "rb") : NULL;
    const size_t bytes = in ? fread(file, 1, sizeof file, in) : 0;
    noh_error error;
    uint32_t index;
    if (noh_pack_open(file, bytes, &f.pack, &error) || noh_pack_mesh_at(&f.pack, 0, &f.mesh, &error))
        return fail("face_gl PACK", &error);
    index = noh_mesh_find_target(&f.mesh, target);
    if (index == NOH_NONE) return fprintf(stderr, "no target '%s'\n", target), 1;
    if (egl_context_open()) return fprintf(stderr, "cannot create an OpenGL ES 3 context with EGL\n"), 1;
    if (noh_gl_api_load(&f.gl, egl_context_get, NULL, &error) || noh_gl_caps_probe(&f.gl, &f.caps, &error))
        return fail("GL", &error);
    if (open_face(&f)) return 1;
    weights[index] = 1.0f;
    if (noh_gl_morph_set_weights(f.morph, 0, weights, &error)) return fail(target, &error);
    noh_gl_morph_update(f.morph, NULL);
    draw(&f);
    printf("%s: %s (%s); %lu bytes on the GPU\n", f.caps.renderer,
           noh_morph_path_name(noh_gl_morph_plan_of(f.morph)->path), noh_gl_morph_plan_of(f.morph)->reason,
           (unsigned long)noh_gl_ledger_bytes(&f.ledger));
    return save(out);
}
