#include "info/info_materials.h"

#include <stdio.h>

#include "convert/texture/texture_blocks.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/low_gl.h"
#include "noh/pack.h"

#define MAPS 10u
#define SPECULAR (NOH_MATERIAL_SPECULAR_WEIGHT | NOH_MATERIAL_SPECULAR_ROUGHNESS)

typedef struct material_map {
    const char *name, *key;
    uint32_t texture;
} material_map;

/* The map of a material that targets colour, or NOH_NONE. */
static uint32_t color_map_of(const noh_pack *pack, const noh_material *m)
{
    for (uint32_t i = 0; i < pack->runs[NOH_CHUNK_WRINKLES].count; i++) {
        const noh_wrinkles_header *h = noh_pack_chunk_at(pack, NOH_CHUNK_WRINKLES, i);
        if (h->colors_offset && m == &pack->materials[h->color_material]) return h->color_texture;
    }
    return NOH_NONE;
}

static void list_maps(const noh_pack *pack, const noh_material *m, material_map maps[MAPS])
{
    const material_map all[MAPS] = { { "base colour", "base_color", m->base_color_texture },
                                     { "normal", "normal", m->normal_texture },
                                     { "occlusion, roughness, metallic", "surface", m->surface_texture },
                                     { "emissive", "emissive", m->emissive_texture },
                                     { m->flags & NOH_MATERIAL_SPECULAR_ROUGHNESS ? "specular colour, roughness"
                                                                                  : "specular colour, weight",
                                       "specular", m->flags & SPECULAR ? m->specular_texture : NOH_NONE },
                                     { "wrinkles", "wrinkle", m->wrinkle_texture },
                                     { "wrinkle weights 1-4", "wrinkle_weights_0", m->more_textures[0] },
                                     { "wrinkle weights 5-8", "wrinkle_weights_1", m->more_textures[1] },
                                     { "wrinkle weights 9-12", "wrinkle_weights_2", m->more_textures[2] },
                                     { "colours by target", "colors", color_map_of(pack, m) } };
    const material_map codes = { "wrinkle regions by pixel", "wrinkle_regions", m->more_textures[0] };
    const material_map toon[] = { { "shade", "shade", m->more_textures[NOH_TOON_SHADE] },
                                  { "matcap", "matcap", m->more_textures[NOH_TOON_MATCAP] },
                                  { m->flags & NOH_MATERIAL_TOON_MASKS ? "shift, outline width, rim" : "outline width",
                                    "outline_width", m->more_textures[NOH_TOON_WIDTH] } };
    for (uint32_t i = 0; i < MAPS; i++) maps[i] = all[i];
    if (m->flags & NOH_MATERIAL_WRINKLE_CODES) maps[6] = codes;
    for (uint32_t i = 0; i < 3 && m->surface == NOH_SURFACE_TOON; i++) maps[6 + i] = toon[i];
}

static const char *alpha_of(const noh_material *m)
{
    return m->flags & NOH_MATERIAL_BLEND ? "blend" : m->flags & NOH_MATERIAL_MASK ? "mask" : "opaque";
}

static const char *surface_of(const noh_material *m)
{
    static const char *const names[] = { "plain", "skin", "eye", "teeth", "toon", "hair" };
    return names[m->surface];
}

void info_print_materials(const noh_pack *pack)
{
    for (uint32_t i = 0; i < pack->material_count; i++) {
        const noh_material *m = &pack->materials[i];
        material_map maps[MAPS];
        list_maps(pack, m, maps);
        printf("material '%s': %s, %s%s%s", noh_pack_string(pack, m->name), surface_of(m), alpha_of(m),
               m->flags & NOH_MATERIAL_DOUBLE_SIDED ? ", two-sided" : "",
               m->flags & NOH_MATERIAL_UNLIT ? ", unlit" : "");
        if (m->flags & NOH_MATERIAL_UNTINTED) printf(", without tint");
        if (m->priority) printf(", priority %d", (int)m->priority);
        for (uint32_t k = 0; k < MAPS; k++) {
            if (maps[k].texture != NOH_NONE)
                printf(", %s '%s'", maps[k].name,
                       noh_pack_chunk_name(pack, pack->runs[NOH_CHUNK_TEXTURE].first + maps[k].texture));
        }
        printf("\n");
    }
}

/* A pixel reads the base colour, a white texel where there is none, and a map for each feature; weights of wrinkles are
 * read at vertices, a mask of their regions and a toon's shade and matcap at pixels. Lit, it reads the environment and
 * up to four texels of the shadow map, too. */
typedef struct material_cost {
    uint32_t textures, fetches, lit;
    uint64_t bytes;
} material_cost;

static material_cost cost_of(const noh_pack *pack, const noh_material *m)
{
    const uint32_t last = m->flags & NOH_MATERIAL_TOON_MASKS      ? 8u
                          : m->surface == NOH_SURFACE_TOON        ? 7u
                          : m->flags & NOH_MATERIAL_WRINKLE_CODES ? 6u
                                                                  : 5u;
    material_cost cost = { 0, 1, 0, 0 };
    material_map maps[MAPS];
    list_maps(pack, m, maps);
    for (uint32_t k = 0; k < MAPS; k++) {
        noh_texture t;
        if (maps[k].texture == NOH_NONE) continue;
        (void)noh_pack_texture_at(pack, maps[k].texture, &t, NULL);
        cost.bytes += noh_gl_picture_bytes(&t, 1);
        cost.textures++;
        cost.fetches += ((k >= 1 && k <= last) || k == MAPS - 1u) && !(m->flags & NOH_MATERIAL_UNLIT);
    }
    cost.lit = cost.fetches + 5u < NOH_GL_FETCHES_MAX ? cost.fetches + 5u : NOH_GL_FETCHES_MAX;
    if (m->flags & NOH_MATERIAL_UNLIT) cost.lit = cost.fetches;
    return cost;
}

void info_print_costs(const noh_pack *pack)
{
    for (uint32_t i = 0; i < pack->material_count; i++) {
        const noh_material *m = &pack->materials[i];
        const material_cost c = cost_of(pack, m);
        printf(
            "material '%s': %s, %u texture%s of %llu bytes, a pixel makes %u fetch%s, %u under a light with a shadow\n",
            noh_pack_string(pack, m->name), surface_of(m), c.textures, c.textures == 1 ? "" : "s",
            (unsigned long long)c.bytes, c.fetches, c.fetches == 1 ? "" : "es", c.lit);
    }
}

void info_json_costs(json *j, const noh_pack *pack)
{
    json_open(j, "material_costs", '[');
    for (uint32_t i = 0; i < pack->material_count; i++) {
        const material_cost c = cost_of(pack, &pack->materials[i]);
        json_open(j, NULL, '{');
        json_text(j, "name", noh_pack_string(pack, pack->materials[i].name));
        json_integer(j, "textures", c.textures);
        json_integer(j, "gpu_bytes", c.bytes);
        json_integer(j, "fetches", c.fetches);
        json_integer(j, "fetches_lit", c.lit);
        json_close(j, '}');
    }
    json_close(j, ']');
}

void info_print_textures(const noh_pack *pack)
{
    for (uint32_t i = 0; i < pack->runs[NOH_CHUNK_TEXTURE].count; i++) {
        noh_texture t;
        (void)noh_pack_texture_at(pack, i, &t, NULL);
        const noh_texture_header *h = t.header;
        printf("texture '%s': %u x %u, %u mip level%s, %s, %s", t.name, h->width, h->height, h->level_count,
               h->level_count == 1 ? "" : "s", h->flags & NOH_TEXTURE_LINEAR ? "data" : "sRGB",
               texture_format_name(h->format));
        if (h->format) {
            const double db = texture_quality_db(h);
            printf(" %.1f dB%s", db, db < TEXTURE_QUALITY_DB ? " (below 38: --textures raw)" : "");
        }
        if (h->trim) printf(", trimmed from %u x %u", h->whole_width, h->whole_height);
        printf(", %llu bytes on the GPU", (unsigned long long)noh_gl_picture_bytes(&t, 1));
        if (h->format && h->format < NOH_TEXTURE_ASTC_4X4)
            printf(", %llu without ETC2", (unsigned long long)noh_gl_picture_bytes(&t, 0));
        printf("\n");
    }
}

static void json_material(json *j, const noh_pack *pack, const noh_material *m)
{
    material_map maps[MAPS];
    list_maps(pack, m, maps);
    json_open(j, NULL, '{');
    json_text(j, "name", noh_pack_string(pack, m->name));
    json_text(j, "surface", surface_of(m));
    json_text(j, "alpha", alpha_of(m));
    json_bool(j, "double_sided", (m->flags & NOH_MATERIAL_DOUBLE_SIDED) != 0);
    json_bool(j, "tint", !(m->flags & NOH_MATERIAL_UNTINTED));
    json_number(j, "priority", (double)m->priority);
    json_open(j, "maps", '{');
    for (uint32_t k = 0; k < MAPS; k++) {
        if (maps[k].texture != NOH_NONE) json_integer(j, maps[k].key, maps[k].texture);
    }
    json_close(j, '}');
    json_close(j, '}');
}

void info_json_materials(json *j, const noh_pack *pack)
{
    json_open(j, "material_list", '[');
    for (uint32_t i = 0; i < pack->material_count; i++) json_material(j, pack, &pack->materials[i]);
    json_close(j, ']');
}

void info_json_textures(json *j, const noh_pack *pack)
{
    json_open(j, "texture_list", '[');
    for (uint32_t i = 0; i < pack->runs[NOH_CHUNK_TEXTURE].count; i++) {
        noh_texture t;
        (void)noh_pack_texture_at(pack, i, &t, NULL);
        json_open(j, NULL, '{');
        json_text(j, "name", t.name);
        json_integer(j, "width", t.header->width);
        json_integer(j, "height", t.header->height);
        json_integer(j, "whole_width", t.header->trim ? t.header->whole_width : t.header->width);
        json_integer(j, "whole_height", t.header->trim ? t.header->whole_height : t.header->height);
        json_integer(j, "levels", t.header->level_count);
        json_bool(j, "data", (t.header->flags & NOH_TEXTURE_LINEAR) != 0);
        json_text(j, "format", texture_format_name(t.header->format));
        json_number(j, "psnr_db", texture_quality_db(t.header));
        json_integer(j, "gpu_bytes", noh_gl_picture_bytes(&t, 1));
        json_integer(j, "gpu_bytes_without_etc2", noh_gl_picture_bytes(&t, 0));
        json_close(j, '}');
    }
    json_close(j, ']');
}
