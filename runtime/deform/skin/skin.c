#include "core/base/assert_internal.h"
#include "core/mesh/mesh_internal.h"
#include "deform/morph/morph_internal.h"
#include "deform/skin/skin_internal.h"
#include "noh/base.h"
#include "noh/deform.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"
#include "noh/pack.h"

#include <string.h>

#include "core/base/math_internal.h"
#include "deform/skin/skin_blend_internal.h"
#include "deform/skin/skin_kernel_internal.h"

/* Benches and tests compile this file again for other instruction sets, under other names. */
#ifndef NOH_SKIN_VERTICES
#define NOH_SKIN_VERTICES noh_skin_vertices
#define NOH_SKIN_ALL 1
#endif

void NOH_SKIN_VERTICES(const noh_mesh *mesh, const float *matrices, const noh_morph_layers *layers, uint32_t first,
                       uint32_t count, float *positions, float *normals, float *tangents);
void NOH_SKIN_VERTICES(const noh_mesh *mesh, const float *matrices, const noh_morph_layers *layers, uint32_t first,
                       uint32_t count, float *positions, float *normals, float *tangents)
{
    skin_job job = { mesh,
                     matrices,
                     layers,
                     positions,
                     normals,
                     tangents,
                     (mesh->header->flags & NOH_MESH_TANGENTS) != 0,
                     mesh->header->palette_count > 1,
                     (mesh->header->flags & NOH_MESH_TEXELS) != 0,
                     { NULL } };
    NOH_ASSERT(matrices && mesh->header->skin != NOH_NONE);
    NOH_ASSERT(first <= mesh->header->vertex_count && count <= mesh->header->vertex_count - first);
    for (uint32_t j = 0; !job.split && j < mesh->palettes[0].joint_count; j++) {
        job.joints[j] = matrices + 12u * (size_t)mesh->palette_joints[j];
    }
    if (tangents && !job.has_tangents) {
        memset(tangents, 0, 16u * (size_t)count);
    }
    /* Full blocks store past their last vertex, where the next block overwrites; the last block must not. */
    for (uint32_t i = 0; i < count; i += NOH_LANES) {
        uint32_t block = count - i < NOH_LANES ? count - i : NOH_LANES;
        skin_block(&job, first + i, block, i, count - i <= NOH_LANES);
    }
}

#ifdef NOH_SKIN_ALL

void noh_skin_matrices(const noh_skin *skin, const float *model, float *matrices)
{
    NOH_ASSERT(skin && model && matrices);
    for (size_t j = 0; j < skin->header->joint_count; j++) {
        noh_matrix_multiply(model + 12u * (size_t)skin->joints[j], skin->inverse_bind + 12u * j, matrices + 12u * j);
    }
}

/* Normalise a moved direction; one of length 0 becomes the rest direction, which need not be unit itself. */
static void unit_or_rest(float v[3], const float rest[3])
{
    static const float up[3] = { 0.0f, 0.0f, 1.0f };
    float unit[3] = { rest[0], rest[1], rest[2] };
    if (noh_dot3(v, v) < 2e-30f) {
        noh_normalize3(unit, up);
    }
    noh_normalize3(v, unit);
}

void noh_skin_apply(const float m[12], noh_vertex *vertex)
{
    float c[9], p[3], n[3], t[4], sign = noh_cofactors(m, c);
    memcpy(p, vertex->position, sizeof p);
    memcpy(n, vertex->normal, sizeof n);
    memcpy(t, vertex->tangent, sizeof t);
    for (int r = 0; r < 3; r++) {
        vertex->position[r] = m[4 * r] * p[0] + m[4 * r + 1] * p[1] + m[4 * r + 2] * p[2] + m[4 * r + 3];
        vertex->normal[r] = sign * (c[3 * r] * n[0] + c[3 * r + 1] * n[1] + c[3 * r + 2] * n[2]);
    }
    unit_or_rest(vertex->normal, n);
    if (t[3] != 0.0f) { /* 0: the mesh has no tangents */
        for (int r = 0; r < 3; r++) {
            vertex->tangent[r] = m[4 * r] * t[0] + m[4 * r + 1] * t[1] + m[4 * r + 2] * t[2];
        }
        unit_or_rest(vertex->tangent, t);
        vertex->tangent[3] = sign * t[3];
    }
}

/* Matrices are blended and then applied once, not applied per joint and blended: twelve sums per joint and vertex
 * whatever is moved, and the normal is consistent with the matrix that moved the position. */
static void blend_matrix(const noh_mesh *mesh, const float *matrices, uint32_t index, float m[12])
{
    uint32_t joints[NOH_INFLUENCES_MAX], count;
    float weights[NOH_INFLUENCES_MAX];
    NOH_ASSERT(mesh->header->skin != NOH_NONE && index < mesh->header->vertex_count && matrices);
    count = noh_mesh_influences(mesh, index, joints, weights);
    for (size_t e = 0; e < 12; e++) {
        m[e] = weights[0] * matrices[12u * (size_t)joints[0] + e];
    }
    for (uint32_t i = 1; i < count; i++) {
        for (size_t e = 0; e < 12; e++) {
            m[e] = m[e] + weights[i] * matrices[12u * (size_t)joints[i] + e];
        }
    }
}

void noh_skin_vertex(const noh_mesh *mesh, const float *matrices, const noh_morph_layers *layers, uint32_t index,
                     noh_vertex *out)
{
    float m[12];
    blend_matrix(mesh, matrices, index, m);
    noh_skin_rest(mesh, layers, index, out);
    noh_skin_apply(m, out);
}

void noh_skin_rest(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t index, noh_vertex *out)
{
    if (layers && noh_mesh_accumulation_texel(mesh, index) < mesh->header->touched_count) {
        noh_morph_vertex(mesh, layers, index, out);
    } else {
        noh_mesh_vertex(mesh, index, out);
        noh_mesh_directions(mesh, index, out->normal, out->tangent); /* unnormalised: noh_skin_apply makes them unit */
        if (layers) noh_morph_uv(mesh, layers, index, out->uv);
    }
}

void noh_skin_position(const noh_mesh *mesh, const float *matrices, const noh_morph_layers *layers, uint32_t index,
                       float out[3])
{
    float p[3];
    noh_morph_position(mesh, layers, index, p);
    noh_skin_point(mesh, matrices, index, p, out);
}

void noh_skin_point(const noh_mesh *mesh, const float *matrices, uint32_t index, const float p[3], float out[3])
{
    float m[12];
    blend_matrix(mesh, matrices, index, m);
    for (int r = 0; r < 3; r++) {
        out[r] = m[4 * r] * p[0] + m[4 * r + 1] * p[1] + m[4 * r + 2] * p[2] + m[4 * r + 3];
    }
}

const char *noh_skin_simd(void)
{
    return NOH_SIMD_NAME;
}

#endif
