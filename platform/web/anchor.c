/* anchor.c: points of the figures as shown last, for what the page places over the picture (package/hotspots.js). */
#include <emscripten.h>
#include <string.h>

#include "web.h"
#include "deform/morph/morph_internal.h"
#include "deform/skin/skin_blend_internal.h"
#include "noh/deform.h"
#include "stage/cast/stage_internal.h"

/* ---- joints ---- */

/* The kind of a joint numbered through all kinds; the index within it replaces *joint. NOH_NONE past the last. */
static uint32_t kind_of(uint32_t *joint)
{
    for (uint32_t k = 0; k < web.cast.desc.kind_count; k++) {
        const uint32_t count = web.cast.plan.kinds[k].joint_count;
        if (*joint < count) return k;
        *joint -= count;
    }
    return NOH_NONE;
}

/* NULL past the last. */
EMSCRIPTEN_KEEPALIVE const char *web_joint_name(uint32_t joint)
{
    const uint32_t kind = kind_of(&joint);
    return kind == NOH_NONE ? NULL : noh_stage_name(web.stage, kind, NOH_NAME_JOINT, joint);
}

/* The world matrix of a joint of the first character, [12]; NULL: it was not shown. Valid until the next call. */
EMSCRIPTEN_KEEPALIVE const float *web_joint_matrix(uint32_t joint)
{
    static float matrix[12];
    const uint32_t kind = kind_of(&joint); /* figure k has kind k */
    if (kind == NOH_NONE || noh_actor_joint(web.stage, web.figures[kind].actor, joint, matrix, NULL)) return NULL;
    return matrix;
}

/* The world matrix of the first character, as web_joint_matrix. */
EMSCRIPTEN_KEEPALIVE const float *web_place_matrix(void)
{
    static float matrix[12];
    noh_place place;
    if (noh_actor_place(web.stage, web.figures[0].actor, &place, NULL)) return NULL;
    noh_place_matrix(&place, matrix);
    return matrix;
}

/* ---- vertices ---- */

static void transform(const float m[12], const float v[3], float w, float out[3])
{
    for (int r = 0; r < 3; r++) out[r] = m[4 * r] * v[0] + m[4 * r + 1] * v[1] + m[4 * r + 2] * v[2] + w * m[4 * r + 3];
}

/* Targets move the point; the normal is without targets. */
static void deform(const noh_mesh *mesh, const noh_actor_mesh *shown, const float *matrices, uint32_t index,
                   noh_vertex *out)
{
    float p[3];
    noh_morph_position_by(mesh, shown->weights, index, p);
    if (!shown->joint_count) {
        noh_skin_rest(mesh, NULL, index, out);
        memcpy(out->position, p, sizeof p);
    } else if (mesh->header->flags & NOH_MESH_DUAL_QUATERNION) {
        noh_dual_quaternion *joints = web_block(web.cast.scratch_at);
        noh_skin_dual_quaternions(matrices, shown->joint_count, joints);
        noh_skin_vertex_dual(mesh, joints, NULL, index, out);
        noh_skin_point_dual(mesh, joints, index, p, out->position);
    } else {
        noh_skin_vertex(mesh, matrices, NULL, index, out);
        noh_skin_point(mesh, matrices, index, p, out->position);
    }
}

/* A mesh of the first character by its number in the pack. */
static int find_mesh(uint32_t number, noh_mesh *mesh, noh_actor_mesh *shown, float *matrices)
{
    for (uint32_t k = 0; k < web.cast.desc.kind_count; k++) {
        const noh_actor actor = web.figures[k].actor;
        for (uint32_t m = 0; noh_actor_mesh_at(web.stage, actor, m, shown, NULL, NULL) == NOH_OK; m++) {
            if (shown->mesh != number) continue;
            return noh_pack_mesh_at(&web.pack, number, mesh, NULL) == NOH_OK &&
                   noh_actor_mesh_at(web.stage, actor, m, shown, matrices, NULL) == NOH_OK;
        }
    }
    return 0;
}

/* NULL past the last. */
EMSCRIPTEN_KEEPALIVE const char *web_mesh_name(uint32_t number)
{
    noh_mesh mesh;
    return noh_pack_mesh_at(&web.pack, number, &mesh, NULL) == NOH_OK ? mesh.name : NULL;
}

/* A vertex of a mesh of the first character: its point and its unit normal in the world, 6 floats; NULL: it was not
 * shown, or the levels that have come lack it. Valid until the next call. */
EMSCRIPTEN_KEEPALIVE const float *web_vertex(uint32_t number, uint32_t index)
{
    static float out[6];
    float *matrices = web_block(web.cast.matrices_at);
    noh_actor_mesh shown;
    noh_mesh mesh;
    noh_vertex v;
    if (!find_mesh(number, &mesh, &shown, matrices) || index >= mesh.header->vertex_count) return NULL;
    deform(&mesh, &shown, matrices, index, &v);
    transform(shown.world, v.position, 1.0f, out);
    transform(shown.world, v.normal, 0.0f, out + 3);
    return out;
}

/* The corner of the picked triangle that is nearest to the picked point. */
EMSCRIPTEN_KEEPALIVE uint32_t web_picked_vertex(void)
{
    const float *mix = web.hit.barycentric;
    const uint32_t corner = mix[0] >= mix[1] && mix[0] >= mix[2] ? 0u : mix[1] >= mix[2] ? 1u : 2u;
    noh_actor_mesh shown;
    noh_mesh mesh;
    (void)noh_pack_mesh_at(&web.pack, web.hit.mesh, &mesh, NULL);
    for (uint32_t m = 0; noh_actor_mesh_at(web.stage, web.hit.actor, m, &shown, NULL, NULL) == NOH_OK; m++) {
        if (shown.mesh == web.hit.mesh) break;
    }
    mesh = noh_mesh_at_lod(&mesh, shown.level);
    return noh_mesh_index(&mesh, 3u * web.hit.triangle + corner);
}
