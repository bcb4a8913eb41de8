/* lighting.h: the light that pictures are drawn in, as the options say it. */
#ifndef NOH_NOH_DRAW_LIGHTING_H
#define NOH_NOH_DRAW_LIGHTING_H

#include "camera.h"
#include "gpu/gpu.h"
#include "noh/noh.h"
#include "noh/light.h"
#include "noh/noh_gl.h"

typedef struct light_options {
    const char *light, *tonemap, *shadow, *transfer, *background; /* of OPTIONS_LIGHT; NULL: their defaults */
    double rotate;                                                /* degrees about the vertical axis */
    double facing;                                                /* view_options.facing: it turns with the front */
} light_options;

#define LIGHTING_SHADOW_PX 512u

typedef enum lighting_background { BACKGROUND_PLAIN, BACKGROUND_GRADIENT, BACKGROUND_LIGHT } lighting_background;

/* Must not move once a figure is lit by it. */
typedef struct lighting {
    const char *name; /* light_options.light */
    void *texels;
    noh_reflection reflection;
    noh_light light; /* not turned */
    noh_gl_light_desc desc;
    noh_lighting told;
    int has_shadow, has_blobs, without_transfer;
    double degrees;  /* how far it is turned, seen from the front */
    float sphere[4]; /* what casts its shadow: of lighting_shadow_view */
    lighting_background background;
} lighting;

/* 1 if the options select an environment, not "none". "auto" is replaced by its light.
 * pack: its materials choose the light of "auto"; NULL: none known
 * shows_surfaces: 0: bones, or values as colours */
int lighting_wanted(light_options *o, const noh_pack *pack, int shows_surfaces);
/* Read or bake the environment. Prints an error and returns an exit code; 0 on success. */
int lighting_open(lighting *l, const light_options *o);
void lighting_close(lighting *l);
/* Turn it, and expose it for faces that look to the front. facing: of light_options */
void lighting_turn(lighting *l, double degrees, double facing);

/* The view of the shadow map, for the contents of the box; also passed to shaders. */
noh_stage_view lighting_shadow_view(lighting *l, const bounds *box);

#endif
