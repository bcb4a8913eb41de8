/* light_measure.h: a pack's transfers against brute force: rays from every vertex, in the bind pose and in a pose of
 * the targets, under random lights. */
#ifndef NOH_NOH_LIGHT_LIGHT_MEASURE_H
#define NOH_NOH_LIGHT_LIGHT_MEASURE_H

#include "convert/light/light_rays.h"
#include "noh/light.h"
#include "noh/pack.h"

/* Random lights: a gradient and one to three lamps, soft (about 60 degrees wide) or sharp (about 25). */
#define LIGHT_KINDS 2u
#define LIGHTS_OF_KIND 12u
#define LIGHT_COUNT (LIGHT_KINDS * LIGHTS_OF_KIND)

typedef enum light_method { LIGHT_STORED, LIGHT_SEED, LIGHT_METHODS } light_method;

/* Sums over vertices and colours. */
typedef struct light_error {
    double square, reference; /* of the differences; of the brute force */
} light_error;

typedef struct light_measure {
    light_rays rays; /* of the brute force */
    float *radiance; /* [rays.count][LIGHT_COUNT][3] */
    noh_light lights[LIGHT_COUNT];
    uint32_t vertices, vertices_all;                 /* measured, and all of the meshes */
    light_error sums[2][LIGHT_METHODS][LIGHT_COUNT]; /* bind pose, then posed */
} light_measure;

/* Returns 1 when out of memory; close in both cases. */
int light_measure_open(light_measure *m, uint32_t ray_count);
void light_measure_close(light_measure *m);

/* Add one mesh that has a transfer. weights[target_count] is its pose. Vertices of materials that blend, and vertices
 * that see less than 15 % of an open matte surface, are left out. 0, or 1 and a filled error. */
int light_measure_mesh(light_measure *m, const noh_pack *pack, uint32_t mesh, const float *weights, model_error *error);

/* The relative root mean square of the error, mean over the lights of a kind. posed: 0 or 1. */
double light_measure_rms(const light_measure *m, int posed, light_method method, uint32_t kind);

#endif
