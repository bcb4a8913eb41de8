#include "gpu_args.h"

#include <string.h>

#include "cli/message.h"
#include "noh/low_gl.h"

int parse_path(const char *text, noh_morph_path *path)
{
    *path = NOH_MORPH_AUTO;
    for (unsigned i = 0; text && i < NOH_MORPH_PATH_COUNT; i++) {
        if (strcmp(text, noh_morph_path_name((noh_morph_path)i)) == 0) {
            *path = (noh_morph_path)i;
            return 0;
        }
    }
    return text ? tool_usage(
                      "--path must be auto, blend, layered, mrt, per-layer, gather, direct, cpu or streams, not '%s'",
                      text)
                : 0;
}

int parse_accumulate(const char *text, noh_accumulate *accumulate)
{
    *accumulate = NOH_ACCUMULATE_AUTO;
    for (unsigned i = 0; text && i < 3; i++) {
        if (strcmp(text, noh_accumulate_name((noh_accumulate)i)) == 0) {
            *accumulate = (noh_accumulate)i;
            return 0;
        }
    }
    return text ? tool_usage("--accumulate must be auto, f32 or f16, not '%s'", text) : 0;
}

int parse_instances(double value, uint32_t *instances)
{
    if (value < 1.0 || value > NOH_MORPH_INSTANCES_MAX || value != (double)(uint32_t)value) {
        return tool_usage("--instances must be a whole number from 1 to %u", NOH_MORPH_INSTANCES_MAX);
    }
    *instances = (uint32_t)value;
    return 0;
}
