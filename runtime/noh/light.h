/* light.h: light from all around as spherical harmonics and as a cube of texels, and how a mesh receives it. All of it
 * runs on the CPU. */

#ifndef NOH_LIGHT_H
#define NOH_LIGHT_H

#include <stddef.h>
#include <stdint.h>

#include "base.h"
#include "format.h"
#include "pack.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ======== environments ========
 * Environment light, as a short description and as spherical harmonics.
 *
 *   noh_environment_find, noh_environment_at   built-in environments: white, studio, room, sky
 *   noh_light_from_environment                 its spherical harmonics, exact
 *   noh_light_exposure                         exposure for faces
 *
 * An environment is an ambient radiance, up to eight lamps and up to two windows. A lamp is round: its radiance at the
 * angle a from its direction is colour * s^power, s = (cos a - edge) / (1 - edge), and 0 where s is not above 0. Its
 * spherical harmonics have a closed form. A window is an upright rectangle of uniform panes with dark bars around each,
 * as reflected in eyes. Its panes are integrated numerically, almost exactly.
 *
 * Radiance is linear RGB; a white matte surface under radiance 1 from all directions reflects 1. Y is up, +Z is towards
 * a viewer in front of the character.
 * Threads: no state; any thread. */

#define NOH_ENVIRONMENT_COUNT 4u

typedef struct noh_lamp {
    float direction[3]; /* unit, towards the lamp */
    float edge;         /* cosine of its half angle, -1 to below 1: 0 is a hemisphere */
    uint32_t power;     /* 0: uniform with a sharp edge; 1, 2: softer */
    float color[3];     /* radiance at its centre */
} noh_lamp;

/* An upright rectangle on the plane at distance 1. */
typedef struct noh_window {
    float direction[3]; /* unit, towards its centre; the plane is perpendicular to it */
    float half[2];      /* half of width and height on the plane; 0.5: 53 degrees in all */
    uint32_t panes[2];  /* columns and rows, 1..4 each */
    float bar;          /* share of a pane's width and height taken by bars, 0 to below 1 */
    float color[3];     /* radiance of the panes, added to the surroundings */
} noh_window;

typedef struct noh_environment {
    const char *name;
    float ambient[3];
    uint32_t lamp_count;
    noh_lamp lamps[NOH_LAMPS_MAX];
    uint32_t window_count;
    noh_window windows[NOH_WINDOWS_MAX];
} noh_environment;

/* Light as spherical harmonics of radiance, with red, green and blue per coefficient. */
typedef struct noh_light {
    uint32_t order; /* 1..NOH_SH_ORDER_MAX */
    float coefs[NOH_SH_COUNT_MAX][3];
} noh_light;

/* The index of a built-in environment by name; NOH_NONE if there is none. */
uint32_t noh_environment_find(const char *name);
/* A built-in environment.
 * ranges  index below NOH_ENVIRONMENT_COUNT */
const noh_environment *noh_environment_at(uint32_t index);

/* Compute the spherical harmonics of an environment.
 * ranges  order 1..NOH_SH_ORDER_MAX; lamp_count at most NOH_LAMPS_MAX, powers at most 2
 * errors  at most 3e-6 of the sum of the lamp colours; for windows with half below 0.7, 1e-5 of the window colours
 * source  the integral over a lamp is of a polynomial of degree at most 7, which Gauss-Legendre quadrature with four
 *         nodes integrates exactly (Abramowitz, Stegun: 25.4.29) */
void noh_light_from_environment(const noh_environment *environment, uint32_t order, noh_light *light);

/* The exposure at which a face that looks towards +Z shows its own colours under this light: 1.1 divided by the
 * luminance that a white matte face reflects, or by 0.6 times the luminance of one that faces the key light, if that is
 * larger. For noh_lighting.exposure with NOH_TONEMAP_NEUTRAL; 1 in darkness.
 * rotation  as in noh_lighting_make; NULL: not rotated
 * ranges    light's order at least 2 */
float noh_light_exposure(const noh_light *light, const float rotation[9]);

/* ======== reflections ========
 * Reflections of an environment by surfaces of any roughness: a cube map with a level for each roughness.
 *
 *   noh_reflection_size       bytes of the texels; noh_reflection_scratch_size: bytes of init's scratch
 *   noh_reflection_init       sample a radiance and blur it
 *   noh_reflection_of_environment  a radiance function for an environment
 *
 * Level 0 is a mirror; level k of 0 to 4 is blurred as by a surface of roughness k / 4 at normal incidence: by the GGX
 * distribution with alpha = roughness^2, weighted by the cosine. The GPU's trilinear filter blends between levels.
 *
 * A texel is 32 bits with a shared exponent (GL_RGB9_E5), which OpenGL ES 3.0 can filter; its largest component has an
 * error of at most 1 / 512. Levels are consecutive, each with its faces in GL's order (+x -x +y -y +z -z) and rows as
 * GL reads them.
 *
 * source   Karis: Real shading in Unreal Engine 4, SIGGRAPH 2013 (the split sum); Walter et al.: Microfacet models for
 *          refraction through rough surfaces, EGSR 2007 (GGX)
 * Threads: no state; any thread. */

#define NOH_REFLECTION_LEVELS 5u

typedef struct noh_reflection {
    uint32_t side;          /* texels of a face of level 0 */
    const uint32_t *texels; /* [noh_reflection_size(side) / 4] */
} noh_reflection;

/* The radiance from a direction, linear RGB, not below 0.
 * shapes  direction is unit */
typedef void (*noh_radiance)(const void *user, const float direction[3], float rgb[3]);

typedef struct noh_reflection_desc {
    uint32_t side; /* power of 2, 16..NOH_REFLECTION_SIDE_MAX; default (0) 64: 130,944 bytes */
    noh_radiance radiance;
    const void *user;
} noh_reflection_desc;

/* A noh_radiance for an environment; user is a const noh_environment *. */
void noh_reflection_of_environment(const void *user, const float direction[3], float rgb[3]);

/* Bytes of the texels, and of the scratch of init; 0 if side is out of range. */
size_t noh_reflection_size(uint32_t side);
size_t noh_reflection_scratch_size(uint32_t side);

/* Sample a radiance and blur it. Level 0 takes 16 samples per texel; the other levels are sums over its texels, or over
 * reduced ones for wide blurs. Errors are at most 2 % of the brightest texel from an exact blur, 0.5 % on average, for
 * the built-in environments.
 * memory   [bytes] for the texels; must stay as long as the reflection
 * scratch  [scratch_bytes] free again afterwards
 * errors   ARG side, no radiance, or memory or scratch is NULL or misaligned; MEMORY one of them is too small (need:
 *          its bytes) */
noh_result noh_reflection_init(void *memory, size_t bytes, void *scratch, size_t scratch_bytes,
                               const noh_reflection_desc *desc, noh_reflection *out, noh_error *error);

/* ======== transfer ========
 * Precomputed radiance transfer of a mesh that deforms: the light that each vertex receives from an
 * environment, in 4 to 8 bytes, and shading with it on the CPU, the reference for the GPU.
 *
 *   noh_transfer_of           the transfer of a mesh
 *   noh_transfer_accumulate   change of occlusion by targets
 *   noh_transfer_lobe         one vertex, decoded
 *   noh_lobe_turn             the lobe of a rotated surface
 *   noh_lobe_shade            the light that it receives
 *   noh_transfer_shade        the light on one vertex as drawn
 *
 * The light reaching a vertex is a function of direction: the cosine to the normal where the sky is visible, 0 where
 * the mesh itself blocks it. It is stored as a lobe, symmetric about an axis: its integral (occlusion) and for each
 * band the mean of a Legendre polynomial. To turn a lobe with the surface, only its axis is turned; light may turn
 * freely, because it is a factor. Axes are bent towards the open side: with axes along the normal
 * (NOH_TRANSFER_ON_NORMAL) the shape adds little to the occlusion. Targets that open a mouth or lower a brow change the
 * occlusion: one stored difference for each vertex and target that moves it, summed by weight like positions.
 *
 * This is valid for surfaces that turn and for occlusion by targets; an arm in front of the face casts no shadow.
 *
 * source   Sloan, Luna, Snyder: Local, deformable precomputed radiance transfer, SIGGRAPH 2005 (zonal harmonics about
 *          their own axes); Microsoft, SparseMorphTargets sample (about the normal); Landis: Production-ready global
 *          illumination, SIGGRAPH course 16, 2002 (the bent normal)
 * Threads: no state; any thread. */

/* The transfer of a mesh, at every LOD level. A view: valid as long as the pack and its bytes are. Shapes are in
 * format.h. */
typedef struct noh_transfer {
    const noh_transfer_header *header;
    const uint8_t *records;
    const float *scales;
    const int8_t *deltas;
} noh_transfer;

/* The transfer of a vertex. */
typedef struct noh_lobe {
    float occlusion;               /* 0..1 */
    float axis[3];                 /* unit, model space */
    float shape[NOH_SH_ORDER_MAX]; /* by band; the first is 1 */
} noh_lobe;

/* Get the transfer of a mesh.
 * errors  NOT_FOUND the pack has no transfer for this mesh: it was built without --transfer; *transfer is untouched */
noh_result noh_transfer_of(const noh_mesh *mesh, noh_transfer *transfer, noh_error *error);

/* Add weight * change of occlusion for all targets with nonzero weights, in the order of noh_morph_accumulate: the
 * reference for the fourth component of positions in accumulators (low_gl.h). Clear the layer first.
 * shapes  weights[target_count], occlusion[morph_height << morph_width_log2] of the mesh's level
 * ranges  weights are finite; the mesh has a transfer */
void noh_transfer_accumulate(const noh_mesh *mesh, const float *weights, float *occlusion);

/* Decode the lobe of a vertex in the bind pose.
 * ranges  vertex below vertex_count of the mesh */
void noh_transfer_lobe(const noh_mesh *mesh, const noh_transfer *transfer, uint32_t vertex, noh_lobe *lobe);

/* Turn the lobe's axis by the smallest rotation from `from` to `to`; does nothing for opposite directions.
 * ranges  both unit */
void noh_lobe_turn(noh_lobe *lobe, const float from[3], const float to[3]);

/* The light reflected by a white matte surface with this lobe: the sum over bands of shape times the light along the
 * axis. If the orders of light and transfer differ, the lower one is used. May be below 0 opposite a sharp lamp, by a
 * few per cent of it.
 * ranges  order: of the transfer, 1..NOH_SH_ORDER_MAX */
void noh_lobe_shade(const noh_lobe *lobe, uint32_t order, const noh_light *light, float rgb[3]);

/* The light on a vertex as drawn.
 * normal     its deformed unit normal, in the space of the light
 * occlusion  the layer of noh_transfer_accumulate; NULL: the bind pose */
void noh_transfer_shade(const noh_mesh *mesh, const noh_transfer *transfer, uint32_t vertex, const float normal[3],
                        const float *occlusion, const noh_light *light, float rgb[3]);

#ifdef __cplusplus
}
#endif

#endif
