/* gl_variants.c: makes a key from a mesh and its bindings, defines from a key, and a program from defines. */
#include "core/base/assert_internal.h"
#include "core/base/name_internal.h"
#include "gl/device/gl_api_internal.h"
#include "gl/draw/gl_material_internal.h"
#include "gl/draw/gl_skin_internal.h"
#include "gl/draw/gl_variants_internal.h"
#include "gl/morph/gl_morph_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"

#include <stddef.h>
#include <string.h>

#include "gl/device/gl_names_internal.h"
#include "shaders.gen.h"

/* The largest of 1, 2, 4, 8 that is at most `limit` and at most `stored`; limit 0: no limit. */
static uint8_t drawn_of(uint32_t stored, uint32_t limit)
{
    uint32_t drawn = stored;
    while (limit && drawn > limit) {
        drawn /= 2;
    }
    return (uint8_t)drawn;
}

noh_gl_variant_key noh_gl_variant_key_of(const noh_mesh *mesh, const noh_gl_skin_binding *skin, int crowd,
                                         int layers_uint, noh_debug_view view)
{
    const noh_mesh_header *h = mesh->header;
    noh_gl_variant_key key = { 0 };
    NOH_ASSERT((unsigned)view <= NOH_VIEW_WRINKLE);
    if (skin && h->influence_count) {
        key.influences = (uint8_t)h->influence_count;
        key.drawn = drawn_of(h->influence_count, skin->influences);
        key.dual_quaternion = (h->flags & NOH_MESH_DUAL_QUATERNION) != 0;
        key.texture = skin->mode == NOH_PALETTE_TEXTURE;
    }
    if (crowd) {
        NOH_ASSERT(skin && skin->mode == NOH_PALETTE_TEXTURE);
        key.texture = key.crowd = 1;
    }
    key.texels = (h->flags & NOH_MESH_TEXELS) != 0;
    key.uv_targets = (h->flags & NOH_MESH_UV_TARGETS) != 0;
    /* A crowd reads no streams: what has them is drawn alone. */
    key.layers_uint = (uint8_t)(crowd && layers_uint == NOH_LAYERS_STREAMS ? NOH_LAYERS_VERTICES : layers_uint);
    key.view = (uint8_t)view;
    if (mesh->transfer) key.transfer = (uint8_t)(mesh->transfer->order | mesh->transfer->flags);
    return key;
}

/* Whether the mesh has colours by target on this material. */
static int has_colors(const noh_mesh *mesh, const noh_material *m)
{
    noh_wrinkles wrinkles;
    return mesh->pack && noh_wrinkles_of(mesh, &wrinkles, NULL) == NOH_OK && wrinkles.colors &&
           m == &mesh->pack->materials[wrinkles.color_material];
}

uint32_t noh_gl_features_of(const noh_mesh *mesh, const noh_material *m)
{
    uint32_t features = m->flags & (NOH_MATERIAL_MASK | NOH_MATERIAL_BLEND) ? NOH_FEATURE_ALPHA : 0u;
    NOH_ASSERT(mesh && mesh->header && m);
    if (m->flags & NOH_MATERIAL_UNLIT) {
        return features;
    }
    if (has_colors(mesh, m)) features |= NOH_FEATURE_COLORS;
    if (mesh->header->flags & NOH_MESH_TANGENTS) {
        if (m->normal_texture != NOH_NONE) features |= NOH_FEATURE_NORMAL_MAP;
        if (m->wrinkle_texture != NOH_NONE) {
            features |= NOH_FEATURE_WRINKLES;
            if (m->flags & NOH_MATERIAL_WRINKLE_CODES) features |= NOH_FEATURE_WRINKLE_PIXEL;
        }
    }
    if (m->surface_texture != NOH_NONE) features |= NOH_FEATURE_SURFACE_MAP;
    if (m->emissive[0] > 0.0f || m->emissive[1] > 0.0f || m->emissive[2] > 0.0f) features |= NOH_FEATURE_EMISSIVE;
    if (m->flags & NOH_MATERIAL_SPECULAR_WEIGHT) features |= NOH_FEATURE_SPECULAR_MAP;
    if (m->flags & NOH_MATERIAL_SPECULAR_ROUGHNESS) {
        features |= NOH_FEATURE_SPECULAR_MAP | NOH_FEATURE_SPECULAR_ROUGHNESS;
    }
    if (m->surface == NOH_SURFACE_SKIN) features |= NOH_FEATURE_SKIN;
    if (m->surface == NOH_SURFACE_EYE) features |= NOH_FEATURE_EYE;
    if (m->surface == NOH_SURFACE_TEETH) features |= NOH_FEATURE_TEETH;
    if (m->surface == NOH_SURFACE_HAIR) features |= NOH_FEATURE_HAIR;
    if (m->surface == NOH_SURFACE_TOON) {
        features |= NOH_FEATURE_TOON;
        if (m->flags & NOH_MATERIAL_TOON_SHADE) features |= NOH_FEATURE_TOON_SHADE;
        if (m->more_textures[NOH_TOON_MATCAP] != NOH_NONE) features |= NOH_FEATURE_MATCAP;
        if (m->flags & NOH_MATERIAL_TOON_MASKS) features |= NOH_FEATURE_TOON_MASKS;
    }
    return features;
}

uint32_t noh_gl_outline_features(const noh_material *m)
{
    const uint32_t cut = m->flags & (NOH_MATERIAL_MASK | NOH_MATERIAL_BLEND) ? NOH_FEATURE_ALPHA : 0u;
    const int has_outline = m->surface == NOH_SURFACE_TOON && m->surface_more[4] != 0.0f &&
                            !(m->flags & NOH_MATERIAL_UNLIT) &&
                            (!(m->flags & NOH_MATERIAL_BLEND) || noh_material_has_core(m));
    return has_outline ? NOH_FEATURE_TOON | NOH_FEATURE_OUTLINE | cut : 0u;
}

noh_gl_variant_key noh_gl_variant_key_depth(noh_gl_variant_key key, int cut)
{
    key.view = NOH_VIEW_LIT;
    key.encode_srgb = key.two_layers = key.lit = key.transfer = 0;
    key.features = 0;
    key.depth = 1;
    key.cut = cut != 0;
    key.uv_targets = key.uv_targets && cut;
    return key;
}

/* ---- text before a shader's own ---- */

/* All defines together fit NOH_GL_DEFINES_BYTES, so they are never cut. */
static size_t put_text(char *text, size_t at, const char *more)
{
    while (*more && at + 1u < NOH_GL_DEFINES_BYTES) {
        text[at++] = *more++;
    }
    text[at] = 0;
    return at;
}

/* "#define NAME D\n" with one digit. */
static size_t put_digit(char *text, size_t at, const char *name, unsigned digit)
{
    const char value[3] = { (char)('0' + digit), '\n', 0 };
    at = put_text(text, at, name);
    return put_text(text, at, value);
}

/* Shadow map fetches of a lit pixel, if the map is not soft: 1 in the phone tier, else 4, or fewer if its other textures
 * leave fewer of 8. */
static unsigned shadow_taps(uint32_t features)
{
    static const unsigned maps[] = { NOH_FEATURE_NORMAL_MAP, NOH_FEATURE_SURFACE_MAP,   NOH_FEATURE_EMISSIVE,
                                     NOH_FEATURE_WRINKLES,   NOH_FEATURE_WRINKLE_PIXEL, NOH_FEATURE_SPECULAR_MAP,
                                     NOH_FEATURE_TOON_SHADE, NOH_FEATURE_MATCAP,        NOH_FEATURE_COLORS,
                                     NOH_FEATURE_TOON_MASKS };
    unsigned left = NOH_GL_FETCHES_MAX - 2u; /* base colour and environment */
    if (features & NOH_FEATURE_PHONE) return 1u;
    for (size_t i = 0; i < sizeof maps / sizeof maps[0]; i++) left -= (features & maps[i]) != 0;
    return left < 4u ? left : 4u;
}

void noh_gl_variant_defines(noh_gl_variant_key key, char text[NOH_GL_DEFINES_BYTES])
{
    NOH_ASSERT(text && key.influences <= 8u && key.drawn <= key.influences && key.view <= NOH_VIEW_WRINKLE);
    NOH_ASSERT(key.depth || !key.cut);
    const struct {
        unsigned on;
        const char *line;
    } flags[] = { { key.texture, "#define NOH_PALETTE_TEXTURE\n" },
                  { key.dual_quaternion, "#define NOH_DUAL_QUATERNION\n" },
                  { key.texels, "#define NOH_MORPH_TEXELS\n" },
                  { key.uv_targets, "#define NOH_UV_TARGETS\n" },
                  { key.crowd, "#define NOH_CROWD\n" },
                  { key.layers_uint == 1u, "#define NOH_LAYERS_UINT\n" },
                  { key.layers_uint == NOH_LAYERS_STREAMS, "#define NOH_STREAMS\n" },
                  { key.layers_uint == NOH_LAYERS_VERTICES, "#define NOH_VERTICES\n" },
                  { key.layers_uint == NOH_LAYERS_DIRECT, "#define NOH_DIRECT\n" },
                  { key.encode_srgb, "#define NOH_ENCODE_SRGB\n" },
                  { key.fade, "#define NOH_FADE\n" },
                  { key.depth, "#define NOH_DEPTH_ONLY\n" },
                  { key.two_layers, "#define NOH_TWO_LAYERS\n" },
                  { key.cut || key.features & NOH_FEATURE_ALPHA, "#define NOH_ALPHA_CUT\n" },
                  { key.lit, "#define NOH_LIT\n" },
                  { key.lit && key.transfer & NOH_TRANSFER_ON_NORMAL, "#define NOH_TRANSFER_ON_NORMAL\n" },
                  { key.features & NOH_FEATURE_NORMAL_MAP, "#define NOH_NORMAL_MAP\n" },
                  { key.features & NOH_FEATURE_SURFACE_MAP, "#define NOH_SURFACE_MAP\n" },
                  { key.features & NOH_FEATURE_EMISSIVE, "#define NOH_EMISSIVE\n" },
                  { key.features & NOH_FEATURE_SKIN, "#define NOH_SKIN\n" },
                  { key.features & NOH_FEATURE_EYE, "#define NOH_EYE\n" },
                  { key.features & NOH_FEATURE_TEETH, "#define NOH_TEETH\n" },
                  { key.features & NOH_FEATURE_HAIR, "#define NOH_HAIR\n" },
                  { key.features & NOH_FEATURE_TOON, "#define NOH_TOON\n" },
                  { key.features & NOH_FEATURE_TOON_SHADE, "#define NOH_TOON_SHADE\n" },
                  { key.features & NOH_FEATURE_MATCAP, "#define NOH_MATCAP\n" },
                  { key.features & NOH_FEATURE_TOON_MASKS, "#define NOH_TOON_MASKS\n" },
                  { key.features & NOH_FEATURE_OUTLINE, "#define NOH_OUTLINE\n" },
                  { key.features & NOH_FEATURE_SPECULAR_MAP, "#define NOH_SPECULAR_MAP\n" },
                  { key.features & NOH_FEATURE_SPECULAR_ROUGHNESS, "#define NOH_SPECULAR_ROUGHNESS\n" },
                  { key.features & NOH_FEATURE_WRINKLE_PIXEL, "#define NOH_WRINKLE_PIXEL\n" },
                  { key.features & NOH_FEATURE_WRINKLES, "#define NOH_WRINKLES\n" },
                  { key.features & NOH_FEATURE_COLORS, "#define NOH_COLORS\n" },
                  { key.features & NOH_FEATURE_PHONE, "#define NOH_PHONE\n" } };
    size_t at = put_digit(text, 0, "#define NOH_INFLUENCES ", key.influences);
    at = put_digit(text, at, "#define NOH_DRAWN ", key.drawn);
    at = put_digit(text, at, "#define NOH_DEBUG_VIEW ", key.view);
    if (key.lit) {
        at = put_digit(text, at, "#define NOH_SHADOW_TAPS ", key.lit == NOH_LIT_SOFT ? 0 : shadow_taps(key.features));
    }
    at = put_digit(text, at, "#define NOH_TRANSFER ", key.lit ? key.transfer & ~NOH_TRANSFER_ON_NORMAL : 0);
    for (size_t i = 0; i < sizeof flags / sizeof flags[0]; i++) {
        at = put_text(text, at, flags[i].on ? flags[i].line : "");
    }
}

/* The texts after the defines, for compiling and for noh_gl_shader_prefix. */
#define PREFIX_PIECES_MAX 14u
static uint32_t prefix_pieces(GLenum stage, const char *pieces[PREFIX_PIECES_MAX])
{
    static const char precision[] = "precision highp float;\nprecision highp int;\n", own[] = "#line 1 0\n";
    static const char at_vertices[] = "#define NOH_AT_VERTICES\n";
    uint32_t count = 0;
    pieces[count++] = precision;
    if (stage == GL_VERTEX_SHADER) {
        pieces[count++] = at_vertices;
        pieces[count++] = noh_shader_common_environment_glsl;
        pieces[count++] = noh_shader_common_delta_glsl;
        pieces[count++] = noh_shader_common_walk_glsl;
        pieces[count++] = noh_shader_common_layers_glsl;
        pieces[count++] = noh_shader_common_attributes_glsl;
        pieces[count++] = noh_shader_common_skin_glsl;
        pieces[count++] = noh_shader_common_face_glsl;
        pieces[count++] = noh_shader_common_transfer_glsl;
        pieces[count++] = noh_shader_common_complexion_glsl;
        pieces[count++] = noh_shader_common_vertex_glsl;
    } else {
        pieces[count++] = noh_shader_common_fade_glsl;
        pieces[count++] = noh_shader_common_fragment_glsl;
        pieces[count++] = noh_shader_common_wrinkle_glsl;
        pieces[count++] = noh_shader_common_material_glsl;
        pieces[count++] = noh_shader_common_environment_glsl;
        pieces[count++] = noh_shader_common_scatter_glsl;
        pieces[count++] = noh_shader_common_eye_glsl;
        pieces[count++] = noh_shader_common_complexion_glsl;
        pieces[count++] = noh_shader_common_light_glsl;
    }
    pieces[count++] = own;
    return count;
}

/* Append a piece, cut at the end of text[bytes]. Return the offset of its end if uncut. */
static size_t put_piece(char *text, size_t bytes, size_t at, const char *piece)
{
    for (; *piece; piece++, at++) {
        if (at < bytes) {
            text[at] = *piece;
        }
    }
    return at;
}

size_t noh_gl_shader_prefix(noh_gl_variant_key key, GLenum stage, char *text, size_t bytes)
{
    char defines[NOH_GL_DEFINES_BYTES];
    const char *pieces[PREFIX_PIECES_MAX + 1u] = { defines };
    size_t room = 0, at = 0;
    NOH_ASSERT((stage == GL_VERTEX_SHADER || stage == GL_FRAGMENT_SHADER) && (text || !bytes));
    const uint32_t count = 1u + prefix_pieces(stage, pieces + 1);
    noh_gl_variant_defines(key, defines);
    for (int pass = 0; pass < 2; pass++) { /* the first measures */
        room = pass && at < bytes ? bytes : 0;
        at = 0;
        for (uint32_t i = 0; i < count; i++) {
            at = put_piece(text, room, at, pieces[i]);
        }
    }
    if (room) {
        text[at] = 0;
    }
    return at + 1u;
}

/* ---- programs ---- */

/* A stage's text after the key's defines. */
#define SOURCE_PIECES_MAX 16u
typedef struct whole_source {
    noh_gl_source source;
    const char *pieces[SOURCE_PIECES_MAX];
} whole_source;

/* own: NULL for the library's shaders */
static void make_source(whole_source *to, GLenum stage, const noh_gl_source *library, const char *own,
                        const char *defines)
{
    uint32_t count = 0;
    if (defines) {
        to->pieces[count++] = defines;
    }
    count += prefix_pieces(stage, to->pieces + count);
    NOH_ASSERT(count + library->piece_count <= SOURCE_PIECES_MAX);
    for (uint32_t i = 0; i < library->piece_count && !own; i++) {
        to->pieces[count++] = library->pieces[i];
    }
    if (own) {
        to->pieces[count++] = own;
    }
    to->source.version = library->version;
    to->source.pieces = to->pieces;
    to->source.piece_count = count;
}

static void find_uniforms(const noh_gl_api *gl, noh_gl_variant *v)
{
    static const struct {
        const char *name;
        size_t at;
    } uniforms[] = { { "noh_view_projection", offsetof(noh_gl_variant, u_view_projection) },
                     { "noh_world", offsetof(noh_gl_variant, u_world) },
                     { "noh_normal", offsetof(noh_gl_variant, u_normal) },
                     { "noh_uv", offsetof(noh_gl_variant, u_uv) },
                     { "noh_morph", offsetof(noh_gl_variant, u_morph) },
                     { "noh_streams", offsetof(noh_gl_variant, u_streams) },
                     { "noh_skin", offsetof(noh_gl_variant, u_skin) },
                     { "noh_camera", offsetof(noh_gl_variant, u_camera) },
                     { "noh_key", offsetof(noh_gl_variant, u_key) },
                     { "noh_base_color", offsetof(noh_gl_variant, u_base_color) },
                     { "noh_material", offsetof(noh_gl_variant, u_material) },
                     { "noh_bounds_min", offsetof(noh_gl_variant, u_bounds_min) },
                     { "noh_bounds_size", offsetof(noh_gl_variant, u_bounds_size) },
                     { "noh_lod", offsetof(noh_gl_variant, u_lod) },
                     { "noh_blends", offsetof(noh_gl_variant, u_blends) },
                     { "noh_f0", offsetof(noh_gl_variant, u_f0) },
                     { "noh_f90", offsetof(noh_gl_variant, u_f90) },
                     { "noh_emissive", offsetof(noh_gl_variant, u_emissive) },
                     { "noh_maps", offsetof(noh_gl_variant, u_maps) },
                     { "noh_surface_values", offsetof(noh_gl_variant, u_surface_values) },
                     { "noh_surface_more", offsetof(noh_gl_variant, u_surface_more) },
                     { "noh_user_values", offsetof(noh_gl_variant, u_user) },
                     { "noh_before", offsetof(noh_gl_variant, u_before) },
                     { "noh_extras", offsetof(noh_gl_variant, u_extras) },
                     { "noh_lighting", offsetof(noh_gl_variant, u_lighting) },
                     { "noh_rest", offsetof(noh_gl_variant, u_rest) },
                     { "noh_center", offsetof(noh_gl_variant, u_center) },
                     { "noh_wrinkle_regions", offsetof(noh_gl_variant, u_wrinkle_regions) },
                     { "noh_wrinkle_models", offsetof(noh_gl_variant, u_wrinkle_models) },
                     { "noh_colors", offsetof(noh_gl_variant, u_colors) } };
    for (size_t i = 0; i < sizeof uniforms / sizeof uniforms[0]; i++) {
        const GLint at = gl->GetUniformLocation(v->program, uniforms[i].name);
        memcpy((char *)v + uniforms[i].at, &at, sizeof at);
    }
}

/* List the attributes of vertex arrays, the game's and the meshes' (low_gl.h), and return their number. Attributes
 * that a mesh lacks are constants of the same kind. */
#define INPUTS_MAX (16u + NOH_GL_OWN_INPUTS_MAX)
static uint32_t list_inputs(const noh_gl_variant_key *key, const noh_gl_shader_desc *own,
                            noh_gl_input inputs[INPUTS_MAX])
{
    static const noh_gl_input of_meshes[] = {
        { NOH_ATTRIBUTE_POSITION, GL_FLOAT_VEC3 },
        { NOH_ATTRIBUTE_NORMAL, GL_INT_VEC2 },
        { NOH_ATTRIBUTE_TANGENT, GL_INT_VEC2 },
        { NOH_ATTRIBUTE_UV, GL_FLOAT_VEC2 },
        { NOH_ATTRIBUTE_COLOR, GL_FLOAT_VEC4 },
        { NOH_ATTRIBUTE_TEXEL, GL_UNSIGNED_INT },
        { NOH_ATTRIBUTE_LOBE, GL_INT_VEC4 },
        { NOH_ATTRIBUTE_MORE_LOBE, GL_INT_VEC4 },
        { NOH_ATTRIBUTE_STREAMS + 2u, GL_UNSIGNED_INT_VEC3 },
        { NOH_ATTRIBUTE_STREAMS + 3u, GL_UNSIGNED_INT_VEC3 },
        { NOH_ATTRIBUTE_MORE_EXTRA, GL_INT_VEC4 }, /* or NOH_ATTRIBUTE_UV_TEXEL */
    };
    static const noh_gl_input shared[2][2] = {
        { { NOH_ATTRIBUTE_REST, GL_FLOAT_VEC3 }, { NOH_ATTRIBUTE_REST_NORMAL, GL_INT_VEC2 } },
        { { NOH_ATTRIBUTE_STREAMS, GL_UNSIGNED_INT_VEC3 }, { NOH_ATTRIBUTE_STREAMS + 1u, GL_UNSIGNED_INT_VEC3 } }
    };
    static const GLenum words[] = { GL_UNSIGNED_INT, GL_UNSIGNED_INT, GL_UNSIGNED_INT_VEC2, GL_UNSIGNED_INT_VEC3,
                                    GL_UNSIGNED_INT_VEC4 };
    const uint32_t influences = key->influences, word_count = NOH_INFLUENCE_WORDS(influences);
    uint32_t count = own->input_count + (uint32_t)(sizeof of_meshes / sizeof of_meshes[0]);
    for (uint32_t i = 0; i < own->input_count; i++) inputs[i] = own->inputs[i];
    memcpy(inputs + own->input_count, of_meshes, sizeof of_meshes);
    if (own->defines && noh_name_has(own->defines, "nohextras")) {
        inputs[count++] = (noh_gl_input){ NOH_ATTRIBUTE_EXTRA, GL_INT_VEC4 };
    }
    for (int i = 0; i < 2; i++) inputs[count++] = shared[key->layers_uint == NOH_LAYERS_STREAMS][i];
    if (influences)
        inputs[count++] = (noh_gl_input){ NOH_ATTRIBUTE_INFLUENCES, words[word_count < 4u ? word_count : 4u] };
    if (word_count > 4u) inputs[count++] = (noh_gl_input){ NOH_ATTRIBUTE_MORE_INFLUENCES, GL_UNSIGNED_INT_VEC3 };
    return count;
}

static noh_result create_program(const noh_gl_device *device, const noh_gl_variant *v, const noh_gl_shader_desc *own,
                                 noh_gl_program_desc *desc, GLuint *program, noh_error *error)
{
    static const char *const blocks[] = { "noh_palette_block" };
    const char *samplers[NOH_UNIT_USER + NOH_GL_OWN_SAMPLERS_MAX] = { "noh_layers",
                                                                      "noh_base_color_texture",
                                                                      "noh_palettes",
                                                                      "noh_normal_texture",
                                                                      "noh_surface_texture",
                                                                      "noh_emissive_texture",
                                                                      "noh_wrinkle_texture",
                                                                      "noh_wrinkle_weights_0",
                                                                      "noh_wrinkle_weights_1",
                                                                      "noh_wrinkle_weights_2",
                                                                      "noh_shadow_map",
                                                                      "noh_environment",
                                                                      "noh_specular_texture",
                                                                      "noh_lists",
                                                                      "noh_starts",
                                                                      "noh_color_texture" };
    char defines[NOH_GL_DEFINES_BYTES];
    whole_source vertex, fragment;
    noh_gl_input inputs[INPUTS_MAX];
    if (v->key.layers_uint == NOH_LAYERS_DIRECT) samplers[NOH_UNIT_LAYERS] = "noh_deltas";
    noh_gl_variant_defines(v->key, defines);
    make_source(&vertex, GL_VERTEX_SHADER, &noh_shader_mesh_vert, own->vertex, own->defines);
    make_source(&fragment, GL_FRAGMENT_SHADER, &noh_shader_mesh_frag, own->fragment, own->defines);
    for (uint32_t i = 0; i < own->sampler_count; i++) {
        samplers[NOH_UNIT_USER + i] = own->samplers[i];
    }
    desc->name = own->name ? own->name : "mesh";
    desc->vertex = &vertex.source;
    desc->fragment = &fragment.source;
    desc->defines = defines;
    desc->samplers = samplers;
    desc->sampler_count = NOH_UNIT_USER + own->sampler_count;
    desc->blocks = blocks;
    desc->block_count = 1;
    desc->inputs = inputs;
    desc->input_count = list_inputs(&v->key, own, inputs);
    desc->ledger = device->ledger;
    return noh_gl_program_create(device->api, desc, program, device->log, device->log_bytes, error);
}

static void tell_made(const noh_gl_api *api, const noh_gl_shader_desc *own, const noh_gl_variant *v)
{
    api->UseProgram(v->program);
    own->made(own->user, api, v->program, v->key);
    api->UseProgram(0);
}

noh_result noh_gl_variant_create(const noh_gl_device *device, noh_gl_variant_key key, const noh_gl_shader_desc *own,
                                 const char *const *varyings, uint32_t varying_count, noh_gl_variant *out,
                                 noh_error *error)
{
    static const noh_gl_shader_desc library = { .view = NOH_VIEW_LIT };
    noh_gl_variant v;
    noh_gl_program_desc desc;
    noh_result result;
    NOH_ASSERT(device && device->api && out && (varyings || !varying_count));
    own = own ? own : &library;
    if (own->sampler_count > NOH_GL_OWN_SAMPLERS_MAX) {
        return noh_fail(error, NOH_ERR_LIMIT, "shader desc: sampler_count is above NOH_GL_OWN_SAMPLERS_MAX",
                        NOH_GL_OWN_SAMPLERS_MAX, own->sampler_count);
    }
    if (own->input_count > NOH_GL_OWN_INPUTS_MAX) {
        return noh_fail(error, NOH_ERR_LIMIT, "shader desc: input_count is above NOH_GL_OWN_INPUTS_MAX",
                        NOH_GL_OWN_INPUTS_MAX, own->input_count);
    }
    memset(&v, 0, sizeof v);
    memset(&desc, 0, sizeof desc);
    v.key = key;
    desc.varyings = varyings;
    desc.varying_count = varying_count;
    result = create_program(device, &v, own, &desc, &v.program, error);
    if (!result) {
        find_uniforms(device->api, &v);
        if (own->made) tell_made(device->api, own, &v);
        result = noh_gl_error_check(device->api, "the driver refused to return the uniforms of a shader variant", 0,
                                    error);
        if (result)
            noh_gl_variant_delete(device->api, device->ledger, &v);
        else
            *out = v;
    }
    return result;
}

void noh_gl_variant_delete(const noh_gl_api *api, noh_gl_ledger *ledger, noh_gl_variant *variant)
{
    NOH_ASSERT(api && variant);
    noh_gl_program_delete(api, ledger, &variant->program);
}

void noh_gl_variant_skin(const noh_gl_api *api, const noh_gl_variant *variant, const noh_mesh *mesh,
                         const noh_gl_skin_binding *skin, uint32_t palette)
{
    NOH_ASSERT(variant->key.texture == (skin->mode == NOH_PALETTE_TEXTURE) || !variant->key.influences);
    uint32_t row = mesh->header->palette_count ? noh_gl_palette_row(skin, mesh, palette) : 0;
    NOH_ASSERT(palette < mesh->header->palette_count || !palette);
    if (variant->key.texture) {
        api->ActiveTexture(GL_TEXTURE0 + NOH_UNIT_PALETTES);
        api->BindTexture(GL_TEXTURE_2D, skin->name);
        api->Uniform4i(variant->u_skin, (GLint)skin->first, (GLint)skin->stride, (GLint)skin->width_log2, (GLint)row);
    } else if (variant->key.influences) {
        api->BindBufferRange(GL_UNIFORM_BUFFER, 0, skin->name, (GLintptr)(skin->first + row) * 16,
                             (GLsizeiptr)(16u * noh_gl_joint_rows(mesh) * NOH_PALETTE_JOINTS_MAX));
    }
}
