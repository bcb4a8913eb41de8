/* gl_quirks.h: what is known of a renderer by its name only.
 *
 *   noh_gl_quirk_find   the entry for a renderer, with its reason and source
 *   noh_gl_quirk_table  all entries
 *
 * Capabilities are found by trying them (gl_caps.h). Only what cannot be tried is decided by the renderer's name, and
 * all of it is in this table. To force or lift a quirk, change caps.renderer.
 *
 * Threads: any; the table is constant. */
#ifndef NOH_GL_GL_QUIRKS_H
#define NOH_GL_GL_QUIRKS_H

#include "core/base/result.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum noh_quirk {
    NOH_QUIRK_SOFTWARE,    /* rasterises on the CPU: auto takes the path cpu */
    NOH_QUIRK_BLEND_DEAR,  /* float blending is slow: auto takes gather, however few targets are expected */
    NOH_QUIRK_HALF_UNSURE, /* rounds halves irregularly: the probe's half-float modes become NOH_HALF_UNKNOWN */
    NOH_QUIRK_TILE_16, /* renders in tiles with 16 bytes a pixel: three layers of floats make tiles smaller, or spill */
    NOH_QUIRK_TILE_32  /* with 32 bytes a pixel */
} noh_quirk;

typedef struct noh_gl_quirk {
    const char *renderer; /* a substring of GL_RENDERER */
    noh_quirk quirk;
    const char *reason; /* a sentence; that of a quirk that decides a path is the plan's `reason` */
    const char *source; /* a document, an issue, or how it was measured */
} noh_gl_quirk;

/* The first entry with that quirk whose name occurs in `renderer`; NULL: none. */
const noh_gl_quirk *noh_gl_quirk_find(const char *renderer, noh_quirk quirk);

/* All entries: [*count]. */
const noh_gl_quirk *noh_gl_quirk_table(uint32_t *count);

#ifdef __cplusplus
}
#endif

#endif
