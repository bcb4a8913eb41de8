/* load.h: a pack on the GPU: its meshes, textures, accumulators and renderer. */
#ifndef NOH_NOH_DRAW_LOAD_H
#define NOH_NOH_DRAW_LOAD_H

#include "gpu/gpu.h"
#include "scene/scene.h"

typedef struct load_options {
    noh_morph_path path;
    noh_accumulate accumulate;
    uint32_t instances; /* of the whole scene; 0: 1 */
    noh_debug_view view;
    int fades; /* 1: levels set by load_set_lod fade into each other; 0: they change at once */
} load_options;

/* How an item is drawn: in one part, or in two while one level fades into another. */
typedef struct load_lod {
    noh_gl_lod parts[2];
    uint32_t part_count;
} load_lod;

typedef struct load {
    gpu *g;
    const pack_file *file;
    const scene *scene;
    noh_gl_mesh *meshes;      /* [mesh_count] */
    noh_gl_texture *pictures; /* [texture_count] */
    noh_gl_renderer renderer;
    gpu_morph morph;
    gpu_skin skin;
    float *matrices; /* [joints of the largest skin][12] */
    size_t matrix_bytes;
    uint32_t *item_instances; /* [item_count]: the morph instance of each item of the first copy of the scene */
    load_lod *lods;           /* [item_count]: the finest loaded level until load_set_lod */
} load;

int load_open(load *l, gpu *g, const pack_file *file, const scene *s, const load_options *o);
void load_close(load *l);

/* Upload the scene's weights and palettes, and accumulate. */
int load_update(load *l, noh_gl_morph_stats *stats);

/* From now on draw an item at the chosen mesh level (noh_lod_choose), or at both levels of a fade, and accumulate for
 * the finer one. Call it before load_update. The caller leaves out influences, joints and targets. */
void load_set_lod(load *l, uint32_t item, const noh_lod *lod, int64_t clock);

/* Draw every item: opaque, then blended. The framebuffer and viewport are the caller's. */
void load_draw(load *l, const noh_gl_camera *camera);

/* The binding of an item's palette, in *out; NULL for a rigid item. */
const noh_gl_skin_binding *load_skin_binding(const load *l, uint32_t item, noh_gl_skin_binding *out);

#endif
