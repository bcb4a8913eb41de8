/* gl_draw.c: the plain renderer's draws.
 *
 * Opaque surfaces are drawn first and write depth. Blended surfaces follow: they test depth but do not write it, so two
 * blended surfaces never hide each other, whatever their order.
 *
 * Triangles are not sorted, because only the GPU knows their positions. Where the texture of a blended surface is
 * nearly opaque, as along strands of hair, this core is drawn with the opaque surfaces and hides whatever is behind it;
 * only the fringe, thin and mostly of one colour, is blended in stored order. */
#include "core/base/assert_internal.h"
#include "core/base/name_internal.h"
#include "gl/draw/gl_draw_internal.h"
#include "gl/draw/gl_light_internal.h"
#include "gl/draw/gl_skin_internal.h"
#include "gl/draw/gl_variants_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"

#include <string.h>

#include "gl/draw/gl_material_internal.h"
#include "gl/device/gl_names_internal.h"
#include "gl/device/gl_state_internal.h"
#include "gl/device/gl_debug_internal.h"
#include "gl/draw/gl_renderer_internal.h"

void noh_gl_draw_begin(noh_gl_renderer *r, const noh_gl_camera *camera)
{
    NOH_ASSERT(r && r->gl && camera);
    noh_gl_group_begin(r->gl, "noh meshes", NULL);
    noh_gl_tests_begin(r->gl, &r->raster);
    noh_gl_samplers_none(r->gl, 0, NOH_UNIT_USER);
    r->camera = *camera;
    noh_gl_draw_instance(r, NULL, NULL, NULL);
    r->priority = NOH_PRIORITY_ANY;
    noh_gl_draw_triangles(r, NULL);
    noh_gl_draw_cover(r, 0);
    noh_gl_draw_before(r, NULL);
    for (uint32_t i = 0; i < r->variant_count; i++) r->variants[i].has_camera = 0;
    noh_gl_draw_wrinkle_look(r, 0, 0);
}

void noh_gl_draw_instance(noh_gl_renderer *r, const uint8_t tint[4], const float user[4],
                          const float regions[NOH_WRINKLE_REGIONS])
{
    static const uint8_t white[4] = { 255, 255, 255, 255 };
    static const float zeros[4] = { 0.0f };
    NOH_ASSERT(r);
    memcpy(r->tint, tint ? tint : white, sizeof r->tint);
    memcpy(r->user, user ? user : zeros, sizeof r->user);
    memset(r->wrinkles, 0, sizeof r->wrinkles);
    for (uint32_t i = 0; regions && i < NOH_WRINKLE_REGIONS; i++) { /* of wrinkles by map, then by channel */
        const uint32_t at = i < NOH_WRINKLE_FOLDS ? 4u * (i % 3u) + i / 3u : i;
        r->wrinkles[at] = (float)(int)(regions[i] * 255.0f + 0.5f) / 255.0f; /* as in crowds */
    }
}

void noh_gl_draw_priority(noh_gl_renderer *r, int priority)
{
    NOH_ASSERT(r);
    r->priority = priority;
}

void noh_gl_draw_cover(noh_gl_renderer *r, unsigned indices)
{
    NOH_ASSERT(r);
    r->cover = indices;
}

void noh_gl_draw_before(noh_gl_renderer *r, const noh_gl_before *before)
{
    NOH_ASSERT(r);
    r->before = before;
}

void noh_gl_draw_triangles(noh_gl_renderer *r, const noh_gl_triangles *triangles)
{
    NOH_ASSERT(r);
    r->triangles = triangles;
}

void noh_gl_draw_wrinkle_look(noh_gl_renderer *r, uint32_t models, uint32_t smoothed)
{
    NOH_ASSERT(r && models <= 7u && smoothed <= 255u);
    r->wrinkle_models = (uint8_t)models;
    r->smoothed = (uint8_t)smoothed;
}

/* ---- uniforms, attributes, textures ---- */

void noh_gl_renderer_light(noh_gl_renderer *renderer, const noh_gl_light *light, const noh_lighting *lighting)
{
    NOH_ASSERT(renderer && renderer->lit && light && lighting);
    renderer->light = light;
    renderer->lighting = lighting;
}

/* The size of the array depends on the transfer's order. */
static void set_rest(const noh_gl_renderer *r, const noh_gl_variant *v)
{
    const uint32_t order = v->key.transfer & ~NOH_TRANSFER_ON_NORMAL;
    float rows[NOH_SH_COUNT_MAX][4];
    noh_lighting_pack_rest(r->lighting, rows);
    r->gl->Uniform4fv(v->u_rest, (GLsizei)NOH_SH_COUNT(order), rows[0]);
}

static void set_lighting(const noh_gl_renderer *r, const noh_gl_variant *v)
{
    float rows[NOH_LIGHTING_ROWS][4];
    NOH_ASSERT(r->light && r->lighting); /* noh_gl_renderer_light was called */
    noh_lighting_pack(r->lighting, r->light->desc.shadow_px, rows);
    r->gl->Uniform4fv(v->u_lighting, NOH_LIGHTING_ROWS, rows[0]);
    r->gl->Uniform3fv(v->u_key, 1, r->lighting->key_direction);
    if (v->key.transfer) set_rest(r, v);
    r->gl->ActiveTexture(GL_TEXTURE0 + NOH_UNIT_ENVIRONMENT);
    r->gl->BindTexture(GL_TEXTURE_CUBE_MAP, r->light->cube.name);
    r->gl->ActiveTexture(GL_TEXTURE0 + NOH_UNIT_SHADOW);
    r->gl->BindTexture(GL_TEXTURE_2D, noh_gl_light_map(r->light));
}

/* Use a variant's program, with the camera of this pass. */
static void use_variant(const noh_gl_renderer *r, const noh_gl_variant *v)
{
    r->gl->UseProgram(v->program);
    if (!v->has_camera) {
        r->variants[v - r->variants].has_camera = 1;
        r->gl->UniformMatrix4fv(v->u_view_projection, 1, GL_FALSE, r->camera.view_projection);
        r->gl->Uniform3fv(v->u_camera, 1, r->camera.eye);
        r->gl->Uniform3fv(v->u_key, 1, r->camera.key);
        if (v->key.lit) set_lighting(r, v);
    }
}

/* How a game's shader reads extra attributes; zeros in a mesh without them. */
static void set_extras(const noh_gl_api *gl, const noh_gl_variant *v, const noh_mesh *mesh)
{
    static const noh_extra_row none[NOH_EXTRAS_MAX];
    const noh_extras_header *h = mesh->extras;
    const void *rows = h ? (const void *)((const uint8_t *)h + h->rows_offset) : none;
    gl->Uniform4fv(v->u_extras, 3 * (GLsizei)(h ? h->count : NOH_EXTRAS_MAX), rows);
    gl->VertexAttribI4i(NOH_ATTRIBUTE_EXTRA, 0, 0, 0, 0);
    gl->VertexAttribI4i(NOH_ATTRIBUTE_MORE_EXTRA, 0, 0, 0, 0);
}

static void set_mesh(const noh_gl_renderer *r, const noh_gl_variant *v, const noh_gl_mesh *mesh,
                     const noh_gl_morph_binding *morph)
{
    const noh_mesh_header *h = mesh->mesh.header;
    const float uv[8] = { h->uv_offset[0], h->uv_offset[1], h->uv_scale[0], h->uv_scale[1], h->uv_per_unit };
    r->gl->Uniform4fv(v->u_uv, v->key.uv_targets ? 2 : 1, uv);
    r->gl->Uniform3f(v->u_bounds_min, h->bounds_min[0], h->bounds_min[1], h->bounds_min[2]);
    r->gl->Uniform3f(v->u_bounds_size, h->bounds_max[0] - h->bounds_min[0], h->bounds_max[1] - h->bounds_min[1],
                     h->bounds_max[2] - h->bounds_min[2]);
    if (v->key.features & NOH_FEATURE_WRINKLES) {
        r->gl->Uniform3f(v->u_center, 0.5f * (h->bounds_min[0] + h->bounds_max[0]),
                         0.5f * (h->bounds_min[1] + h->bounds_max[1]), 0.5f * (h->bounds_min[2] + h->bounds_max[2]));
    }
    if (morph) noh_gl_morph_bind(r->gl, morph);
    r->gl->VertexAttribI4i(NOH_ATTRIBUTE_TANGENT, 0, 0, 0, 1);
    r->gl->VertexAttrib4f(NOH_ATTRIBUTE_UV, 0.0f, 0.0f, 0.0f, 1.0f);
    r->gl->VertexAttrib4f(NOH_ATTRIBUTE_COLOR, 1.0f, 1.0f, 1.0f, 1.0f);
    if (v->u_extras >= 0) set_extras(r->gl, v, &mesh->mesh);
    noh_gl_mesh_bind(r->gl, mesh, morph);
    if (r->cover) r->gl->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, r->cover);
    if (r->triangles) r->gl->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, r->triangles->buffer);
    if (morph) noh_gl_morph_bind_streams(r->gl, v->u_streams, morph);
}

/* The caller's front face, or the opposite one for a mirrored instance, or for the hull of an outline. */
static void set_front(noh_gl_renderer *r, int mirrored)
{
    const GLenum kept = r->raster.front_face;
    if (!mirrored && !(r->raster.kept & NOH_KEEP_FACE)) return;
    if (!(r->raster.kept & NOH_KEEP_FACE)) {
        noh_gl_raster_keep(r->gl, &r->raster, NOH_KEEP_FACE);
    }
    r->gl->FrontFace(mirrored ? (GLenum)(GL_CW + GL_CCW) - r->raster.front_face : kept);
}

static int is_outline(const noh_gl_variant *v)
{
    return (v->key.features & NOH_FEATURE_OUTLINE) != 0;
}

/* Uniforms of one instance. A crowd has these values in rows instead. */
static void set_instance(noh_gl_renderer *r, const noh_gl_variant *v, const float world[12],
                         const noh_gl_morph_binding *morph)
{
    float rows[12], determinant = noh_gl_normal_rows(world, rows);
    uint32_t tint[3];
    set_front(r, (determinant < 0.0f) != is_outline(v));
    r->gl->Uniform4fv(v->u_world, 3, world);
    r->gl->Uniform4fv(v->u_normal, 3, rows);
    noh_gl_tint_bits(r->tint, tint);
    if (v->u_user >= 0) r->gl->Uniform4fv(v->u_user, 1, r->user);
    if (morph) {
        r->gl->Uniform4i(v->u_morph, morph->tile_x | (GLint)tint[0], morph->tile_y | (GLint)tint[1],
                         morph->width_log2 | (GLint)tint[2], morph->touched);
    } else {
        r->gl->Uniform4i(v->u_morph, (GLint)tint[0], (GLint)tint[1], (GLint)tint[2], 0);
    }
}

/* The last frame, for noh_clip_before; where it is not known, this one. world: NULL for a crowd */
static void set_before(const noh_gl_renderer *r, const noh_gl_variant *v, const float *world,
                       const noh_gl_morph_binding *morph, const noh_gl_skin_binding *skin)
{
    float rows[9][4] = { { 0.0f } };
    memcpy(rows[0], r->before ? r->before->view_projection : r->camera.view_projection,
           sizeof r->camera.view_projection);
    if (world) memcpy(rows[4], r->before ? r->before->world : world, 12u * sizeof *world);
    if (r->before) {
        memcpy(rows[7], r->before->tile, sizeof rows[7]);
    } else if (morph) {
        noh_gl_tile_floats(morph, rows[7]);
    }
    rows[8][0] = r->before && skin ? (float)skin->before_row : 0.0f;
    r->gl->Uniform4fv(v->u_before, 9, rows[0]);
}

static void bind_picture(const noh_gl_renderer *r, uint32_t unit, uint32_t texture, const noh_gl_texture *pictures)
{
    const GLuint name = texture == NOH_NONE ? r->white.name : pictures[texture].name;
    NOH_ASSERT(name); /* the picture was created */
    r->gl->ActiveTexture(GL_TEXTURE0 + unit);
    r->gl->BindTexture(GL_TEXTURE_2D, name);
}

/* Added to the surface type in the uniform: base colours are premultiplied by alpha. */
#define PREMULTIPLIED 0.25f
static void set_base_color(const noh_gl_renderer *r, const noh_gl_variant *v, const noh_material *m, float cutoff,
                           const noh_gl_texture *pictures)
{
    const float strands = noh_material_has_core(m) && cutoff < 0.0f ? -1.0f
                                                                    : 0.0f; /* the core has a cutoff of its own */
    const float kind = m->flags & NOH_MATERIAL_UNLIT ? 1.0f : strands;
    const int premultiplied = m->base_color_texture != NOH_NONE && pictures[m->base_color_texture].premultiplied;
    bind_picture(r, NOH_UNIT_BASE_COLOR, m->base_color_texture, pictures);
    r->gl->Uniform4fv(v->u_base_color, 1, m->base_color);
    r->gl->Uniform4f(v->u_material, m->roughness, m->metallic, cutoff, premultiplied ? kind + PREMULTIPLIED : kind);
}

/* Textures and uniforms of the variant's features. */
static void set_features(const noh_gl_renderer *r, const noh_gl_variant *v, const noh_material *m,
                         const noh_gl_texture *pictures)
{
    const uint32_t features = v->key.features;
    r->gl->Uniform3fv(v->u_f0, 1, m->f0);
    r->gl->Uniform1f(v->u_f90, 1.0f - m->f90_loss);
    if (features & NOH_FEATURE_SPECULAR_MAP) bind_picture(r, NOH_UNIT_SPECULAR, m->specular_texture, pictures);
    if (features & NOH_FEATURE_NORMAL_MAP) bind_picture(r, NOH_UNIT_NORMAL, m->normal_texture, pictures);
    if (features & NOH_FEATURE_SURFACE_MAP) bind_picture(r, NOH_UNIT_SURFACE, m->surface_texture, pictures);
    if (features & (NOH_FEATURE_NORMAL_MAP | NOH_FEATURE_SURFACE_MAP)) {
        r->gl->Uniform4f(v->u_maps, m->normal_scale, m->occlusion_strength, 0.0f, 0.0f);
    }
    if (features & NOH_FEATURE_EMISSIVE) {
        bind_picture(r, NOH_UNIT_EMISSIVE, m->emissive_texture, pictures);
        r->gl->Uniform3fv(v->u_emissive, 1, m->emissive);
    }
    for (uint32_t k = 0; k < 3; k++) {
        static const uint32_t of[3] = { NOH_FEATURE_TOON_SHADE, NOH_FEATURE_MATCAP,
                                        NOH_FEATURE_OUTLINE | NOH_FEATURE_TOON_MASKS };
        if (features & NOH_FEATURE_TOON && features & of[k])
            bind_picture(r, NOH_UNIT_WRINKLE_WEIGHTS + k, m->more_textures[k], pictures);
    }
}

static void decode_color(float code, float rgb[3])
{
    for (uint32_t i = 0; i < 3; i++) {
        const float root = (float)((uint32_t)code >> 8u * i & 255u) / 255.0f;
        rgb[i] = root * root;
    }
}

/* noh_surface_more of a toon: hardness, power, lift; rim; outline; its width, 1 if the base colour multiplies it. */
static void set_toon(const noh_gl_renderer *r, const noh_gl_variant *v, const noh_material *m)
{
    const float *values = m->surface_more;
    float more[4][3] = { { values[0], values[2], values[3] },
                         { 0.0f },
                         { 0.0f },
                         { values[4], m->flags & NOH_MATERIAL_OUTLINE_LIT ? 1.0f : 0.0f, 0.0f } };
    decode_color(values[1], more[1]);
    decode_color(values[5], more[2]);
    r->gl->Uniform3fv(v->u_surface_more, 4, more[0]);
}

/* Half the lips' gap, in depths of the mouth: endless where no place of the mouth is known, and never so small that
 * depths over it are not finite. A crowd adds its own opening. */
static float half_gap(const noh_material *m, const noh_gl_morph_binding *morph, int is_crowd)
{
    const float *more = m->surface_more;
    if (!(more[m->surface == NOH_SURFACE_SKIN ? 2 : 0] > 0.0f)) return 1e9f;
    const float rest = more[3] > 0.0f ? more[3] : 0.24f;
    return (rest > 1.0f / 256.0f ? rest : 1.0f / 256.0f) + (morph && !is_crowd ? morph->lips : 0.0f);
}

/* Uniforms of skin, eye, teeth, toon and hair materials. The unit of skin defaults to metres. */
static void set_surface(const noh_gl_renderer *r, const noh_gl_variant *v, const noh_material *m,
                        const noh_gl_morph_binding *morph)
{
    float more[6];
    memcpy(more, m->surface_more, sizeof more);
    const float mm = m->surface_values[0] > 0.0f ? m->surface_values[0] : 1000.0f;
    const int is_skin = m->surface == NOH_SURFACE_SKIN;
    r->gl->Uniform4f(v->u_surface_values, is_skin ? mm : m->surface_values[0], m->surface_values[1],
                     m->surface_values[2], m->surface_values[3]);
    if (m->surface == NOH_SURFACE_TOON) {
        set_toon(r, v, m);
        return;
    }
    if (is_skin || m->surface == NOH_SURFACE_TEETH) more[3] = half_gap(m, morph, v->key.crowd);
    r->gl->Uniform3fv(v->u_surface_more, 2, more);
}

/* A crowd has the regions in a row of each instance, if the mesh has any. */
#define REGIONS_IN_ROWS 8
static void set_wrinkles(const noh_gl_renderer *r, const noh_gl_variant *v, const noh_material *m, int in_rows,
                         const noh_gl_texture *pictures)
{
    const GLint models = (GLint)(r->wrinkle_models ? r->wrinkle_models : m->wrinkle_models);
    bind_picture(r, NOH_UNIT_WRINKLE, m->wrinkle_texture, pictures);
    for (uint32_t k = 0; k < (v->key.features & NOH_FEATURE_WRINKLE_PIXEL ? 1u : 3u); k++) {
        bind_picture(r, NOH_UNIT_WRINKLE_WEIGHTS + k, m->more_textures[k], pictures);
    }
    if (!v->key.crowd) r->gl->Uniform4fv(v->u_wrinkle_regions, 3, r->wrinkles);
    r->gl->Uniform2i(v->u_wrinkle_models, models | (in_rows ? REGIONS_IN_ROWS : 0), 255 - r->smoothed);
}

/* noh_colors: the regions' colours and weights, which a crowd has in a row of each instance. */
static void set_colors(const noh_gl_renderer *r, const noh_gl_variant *v, const noh_mesh *mesh,
                       const noh_gl_texture *pictures)
{
    float colors[NOH_WRINKLE_COLORS][4];
    noh_wrinkles wrinkles;
    (void)noh_wrinkles_of(mesh, &wrinkles, NULL); /* the feature says that it has colours */
    for (uint32_t c = 0; c < NOH_WRINKLE_COLORS; c++) {
        for (uint32_t i = 0; i < 3; i++) {
            const float root = (float)wrinkles.colors[4u * c + i] / 255.0f;
            colors[c][i] = root * root;
        }
        colors[c][3] = v->key.crowd ? 1.0f : r->wrinkles[NOH_WRINKLE_FOLDS + c];
    }
    bind_picture(r, NOH_UNIT_COLORS, wrinkles.color_texture, pictures);
    r->gl->Uniform4fv(v->u_colors, NOH_WRINKLE_COLORS, colors[0]);
}

static void set_material(const noh_gl_renderer *r, const noh_gl_variant *v, const noh_mesh *mesh, const noh_material *m,
                         float cutoff, const noh_gl_morph_binding *morph, const noh_gl_texture *pictures)
{
    if (!v->key.depth || v->key.cut) {
        set_base_color(r, v, m, cutoff, pictures);
    }
    if (!v->key.depth) {
        set_features(r, v, m, pictures);
        if (v->key.features & NOH_FEATURE_WRINKLES) {
            set_wrinkles(r, v, m, v->key.crowd && noh_gl_crowd_rows(mesh) > NOH_CROWD_ROWS, pictures);
        }
        if (v->key.features & NOH_FEATURE_COLORS) set_colors(r, v, mesh, pictures);
        if (m->surface != NOH_SURFACE_PLAIN) set_surface(r, v, m, morph);
    }
    if ((m->flags & NOH_MATERIAL_DOUBLE_SIDED) && !is_outline(v)) {
        r->gl->Disable(GL_CULL_FACE);
    } else {
        r->gl->Enable(GL_CULL_FACE);
    }
}

/* ---- drawing ---- */

NOH_STATIC_ASSERT(NOH_PRIORITY_ANY == NOH_PRIORITY_NONE, no_priority);

static const noh_gl_lod whole = { 0, 0.0f, 1.0f };

/* The arguments of one draw call. */
typedef struct draw_job {
    noh_gl_renderer *r;
    const noh_gl_mesh *mesh;
    const float *world; /* NULL: a crowd */
    const noh_gl_morph_binding *morph;
    const noh_gl_skin_binding *skin;
    uint32_t count;
    const noh_gl_lod *lod;
    const noh_gl_texture *pictures;
} draw_job;

/* The submeshes that one pass draws. */
typedef enum draw_part { PART_OPAQUE, PART_OUTLINE, PART_BLENDED, PART_SOLID_DEPTH, PART_CUT_DEPTH } draw_part;

static int is_in_part(const noh_material *m, draw_part part)
{
    const int blended = (m->flags & NOH_MATERIAL_BLEND) != 0, cut = (m->flags & NOH_MATERIAL_MASK) != 0;
    switch (part) {
    case PART_OPAQUE: return !blended || noh_material_has_core(m);
    case PART_OUTLINE: return noh_gl_outline_features(m) != 0;
    case PART_BLENDED: return blended;
    case PART_SOLID_DEPTH: return !blended && !cut;
    default: return (!blended && cut) || noh_material_has_core(m);
    }
}

/* Pixels with a lower alpha are not drawn; -1: all are drawn. The shader takes cutoff + SOFT as alpha to coverage, and
 * cutoff + 3 * SOFT as a dither. */
#define SOFT 2.0f
static float cutoff_of(const noh_gl_renderer *r, const noh_material *m, draw_part part)
{
    const int soft = part == PART_OPAQUE ? noh_gl_is_covering(&r->raster) : 0;
    if (part != PART_BLENDED && noh_material_has_core(m)) {
        return NOH_CORE_ALPHA;
    }
    if (!(m->flags & NOH_MATERIAL_MASK)) return -1.0f;
    const float cutoff = m->alpha_cutoff < 1.5f ? m->alpha_cutoff : 1.5f; /* above 1 nothing is drawn */
    if (!soft || !(cutoff > 0.0f)) return cutoff;
    /* The line of the cutoff is half a step of 8 bits below it: pixels that have it are inside. */
    const float line = cutoff - 0.5f / 255.0f;
    return (line > 1.0f / 512.0f ? line : 1.0f / 512.0f) + SOFT * (float)soft;
}

static int is_in_depth(draw_part part)
{
    return part == PART_SOLID_DEPTH || part == PART_CUT_DEPTH;
}

/* NULL if the renderer's desc did not ask for this variant. */
static const noh_gl_variant *variant_of(const draw_job *j, draw_part part, uint32_t features)
{
    noh_gl_variant_key key = noh_gl_variant_key_of(&j->mesh->mesh, j->skin, !j->world, j->r->layers_uint, j->r->view);
    key.fade = j->lod->from > 0.0f || j->lod->to < 1.0f;
    key.features = features;
    if (is_in_depth(part)) {
        key = noh_gl_variant_key_depth(key, part == PART_CUT_DEPTH);
    }
    return noh_gl_renderer_variant(j->r, key);
}

/* Index of the first of the renderer's own triangles with at least this number. */
static uint32_t first_from(const noh_gl_triangles *t, uint32_t number)
{
    uint32_t low = 0, high = t->count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2u;
        if (t->numbers[middle] < number) {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return low;
}

/* The number of indices that a submesh draws. *first: its first triangle in the renderer's own triangles */
static uint32_t own_count(const noh_gl_triangles *t, const noh_submesh *s, uint32_t *first)
{
    const uint32_t end = first_from(t, (s->first_index + s->index_count) / 3u);
    *first = first_from(t, s->first_index / 3u);
    return 3u * (end - *first);
}

static int draws_nothing(const draw_job *j, const noh_submesh *s)
{
    uint32_t first;
    return !s->index_count || (j->r->triangles && !own_count(j->r->triangles, s, &first));
}

static void draw_own(const draw_job *j, const noh_submesh *s)
{
    const noh_gl_triangles *t = j->r->triangles;
    uint32_t first;
    const uint32_t count = own_count(t, s, &first);
    j->r->gl->DrawElements(GL_TRIANGLES, (GLsizei)count, GL_UNSIGNED_INT,
                           (const void *)((uintptr_t)(t->first + first) * 12u));
}

static void draw_submesh(const draw_job *j, const noh_submesh *s, size_t level_first)
{
    const noh_gl_api *gl = j->r->gl;
    const void *first = (const void *)(level_first + (uintptr_t)s->first_index * j->mesh->room->index_bytes);
    if (j->r->triangles) {
        draw_own(j, s);
        return;
    }
    if (j->count == 1u) {
        gl->DrawElements(GL_TRIANGLES, (GLsizei)s->index_count, j->mesh->index_type, first);
    } else {
        gl->DrawElementsInstanced(GL_TRIANGLES, (GLsizei)s->index_count, j->mesh->index_type, first, (GLsizei)j->count);
    }
}

static void begin_variant(const draw_job *j, const noh_gl_variant *v, uint32_t level)
{
    use_variant(j->r, v);
    set_mesh(j->r, v, j->mesh, j->morph);
    if (j->world) {
        set_instance(j->r, v, j->world, j->morph);
    } else {
        set_front(j->r, is_outline(v));
        if (v->u_user >= 0) j->r->gl->Uniform4f(v->u_user, (float)j->skin->user_row, 0.0f, 0.0f, 0.0f);
    }
    if (v->u_before >= 0) set_before(j->r, v, j->world, j->morph, j->skin);
    j->r->gl->Uniform3f(v->u_lod, j->lod->from, j->lod->to, (float)level);
}

/* Bits of the uniform noh_blends: how a tint applies. */
#define TINT_ALPHA 1
#define TINT_NO_COLOR 2
#define COMPLEXION_SHIFT 2

/* Which part of a complexion a material shows (common_complexion.glsl): by its surface, else by the first word that its
 * name has. */
static GLint complexion_part(const noh_mesh *mesh, const noh_material *m)
{
    static const struct {
        char word[11];
        uint8_t part;
    } words[] = { { "lash", 0 }, { "lashes", 0 },  { "eyelash", 0 }, { "eyelashes", 0 },
                  { "brow", 4 }, { "eyebrow", 4 }, { "hair", 3 } };
    const char *name = noh_pack_string(mesh->pack, m->name);
    if (m->surface == NOH_SURFACE_SKIN) return 1;
    if (m->surface == NOH_SURFACE_EYE) return 2;
    if (m->surface == NOH_SURFACE_TEETH) return 0;
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        if (noh_name_has(name, words[i].word)) return words[i].part;
    }
    return m->surface == NOH_SURFACE_HAIR ? 3 : 0;
}

static void draw_material(const draw_job *j, const noh_gl_variant *v, const noh_submesh *s, size_t first,
                          draw_part part)
{
    const noh_material *m = noh_mesh_material(&j->mesh->mesh, s);
    set_material(j->r, v, &j->mesh->mesh, m, cutoff_of(j->r, m, part), j->morph, j->pictures);
    const GLint shows = v->u_user >= 0 ? complexion_part(&j->mesh->mesh, m) << COMPLEXION_SHIFT : 0;
    j->r->gl->Uniform1i(v->u_blends, shows | ((m->flags & NOH_MATERIAL_BLEND) ? TINT_ALPHA : 0) |
                                         ((m->flags & NOH_MATERIAL_UNTINTED) ? TINT_NO_COLOR : 0));
    if (j->r->shaders.bind) {
        j->r->shaders.bind(j->r->shaders.user, j->r->gl, v->program, m);
    }
    draw_submesh(j, s, first);
}

/* PART_BLENDED draws only the given priority; other parts draw all. */
static void draw_part_of(const draw_job *j, draw_part part, int priority)
{
    size_t first;
    const noh_mesh level = noh_gl_mesh_lod(j->mesh, j->lod->level, &first);
    const noh_gl_variant *v = NULL;
    uint32_t palette = NOH_NONE;
    for (uint32_t i = 0; i < level.header->submesh_count; i++) {
        const noh_submesh *s = &level.submeshes[i];
        const noh_material *m = noh_mesh_material(&j->mesh->mesh, s);
        const uint32_t features = is_in_depth(part)      ? 0
                                  : part == PART_OUTLINE ? noh_gl_outline_features(m)
                                                         : noh_gl_features_of(&j->mesh->mesh, m);
        if (draws_nothing(j, s) || !is_in_part(m, part) || (part == PART_BLENDED && m->priority != priority)) {
            continue;
        }
        if (!v || (v->key.features & ~NOH_FEATURE_PHONE) != features) {
            v = variant_of(j, part, features);
            NOH_ASSERT(v || part == PART_OUTLINE); /* the renderer's desc asked for it */
            if (!v) break;
            begin_variant(j, v, level.header->level);
            palette = NOH_NONE;
        }
        if (j->skin && s->palette != palette) {
            palette = s->palette;
            noh_gl_variant_skin(j->r->gl, v, &j->mesh->mesh, j->skin, palette);
        }
        draw_material(j, v, s, first, part);
    }
    if (v && (j->r->triangles || j->r->cover)) j->r->gl->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, j->mesh->indices.name);
    if (v && j->morph && !j->morph->vertex_array && (j->morph->vertex_buffer || j->morph->stream_buffer)) {
        noh_gl_mesh_unbind(j->r->gl, j->mesh, j->morph);
    }
}

static void draw_blended(const draw_job *j)
{
    const noh_mesh *mesh = &j->mesh->mesh;
    if (j->r->priority != NOH_PRIORITY_ANY) {
        draw_part_of(j, PART_BLENDED, j->r->priority);
        return;
    }
    for (int p = noh_mesh_next_priority(mesh, -NOH_PRIORITY_ANY); p != NOH_PRIORITY_ANY;
         p = noh_mesh_next_priority(mesh, p)) {
        draw_part_of(j, PART_BLENDED, p);
    }
}

static void draw_pass(const draw_job *j, int pass)
{
    NOH_ASSERT(j->mesh->vertex_array && pass >= NOH_DRAW_OPAQUE && pass <= NOH_DRAW_DEPTH);
    NOH_ASSERT(!j->morph || j->morph->is_uint == j->r->layers_uint);
    NOH_ASSERT(!j->morph || pass == NOH_DRAW_DEPTH || (j->morph->layer_count == 2) == j->r->without_tangents);
    if (!j->count || !(j->lod->from < j->lod->to)) {
        return;
    }
    if (pass == NOH_DRAW_DEPTH) {
        noh_gl_depth_only_begin(j->r->gl, &j->r->raster);
        draw_part_of(j, PART_SOLID_DEPTH, 0);
        draw_part_of(j, PART_CUT_DEPTH, 0);
        noh_gl_depth_only_end(j->r->gl, &j->r->raster);
    } else if (pass == NOH_DRAW_BLENDED) {
        noh_gl_blend_begin(j->r->gl, &j->r->raster);
        draw_blended(j);
        noh_gl_blend_end(j->r->gl, &j->r->raster);
    } else {
        draw_part_of(j, PART_OPAQUE, 0);
        draw_part_of(j, PART_OUTLINE, 0);
    }
}

void noh_gl_draw_mesh(noh_gl_renderer *r, const noh_gl_mesh *mesh, const float world[12],
                      const noh_gl_morph_binding *morph, const noh_gl_skin_binding *skin, const noh_gl_lod *lod,
                      const noh_gl_texture *pictures, int pass)
{
    const draw_job job = { r, mesh, world, morph, skin, 1, lod ? lod : &whole, pictures };
    NOH_ASSERT(world);
    draw_pass(&job, pass);
}

void noh_gl_draw_crowd(noh_gl_renderer *r, const noh_gl_mesh *mesh, const noh_gl_morph_binding *morph,
                       const noh_gl_skin_binding *first, uint32_t count, const noh_gl_lod *lod,
                       const noh_gl_texture *pictures, int pass)
{
    NOH_ASSERT(!morph || !(morph->stream_buffer || morph->vertex_buffer));
    const draw_job job = { r, mesh, NULL, morph, first, count, lod ? lod : &whole, pictures };
    NOH_ASSERT(!r->triangles);
    draw_pass(&job, pass);
}

void noh_gl_draw_end(const noh_gl_renderer *r)
{
    NOH_ASSERT(r && r->gl);
    static const GLuint units[] = { NOH_UNIT_WRINKLE,
                                    NOH_UNIT_WRINKLE_WEIGHTS,
                                    NOH_UNIT_WRINKLE_WEIGHTS + 1u,
                                    NOH_UNIT_WRINKLE_WEIGHTS + 2u,
                                    NOH_UNIT_PALETTES,
                                    NOH_UNIT_NORMAL,
                                    NOH_UNIT_SURFACE,
                                    NOH_UNIT_EMISSIVE,
                                    NOH_UNIT_SPECULAR,
                                    NOH_UNIT_BASE_COLOR,
                                    NOH_UNIT_COLORS,
                                    NOH_UNIT_LISTS,
                                    NOH_UNIT_LISTS + 1u,
                                    NOH_UNIT_LAYERS };
    const unsigned count = sizeof units / sizeof units[0] - (r->layers_uint == NOH_LAYERS_DIRECT ? 0 : 3u);
    r->gl->BindVertexArray(0);
    r->gl->UseProgram(0);
    for (unsigned i = 0; i < count; i++) {
        r->gl->ActiveTexture(GL_TEXTURE0 + units[i]);
        r->gl->BindTexture(GL_TEXTURE_2D, 0);
    }
    if (r->lit) {
        r->gl->ActiveTexture(GL_TEXTURE0 + NOH_UNIT_ENVIRONMENT);
        r->gl->BindTexture(GL_TEXTURE_CUBE_MAP, 0);
        r->gl->ActiveTexture(GL_TEXTURE0 + NOH_UNIT_SHADOW);
        r->gl->BindTexture(GL_TEXTURE_2D, 0);
    }
    r->gl->ActiveTexture(GL_TEXTURE0 + NOH_UNIT_LAYERS);
    r->gl->BindTexture(GL_TEXTURE_2D_ARRAY, 0);
    r->gl->BindBufferBase(GL_UNIFORM_BUFFER, 0, 0);
    noh_gl_raster_put_back(r->gl, &r->raster);
    noh_gl_group_end(r->gl);
}
