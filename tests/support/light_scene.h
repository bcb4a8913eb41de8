/* light_scene.h: a sphere of radius 1, or a square of half a side 1 that faces +z, of one material, drawn by a plain
 * renderer along -z. */
#ifndef NOH_TESTS_SUPPORT_LIGHT_SCENE_H
#define NOH_TESTS_SUPPORT_LIGHT_SCENE_H

#include "convert/model/model.h"
#include "gpu/canvas.h"
#include "support/gl_fixture.h"
#include "support/srgb.h"
#include "noh/pack.h"
#include "noh/gl_device.h"
#include "noh/light.h"
#include "noh/noh_gl.h"
#include "noh/low_gl.h"

#define SIDE 65u
#define PI 3.14159265358979323846

enum { SPHERE, SQUARE, MESHES };

typedef struct scene {
    gpu *g;
    uint8_t *bytes;
    noh_pack pack;
    noh_mesh meshes[MESHES];
    noh_gl_mesh drawn[MESHES];
    noh_gl_renderer renderer;
    noh_reflection reflection;
    noh_gl_light light;
    noh_gl_texture picture; /* the pack's first texture, if it has one */
    noh_gl_ledger ledger;
    canvas canvas;
    float eye[3]; /* highlights are seen from there; the picture stays that along -z */
    float key[3]; /* of the plain light, unit */
} scene;

/* Two-sided, of base colour, roughness, metallic and f0. */
model_material scene_material(const float values[4]);

#define SCENE_SOFT 0x80000000u /* with shadow_px: a soft map, if this GPU has it (noh_gl_light.is_soft) */

/* lit: by an environment and a shadow map of that side, 0 none; NULL: by the plain light.
 * own: a fragment shader in place of the library's, for colour alone; or NULL */
void scene_open(scene *s, const model_material *material, const noh_environment *lit, uint32_t shadow_px,
                const char *own);
/* A pack of that material, to be freed. texture: its first one, copied; NULL: none */
uint8_t *scene_pack(const model_material *material, const model_texture *texture, size_t *count);
/* The same with a pack of yours, of MESHES meshes, which scene_close frees. */
void scene_open_pack(scene *s, uint8_t *bytes, size_t count, const noh_environment *lit, uint32_t shadow_px,
                     const char *own);
void scene_close(scene *s);

/* Parallel, along -z, of -1..1 in x and y. */
noh_gl_camera scene_front(void);
void scene_draw_mesh(scene *s, int mesh, const float world[12], int pass);

/* rgba[SIDE][SIDE][4], top row first, to be freed. lighting: NULL in plain light */
uint8_t *scene_draw(scene *s, int mesh, const float world[12], const noh_lighting *lighting);

/* The place of a column in -1..1, or of a row, downwards. */
double pixel_at(uint32_t i);

/* Light from nowhere but the key, of 0.9. */
void key_alone(const float to_light[3], noh_lighting *lighting);

extern const float scene_identity[12];
extern const noh_environment scene_black;

#endif
