/* gl_quirks.c: the table of quirks. Each entry has a source, so that it can be checked again and removed. */
#include "core/base/assert_internal.h"
#include "gl/device/gl_quirks_internal.h"
#include "noh/low_gl.h"

#define SOFTWARE_REASON "cpu: this GL is rasterised in software, so SIMD on the CPU is the least work"

#define PANFROST_TILES \
    "Mesa 25.0.7, panfrost's table of tile buffers, halved because two tiles are in flight: not measured here"

static const noh_gl_quirk quirks[] = {
    { "llvmpipe", NOH_QUIRK_SOFTWARE, SOFTWARE_REASON,
      "noh bench, Mesa 22.3.6: runtime/gl/LOG.md; also names zink on lavapipe" },
    { "softpipe", NOH_QUIRK_SOFTWARE, SOFTWARE_REASON, "Mesa's other software rasteriser" },
    { "swrast", NOH_QUIRK_SOFTWARE, SOFTWARE_REASON, "Mesa's classic software rasteriser, up to 21.3" },
    { "SwiftShader", NOH_QUIRK_SOFTWARE, SOFTWARE_REASON, "what browsers fall back to; gfx-rs/gfx#2962" },
    { "Microsoft Basic Render", NOH_QUIRK_SOFTWARE, SOFTWARE_REASON,
      "Direct3D's WARP under ANGLE; simdsoft/x-studio#602" },
    { "Mali", NOH_QUIRK_BLEND_DEAR, "gather: this GPU's vendor advises against blending into float framebuffers",
      "Arm GPU Best Practices Developer Guide (101897), Fragment shading, Blending" },
    { "Mali-G610", NOH_QUIRK_TILE_64, "tiles of 16 x 16 pixels have 64 bytes a pixel", PANFROST_TILES },
    { "Mali-G710", NOH_QUIRK_TILE_64, "tiles of 16 x 16 pixels have 64 bytes a pixel", "as G610, with more cores" },
    { "Mali-T", NOH_QUIRK_TILE_16, "tiles of 16 x 16 pixels have 16 bytes a pixel", PANFROST_TILES },
    { "Mali-G71", NOH_QUIRK_TILE_16, "tiles of 16 x 16 pixels have 16 bytes a pixel", PANFROST_TILES },
    { "Mali", NOH_QUIRK_TILE_32, "tiles of 16 x 16 pixels have 32 bytes a pixel", PANFROST_TILES },
    { "Apple", NOH_QUIRK_TILE_32, "tile memory has 32 bytes a pixel from A8 on",
      "Apple, Metal Feature Set Tables, maximum render target size per pixel: reasoned, not measured here" },
    { "Mali", NOH_QUIRK_BLOCK_DEAR, "rows of joints cost this GPU less from a texture than from a uniform block",
      "Mesa 25.0.7's compilers (tools/phones): four joints 6.5 + 11.3 cycles of a G52 by texels, 15 + 23 by a block; "
      "Adreno 630 and VideoCore VI take 7 and 10 % less by a block: a model, not measured" },
    { "SwiftShader", NOH_QUIRK_HALF_UNSURE,
      "halves below 2^-14 are rounded twice now and then, which no probe of a few texels shows",
      "noh verify --seed 1 on the demo mask, ANGLE of Chromium 150: two of 365,646 values one step off" }
};
#define QUIRK_COUNT (sizeof quirks / sizeof quirks[0])

static int contains(const char *text, const char *word)
{
    for (; *text; text++) {
        const char *a = text, *b = word;
        while (*b && *a == *b) {
            a++;
            b++;
        }
        if (!*b) {
            return 1;
        }
    }
    return 0;
}

const noh_gl_quirk *noh_gl_quirk_find(const char *renderer, noh_quirk quirk)
{
    NOH_ASSERT(renderer && quirk <= NOH_QUIRK_BLOCK_DEAR);
    for (uint32_t i = 0; i < QUIRK_COUNT; i++) {
        if (quirks[i].quirk == quirk && contains(renderer, quirks[i].renderer)) {
            return &quirks[i];
        }
    }
    return NULL;
}

const noh_gl_quirk *noh_gl_quirk_table(uint32_t *count)
{
    NOH_ASSERT(count);
    *count = (uint32_t)QUIRK_COUNT;
    return quirks;
}
