/* texts.c: writes the text of every kind of program to FOLDER/NAME.{vert,geom,frag}, and prints the names. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"
#include "shaders.gen.h"

#define GL_FRAGMENT_SHADER 0x8B30u
#define GL_VERTEX_SHADER 0x8B31u
#define PREFIX_BYTES (256u << 10)
#define NAME_BYTES 96u

static const char *folder;

static FILE *open_text(const char *name, const char *stage)
{
    char path[512];
    snprintf(path, sizeof path, "%s/%s.%s", folder, name, stage);
    FILE *out = fopen(path, "wb");
    if (!out) {
        perror(path);
        exit(1);
    }
    return out;
}

static void put(const char *name, const char *stage, const char *version, const char *before, const noh_gl_source *s)
{
    FILE *out = open_text(name, stage);
    fputs(version ? version : s->version, out);
    fputs(before, out);
    for (uint32_t i = 0; i < s->piece_count; i++) fputs(s->pieces[i], out);
    if (fclose(out)) exit(1);
}

/* ---- meshes ---- */

static void put_mesh(const char *name, noh_gl_variant_key key)
{
    static char prefix[PREFIX_BYTES];
    noh_gl_shader_prefix(key, GL_VERTEX_SHADER, prefix, sizeof prefix);
    put(name, "vert", NULL, prefix, &noh_shader_mesh_vert);
    noh_gl_shader_prefix(key, GL_FRAGMENT_SHADER, prefix, sizeof prefix);
    put(name, "frag", NULL, prefix, &noh_shader_mesh_frag);
    puts(name);
}

#define NORMAL_AND_SURFACE (NOH_FEATURE_NORMAL_MAP | NOH_FEATURE_SURFACE_MAP)
#define ALL_MAPS (NORMAL_AND_SURFACE | NOH_FEATURE_EMISSIVE | NOH_FEATURE_SPECULAR_MAP | NOH_FEATURE_ALPHA)

#define COUNT(array) (sizeof(array) / sizeof *(array))

/* Fragment shaders, on a rigid mesh: surfaces by maps and by light, in both tiers. */
static void put_surfaces(void)
{
    enum { UNLIT = 1, LIT = 2, TRANSFER = 4, PHONE_UNLIT = 8, PHONE_LIT = 16, PHONE_TRANSFER = 32, SOFT = 64 };
    enum { PHONE_SOFT = 128 };
    static const struct {
        const char *name;
        uint32_t features;
        unsigned lights;
    } surfaces[] = {
        { "plain", 0, UNLIT | LIT | TRANSFER | PHONE_UNLIT | PHONE_LIT | SOFT | PHONE_SOFT },
        { "plain-alpha", NOH_FEATURE_ALPHA, LIT | PHONE_LIT },
        { "plain-maps", NORMAL_AND_SURFACE, UNLIT | LIT | PHONE_LIT },
        { "plain-all", ALL_MAPS, LIT | PHONE_LIT },
        { "skin", NOH_FEATURE_SKIN,
          UNLIT | LIT | TRANSFER | PHONE_UNLIT | PHONE_LIT | PHONE_TRANSFER | SOFT | PHONE_SOFT },
        { "skin-maps", NOH_FEATURE_SKIN | NORMAL_AND_SURFACE, LIT | PHONE_LIT | SOFT | PHONE_SOFT },
        { "skin-wrinkles", NOH_FEATURE_SKIN | NORMAL_AND_SURFACE | NOH_FEATURE_WRINKLES, LIT | PHONE_LIT },
        { "skin-codes", NOH_FEATURE_SKIN | NORMAL_AND_SURFACE | NOH_FEATURE_WRINKLES | NOH_FEATURE_WRINKLE_PIXEL, LIT },
        { "eye", NOH_FEATURE_EYE, UNLIT | LIT | TRANSFER | PHONE_LIT },
        { "teeth", NOH_FEATURE_TEETH, LIT | PHONE_LIT },
        { "toon", NOH_FEATURE_TOON, UNLIT | LIT },
        { "cards", NOH_FEATURE_HAIR | NOH_FEATURE_ALPHA, LIT | PHONE_LIT },
    };
    static const struct {
        const char *name;
        uint32_t features;
        uint8_t lit, transfer;
    } lights[] = { { "unlit", 0, 0, 0 },
                   { "lit", 0, 1, 0 },
                   { "transfer", 0, 1, 4 },
                   { "unlit-phone", NOH_FEATURE_PHONE, 0, 0 },
                   { "lit-phone", NOH_FEATURE_PHONE, 1, 0 },
                   { "transfer-phone", NOH_FEATURE_PHONE, 1, 4 },
                   { "soft", 0, NOH_LIT_SOFT, 0 },
                   { "soft-phone", NOH_FEATURE_PHONE, NOH_LIT_SOFT, 0 } };
    for (size_t s = 0; s < COUNT(surfaces); s++) {
        for (unsigned i = 0; i < COUNT(lights); i++) {
            const uint32_t features = (surfaces[s].features | lights[i].features);
            const noh_gl_variant_key key = { .features = features,
                                             .two_layers = !(features & NOH_FEATURE_NORMAL_MAP),
                                             .lit = lights[i].lit,
                                             .transfer = lights[i].transfer };
            char name[NAME_BYTES];
            if (!(surfaces[s].lights >> i & 1u)) continue;
            snprintf(name, sizeof name, "%s-%s", surfaces[s].name, lights[i].name);
            put_mesh(name, key);
        }
    }
}

/* Vertex shaders: ways to morph, joints and depth, under a fragment shader that only reads what they write. */
static void put_vertices(void)
{
    static const char *const lines[] = {
        "precision highp float;\n"
        "in vec3 v_world;\nin vec3 v_normal;\nin vec2 v_uv;\nin vec4 v_color;\n"
        "out vec4 o_color;\n"
        "void main()\n{\n    o_color = v_color * vec4(v_world + v_normal, v_uv);\n}\n"
    };
    static const noh_gl_source reads = { "#version 300 es\n", lines, 1 };
    static const struct {
        const char *name;
        noh_gl_variant_key key;
    } rows[] = { { "v-rigid", { .two_layers = 1 } },
                 { "v-three-layers", { .layers_uint = 0 } },
                 { "v-streams", { .two_layers = 1, .layers_uint = NOH_LAYERS_STREAMS } },
                 { "v-vertices", { .two_layers = 1, .layers_uint = NOH_LAYERS_VERTICES } },
                 { "v-direct", { .two_layers = 1, .layers_uint = NOH_LAYERS_DIRECT } },
                 { "v-uv-targets", { .two_layers = 1, .uv_targets = 1, .texels = 1 } },
                 { "v-block-1", { .two_layers = 1, .influences = 1, .drawn = 1 } },
                 { "v-block-4", { .two_layers = 1, .influences = 4, .drawn = 4 } },
                 { "v-block-8", { .two_layers = 1, .influences = 8, .drawn = 8 } },
                 { "v-block-4-dual", { .two_layers = 1, .influences = 4, .drawn = 4, .dual_quaternion = 1 } },
                 { "v-texture-4", { .two_layers = 1, .influences = 4, .drawn = 4, .texture = 1 } },
                 { "v-crowd-4", { .two_layers = 1, .influences = 4, .drawn = 4, .texture = 1, .crowd = 1 } },
                 { "v-depth-block-4", { .depth = 1, .influences = 4, .drawn = 4 } },
                 { "v-depth-crowd-4", { .depth = 1, .influences = 4, .drawn = 4, .texture = 1, .crowd = 1 } },
                 { "v-depth-cut-fade", { .depth = 1, .cut = 1, .fade = 1 } } };
    for (size_t i = 0; i < COUNT(rows); i++) {
        put_mesh(rows[i].name, rows[i].key);
        if (!rows[i].key.depth) put(rows[i].name, "frag", NULL, "", &reads);
    }
}

/* All features at once, where a compiler runs out of registers first. */
static void put_corners(void)
{
    static const struct {
        const char *name;
        uint16_t surface;
        uint8_t layers_uint, crowd;
    } corners[] = { { "x-plain-layers", 0, 0, 0 },
                    { "x-skin-layers", NOH_FEATURE_SKIN, 0, 0 },
                    { "x-eye-layers", NOH_FEATURE_EYE, 0, 0 },
                    { "x-teeth-layers", NOH_FEATURE_TEETH, 0, 0 },
                    { "x-skin-streams", NOH_FEATURE_SKIN, NOH_LAYERS_STREAMS, 0 },
                    { "x-skin-layers-crowd", NOH_FEATURE_SKIN, 0, 1 },
                    { "x-skin-direct-crowd", NOH_FEATURE_SKIN, NOH_LAYERS_DIRECT, 1 },
                    { "x-eye-layers-crowd", NOH_FEATURE_EYE, 0, 1 },
                    { "x-eye-direct-crowd", NOH_FEATURE_EYE, NOH_LAYERS_DIRECT, 1 } };
    for (size_t i = 0; i < COUNT(corners); i++) {
        const uint8_t crowd = corners[i].crowd;
        /* As many maps as a material may have. */
        const uint16_t more = crowd ? NOH_FEATURE_SPECULAR_MAP : NOH_FEATURE_WRINKLE_PIXEL;
        const uint32_t features = (corners[i].surface | NORMAL_AND_SURFACE | NOH_FEATURE_EMISSIVE | NOH_FEATURE_ALPHA |
                                   NOH_FEATURE_WRINKLES | more);
        const noh_gl_variant_key key = { .influences = 8,
                                         .drawn = 8,
                                         .dual_quaternion = crowd,
                                         .texture = crowd,
                                         .crowd = crowd,
                                         .texels = 1,
                                         .uv_targets = corners[i].layers_uint != NOH_LAYERS_STREAMS,
                                         .layers_uint = corners[i].layers_uint,
                                         .fade = 1,
                                         .encode_srgb = 1,
                                         .lit = 1,
                                         .transfer = 6,
                                         .features = features };
        put_mesh(corners[i].name, key);
    }
}

/* Figures of a crowd as most are: four joints, folds, and light by transfer. */
static void put_crowds(void)
{
    static const struct {
        const char *name;
        uint16_t surface;
        uint8_t layers_uint;
    } rows[] = { { "crowd-skin", NOH_FEATURE_SKIN, 0 },
                 { "crowd-skin-direct", NOH_FEATURE_SKIN, NOH_LAYERS_DIRECT },
                 { "crowd-eye", NOH_FEATURE_EYE, 0 } };
    for (size_t i = 0; i < COUNT(rows); i++) {
        const noh_gl_variant_key key = { .influences = 4,
                                         .drawn = 4,
                                         .texture = 1,
                                         .crowd = 1,
                                         .texels = 1,
                                         .layers_uint = rows[i].layers_uint,
                                         .lit = 1,
                                         .transfer = 4,
                                         .features = (uint32_t)rows[i].surface | NORMAL_AND_SURFACE |
                                                     NOH_FEATURE_WRINKLES };
        put_mesh(rows[i].name, key);
    }
}

/* ---- the others ---- */

static void put_drawables(void)
{
    static const struct {
        const char *name, *defines;
        const noh_gl_source *vertex, *fragment;
    } all[] = { { "backdrop", "#define NOH_LIT\n", &noh_shader_backdrop_vert, &noh_shader_backdrop_frag },
                { "floor", "#define NOH_LIT\n", &noh_shader_floor_vert, &noh_shader_floor_frag },
                { "hair-lit", "#define NOH_LIT\n", &noh_shader_hair_vert, &noh_shader_hair_frag },
                { "terrain-lit", "#define NOH_LIT\n", &noh_shader_terrain_vert, &noh_shader_terrain_frag } };
    for (size_t i = 0; i < COUNT(all); i++) {
        static char before[PREFIX_BYTES];
        snprintf(before, sizeof before, "precision highp float;\nprecision highp int;\n%s%s%s%s", all[i].defines,
                 noh_gl_shader_text("common_fade.glsl"), noh_gl_shader_text("common_fragment.glsl"),
                 noh_gl_shader_text("common_environment.glsl"));
        put(all[i].name, "vert", NULL, all[i].defines, all[i].vertex);
        put(all[i].name, "frag", NULL, before, all[i].fragment);
        puts(all[i].name);
    }
    put("soft-shadow", "vert", NULL, "", &noh_shader_probe_triangle_vert);
    put("soft-shadow", "frag", NULL, "", &noh_shader_shadow_blur_frag);
    puts("soft-shadow");
    put("blob", "vert", NULL, "#define NOH_BLOBS_DRAWN 16\n", &noh_shader_blob_vert);
    put("blob", "frag", NULL, "", &noh_shader_blob_frag);
    puts("blob");
}

static void put_passes(void)
{
    static const struct {
        const char *name, *version, *defines, *gather;
    } layers[] = { { "3", NULL, "", "" },
                   { "2", NULL, "#define TWO_LAYERS\n", "#define NOH_TWO_LAYERS\n" },
                   { "2-occlusion", NULL, "#define TWO_LAYERS\n#define OCCLUSION\n",
                     "#define NOH_TWO_LAYERS\n#define NOH_OCCLUSION\n" } };
    static const char es32[] = "#version 320 es\n";
    char name[NAME_BYTES], defines[256];
    for (size_t i = 0; i < COUNT(layers); i++) {
        snprintf(name, sizeof name, "m-gather-%s", layers[i].name);
        put(name, "vert", NULL, layers[i].gather, &noh_shader_morph_gather_vert);
        put(name, "frag", NULL, layers[i].gather, &noh_shader_morph_gather_frag);
        puts(name);
        snprintf(name, sizeof name, "m-mrt-%s", layers[i].name);
        snprintf(defines, sizeof defines, "#define MORPH_MRT\n%s", layers[i].defines);
        put(name, "vert", NULL, defines, &noh_shader_morph_block_vert);
        put(name, "frag", NULL, defines, &noh_shader_morph_mrt_frag);
        puts(name);
        snprintf(name, sizeof name, "m-layered-%s", layers[i].name);
        snprintf(defines, sizeof defines, "#define MORPH_LAYERED\n%s", layers[i].defines);
        put(name, "vert", es32, defines, &noh_shader_morph_block_vert);
        put(name, "geom", es32, defines, &noh_shader_morph_layered_geom);
        put(name, "frag", es32, defines, &noh_shader_morph_one_frag);
        puts(name);
    }
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: texts FOLDER\n");
        return 2;
    }
    folder = argv[1];
    put_surfaces();
    put_vertices();
    put_corners();
    put_crowds();
    put_drawables();
    put_passes();
    return fflush(stdout) ? 1 : 0;
}
