/* face_cpu.c: a face smiles, without a GPU. Reads a pack, sums morph targets with SIMD, and draws the result.
 *
 *   face_cpu PACK [TARGET=WEIGHT]... [-o OUT.ppm]        default: smile=1, face.ppm
 *
 * All memory is two arrays: the file, and a block for noh. */
#include <stdlib.h>
#include <string.h>

#include "noh/deform.h"
#include "picture.h"

static unsigned char file[8u << 20] ALIGNED_16;
static unsigned char memory[1u << 20] ALIGNED_16; /* all memory for noh */
static picture image;

static int fail(const char *what, const noh_error *error)
{
    fprintf(stderr, "%s: %s (at %lu, need %lu)\n", what, error->what, (unsigned long)error->where,
            (unsigned long)error->need);
    return 1;
}

/* Parse "smile=0.5" into the weights. */
static int set_weight(const noh_mesh *mesh, const char *text, float *weights)
{
    char name[NOH_NAME_BYTES_MAX];
    const char *equals = strchr(text, '=');
    const size_t length = equals ? (size_t)(equals - text) : strlen(text);
    uint32_t target;
    if (length >= sizeof name) return 1;
    memcpy(name, text, length);
    name[length] = 0;
    target = noh_mesh_find_target(mesh, name);
    if (target == NOH_NONE) {
        fprintf(stderr, "no target '%s' in mesh '%s'\n", name, mesh->name);
        return 1;
    }
    weights[target] = equals ? (float)atof(equals + 1) : 1.0f;
    return 0;
}

static void draw(const noh_pack *pack, const noh_mesh *mesh, const noh_morph_layers *layers)
{
    const float *low = mesh->header->bounds_min, *high = mesh->header->bounds_max;
    const float centre[3] = { 0.5f * (low[0] + high[0]), 0.5f * (low[1] + high[1]), 0.5f * (low[2] + high[2]) };
    picture_clear(&image, centre, 1.15f * (high[1] - low[1]));
    for (uint32_t s = 0; s < mesh->header->submesh_count; s++) {
        const noh_submesh *part = &mesh->submeshes[s];
        const float *tint = part->material == NOH_NONE ? picture_white : pack->materials[part->material].base_color;
        for (uint32_t i = 0; i < part->index_count; i++) {
            noh_vertex v;
            noh_morph_vertex(mesh, layers, noh_mesh_index(mesh, part->first_index + i), &v);
            picture_corner(&image, i % 3u, v.position, v.normal, v.color, tint);
        }
    }
}

int main(int argc, char **argv)
{
    static float weights[NOH_TARGETS_MAX];
    const char *out = "face.ppm";
    noh_morph_layers layers;
    noh_error error;
    noh_pack pack;
    noh_mesh mesh;
    int asked = 0;
    if (argc < 2) {
        fprintf(stderr, "usage: face_cpu PACK [TARGET=WEIGHT]... [-o OUT.ppm]\n");
        return 2;
    }
    if (noh_pack_open(file, picture_read(argv[1], file, sizeof file), &pack, &error)) return fail(argv[1], &error);
    if (noh_pack_mesh_at(&pack, 0, &mesh, &error)) return fail(argv[1], &error);
    for (int i = 2; i < argc; i++) {
        if (strcmp(argv[i], "-o") == 0 && i + 1 < argc) {
            out = argv[++i];
        } else if (set_weight(&mesh, argv[i], weights)) {
            return 1;
        } else {
            asked = 1;
        }
    }
    if (!asked && set_weight(&mesh, "smile=1", weights)) return 1;
    if (noh_morph_layers_init(memory, sizeof memory, &mesh, &layers, &error)) return fail("morph layers", &error);
    noh_morph_accumulate(&mesh, weights, &layers);
    draw(&pack, &mesh, &layers);
    printf("%s: %lu targets, %lu bytes for the sums, %s\n", mesh.name, (unsigned long)mesh.header->target_count,
           (unsigned long)noh_morph_layers_size(&mesh), out);
    return picture_save(&image, out);
}
