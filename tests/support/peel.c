#include "peel.h"

#include "gpu/canvas.h"
#include "renderer.h"
#include "srgb.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* mesh.frag with another main behind its own. What is clear altogether is no layer. The materials are opaque here, and
 * keep their alpha all the same. */
static const char before[] = "#define main mesh_main\n"
                             "#define noh_cut(alpha) (alpha)\n";
static const char behind[] = "\n#undef main\n"
                             "uniform highp sampler2D u_opaque;\n"
                             "uniform highp sampler2D u_peeled;\n"
                             "void main()\n{\n"
                             " ivec2 at = ivec2(gl_FragCoord.xy);\n"
                             " mesh_main();\n"
                             " if (o_color.a < 0.5 / 255.0 || gl_FragCoord.z > texelFetch(u_opaque, at, 0).r ||\n"
                             "  gl_FragCoord.z <= texelFetch(u_peeled, at, 0).r) discard;\n"
                             "}\n";

/* And what blends keeps the alpha that it is blended with. */
static void bind_depths(void *user, const noh_gl_api *gl, GLuint program, const noh_material *material)
{
    const peel *p = user;
    const float strands = material->base_color_texture == NOH_NONE ? 0.0f : -1.0f;
    gl->Uniform4f(gl->GetUniformLocation(program, "noh_material"), material->roughness, material->metallic, -1.0f,
                  material->flags & NOH_MATERIAL_UNLIT ? 1.0f : strands);
    gl->ActiveTexture(GL_TEXTURE0 + NOH_UNIT_USER);
    gl->BindTexture(GL_TEXTURE_2D, p->depth[0]);
    gl->ActiveTexture(GL_TEXTURE0 + NOH_UNIT_USER + 1u);
    gl->BindTexture(GL_TEXTURE_2D, p->behind);
}

/* ---- opening ---- */

static GLuint texture(const peel *p, GLenum format)
{
    const noh_gl_api *gl = &p->g->gl;
    GLuint name = 0;
    gl->GenTextures(1, &name);
    gl->BindTexture(GL_TEXTURE_2D, name);
    gl->TexStorage2D(GL_TEXTURE_2D, 1, format, (GLsizei)p->side, (GLsizei)p->side);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl->BindTexture(GL_TEXTURE_2D, 0);
    return name;
}

static void open_target(peel *p)
{
    const noh_gl_api *gl = &p->g->gl;
    p->color = texture(p, GL_SRGB8_ALPHA8);
    for (int i = 0; i < 3; i++) p->depth[i] = texture(p, GL_DEPTH_COMPONENT32F);
    gl->GenFramebuffers(1, &p->framebuffer);
    gl->BindFramebuffer(GL_FRAMEBUFFER, p->framebuffer);
    gl->FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, p->color, 0);
    gl->FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, p->depth[0], 0);
    assert_int_equal(gl->CheckFramebufferStatus(GL_FRAMEBUFFER), GL_FRAMEBUFFER_COMPLETE);
}

void peel_open(peel *p, gpu *g, const noh_mesh *mesh, uint32_t side)
{
    static const char *const samplers[] = { "u_opaque", "u_peeled" };
    char *text = test_shader_body("shaders_es/mesh.frag"), log[4096] = "";
    noh_gl_renderer_desc desc;
    memset(p, 0, sizeof *p);
    memset(&desc, 0, sizeof desc);
    p->g = g;
    p->side = side;
    p->mesh = *mesh;
    p->pack = *mesh->pack;
    p->mesh.pack = &p->pack;
    p->materials = test_zeros(p->pack.material_count * sizeof *p->materials);
    for (uint32_t i = 0; i < p->pack.material_count; i++) {
        p->materials[i] = mesh->pack->materials[i];
        p->materials[i].flags &= ~NOH_MATERIAL_BLEND;
    }
    p->pack.materials = p->materials;
    p->fragment = test_zeros(strlen(text) + sizeof before + sizeof behind);
    strcpy(p->fragment, before);
    strcat(p->fragment, text);
    strcat(p->fragment, behind);
    free(text);
    const noh_gl_shader_desc own = { .name = "peel",
                                     .fragment = p->fragment,
                                     .samplers = samplers,
                                     .sampler_count = 2,
                                     .bind = bind_depths,
                                     .user = p };
    const noh_gl_device device = { &g->gl, &g->caps, &p->ledger, log, sizeof log };
    desc.meshes = &p->mesh;
    desc.mesh_count = 1;
    desc.shaders = &own;
    if (renderer_create(&device, &desc, &p->renderer, NULL)) fail_msg("%s", log);
    open_target(p);
}

void peel_close(peel *p)
{
    const noh_gl_api *gl = &p->g->gl;
    gl->BindFramebuffer(GL_FRAMEBUFFER, 0);
    gl->DeleteFramebuffers(1, &p->framebuffer);
    gl->DeleteTextures(1, &p->color);
    gl->DeleteTextures(3, p->depth);
    noh_gl_renderer_delete(&p->renderer);
    assert_int_equal(noh_gl_ledger_bytes(&p->ledger), 0);
    free(p->fragment);
    free(p->materials);
}

/* ---- drawing ---- */

static void begin(const peel *p, GLuint depth, const float color[4])
{
    static const float far = 1.0f;
    const noh_gl_api *gl = &p->g->gl;
    gl->BindFramebuffer(GL_FRAMEBUFFER, p->framebuffer);
    gl->FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth, 0);
    gl->Viewport(0, 0, (GLsizei)p->side, (GLsizei)p->side);
    if (!p->g->caps.is_es) gl->Enable(DESKTOP_FRAMEBUFFER_SRGB);
    gl->DepthMask(GL_TRUE);
    gl->ClearBufferfv(GL_COLOR, 0, color);
    gl->ClearBufferfv(GL_DEPTH, 0, &far);
}

void peel_begin(peel *p)
{
    static const float background[4] = { CANVAS_BACKGROUND_LINEAR, 1.0f };
    begin(p, p->depth[0], background);
}

uint8_t *peel_read(const peel *p)
{
    uint8_t *rgba = test_zeros((size_t)p->side * p->side * 4u);
    p->g->gl.ReadPixels(0, 0, (GLsizei)p->side, (GLsizei)p->side, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
    return rgba;
}

/* ---- blending ---- */

/* Front to back: sums[side * side][4] of the light so far, and how much of what lies behind is let through. Returns
 * whether the layer has anything. */
static int add_layer(const peel *p, const uint8_t *layer, double *sums)
{
    int any = 0;
    for (uint32_t i = 0; i < p->side * p->side; i++) {
        const double alpha = layer[4u * i + 3u] / 255.0;
        if (alpha == 0.0) continue;
        any = 1;
        for (uint32_t c = 0; c < 3; c++) sums[4u * i + c] += sums[4u * i + 3u] * alpha * decoded(layer[4u * i + c]);
        sums[4u * i + 3u] *= 1.0 - alpha;
    }
    return any;
}

/* The nearest of what lies behind p->behind, to be freed. */
static uint8_t *peel_layer(peel *p, const noh_gl_mesh *blended, GLuint depth, const noh_gl_camera *camera,
                           const noh_gl_texture *pictures)
{
    static const float identity[12] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0 }, clear[4] = { 0 };
    begin(p, depth, clear);
    noh_gl_draw_begin(&p->renderer, camera);
    noh_gl_draw_mesh(&p->renderer, blended, identity, NULL, NULL, NULL, pictures, NOH_DRAW_OPAQUE);
    noh_gl_draw_end(&p->renderer);
    return peel_read(p);
}

static void peel_all(peel *p, const noh_gl_mesh *blended, const noh_gl_camera *camera, const noh_gl_texture *pictures,
                     double *sums)
{
    static const float near = 0.0f;
    int any = 1;
    begin(p, p->depth[2], (const float[4]){ 0 });
    p->g->gl.ClearBufferfv(GL_DEPTH, 0, &near);
    p->behind = p->depth[2];
    for (p->layers = 0; any; p->layers += (uint32_t)any) {
        const GLuint depth = p->depth[1u + p->layers % 2u];
        uint8_t *layer = peel_layer(p, blended, depth, camera, pictures);
        any = add_layer(p, layer, sums);
        free(layer);
        p->behind = depth;
        assert_true(p->layers < PEEL_LAYERS_MAX);
    }
}

uint8_t *peel_picture(peel *p, const noh_mesh *blended, const noh_gl_camera *camera, const noh_gl_texture *pictures)
{
    uint8_t *rgba = peel_read(p);
    double *sums = test_zeros((size_t)p->side * p->side * 4u * sizeof *sums);
    noh_mesh of = *blended;
    noh_gl_mesh mesh;
    of.pack = &p->pack;
    for (uint32_t i = 0; i < p->side * p->side; i++) sums[4u * i + 3u] = 1.0;
    assert_int_equal(noh_gl_mesh_create(&p->g->gl, &p->ledger, &of, &mesh, NULL), NOH_OK);
    peel_all(p, &mesh, camera, pictures, sums);
    noh_gl_mesh_delete(&p->g->gl, &p->ledger, &mesh);
    for (uint32_t i = 0; i < p->side * p->side; i++) {
        for (uint32_t c = 0; c < 3; c++) {
            rgba[4u * i + c] =
                (uint8_t)(encoded(sums[4u * i + c] + sums[4u * i + 3u] * decoded(rgba[4u * i + c])) + 0.5);
        }
    }
    free(sums);
    return rgba;
}

uint32_t peel_wrong(const peel *p, const uint8_t *a, const uint8_t *b, int wrong, int *worst)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < p->side * p->side; i++) {
        int off = 0;
        for (uint32_t c = 0; c < 3; c++) {
            const int d = abs(a[4u * i + c] - b[4u * i + c]);
            off = d > off ? d : off;
        }
        count += off > wrong;
        *worst = off > *worst ? off : *worst;
    }
    return count;
}
