/* debug_kind.h: what --debug shows in place of the lit surface, or over it. */
#ifndef NOH_NOH_DRAW_DEBUG_KIND_H
#define NOH_NOH_DRAW_DEBUG_KIND_H

#include "noh/noh_gl.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The first values equal noh_debug_view, which the library's shaders show; overlay.h draws the others. */
typedef enum debug_kind {
    DEBUG_NONE,
    DEBUG_WIREFRAME = NOH_VIEW_WRINKLE + 1,
    DEBUG_JOINTS,
    DEBUG_WEIGHTS,
    DEBUG_BONES,
    DEBUG_COUNT
} debug_kind;

extern const char *const debug_names[DEBUG_COUNT];
#define DEBUG_VALUES "none|position|normal|tangent|lod|light|occlusion|wrinkle|wireframe|joints|weights|bones"

/* text  NULL: none. Prints an error and returns an exit code; 0 on success. */
int debug_parse(const char *text, debug_kind *kind);
/* The view that the library's shaders show below the overlay. */
noh_debug_view debug_view_of(debug_kind kind);

#ifdef __cplusplus
}
#endif
#endif
