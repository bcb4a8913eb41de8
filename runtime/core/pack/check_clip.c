/* check_clip.c: the checkers of skeletons and clips. The compressed clip inside a clip chunk is checked by
 * noh_clip_init when it is opened: its bytes alone say whether they are right. */
#include "core/pack/check_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/pack.h"

#include <stddef.h>

/* How large the bind pose gets along the chain that leads to a joint: a bound of the scales' product, and of how far
 * from the root a point of it lies. */
static int is_chain_bounded(const float *bind, const uint16_t *parents, uint32_t joint)
{
    float scale = 1.0f, reach = 0.0f;
    for (uint32_t j = joint;; j = parents[j]) {
        const float *t = bind + 10u * (size_t)j + 4;
        float largest = 0.0f;
        for (int k = 0; k < 3; k++) {
            const float s = t[3 + k] < 0.0f ? -t[3 + k] : t[3 + k];
            if (s > largest) largest = s;
        }
        scale *= largest > 1.0f ? largest : 1.0f;
        reach *= largest;
        for (int k = 0; k < 3; k++) reach += t[k] < 0.0f ? -t[k] : t[k];
        if (!(scale <= NOH_NUMBER_MAX && reach <= NOH_NUMBER_MAX)) return 0;
        if (parents[j] == NOH_PACK_JOINT_ROOT) return 1;
    }
}

static noh_result check_bind(const noh_check *check, const noh_skeleton_header *h)
{
    const uint16_t *parents = (const uint16_t *)(const void *)(check->bytes + h->parents_offset);
    const float *bind = (const float *)(const void *)(check->bytes + h->bind_offset);
    noh_result result = noh_check_floats(check, bind, h->joint_count * 10u, "bind pose is not finite");
    for (uint32_t j = 0; !result && j < h->joint_count; j++) {
        if (is_chain_bounded(bind, parents, j)) continue;
        result = noh_check_fail(check, "bind pose of a joint and those above it is larger than 10^12",
                                h->bind_offset + 40ull * j);
    }
    return result;
}

static noh_result check_joints(const noh_check *check, const noh_skeleton_header *h)
{
    const uint16_t *parents = (const uint16_t *)(const void *)(check->bytes + h->parents_offset);
    const float *bind = (const float *)(const void *)(check->bytes + h->bind_offset);
    const uint32_t *names = (const uint32_t *)(const void *)(check->bytes + h->names_offset);
    for (uint32_t j = 0; j < h->joint_count; j++) {
        const float *q = bind + 10u * (size_t)j;
        float square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
        if (parents[j] != NOH_PACK_JOINT_ROOT && parents[j] >= j) {
            return noh_check_fail(check, "joint comes before its parent", h->parents_offset + 2ull * j);
        }
        if (!(square > 0.99f && square < 1.01f)) {
            return noh_check_fail(check, "bind rotation is not a unit quaternion", h->bind_offset + 40ull * j);
        }
        if (names[j] >= check->pack->string_bytes) {
            return noh_check_fail(check, "joint's name lies outside the strings", h->names_offset + 4ull * j);
        }
    }
    return check_bind(check, h);
}

/* The joint counts of the LOD levels: falling, and no level lacks a joint without a parent. After check_joints. */
static noh_result check_levels(const noh_check *check, const noh_skeleton_header *h)
{
    const uint16_t *parents = (const uint16_t *)(const void *)(check->bytes + h->parents_offset);
    const uint32_t *counts = (const uint32_t *)(const void *)(check->bytes + h->levels_offset);
    for (uint32_t i = 0; i < h->level_count; i++) {
        if (!counts[i] || (i ? counts[i] >= counts[i - 1] : counts[i] != h->joint_count)) {
            return noh_check_fail(check, "joint levels do not begin with all joints, or do not fall",
                                  h->levels_offset + 4ull * i);
        }
    }
    for (uint32_t j = counts[h->level_count - 1]; j < h->joint_count; j++) {
        if (parents[j] == NOH_PACK_JOINT_ROOT) {
            return noh_check_fail(check, "joint level leaves out a joint that has no parent",
                                  h->parents_offset + 2ull * j);
        }
    }
    return NOH_OK;
}

noh_result noh_check_skeleton(noh_check *check)
{
    const noh_skeleton_header *h = (const noh_skeleton_header *)(const void *)check->bytes;
    noh_result result = noh_check_head(check, sizeof *h);
    if (result) {
        return result;
    }
    if (!h->joint_count || h->joint_count > NOH_JOINTS_MAX) {
        return noh_check_fail(check, "joint count is zero or over the limit",
                              offsetof(noh_skeleton_header, joint_count));
    }
    if (!(h->unit_cm > 0.0f) || !noh_float_finite(h->unit_cm)) {
        return noh_check_fail(check, "unit of a skeleton is not a length", offsetof(noh_skeleton_header, unit_cm));
    }
    if (!h->level_count || h->level_count > NOH_LOD_LEVELS_MAX) {
        return noh_check_fail(check, "count of joint levels is zero or over the limit",
                              offsetof(noh_skeleton_header, level_count));
    }
    result = noh_check_array(check, offsetof(noh_skeleton_header, parents_offset), h->joint_count, 2);
    if (!result) result = noh_check_array(check, offsetof(noh_skeleton_header, bind_offset), h->joint_count, 40);
    if (!result) result = noh_check_array(check, offsetof(noh_skeleton_header, names_offset), h->joint_count, 4);
    if (!result) result = noh_check_array(check, offsetof(noh_skeleton_header, levels_offset), h->level_count, 4);
    if (!result) result = noh_check_end(check);
    if (!result) result = check_joints(check, h);
    return result ? result : check_levels(check, h);
}

static noh_result check_events(const noh_check *check, const noh_clip_header *h)
{
    const noh_clip_event *events = (const noh_clip_event *)(const void *)(check->bytes + h->events_offset);
    for (uint32_t i = 0; i < h->event_count; i++) {
        uint64_t at = h->events_offset + (uint64_t)i * sizeof *events;
        noh_result result = noh_check_name(check, events[i].name, events[i].name_hash,
                                           at + offsetof(noh_clip_event, name));
        if (result) {
            return result;
        }
        if (i && events[i].tick < events[i - 1].tick) {
            return noh_check_fail(check, "callback keys are not in time order", at + offsetof(noh_clip_event, tick));
        }
        if (!noh_float_finite(events[i].weight_min) || events[i].weight_min < 0.0f) {
            return noh_check_fail(check, "callback key's smallest weight is not 0 or more",
                                  at + offsetof(noh_clip_event, weight_min));
        }
    }
    return NOH_OK;
}

static noh_result check_markers(const noh_check *check, const noh_clip_header *h)
{
    const noh_clip_marker *markers = (const noh_clip_marker *)(const void *)(check->bytes + h->markers_offset);
    for (uint32_t i = 0; i < h->marker_count; i++) {
        uint64_t at = h->markers_offset + (uint64_t)i * sizeof *markers;
        noh_result result = noh_check_name(check, markers[i].name, markers[i].name_hash,
                                           at + offsetof(noh_clip_marker, name));
        if (result) {
            return result;
        }
        if (i && markers[i].tick <= markers[i - 1].tick) {
            return noh_check_fail(check, "sync markers are not in time order", at + offsetof(noh_clip_marker, tick));
        }
    }
    return NOH_OK;
}

static noh_result check_binding(const noh_check *check, const noh_clip_header *h)
{
    const noh_pack *pack = check->pack;
    const noh_skeleton_header *skeleton;
    if (h->joint_count == 0) {
        const noh_check_field fields[] = {
            { offsetof(noh_clip_header, skeleton_hash), h->skeleton_hash != 0 },
            { offsetof(noh_clip_header, skeleton), h->skeleton != NOH_NONE },
            { offsetof(noh_clip_header, joint_error_count), h->joint_error_count != 0 },
        };
        return noh_check_fields(check, fields, 3, "clip without joints names a skeleton, or has joint errors", 0);
    }
    if (h->skeleton >= pack->skeleton_count) {
        return noh_check_fail(check, "clip names a skeleton that is not there", offsetof(noh_clip_header, skeleton));
    }
    skeleton = (const noh_skeleton_header *)(const void *)(pack->bytes +
                                                           pack->chunks[pack->first_skeleton + h->skeleton].offset);
    if (skeleton->joint_count != h->joint_count) {
        return noh_check_fail(check, "clip's joint count is not its skeleton's",
                              offsetof(noh_clip_header, joint_count));
    }
    if (skeleton->hash != h->skeleton_hash) {
        return noh_check_fail(check, "clip's hash is not its skeleton's", offsetof(noh_clip_header, skeleton_hash));
    }
    if (skeleton->level_count != h->joint_error_count) {
        return noh_check_fail(check, "clip's joint errors are not of its skeleton's levels",
                              offsetof(noh_clip_header, joint_error_count));
    }
    return NOH_OK;
}

/* Errors begin with 0 and never fall: leaving more out never makes a pose better. */
static noh_result check_errors(const noh_check *check, const float *errors, uint32_t count, const char *what)
{
    for (uint32_t i = 0; i < count; i++) {
        if (!noh_float_finite(errors[i]) || (i ? errors[i] < errors[i - 1] : errors[i] != 0.0f)) {
            return noh_check_fail(check, what, (uint64_t)((const uint8_t *)(errors + i) - check->bytes));
        }
    }
    return NOH_OK;
}

static noh_result check_clip_errors(const noh_check *check, const noh_clip_header *h)
{
    const float *joint_errors = (const float *)(const void *)(check->bytes + h->joint_errors_offset);
    noh_result result = check_errors(check, joint_errors, h->joint_error_count,
                                     "joint errors do not begin with 0, or fall, or are not finite");
    if (!result)
        result = check_errors(check, h->update_rate_error, NOH_CLIP_UPDATE_RATES,
                              "update rate errors do not begin with 0, or fall, or are not finite");
    if (!result && (!noh_float_finite(h->error_shell) || h->error_shell < 0.0f)) {
        result = noh_check_fail(check, "the shell of a clip's errors is not a length",
                                offsetof(noh_clip_header, error_shell));
    }
    return result;
}

/* The ends of the root joint: unit rotations where there are joints. */
static noh_result check_root_ends(const noh_check *check, const noh_clip_header *h)
{
    const uint64_t at = offsetof(noh_clip_header, root_ends);
    noh_result result = noh_check_floats(check, h->root_ends[0], 14, "root joint's first or last frame is not finite");
    for (uint32_t i = 0; i < 2 && !result; i++) {
        const float *q = h->root_ends[i];
        const float square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
        if (h->joint_count && !(square > 0.99f && square < 1.01f)) {
            result = noh_check_fail(check, "root joint's rotation in the first or last frame is not unit",
                                    at + i * sizeof h->root_ends[0]);
        }
    }
    return result;
}

noh_result noh_check_clip(noh_check *check)
{
    const noh_clip_header *h = (const noh_clip_header *)(const void *)check->bytes;
    noh_result result = noh_check_head(check, sizeof *h);
    if (!result) result = check_binding(check, h);
    if (result) {
        return result;
    }
    if (h->event_count > NOH_CLIP_EVENTS_MAX) {
        return noh_check_fail(check, "callback key count is over the limit", offsetof(noh_clip_header, event_count));
    }
    if (h->marker_count > NOH_CLIP_MARKERS_MAX) {
        return noh_check_fail(check, "sync marker count is over the limit", offsetof(noh_clip_header, marker_count));
    }
    result = noh_check_array(check, offsetof(noh_clip_header, events_offset), h->event_count, sizeof(noh_clip_event));
    if (!result)
        result = noh_check_array(check, offsetof(noh_clip_header, markers_offset), h->marker_count,
                                 sizeof(noh_clip_marker));
    if (!result)
        result = noh_check_array(check, offsetof(noh_clip_header, joint_errors_offset), h->joint_error_count, 4);
    if (!result) result = noh_check_array(check, offsetof(noh_clip_header, clip_offset), h->clip_bytes, 1);
    if (!result) result = noh_check_end(check);
    if (!result) result = check_events(check, h);
    if (!result) result = check_markers(check, h);
    if (!result) result = check_root_ends(check, h);
    return result ? result : check_clip_errors(check, h);
}
