#include "debug_kind.h"

#include <string.h>

#include "cli/message.h"

const char *const debug_names[DEBUG_COUNT] = { "none",      "position", "normal",    "tangent", "lod",     "light",
                                               "occlusion", "wrinkle",  "wireframe", "joints",  "weights", "bones" };

int debug_parse(const char *text, debug_kind *kind)
{
    *kind = DEBUG_NONE;
    for (int i = 0; text && i < DEBUG_COUNT; i++) {
        if (strcmp(text, debug_names[i]) == 0) {
            *kind = (debug_kind)i;
            return 0;
        }
    }
    return text ? tool_usage("--debug must be none, position, normal, tangent, lod, light, occlusion, wrinkle, "
                             "wireframe, joints, weights or bones, not '%s'",
                             text)
                : 0;
}

noh_debug_view debug_view_of(debug_kind kind)
{
    return kind < DEBUG_WIREFRAME ? (noh_debug_view)kind : NOH_VIEW_LIT;
}
