#include "bounds.h"
#include "deform/pick/bounds_internal.h"
#include "noh/low_core.h"

static void grow(float box[6], const float world[12], const float p[3])
{
    for (int c = 0; c < 3; c++) {
        const float x = world[4 * c] * p[0] + world[4 * c + 1] * p[1] + world[4 * c + 2] * p[2] + world[4 * c + 3];
        box[c] = x < box[c] ? x : box[c];
        box[3 + c] = x > box[3 + c] ? x : box[3 + c];
    }
}

static void grow_mesh(float box[6], const noh_pack *pack, const noh_actor_mesh *of, const float *matrices, int face)
{
    noh_mesh mesh;
    (void)noh_pack_mesh_at(pack, of->mesh, &mesh, NULL);
    mesh = noh_mesh_at_lod(&mesh, NOH_LOD_LEVELS_MAX);
    for (uint32_t v = 0; v < mesh.header->vertex_count; v++) {
        float skinned[3];
        if (face && noh_mesh_accumulation_texel(&mesh, v) >= mesh.header->touched_count) continue;
        if (of->joint_count) noh_skin_position(&mesh, matrices, NULL, v, skinned);
        grow(box, of->world, of->joint_count ? skinned : mesh.positions + 3 * (size_t)v);
    }
}

void web_bounds(const noh_stage *stage, const noh_pack *pack, uint32_t actor_count, float *matrices, int face,
                float box[6])
{
    noh_box_empty(box);
    for (uint32_t i = 0; i < actor_count; i++) {
        const noh_actor actor = noh_stage_actor_at(stage, i);
        noh_actor_mesh mesh;
        for (uint32_t m = 0; noh_actor_mesh_at(stage, actor, m, &mesh, matrices, NULL) == NOH_OK; m++) {
            grow_mesh(box, pack, &mesh, matrices, face);
        }
    }
}
