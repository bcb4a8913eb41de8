/* check_hair.c: the checker of a haircut. */
#include <stddef.h>

#include "noh/base.h"
#include "noh/format.h"
#include "core/base/math_internal.h"
#include "core/pack/check_internal.h"

#define FAR 1000.0f /* metres: no head is larger */

static int is_count(uint32_t value, uint32_t low, uint32_t high)
{
    return value >= low && value <= high;
}

static noh_result check_header(const noh_check *check, const noh_pack_hair_header *h)
{
    const noh_check_field fields[] = {
        { offsetof(noh_pack_hair_header, hair_count), !is_count(h->hair_count, 1, NOH_HAIRS_MAX) },
        { offsetof(noh_pack_hair_header, point_count), !is_count(h->point_count, 2, NOH_HAIR_POINTS_MAX) },
        { offsetof(noh_pack_hair_header, patch_count), !is_count(h->patch_count, 1, NOH_HAIR_PATCHES_MAX) },
        { offsetof(noh_pack_hair_header, sphere_count), h->sphere_count > NOH_HAIR_SPHERES_MAX },
        { offsetof(noh_pack_hair_header, strip_count), !is_count(h->strip_count, 1, NOH_HAIR_STRIPS_MAX) },
        { offsetof(noh_pack_hair_header, segment_count), !is_count(h->segment_count, 1, NOH_HAIR_SEGMENTS_MAX) },
        { offsetof(noh_pack_hair_header, metres), !noh_is_within(h->metres, 1e-6f, 1e6f) },
        { offsetof(noh_pack_hair_header, pull), !noh_is_within(h->pull, 0.0f, 1.0f) },
        { offsetof(noh_pack_hair_header, pull_at_tip), !noh_is_within(h->pull_at_tip, 0.0f, 1.0f) },
        { offsetof(noh_pack_hair_header, damping), !noh_is_within(h->damping, 0.0f, FAR) },
        { offsetof(noh_pack_hair_header, gravity), !noh_is_within(h->gravity, 0.0f, FAR) },
        { offsetof(noh_pack_hair_header, width_root), !noh_is_within(h->width_root, 1e-6f, 1.0f) },
        { offsetof(noh_pack_hair_header, width_tip), !noh_is_within(h->width_tip, 1e-6f, 1.0f) },
        { offsetof(noh_pack_hair_header, curl_radius), !noh_is_within(h->curl_radius, 0.0f, 1.0f) },
        { offsetof(noh_pack_hair_header, curl_turns), !noh_is_within(h->curl_turns, -100.0f, 100.0f) },
        { offsetof(noh_pack_hair_header, scatter), !noh_is_within(h->scatter, 0.0f, 1.0f) },
        { offsetof(noh_pack_hair_header, gloss), !noh_is_within(h->gloss, 0.0f, 4.0f) },
    };
    return noh_check_fields(check, fields, sizeof fields / sizeof fields[0], "number of a haircut is out of its range",
                            0);
}

static noh_result check_range(const noh_check *check, uint64_t at, uint32_t count, float low, float high)
{
    const float *values = (const float *)(const void *)(check->bytes + at);
    for (uint32_t i = 0; i < count; i++) {
        if (!noh_is_within(values[i], low, high)) {
            return noh_check_fail(check, "number of a haircut is out of its range", at + 4ull * i);
        }
    }
    return NOH_OK;
}

/* Two points at one place have no direction between them. */
static noh_result check_points(const noh_check *check, const noh_pack_hair_header *h)
{
    const float *p = (const float *)(const void *)(check->bytes + h->points_offset);
    const uint32_t count = h->hair_count * h->point_count;
    const noh_result result = check_range(check, h->points_offset, 3u * count, -FAR, FAR);
    for (uint32_t i = 0; !result && i + 1u < count; i++) {
        const float *a = p + 3u * (size_t)i;
        const float way[3] = { a[3] - a[0], a[4] - a[1], a[5] - a[2] };
        if ((i + 1u) % h->point_count && !(noh_dot3(way, way) > 1e-12f)) {
            return noh_check_fail(check, "two points of a control hair are at one place",
                                  h->points_offset + 12ull * (i + 1u));
        }
    }
    return result;
}

static noh_result check_patches(const noh_check *check, const noh_pack_hair_header *h)
{
    const uint32_t *corners = (const uint32_t *)(const void *)(check->bytes + h->patches_offset);
    for (uint32_t i = 0; i < 4u * h->patch_count; i++) {
        if (corners[i] >= h->hair_count) {
            return noh_check_fail(check, "patch of a haircut names a missing control hair",
                                  h->patches_offset + 4ull * i);
        }
    }
    return NOH_OK;
}

static noh_result check_spheres(const noh_check *check, const noh_pack_hair_header *h)
{
    const float *s = (const float *)(const void *)(check->bytes + h->spheres_offset);
    for (uint32_t i = 0; i < h->sphere_count; i++) {
        if (!noh_is_within(s[4u * (size_t)i + 3u], 0.0f, FAR)) {
            return noh_check_fail(check, "radius of a haircut's sphere is out of range",
                                  h->spheres_offset + 16ull * i + 12u);
        }
    }
    return check_range(check, h->spheres_offset, 4u * h->sphere_count, -FAR, FAR);
}

noh_result noh_check_hair(noh_check *check)
{
    const noh_pack_hair_header *h = (const noh_pack_hair_header *)(const void *)check->bytes;
    noh_result result = noh_check_head(check, sizeof *h);
    if (result) return result;
    result = check_header(check, h);
    if (!result) result = noh_check_name(check, h->joint, h->joint_hash, offsetof(noh_pack_hair_header, joint));
    if (!result) result = check_range(check, offsetof(noh_pack_hair_header, middle), 3, -FAR, FAR);
    if (!result) result = check_range(check, offsetof(noh_pack_hair_header, color_root), 6, 0.0f, 1.0f);
    if (!result) {
        result = noh_check_array(check, offsetof(noh_pack_hair_header, points_offset),
                                 (uint64_t)h->hair_count * h->point_count, 12);
    }
    if (!result) {
        result = noh_check_array(check, offsetof(noh_pack_hair_header, patches_offset), h->patch_count, 16);
    }
    if (!result) {
        result = noh_check_array(check, offsetof(noh_pack_hair_header, spheres_offset), h->sphere_count, 16);
    }
    if (!result) result = check_points(check, h);
    if (!result) result = check_patches(check, h);
    if (!result) result = check_spheres(check, h);
    return result ? result : noh_check_end(check);
}
