/* gl_quirks_internal.h: the private part of low_gl.h. */
#ifndef NOH_GL_GL_QUIRKS_INTERNAL_H
#define NOH_GL_GL_QUIRKS_INTERNAL_H

#include "noh/low_gl.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ======== known drivers ========
 * Workarounds chosen by the renderer's name.
 *
 *   noh_gl_quirk_find   the entry for a renderer, with its reason and source
 *
 * Capabilities are tested (gl_device.h). Only what cannot be tested is decided by the renderer's name, with this table.
 * To force or disable a quirk, change caps.renderer.
 *
 * Threads: any; the table is constant. */

typedef enum noh_quirk {
    NOH_QUIRK_SOFTWARE,    /* rasterises on the CPU: auto chooses the path cpu */
    NOH_QUIRK_BLEND_DEAR,  /* float blending is slow: auto chooses gather for any number of targets */
    NOH_QUIRK_HALF_UNSURE, /* rounds halves irregularly: the probe sets half-float modes to NOH_HALF_UNKNOWN */
    /* Renders in tiles with 16, 32 or 64 bytes per pixel: more bytes of float layers make tiles smaller, or spill. Of
     * these, the first entry in the table applies */
    NOH_QUIRK_TILE_16,
    NOH_QUIRK_TILE_32,
    NOH_QUIRK_TILE_64,
    NOH_QUIRK_BLOCK_DEAR /* uniform blocks read at an index cost more than texels: palettes are in a texture */
} noh_quirk;

typedef struct noh_gl_quirk {
    const char *renderer; /* a substring of GL_RENDERER */
    noh_quirk quirk;
    const char *reason; /* a sentence; if the quirk decides the path, the plan's `reason` */
    const char *source; /* a document, an issue, or the measurement */
} noh_gl_quirk;

/* The first entry with this quirk whose name occurs in `renderer`; NULL: none. */
const noh_gl_quirk *noh_gl_quirk_find(const char *renderer, noh_quirk quirk);

/* All entries: [*count]. */
const noh_gl_quirk *noh_gl_quirk_table(uint32_t *count);

#ifdef __cplusplus
}
#endif

#endif
