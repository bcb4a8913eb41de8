#include "budget_phone.h"

#include <stdio.h>
#include <string.h>

#include "cli/message.h"
#include "gl/draw/gl_variants_internal.h"
#include "noh/format.h"
#include "noh/low_gl.h"
#include "phones.gen.h"

#define NAME_BYTES 64u
#define FRAMES 60.0

typedef struct phone_gpu {
    const char *name, *what, *unit;
    double rate; /* a second, of pixels or vertices times the unit */
} phone_gpu;

/* Mali: cores times clock. Adreno and VideoCore: lanes times clock. */
static const phone_gpu gpus[] = { { "g52", "Mali-G52 MP2, 850 MHz", "cycles", 2.0 * 850e6 },
                                  { "g57", "Mali-G57 MC2, 950 MHz", "cycles", 2.0 * 950e6 },
                                  { "g610", "Mali-G610 MC6, 860 MHz", "cycles", 6.0 * 860e6 },
                                  { "a630", "Adreno 630, 710 MHz, 256 lanes", "instructions", 256.0 * 710e6 },
                                  { "v3d", "VideoCore VI of a Raspberry Pi 4, 500 MHz", "instructions",
                                    32.0 * 500e6 } };

int budget_phone_choose(const char *name, budget_phone *p)
{
    for (size_t i = 0; i < sizeof gpus / sizeof *gpus && !p->gpu; i++) {
        if (strcmp(gpus[i].name, name) == 0) p->gpu = &gpus[i];
    }
    return p->gpu ? 0 : tool_usage("--gpu must be g52, g57, g610, a630 or v3d, not '%s'", name);
}

/* What the table says; 0: nothing. */
static double cost_of(const phone_gpu *gpu, const char *program, const char *stage)
{
    for (size_t i = 0; i < sizeof phone_rows / sizeof *phone_rows; i++) {
        const phone_row *row = &phone_rows[i];
        for (size_t k = 0; k < PHONE_COLUMNS; k++) {
            if (!strcmp(row->program, program) && !strcmp(row->stage, stage) && !strcmp(phone_columns[k], gpu->name))
                return row->cost[k];
        }
    }
    return 0.0;
}

/* The program of a material's features, or of the most similar features that the table has. Returns its cost. */
static double material_cost(const budget_phone *p, uint32_t features, int transfer, char name[NAME_BYTES])
{
    const char *surface = features & NOH_FEATURE_SKIN    ? "skin"
                          : features & NOH_FEATURE_EYE   ? "eye"
                          : features & NOH_FEATURE_TEETH ? "teeth"
                          : features & NOH_FEATURE_TOON  ? "toon"
                          : features & NOH_FEATURE_HAIR  ? "cards"
                                                         : "plain";
    const char *maps = features & NOH_FEATURE_WRINKLE_PIXEL                            ? "-codes"
                       : features & NOH_FEATURE_WRINKLES                               ? "-wrinkles"
                       : features & (NOH_FEATURE_SPECULAR_MAP | NOH_FEATURE_EMISSIVE)  ? "-all"
                       : features & (NOH_FEATURE_NORMAL_MAP | NOH_FEATURE_SURFACE_MAP) ? "-maps"
                       : features & NOH_FEATURE_ALPHA                                  ? "-alpha"
                                                                                       : "";
    const char *const of_maps[] = { maps, "-wrinkles", "-maps", "" };
    const char *const lights[] = { transfer ? "-transfer" : "-lit", "-lit" };
    for (int light = 0; light < 2; light++) {
        for (int i = 0; i < 4; i++) {
            if (i && !*maps) continue;
            snprintf(name, NAME_BYTES, "%s%s%s%s", surface, of_maps[i], lights[light],
                     p->shading == NOH_SHADING_PHONE ? "-phone" : "");
            const double cost = cost_of(p->gpu, name, "fragment");
            if (cost > 0.0) return cost;
        }
    }
    return 0.0;
}

static double share_of(const budget_phone *p, double cost, double count)
{
    return 100.0 * cost * count * FRAMES / p->gpu->rate;
}

/* A submesh, or with material NULL the vertices. */
typedef struct phone_line {
    const char *material, *program;
    double cost, count, percent;
} phone_line;

/* at: submeshes, then the vertices. 0: past these. */
static int list_lines(const budget_phone *p, const noh_mesh *mesh, uint32_t at, phone_line *line, char name[NAME_BYTES])
{
    const uint32_t submeshes = mesh->header->submesh_count;
    memset(line, 0, sizeof *line);
    if (at > submeshes) return 0;
    line->program = name;
    if (at < submeshes) {
        const uint32_t material = mesh->submeshes[at].material;
        const noh_material *m = material == NOH_NONE ? NULL : &mesh->pack->materials[material];
        line->material = m ? noh_pack_string(mesh->pack, m->name) : "";
        line->count = (double)p->size[0] * p->size[1];
        line->cost = material_cost(p, m ? noh_gl_features_of(mesh, m) : 0, mesh->transfer != NULL, name);
    } else {
        const int dual = (mesh->header->flags & NOH_MESH_DUAL_QUATERNION) != 0;
        snprintf(name, NAME_BYTES, "%s",
                 !mesh->header->influence_count ? "v-rigid"
                 : dual                         ? "v-block-4-dual"
                                                : "v-texture-4");
        line->count = mesh->header->vertex_count;
        line->cost = cost_of(p->gpu, name, "position") + cost_of(p->gpu, name, "varying");
    }
    line->percent = share_of(p, line->cost, line->count);
    return 1;
}

/* The next mesh of a pack at its finest level. */
static int mesh_of(const noh_pack *pack, uint32_t *at, noh_mesh *mesh)
{
    while (!noh_pack_mesh_at(pack, (*at)++, mesh, NULL)) {
        if (mesh->header->level == mesh->header->level_first) return 1;
    }
    return 0;
}

static void print_line(const budget_phone *p, const phone_line *line)
{
    if (line->cost <= 0.0) {
        printf("  %-30s no figure (make phones-update)\n", line->material ? line->material : "vertices");
    } else if (line->material) {
        printf("  %-30s %8.4g %s a pixel, %.3g %% of a frame of 1/%g s if it fills %ux%u: %s\n", line->material,
               line->cost, p->gpu->unit, line->percent, FRAMES, p->size[0], p->size[1], line->program);
    } else {
        printf("  %-30s %8.4g %s a vertex, %.3g %% of a frame of 1/%g s for all %g: %s\n", "vertices", line->cost,
               p->gpu->unit, line->percent, FRAMES, line->count, line->program);
    }
}

void budget_phone_print(const budget_phone *p, const noh_pack *pack)
{
    char name[NAME_BYTES];
    phone_line line;
    noh_mesh mesh;
    uint32_t at = 0;
    printf("on %s (%s), by a model: figures of Mesa's compiler, without memory and caches\n", p->gpu->name,
           p->gpu->what);
    while (mesh_of(pack, &at, &mesh)) {
        for (uint32_t i = 0; list_lines(p, &mesh, i, &line, name); i++) print_line(p, &line);
    }
}

static void json_line(json *j, const phone_line *line)
{
    json_open(j, NULL, '{');
    if (line->material) json_text(j, "material", line->material);
    json_text(j, "program", line->program);
    json_number(j, "cost", line->cost);
    json_number(j, "percent_of_frame", line->percent);
    json_close(j, '}');
}

void budget_phone_json(json *j, const budget_phone *p, const noh_pack *pack)
{
    char name[NAME_BYTES];
    phone_line line;
    noh_mesh mesh;
    uint32_t at = 0;
    json_open(j, "phone", '{');
    json_text(j, "gpu", p->gpu->name);
    json_text(j, "unit", p->gpu->unit);
    json_integer(j, "width", p->size[0]);
    json_integer(j, "height", p->size[1]);
    json_open(j, "shaders", '[');
    while (mesh_of(pack, &at, &mesh)) {
        for (uint32_t i = 0; list_lines(p, &mesh, i, &line, name); i++) json_line(j, &line);
    }
    json_close(j, ']');
    json_close(j, '}');
}
