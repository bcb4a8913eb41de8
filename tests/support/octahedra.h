/* octahedra.h: a .gltf of octahedra, for tests that ask which way surfaces face.
 *
 * Octahedron k has radius 1, its centre at x = 3 k, and follows joint k. Accessors: 0 POSITION, 1 NORMAL, 2 TANGENT
 * (along the normal's cross product with (1, 2, 3), w 1), 3 JOINTS_0, 4 WEIGHTS_0, 5 indices, 6 inverse bind matrices,
 * 7 a target's POSITION, that moves all by (0.5, 0, 0). */
#ifndef NOH_TESTS_SUPPORT_OCTAHEDRA_H
#define NOH_TESTS_SUPPORT_OCTAHEDRA_H

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support.h"

#define OCTAHEDRA_MAX 2u
#define OCTAHEDRON_VERTICES 24u
#define OCTAHEDRON_TRIANGLES 8u

typedef struct octahedra {
    float position[OCTAHEDRA_MAX * OCTAHEDRON_VERTICES][3], normal[OCTAHEDRA_MAX * OCTAHEDRON_VERTICES][3];
    float tangent[OCTAHEDRA_MAX * OCTAHEDRON_VERTICES][4];
    uint8_t joints[OCTAHEDRA_MAX * OCTAHEDRON_VERTICES][4];
    float weights[OCTAHEDRA_MAX * OCTAHEDRON_VERTICES][4];
    uint32_t indices[OCTAHEDRA_MAX * OCTAHEDRON_VERTICES];
    float binds[OCTAHEDRA_MAX][16];
    float moved[OCTAHEDRA_MAX * OCTAHEDRON_VERTICES][3];
} octahedra;

static inline void octahedra_make(octahedra *o, const float scales[OCTAHEDRA_MAX])
{
    memset(o, 0, sizeof *o);
    for (uint32_t v = 0; v < OCTAHEDRA_MAX * OCTAHEDRON_VERTICES; v++) {
        const uint32_t k = v / OCTAHEDRON_VERTICES, face = v % OCTAHEDRON_VERTICES / 3u, corner = v % 3u;
        const float sign[3] = { face & 1u ? -1.0f : 1.0f, face & 2u ? -1.0f : 1.0f, face & 4u ? -1.0f : 1.0f };
        const uint32_t flipped = (face & 1u) ^ (face >> 1 & 1u) ^ (face >> 2 & 1u);
        const uint32_t axis = flipped ? 2u - corner : corner;
        const float n[3] = { sign[0] * 0.57735027f, sign[1] * 0.57735027f, sign[2] * 0.57735027f };
        float t[3] = { n[1] * 3 - n[2] * 2, n[2] - n[0] * 3, n[0] * 2 - n[1] }, length;
        length = sqrtf(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]);
        for (int i = 0; i < 3; i++) o->normal[v][i] = n[i], o->tangent[v][i] = t[i] / length;
        o->tangent[v][3] = 1.0f;
        o->position[v][axis] = sign[axis];
        o->position[v][0] += 3.0f * (float)k;
        o->joints[v][0] = (uint8_t)k;
        o->weights[v][0] = 1.0f;
        o->indices[v] = v;
        o->moved[v][0] = 0.5f;
    }
    for (uint32_t k = 0; k < OCTAHEDRA_MAX; k++) {
        for (uint32_t i = 0; i < 4; i++) o->binds[k][5 * i] = i ? 1.0f : scales[k];
    }
}

/* count: how many are drawn. json: what follows the meshes, ",\"nodes\":[...]" and the rest. */
static inline const char *octahedra_write(const octahedra *o, uint32_t count, const char *name, const char *json)
{
    static const struct {
        uint32_t size, offset, components;
        const char *type;
    } views[] = {
        { 12, offsetof(octahedra, position), 5126, "VEC3" }, { 12, offsetof(octahedra, normal), 5126, "VEC3" },
        { 16, offsetof(octahedra, tangent), 5126, "VEC4" },  { 4, offsetof(octahedra, joints), 5121, "VEC4" },
        { 16, offsetof(octahedra, weights), 5126, "VEC4" },  { 4, offsetof(octahedra, indices), 5125, "SCALAR" },
        { 64, offsetof(octahedra, binds), 5126, "MAT4" },    { 12, offsetof(octahedra, moved), 5126, "VEC3" },
    };
    const uint32_t vertices = count * OCTAHEDRON_VERTICES;
    char file[64], text[8192];
    size_t used;
    snprintf(file, sizeof file, "%s.bin", name);
    test_write_file(test_path(file), o, sizeof *o);
    used = (size_t)snprintf(text, sizeof text,
                            "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":%u,\"uri\":\"%s\"}],"
                            "\"bufferViews\":[",
                            (unsigned)sizeof *o, file);
    for (uint32_t i = 0; i < TEST_COUNT(views); i++) {
        const uint32_t rows = i == 6 ? OCTAHEDRA_MAX : OCTAHEDRA_MAX * OCTAHEDRON_VERTICES;
        used += (size_t)snprintf(text + used, sizeof text - used,
                                 "%s{\"buffer\":0,\"byteOffset\":%u,\"byteLength\":%u}", i ? "," : "",
                                 (unsigned)views[i].offset, (unsigned)(rows * views[i].size));
    }
    used += (size_t)snprintf(text + used, sizeof text - used, "],\"accessors\":[");
    for (uint32_t i = 0; i < TEST_COUNT(views); i++) {
        used += (size_t)snprintf(text + used, sizeof text - used,
                                 "%s{\"bufferView\":%u,\"componentType\":%u,\"count\":%u,\"type\":\"%s\"%s}",
                                 i ? "," : "", (unsigned)i, (unsigned)views[i].components,
                                 (unsigned)(i == 6 ? OCTAHEDRA_MAX : vertices), views[i].type,
                                 i == 0   ? ",\"min\":[-1,-1,-1],\"max\":[4,1,1]"
                                 : i == 7 ? ",\"min\":[0.5,0,0],\"max\":[0.5,0,0]"
                                          : "");
    }
    snprintf(text + used, sizeof text - used, "]%s}", json);
    snprintf(file, sizeof file, "%s.gltf", name);
    test_write_file(test_path(file), text, strlen(text));
    return test_path(file);
}

#endif
