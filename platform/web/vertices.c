/* vertices.c: writes the deformed vertices of each mesh to buffers for another renderer on the same context
 * (package/three.js). Each vertex is drawn as a point without rasterisation, and transform feedback writes the output
 * of the vertex shader. Constant attributes are written once. */
#include <emscripten.h>
#include <string.h>

#include "web.h"
#include "gl/draw/gl_skin_internal.h"

__attribute__((import_module("noh"), import_name("feedback"))) void web_gl_feedback(int begins);

enum { OUT_POSITION, OUT_NORMAL, OUT_TANGENT, OUT_UV, OUT_COLOR, OUT_COUNT };

#define MOVING 4u /* outputs written in each frame; WebGL guarantees at least four */
#define DRAWN_MAX 64u
#define VARIANTS_MAX 16u

static const char *const names[OUT_COUNT] = { "noh_out_position", "noh_out_normal", "noh_out_tangent", "noh_out_uv",
                                              "noh_out_color" };
static const uint32_t floats_of[OUT_COUNT] = { 3, 3, 4, 2, 4 };
static const char vertex_text[] =
    "out vec3 noh_out_position;\nout vec3 noh_out_normal;\nout vec4 noh_out_tangent;\nout vec2 noh_out_uv;\n"
    "out vec4 noh_out_color;\n"
    "void main()\n{\n"
    "    noh_vertex v = noh_fetch();\n"
    "    noh_out_position = v.position;\n"
    "    noh_out_normal = normalize(v.normal);\n"
    "    noh_out_tangent = vec4(normalize(v.tangent.xyz), v.tangent.w);\n"
    "    noh_out_uv = v.uv;\n"
    "    noh_out_color = v.color;\n"
    "    gl_Position = vec4(v.position, 1.0);\n"
    "    gl_PointSize = 1.0;\n"
    "}\n";
static const char fragment_text[] = "out vec4 noh_out;\nvoid main()\n{\n    noh_out = vec4(0.0);\n}\n";

/* A mesh of a figure. */
typedef struct web_drawn {
    uint32_t figure, index; /* index for noh_actor_mesh_at */
    uint32_t mesh, level;   /* mesh of the pack; last written level */
    int is_written;
    noh_gl_buffer outs[OUT_COUNT];
} web_drawn;

typedef struct web_program {
    noh_gl_variant variant;
    int moving; /* 1: writes moving outputs, 0: constant ones */
} web_program;

static struct {
    web_drawn drawn[DRAWN_MAX];
    uint32_t count;
    web_program programs[VARIANTS_MAX];
    uint32_t program_count;
    const noh_gl_texture *pictures;
} all;

/* ---- create and delete ---- */

/* three.js needs a separate buffer for each attribute. */
static void GL_APIENTRY separate(GLuint program, GLsizei count, const GLchar *const *varyings, GLenum mode)
{
    (void)mode;
    web.gl.TransformFeedbackVaryings(program, count, varyings, GL_SEPARATE_ATTRIBS);
}

static noh_result create_program(noh_gl_variant_key key, int moving, web_program *out)
{
    static const noh_gl_shader_desc own = { .name = "vertices", .vertex = vertex_text, .fragment = fragment_text };
    noh_gl_api gl = web.gl;
    const noh_gl_device device = { &gl, &web.caps, &web.ledger, NULL, 0 };
    gl.TransformFeedbackVaryings = separate;
    out->moving = moving;
    return noh_gl_variant_create(&device, key, &own, moving ? names : names + MOVING,
                                 moving ? MOVING : OUT_COUNT - MOVING, &out->variant, &web.error);
}

static const noh_gl_variant *program_of(noh_gl_variant_key key, int moving)
{
    for (uint32_t i = 0; i < all.program_count; i++) {
        const web_program *p = &all.programs[i];
        if (p->moving == moving && memcmp(&p->variant.key, &key, sizeof key) == 0) return &p->variant;
    }
    if (all.program_count == VARIANTS_MAX) {
        (void)noh_fail(&web.error, NOH_ERR_LIMIT, "the meshes need more shader variants than the limit", VARIANTS_MAX,
                       0);
        return NULL;
    }
    if (create_program(key, moving, &all.programs[all.program_count])) return NULL;
    return &all.programs[all.program_count++].variant;
}

static noh_result create_buffers(web_drawn *d)
{
    noh_mesh mesh;
    noh_result result = noh_pack_mesh_at(&web.pack, d->mesh, &mesh, &web.error);
    for (uint32_t i = 0; i < OUT_COUNT && !result; i++) {
        const uint64_t bytes = (uint64_t)mesh.header->vertex_count * floats_of[i] * sizeof(float);
        result = noh_gl_buffer_create(&web.gl, &web.ledger, GL_ARRAY_BUFFER, bytes, NULL, GL_DYNAMIC_COPY, &d->outs[i],
                                      &web.error);
    }
    d->is_written = 0;
    return result;
}

/* List the meshes of all figures and create their buffers. Returns 0 or a noh_result. */
EMSCRIPTEN_KEEPALIVE int web_vertices_open(void)
{
    noh_result result = NOH_OK;
    (void)web_measure(); /* shows all of them */
    all.count = 0;
    web.gl.BindVertexArray(0);
    for (uint32_t f = 0; f < web.figure_count && !result; f++) {
        noh_actor_mesh mesh;
        for (uint32_t m = 0;
             !result && noh_actor_mesh_at(web.stage, web.figures[f].actor, m, &mesh, NULL, NULL) == NOH_OK; m++) {
            if (all.count == DRAWN_MAX) {
                return (int)noh_fail(&web.error, NOH_ERR_LIMIT,
                                     "the figures have more meshes than the limit for another renderer", DRAWN_MAX, 0);
            }
            all.drawn[all.count] = (web_drawn){ .figure = f, .index = m, .mesh = mesh.mesh };
            result = create_buffers(&all.drawn[all.count++]);
        }
    }
    return (int)result;
}

EMSCRIPTEN_KEEPALIVE void web_vertices_close(void)
{
    for (uint32_t i = 0; i < all.count; i++) {
        for (uint32_t o = 0; o < OUT_COUNT; o++) noh_gl_buffer_delete(&web.gl, &web.ledger, &all.drawn[i].outs[o]);
    }
    for (uint32_t i = 0; i < all.program_count; i++) {
        noh_gl_variant_delete(&web.gl, &web.ledger, &all.programs[i].variant);
    }
    all.program_count = 0;
    all.pictures = NULL;
}

/* Call after web_restore: recreate everything, under new names; deleting the objects of the lost context has no effect.
 * Returns 0 or a noh_result. */
EMSCRIPTEN_KEEPALIVE int web_vertices_restore(void)
{
    noh_result result = NOH_OK;
    web_vertices_close();
    web.gl.BindVertexArray(0);
    for (uint32_t i = 0; i < all.count && !result; i++) result = create_buffers(&all.drawn[i]);
    return (int)result;
}

/* ---- write ---- */

/* The arguments of a pass over a mesh. */
typedef struct web_pass {
    web_drawn *d;
    noh_mesh mesh; /* at the shown level */
    noh_stage_drawn on_gl;
    float world[12];
} web_pass;

static void set_uniforms(const web_pass *p, const noh_gl_variant *v)
{
    const noh_gl_api *gl = &web.gl;
    const noh_mesh_header *h = p->mesh.header;
    const noh_gl_morph_binding *morph = &p->on_gl.morph;
    float rows[12];
    (void)noh_gl_normal_rows(p->world, rows);
    gl->UseProgram(v->program);
    gl->Uniform4f(v->u_uv, h->uv_offset[0], h->uv_offset[1], h->uv_scale[0], h->uv_scale[1]);
    gl->Uniform4fv(v->u_world, 3, p->world);
    gl->Uniform4fv(v->u_normal, 3, rows);
    gl->Uniform4i(v->u_morph, morph->tile_x, morph->tile_y, morph->width_log2, morph->touched); /* zeros: not morphed */
    if (p->on_gl.is_morphed) noh_gl_morph_bind(gl, morph);
    gl->VertexAttribI4i(NOH_ATTRIBUTE_TANGENT, 0, 0, 0, 1);
    gl->VertexAttrib4f(NOH_ATTRIBUTE_UV, 0.0f, 0.0f, 0.0f, 1.0f);
    gl->VertexAttrib4f(NOH_ATTRIBUTE_COLOR, 1.0f, 1.0f, 1.0f, 1.0f);
    noh_gl_mesh_bind(gl, p->on_gl.mesh, p->on_gl.is_morphed ? morph : NULL);
}

/* Each vertex belongs to one submesh, and so to one palette. */
static void write_submesh(const web_pass *p, const noh_submesh *s, uint32_t first, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t out = first + i, bytes = floats_of[out] * (uint32_t)sizeof(float);
        web.gl.BindBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, i, p->d->outs[out].name,
                               (GLintptr)(s->first_vertex * bytes), (GLsizeiptr)(s->vertex_count * bytes));
    }
    web_gl_feedback(1);
    web.gl.DrawArraysInstanced(GL_POINTS, (GLint)s->first_vertex, (GLsizei)s->vertex_count, 1);
    web_gl_feedback(0);
}

static noh_result write(const web_pass *p, int moving)
{
    const noh_gl_skin_binding *skin = p->on_gl.is_skinned ? &p->on_gl.skin : NULL;
    noh_gl_variant_key key = noh_gl_variant_key_of(&p->mesh, skin, 0, p->on_gl.morph.is_uint, NOH_VIEW_LIT);
    const noh_gl_variant *v;
    key.two_layers = p->on_gl.is_morphed && p->on_gl.morph.layer_count == 2;
    v = program_of(key, moving);
    if (!v) return web.error.result;
    set_uniforms(p, v);
    web.gl.Enable(GL_RASTERIZER_DISCARD);
    for (uint32_t i = 0; i < p->mesh.header->submesh_count; i++) {
        const noh_submesh *s = &p->mesh.submeshes[i];
        if (!s->vertex_count) continue;
        if (skin) noh_gl_variant_skin(&web.gl, v, &p->mesh, skin, s->palette);
        write_submesh(p, s, moving ? 0 : MOVING, moving ? MOVING : OUT_COUNT - MOVING);
    }
    web.gl.Disable(GL_RASTERIZER_DISCARD);
    noh_gl_mesh_unbind(&web.gl, p->on_gl.mesh, p->on_gl.is_morphed ? &p->on_gl.morph : NULL);
    for (uint32_t i = 0; i < MOVING; i++) web.gl.BindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, i, 0);
    return NOH_OK;
}

/* Returns 0 if no view sees the mesh: then its buffers stay unchanged. */
static int look_at(web_drawn *d, web_pass *p)
{
    noh_actor_mesh shown;
    const noh_actor actor = web.figures[d->figure].actor;
    size_t first;
    if (noh_actor_on_gl(web.stage, actor, d->index, &p->on_gl, NULL)) return 0;
    if (noh_actor_mesh_at(web.stage, actor, d->index, &shown, NULL, NULL)) return 0;
    p->d = d;
    d->level = shown.level;
    p->mesh = noh_gl_mesh_lod(p->on_gl.mesh, shown.level, &first);
    memcpy(p->world, shown.world, sizeof p->world);
    all.pictures = p->on_gl.pictures;
    return 1;
}

/* Pose a frame for web_view and write its vertices. height_px: height of the picture. Returns 0 or a noh_result. */
EMSCRIPTEN_KEEPALIVE int web_vertices(uint32_t height_px)
{
    noh_result result;
    web.view.height_px = height_px;
    web.view.cut = 1; /* fades are not supported */
    result = noh_stage_frame_begin(web.stage, &web.view, 1, &web.error);
    if (!result) result = noh_stage_frame_end(web.stage, &web.error);
    for (uint32_t i = 0; i < all.count && !result; i++) {
        web_drawn *d = &all.drawn[i];
        web_pass p;
        size_t first;
        if (!look_at(d, &p)) continue;
        result = write(&p, 1);
        p.mesh = noh_gl_mesh_lod(p.on_gl.mesh, 0, &first); /* vertices of all levels */
        if (!result && !d->is_written) result = write(&p, 0);
        d->is_written = 1;
    }
    web.gl.BindVertexArray(0);
    return (int)result;
}

/* ---- queries of another renderer ---- */

EMSCRIPTEN_KEEPALIVE uint32_t web_drawn_count(void)
{
    return all.count;
}
static noh_mesh mesh_of(uint32_t i, uint32_t level)
{
    noh_mesh mesh;
    (void)noh_pack_mesh_at(&web.pack, all.drawn[i].mesh, &mesh, NULL);
    return noh_mesh_at_lod(&mesh, level);
}
EMSCRIPTEN_KEEPALIVE const char *web_drawn_name(uint32_t i)
{
    return mesh_of(i, 0).name;
}
/* Vertices of the finest level; buffers have the same length. */
EMSCRIPTEN_KEEPALIVE uint32_t web_drawn_vertices(uint32_t i)
{
    return mesh_of(i, 0).header->vertex_count;
}
/* Bits: 1 tangents, 2 texture coordinates, 4 colours. */
EMSCRIPTEN_KEEPALIVE uint32_t web_drawn_has(uint32_t i)
{
    return mesh_of(i, 0).header->flags & (NOH_MESH_TANGENTS | NOH_MESH_UVS | NOH_MESH_COLORS);
}
/* The last written level. */
EMSCRIPTEN_KEEPALIVE uint32_t web_drawn_level(uint32_t i)
{
    return all.drawn[i].level;
}
EMSCRIPTEN_KEEPALIVE uint32_t web_drawn_level_count(uint32_t i)
{
    return mesh_of(i, 0).header->level_count;
}
/* The name of a buffer of floats: 0 positions (3), 1 normals (3), 2 tangents (4), 3 texture coordinates (2), 4 colours
 * (4). */
EMSCRIPTEN_KEEPALIVE uint32_t web_drawn_buffer(uint32_t i, uint32_t out)
{
    return all.drawn[i].outs[out].name;
}
/* A level's indices, and the bytes of each. */
EMSCRIPTEN_KEEPALIVE const void *web_drawn_indices(uint32_t i, uint32_t level)
{
    return mesh_of(i, level).indices;
}
EMSCRIPTEN_KEEPALIVE uint32_t web_drawn_index_count(uint32_t i, uint32_t level)
{
    return mesh_of(i, level).header->index_count;
}
EMSCRIPTEN_KEEPALIVE uint32_t web_drawn_index_bytes(uint32_t i)
{
    return mesh_of(i, 0).header->index_bytes;
}
/* A level's submeshes: uint32_t [count][6], whose first three values are the first index, the count, the material. */
EMSCRIPTEN_KEEPALIVE uint32_t web_drawn_part_count(uint32_t i, uint32_t level)
{
    return mesh_of(i, level).header->submesh_count;
}
EMSCRIPTEN_KEEPALIVE const noh_submesh *web_drawn_parts(uint32_t i, uint32_t level)
{
    return mesh_of(i, level).submeshes;
}

/* A material: its name; and base colour (4), roughness, metallic, emissive (3), alpha cutoff or -1, scale of the normal
 * map, 1 if it blends, 1 if double-sided, 1 if unlit, 1 if its texture's colours are premultiplied. Valid until the
 * next call. */
EMSCRIPTEN_KEEPALIVE uint32_t web_material_count(void)
{
    return web.pack.material_count;
}
EMSCRIPTEN_KEEPALIVE const char *web_material_name(uint32_t m)
{
    return noh_pack_string(&web.pack, web.pack.materials[m].name);
}
EMSCRIPTEN_KEEPALIVE const float *web_material(uint32_t m)
{
    static float told[15];
    const noh_material *of = &web.pack.materials[m];
    noh_texture base;
    memcpy(told, of->base_color, sizeof of->base_color);
    told[4] = of->roughness;
    told[5] = of->metallic;
    memcpy(told + 6, of->emissive, sizeof of->emissive);
    told[9] = of->flags & NOH_MATERIAL_MASK ? of->alpha_cutoff : -1.0f;
    told[10] = of->normal_scale;
    told[11] = of->flags & NOH_MATERIAL_BLEND ? 1.0f : 0.0f;
    told[12] = of->flags & NOH_MATERIAL_DOUBLE_SIDED ? 1.0f : 0.0f;
    told[13] = of->flags & NOH_MATERIAL_UNLIT ? 1.0f : 0.0f;
    told[14] = 0.0f;
    if (noh_pack_texture_at(&web.pack, of->base_color_texture, &base, NULL) == NOH_OK) {
        told[14] = base.header->format == NOH_TEXTURE_ETC2_RGBA1 ? 1.0f : 0.0f;
    }
    return told;
}
/* The name of a material's texture, after the first frame; 0: none. which: 0 base colour, 1 normals, 2 occlusion,
 * roughness and metallic, 3 emissive. */
EMSCRIPTEN_KEEPALIVE uint32_t web_material_picture(uint32_t m, uint32_t which)
{
    const noh_material *of = &web.pack.materials[m];
    const uint32_t textures[4] = { of->base_color_texture, of->normal_texture, of->surface_texture,
                                   of->emissive_texture };
    return all.pictures && textures[which] != NOH_NONE ? all.pictures[textures[which]].name : 0u;
}

/* The distance of a ray's hit; negative: none. web_hit_point returns the point, web_picked_mesh and web_picked_joint
 * the names. */
EMSCRIPTEN_KEEPALIVE float web_pick_ray(float x, float y, float z, float dx, float dy, float dz, float most)
{
    const float origin[3] = { x, y, z }, direction[3] = { dx, dy, dz };
    return noh_stage_pick(web.stage, origin, direction, most, &web.hit, NULL) == NOH_OK ? web.hit.distance : -1.0f;
}
EMSCRIPTEN_KEEPALIVE const float *web_hit_point(void)
{
    return web.hit.point;
}
