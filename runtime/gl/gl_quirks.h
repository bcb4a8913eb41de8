/* gl_quirks.h: what a renderer's name tells and a probe cannot.
 *
 *   noh_gl_quirk_find   the entry that says so of a renderer, with its reason and source
 *   noh_gl_quirk_table  all of them
 *
 * Abilities are found by trying (gl_caps.h). Here is only what the library does
 * otherwise because of a name, each thing once. A quirk is forced or lifted by
 * changing caps.renderer. */
#ifndef NOH_GL_GL_QUIRKS_H
#define NOH_GL_GL_QUIRKS_H

#include "base/result.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum noh_quirk {
    NOH_QUIRK_SOFTWARE,    /* auto takes the path cpu: the rasteriser runs there anyway */
    NOH_QUIRK_BLEND_DEAR,  /* auto takes gather before mrt, whatever number of targets is expected */
    NOH_QUIRK_HALF_UNSURE  /* the probe's half-float modes become NOH_HALF_UNKNOWN */
} noh_quirk;

typedef struct noh_gl_quirk {
    const char *renderer; /* a part of GL_RENDERER */
    noh_quirk quirk;
    const char *reason;
    const char *source;   /* who says so: a document, an issue, or how it was measured */
} noh_gl_quirk;

/* NULL where the renderer has no such quirk. */
const noh_gl_quirk *noh_gl_quirk_find(const char *renderer, noh_quirk quirk);

const noh_gl_quirk *noh_gl_quirk_table(uint32_t *count);

#ifdef __cplusplus
}
#endif

#endif
