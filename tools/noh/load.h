/* load.h: a pack made ready to draw: its meshes, textures, accumulators and renderer.
 * What load_budget says before is what load_open takes, to the byte. */
#ifndef NOH_TOOL_LOAD_H
#define NOH_TOOL_LOAD_H

#include "gpu.h"
#include "scene.h"

typedef struct load_part {
    char name[96];
    uint64_t cpu_bytes, gpu_bytes;
} load_part;

typedef struct load_budget {
    noh_gl_morph_plan plan;
    noh_gl_skin_plan skin_plan; /* mode AUTO: nothing is skinned */
    load_part *parts;
    uint32_t part_count;
    uint64_t cpu_bytes, gpu_bytes, pack_bytes; /* pack_bytes: with that of --anim */
} load_budget;

typedef struct load_options {
    noh_morph_path path;
    noh_accumulate accumulate;
    uint32_t instances; /* of the whole scene; 0: 1 */
    noh_debug_view view;
    int fades;          /* load_set_detail's levels fade into each other; else they change at once */
} load_options;

/* Of clips alone, the clips, with a plan that says nothing but its reason. Prints an error and returns an exit code; 0 on
 * success. */
int load_budget_make(load_budget *b, const pack_file *file, const scene *s, const noh_gl_caps *caps, const load_options *o);
void load_budget_free(load_budget *b);

/* How an item is drawn: in one part, or in two while a level fades into another. */
typedef struct load_detail {
    noh_gl_detail parts[2];
    uint32_t part_count;
} load_detail;

typedef struct load {
    gpu *g;
    const pack_file *file;
    const scene *scene;
    noh_gl_mesh *meshes;       /* [mesh_count] */
    noh_gl_texture *pictures;  /* [texture_count] */
    noh_gl_renderer renderer;
    gpu_morph morph;
    gpu_skin skin;
    float *matrices;           /* [joints of the largest skin][12] */
    size_t matrix_bytes;
    uint32_t *item_instances;  /* [item_count]: the morph instance of each item of the first copy of the scene */
    load_detail *details;      /* [item_count]: the finest level that is there, until load_set_detail */
} load;

int load_open(load *l, gpu *g, const pack_file *file, const scene *s, const load_options *o);
void load_close(load *l);

/* Make everything again after g's context was lost and g->gl filled for a new one. On error
 * what could be made stays, to be closed. */
int load_restore(load *l);

/* Hand the scene's weights to the accumulator and accumulate; hand its joints to the palettes. */
int load_update(load *l, noh_gl_morph_stats *stats);

/* From now on draw an item at the mesh level that was chosen (noh_detail_choose), or at both that fade, and accumulate
 * what the finer of them needs. Before load_update. Influences, joints and targets are the caller's to leave out. */
void load_set_detail(load *l, uint32_t item, const noh_detail *detail, int64_t clock);

/* Draw every item: opaque, then blended. The framebuffer and viewport are the caller's. */
void load_draw(load *l, const noh_gl_camera *camera);

/* Where an item's joints are: out, or NULL for a rigid one. */
const noh_gl_skin_binding *load_skin_binding(const load *l, uint32_t item, noh_gl_skin_binding *out);

/* Capabilities to assume where there is no driver: a GLES 3.2 device on which everything
 * works and textures are as large as every ES 3.0 has them. */
noh_gl_caps nominal_caps(void);

#endif
