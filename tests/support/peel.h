/* peel.h: what blends, in the right order at each pixel.
 *
 * Each pass draws the nearest surface behind the one that the pass before drew, without blending, with the library's
 * own shader (depth peeling: Everitt, Interactive order-independent transparency, 2001). The layers are then blended on
 * the CPU, back to front, in linear light. No order of triangles enters into it. */
#ifndef NOH_TESTS_SUPPORT_PEEL_H
#define NOH_TESTS_SUPPORT_PEEL_H

#include "support/gl_fixture.h"
#include "noh/format.h"
#include "noh/pack.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"

#define PEEL_LAYERS_MAX 250u

/* A square target of one sample, sRGB, and a renderer that peels. */
typedef struct peel {
    gpu *g;
    uint32_t side;
    uint32_t layers; /* that the last picture had */
    GLuint framebuffer, color, depth[3];
    GLuint behind; /* the depth texture that the next layer lies behind */
    noh_pack pack; /* the mesh's, in which nothing blends */
    noh_mesh mesh; /* with that pack */
    noh_material *materials;
    char *fragment;
    noh_gl_renderer renderer;
    noh_gl_ledger ledger;
} peel;

/* mesh: with what blends and what does not; its pack must stay */
void peel_open(peel *p, gpu *g, const noh_mesh *mesh, uint32_t side);
void peel_close(peel *p);

/* Bind the target, cleared to the background of pictures, for passes of any renderer. */
void peel_begin(peel *p);
/* rgba[side][side][4] as drawn since peel_begin, the lowest row first, to be freed. */
uint8_t *peel_read(const peel *p);

/* Behind peel_begin and everything opaque: that with the submeshes of `blended` over it, a copy of the mesh with
 * those submeshes alone. To be freed, like peel_read. */
uint8_t *peel_picture(peel *p, const noh_mesh *blended, const noh_gl_camera *camera, const noh_gl_texture *pictures);

/* Pixels with a channel that is off by more than `wrong` of 255. *worst: raised to the largest difference. */
uint32_t peel_wrong(const peel *p, const uint8_t *a, const uint8_t *b, int wrong, int *worst);

#endif
