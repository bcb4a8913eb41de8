#include "named_errors.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static size_t name_length(const char *item)
{
    const char *equals = strrchr(item, '=');
    return equals ? (size_t)(equals - item) : 0;
}

static int is_named(const char *item, const char *name)
{
    size_t length = name_length(item);
    return strlen(name) == length && memcmp(item, name, length) == 0;
}

double named_error(const named_errors *errors, const char *name)
{
    for (uint32_t i = errors->count; i > 0; i--) {
        if (is_named(errors->items[i - 1u], name)) {
            return strtod(errors->items[i - 1u] + strlen(name) + 1u, NULL);
        }
    }
    return 0.0;
}

double *named_joint_errors(const named_errors *errors, const raw_skeleton *skeleton, int *failed)
{
    double *out;
    if (!errors->count || !skeleton->joint_count) {
        return NULL;
    }
    out = calloc(skeleton->joint_count, sizeof *out);
    *failed |= !out;
    for (uint32_t j = 0; out && j < skeleton->joint_count; j++) {
        out[j] = named_error(errors, skeleton->joints[j].name ? skeleton->joints[j].name : "");
    }
    return out;
}

static int has_clip(raw_set *const *sets, uint32_t set_count, const char *item)
{
    for (uint32_t i = 0; i < set_count; i++) {
        for (uint32_t c = 0; c < sets[i]->clip_count; c++) {
            if (is_named(item, sets[i]->clips[c].name)) return 1;
        }
    }
    return 0;
}

static int has_joint(raw_set *const *sets, uint32_t set_count, const char *item)
{
    for (uint32_t i = 0; i < set_count; i++) {
        for (uint32_t j = 0; j < sets[i]->skeleton.joint_count; j++) {
            if (sets[i]->skeleton.joints[j].name && is_named(item, sets[i]->skeleton.joints[j].name)) return 1;
        }
    }
    return 0;
}

static int check_number(const char *item, const char *option, model_error *error)
{
    const char *number = item + name_length(item) + 1u;
    char *end = NULL;
    double value = name_length(item) ? strtod(number, &end) : 0.0;
    if (end && end != number && !*end && isfinite(value) && value > 0.0) {
        return 0;
    }
    snprintf(error->what, sizeof error->what, "%s must be NAME=CM with CM above 0 centimetres, not '%.100s'", option,
             item);
    error->where[0] = 0;
    return 1;
}

int named_errors_check(const named_errors *clips, const named_errors *joints, raw_set *const *sets, uint32_t set_count,
                       model_error *error)
{
    for (uint32_t i = 0; i < clips->count + joints->count; i++) {
        const int of_clip = i < clips->count;
        const char *item = of_clip ? clips->items[i] : joints->items[i - clips->count];
        if (check_number(item, of_clip ? "--clip-error" : "--joint-error", error)) {
            return 1;
        }
        if (!(of_clip ? has_clip(sets, set_count, item) : has_joint(sets, set_count, item))) {
            snprintf(error->what, sizeof error->what, "no %s is named '%.*s'", of_clip ? "clip" : "joint",
                     (int)name_length(item), item);
            error->where[0] = 0;
            return 1;
        }
    }
    return 0;
}
