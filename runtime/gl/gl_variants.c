/* gl_variants.c: from a mesh and its bindings to a key, from a key to its defines, from the defines to a program. */
#include "gl/gl_variants.h"

#include <string.h>

#include "gl/gl_program.h"
#include "shaders.gen.h"

/* The largest of 1, 2, 4, 8 that is at most `limit` and at most `stored`; limit 0: all that are stored. */
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
    noh_gl_variant_key key = { 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 };
    NOH_ASSERT((unsigned)view <= NOH_VIEW_LOD);
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
    key.layers_uint = layers_uint != 0;
    key.view = (uint8_t)view;
    return key;
}

/* ---- the text of the defines ---- */

/* All defines together take 214 bytes, so NOH_GL_DEFINES_BYTES never cuts them. */
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

void noh_gl_variant_defines(noh_gl_variant_key key, char text[NOH_GL_DEFINES_BYTES])
{
    NOH_ASSERT(text && key.influences <= 8u && key.drawn <= key.influences && key.view <= NOH_VIEW_LOD);
    const struct {
        int on;
        const char *line;
    } flags[] = { { key.texture, "#define PALETTE_TEXTURE\n" },
                  { key.dual_quaternion, "#define DUAL_QUATERNION\n" },
                  { key.texels, "#define MORPH_TEXELS\n" },
                  { key.crowd, "#define CROWD\n" },
                  { key.layers_uint, "#define LAYERS_UINT\n" },
                  { key.encode_srgb, "#define ENCODE_SRGB\n" },
                  { key.fade, "#define FADE\n" } };
    size_t at = put_digit(text, 0, "#define INFLUENCES ", key.influences);
    at = put_digit(text, at, "#define DRAWN ", key.drawn);
    at = put_digit(text, at, "#define DEBUG_VIEW ", key.view);
    for (size_t i = 0; i < sizeof flags / sizeof flags[0]; i++) {
        at = put_text(text, at, flags[i].on ? flags[i].line : "");
    }
}

/* ---- programs ---- */

static void find_uniforms(const noh_gl_api *gl, noh_gl_variant *v)
{
    const struct {
        const char *name;
        GLint *at;
    } uniforms[] = { { "u_view_projection", &v->u_view_projection },
                     { "u_world", &v->u_world },
                     { "u_normal", &v->u_normal },
                     { "u_uv", &v->u_uv },
                     { "u_morph", &v->u_morph },
                     { "u_skin", &v->u_skin },
                     { "u_camera", &v->u_camera },
                     { "u_key", &v->u_key },
                     { "u_base_color", &v->u_base_color },
                     { "u_material", &v->u_material },
                     { "u_bounds_min", &v->u_bounds_min },
                     { "u_bounds_size", &v->u_bounds_size },
                     { "u_lod", &v->u_lod } };
    for (size_t i = 0; i < sizeof uniforms / sizeof uniforms[0]; i++) {
        *uniforms[i].at = gl->GetUniformLocation(v->program, uniforms[i].name);
    }
}

noh_result noh_gl_variant_create(const noh_gl_device *device, noh_gl_variant_key key, const char *const *varyings,
                                 uint32_t varying_count, noh_gl_variant *out, noh_error *error)
{
    static const char *const samplers[] = { "u_layers", "u_base_color_texture", "u_palettes" };
    static const char *const blocks[] = { "palette_block" };
    char defines[NOH_GL_DEFINES_BYTES];
    noh_gl_variant v;
    noh_gl_program_desc desc;
    noh_result result;
    NOH_ASSERT(device && device->api && out && (varyings || !varying_count));
    memset(&v, 0, sizeof v);
    memset(&desc, 0, sizeof desc);
    noh_gl_variant_defines(key, defines);
    desc.name = "mesh";
    desc.vertex = &noh_shader_mesh_vert;
    desc.fragment = &noh_shader_mesh_frag;
    desc.defines = defines;
    desc.samplers = samplers;
    desc.sampler_count = 3;
    desc.blocks = blocks;
    desc.block_count = 1;
    desc.varyings = varyings;
    desc.varying_count = varying_count;
    desc.ledger = device->ledger;
    result = noh_gl_program_create(device->api, &desc, &v.program, device->log, device->log_bytes, error);
    if (!result) {
        v.key = key;
        find_uniforms(device->api, &v);
        result = noh_gl_error_check(device->api, "the driver refuses to tell a shader variant's uniforms", 0, error);
        if (result) {
            noh_gl_variant_delete(device->api, device->ledger, &v);
        } else {
            *out = v;
        }
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
    uint32_t row = mesh->header->palette_count ? noh_gl_palette_row(skin, mesh, palette) : 0;
    NOH_ASSERT(palette < mesh->header->palette_count || !palette);
    NOH_ASSERT(variant->key.texture == (skin->mode == NOH_PALETTE_TEXTURE) || !variant->key.influences);
    if (variant->key.texture) {
        api->ActiveTexture(GL_TEXTURE0 + NOH_UNIT_PALETTES);
        api->BindTexture(GL_TEXTURE_2D, skin->name);
        api->Uniform4i(variant->u_skin, (GLint)skin->first, (GLint)skin->stride, (GLint)skin->width_log2, (GLint)row);
    } else if (variant->key.influences) {
        api->BindBufferRange(GL_UNIFORM_BUFFER, 0, skin->name, (GLintptr)(skin->first + row) * 16,
                             (GLsizeiptr)(16u * noh_gl_joint_rows(mesh) * NOH_PALETTE_JOINTS_MAX));
    }
}
