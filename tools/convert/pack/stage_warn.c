#include "stage_warn.h"

#include <stdlib.h>

#include "noh/clip.h"
#include "stage/modules/springs_internal.h"

typedef struct need {
    const char *what, *of;
    uint64_t count, limit;
    const char *remedy;
} need;

static void check(FILE *out, const need *n)
{
    if (n->count <= n->limit) return;
    fprintf(out, "warning: %s take %llu %s, and a stage has at most %llu: %s\n", n->what, (unsigned long long)n->count,
            n->of, (unsigned long long)n->limit, n->remedy);
}

static uint32_t skeletons_of(const noh_pack *pack)
{
    return pack->runs[NOH_CHUNK_SKELETON].count ? pack->runs[NOH_CHUNK_SKELETON].count : 1u;
}

/* The first kind also draws the meshes that no joint moves. */
static uint32_t skeleton_of(const noh_pack *pack, const noh_mesh *mesh)
{
    noh_skin skin;
    return noh_pack_skin_at(pack, mesh->header->skin, &skin, NULL) == NOH_OK ? skin.header->skeleton : 0;
}

/* Add the meshes that are drawn to meshes[skeletons_of]. Returns the morph targets of all of them. */
static uint64_t count_drawn(const noh_pack *pack, uint32_t *meshes)
{
    const uint32_t count = pack->node_count ? pack->node_count : pack->runs[NOH_CHUNK_MESH].count;
    uint64_t targets = 0;
    for (uint32_t i = 0; i < count; i++) {
        noh_mesh mesh;
        if (noh_pack_mesh_at(pack, pack->node_count ? pack->nodes[i].mesh : i, &mesh, NULL) != NOH_OK) continue;
        meshes[skeleton_of(pack, &mesh)]++;
        targets += mesh.header->target_count;
    }
    return targets;
}

NOH_STATIC_ASSERT(NOH_STAGE_MESHES_MAX == 32, the_text_says_it);

static void check_meshes(const noh_pack *pack, const uint32_t *meshes, FILE *out)
{
    char what[48];
    uint32_t count = 0;
    need n = { what, "kinds (at most 32 meshes of one skeleton in each)", 0, NOH_STAGE_KINDS_MAX,
               "join meshes in the program that made them" };
    for (uint32_t s = 0; s < skeletons_of(pack); s++) {
        count += meshes[s];
        n.count += (meshes[s] + NOH_STAGE_MESHES_MAX - 1u) / NOH_STAGE_MESHES_MAX;
    }
    (void)snprintf(what, sizeof what, "the pack's %u drawn meshes", count);
    check(out, &n);
}

/* Clips can have named floats, too, which their bank counts. */
static void check_floats(const noh_pack *pack, uint64_t targets, FILE *out)
{
    need n = { "morph targets of all drawn meshes, with named floats,", "floats", targets, NOH_FLOATS_MAX,
               "a stage plays no clip of this pack; remove targets, or join the meshes that have them" };
    for (uint32_t s = 0; s < skeletons_of(pack); s++) {
        const noh_clip_bank_desc bank = { .clips = pack, .skeleton = s };
        noh_error why = { NOH_OK, "", 0, 0 };
        if (!noh_clip_bank_size(&bank, &why) && why.result == NOH_ERR_LIMIT && why.need > n.count) n.count = why.need;
    }
    check(out, &n);
}

static void check_springs(const noh_pack *pack, FILE *out)
{
    for (uint32_t s = 0; s < pack->runs[NOH_CHUNK_SKELETON].count; s++) {
        noh_springs_desc springs;
        size_t state, scratch;
        if (!noh_springs_of_pack(pack, s, &springs)) continue;
        noh_springs_measure(&springs, &state, &scratch);
        check(out, &(need){ "springs of a skeleton", "bytes for an actor", state, NOH_MODIFIER_BYTES_MAX,
                            "give it fewer chains or colliders" });
    }
}

int stage_warn(const noh_pack *pack, FILE *out)
{
    uint32_t *meshes = calloc(skeletons_of(pack), sizeof *meshes);
    if (!meshes) return 1;
    check_floats(pack, count_drawn(pack, meshes), out);
    check_meshes(pack, meshes, out);
    check_springs(pack, out);
    free(meshes);
    return 0;
}
