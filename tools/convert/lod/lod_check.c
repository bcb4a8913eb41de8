/* lod_check.c: what lod_build refuses, and its defaults. */
#include "lod_internal.h"

#include <math.h>

#include "convert/model/model_build.h"

#define LARGEST 1e6f /* products of much larger lengths would overflow */

static const float standard_ratios[] = { 1.0f, 0.5f, 0.25f, 0.1f };

static int check_floats(const float *values, size_t count, const char *what, model_error *error)
{
    for (size_t i = 0; i < count; i++) {
        if (!isfinite(values[i])) {
            return model_fail(error, "", "%s of vertex %zu is not a finite number", what, i / 3u);
        }
        if (fabsf(values[i]) > LARGEST) {
            return model_fail(error, "", "%s of vertex %zu is %g: LOD levels are made of meshes within %g", what,
                              i / 3u, (double)values[i], (double)LARGEST);
        }
    }
    return 0;
}

double lod_bytes(const model_mesh *mesh, uint32_t pose_count, uint32_t mix_count)
{
    const double mixes = mesh->target_count > 1u ? (mix_count ? mix_count : LOD_MIXES) : 0u;
    const double still = 1.0 + pose_count, poses = still + mesh->target_count + mixes;
    double pairs = mesh->vertex_count * still;
    for (size_t v = 0; v < mesh->vertex_count; v++) {
        uint32_t moves = 0;
        for (uint32_t t = 0; t < mesh->target_count; t++) {
            const float *delta = mesh->targets[t].position + 3u * v;
            moves += delta[0] != 0.0f || delta[1] != 0.0f || delta[2] != 0.0f;
        }
        pairs += moves ? moves + mixes : 0.0;
    }
    return 12.0 * mesh->vertex_count * poses + 88.0 * pairs;
}

int lod_check_mesh(const model_mesh *mesh, const lod_options *o, model_error *error)
{
    size_t floats = (size_t)mesh->vertex_count * 3u;
    if (check_floats(mesh->position, floats, "the position", error)) {
        return 1;
    }
    for (uint32_t t = 0; t < mesh->target_count; t++) {
        if (check_floats(mesh->targets[t].position, floats, "a target's delta", error)) {
            return 1;
        }
    }
    for (uint32_t i = 0; i < o->pose_count; i++) {
        if (check_floats(o->poses[i], floats, "a pose's position", error)) {
            return 1;
        }
    }
    for (uint32_t i = 0; i < mesh->index_count; i++) {
        if (mesh->indices[i] >= mesh->vertex_count) {
            return model_fail(error, "", "index %u is vertex %u of %u", i, mesh->indices[i], mesh->vertex_count);
        }
    }
    const double bytes = lod_bytes(mesh, o->pose_count, o->mix_count);
    if (bytes > LOD_BYTES_MAX) {
        return model_fail(error, mesh->name ? mesh->name : "",
                          "LOD levels of %u vertices with %u targets would take %.1f GB of memory, more than %g: lower "
                          "the number of either, or build without levels (--lod 1)",
                          mesh->vertex_count, mesh->target_count, bytes / 1e9, LOD_BYTES_MAX / 1e9);
    }
    return 0;
}

int lod_check_options(lod_options *o, uint32_t target_count, model_error *error)
{
    if (!o->level_count && !o->ratios && !o->errors) {
        o->ratios = standard_ratios;
        o->level_count = (uint32_t)(sizeof standard_ratios / sizeof *standard_ratios);
    }
    if (!o->level_count || o->level_count > LOD_LEVELS_MAX || (!o->ratios && !o->errors)) {
        return model_fail(error, "", "%u LOD levels: the number of ratios or errors must be 1 to %u", o->level_count,
                          LOD_LEVELS_MAX);
    }
    for (uint32_t i = 0; i < o->level_count; i++) {
        float value = o->errors ? o->errors[i] : o->ratios[i], last = i == 0      ? value
                                                                      : o->errors ? o->errors[i - 1u]
                                                                                  : o->ratios[i - 1u];
        if (!(value >= 0.0f) || (!o->errors && value > 1.0f) || (o->errors ? value < last : value > last)) {
            return model_fail(error, "", "LOD level %u: %g after %g; levels go from fine to coarse", i, (double)value,
                              (double)last);
        }
    }
    if ((uint64_t)target_count + o->mix_count + o->pose_count + 64u > LOD_POSES_MAX) {
        return model_fail(error, "", "%u targets and %u poses are more than %u", target_count, o->pose_count,
                          LOD_POSES_MAX);
    }
    if (!(o->pose_weight > 0.0f)) {
        o->pose_weight = 0.4f;
    }
    if (!(o->face_weight > 0.0f)) {
        o->face_weight = o->pose_count ? 1.2f : 1.0f;
    }
    return 0;
}
