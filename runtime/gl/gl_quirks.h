/* gl_quirks.h: what a renderer's name tells and a probe cannot.
 *
 *   noh_gl_quirk_find   the entry that says so of a renderer, with its reason and source
 *   noh_gl_quirk_table  all of them
 *
 * Capabilities are found by trying (gl_caps.h). Only what cannot be tried is decided
 * by a renderer's name, and all of that is in this table. To force or lift a quirk,
 * change caps.renderer.
 *
 * Threads: any; the table is constant. */
#ifndef NOH_GL_GL_QUIRKS_H
#define NOH_GL_GL_QUIRKS_H

#include "base/result.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum noh_quirk {
    NOH_QUIRK_SOFTWARE,   /* rasterised on the CPU: auto takes the path cpu */
    NOH_QUIRK_BLEND_DEAR, /* float blending is slow: auto takes gather, however few targets are expected */
    NOH_QUIRK_HALF_UNSURE /* the probe's half-float modes become NOH_HALF_UNKNOWN */
} noh_quirk;

typedef struct noh_gl_quirk {
    const char *renderer; /* a part of GL_RENDERER */
    noh_quirk quirk;
    const char *reason;
    const char *source; /* who says so: a document, an issue, or how it was measured */
} noh_gl_quirk;

/* NULL where the renderer has no such quirk. */
const noh_gl_quirk *noh_gl_quirk_find(const char *renderer, noh_quirk quirk);

const noh_gl_quirk *noh_gl_quirk_table(uint32_t *count);

#ifdef __cplusplus
}
#endif

#endif
