/* check_clip.c: the checker of clips. noh_clip_init checks the compressed clip inside the chunk when it opens it: the
 * clip's bytes alone say whether they are right. */
#include "core/base/math_internal.h"
#include "core/pack/check_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/pack.h"

#include <stddef.h>

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
        if (!noh_is_finite(events[i].weight_min) || events[i].weight_min < 0.0f) {
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
    if (h->skeleton >= pack->runs[NOH_CHUNK_SKELETON].count) {
        return noh_check_fail(check, "clip names a missing skeleton", offsetof(noh_clip_header, skeleton));
    }
    skeleton = noh_pack_chunk_at(pack, NOH_CHUNK_SKELETON, h->skeleton);
    if (skeleton->joint_count != h->joint_count) {
        return noh_check_fail(check, "clip's joint count is not its skeleton's",
                              offsetof(noh_clip_header, joint_count));
    }
    if (skeleton->hash != h->skeleton_hash) {
        return noh_check_fail(check, "clip's hash is not its skeleton's", offsetof(noh_clip_header, skeleton_hash));
    }
    if (skeleton->level_count != h->joint_error_count) {
        return noh_check_fail(check, "number of a clip's joint errors differs from its skeleton's joint levels",
                              offsetof(noh_clip_header, joint_error_count));
    }
    return NOH_OK;
}

/* Errors begin with 0 and never fall: leaving more out never makes a pose better. */
static noh_result check_errors(const noh_check *check, const float *errors, uint32_t count, const char *what)
{
    for (uint32_t i = 0; i < count; i++) {
        if (!noh_is_finite(errors[i]) || (i ? errors[i] < errors[i - 1] : errors[i] != 0.0f)) {
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
    if (!result && (!noh_is_finite(h->error_shell) || h->error_shell < 0.0f)) {
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
