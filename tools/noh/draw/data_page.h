/* data_page.h: the data textures of morph targets as pictures: one pixel for each accumulation texel of a mesh, in
 * three layers: position, normal, tangent. x, y, z are red, green, blue.
 *
 *   data_page_open / data_page_close
 *   data_page_base   the bind pose: positions from black to white across the mesh's box, directions around grey
 *   data_page_sums   the deltas that weights accumulate, around grey; of one target at weight 1: its delta texels
 *
 * source  Microsoft, SparseMorphTargets (DirectX SDK), which shows its data textures at a hundredth of their values */
#ifndef NOH_NOH_DRAW_DATA_PAGE_H
#define NOH_NOH_DRAW_DATA_PAGE_H

#include "noh/pack.h"

#define DATA_LAYERS 3u

extern const char *const data_layer_names[DATA_LAYERS];

typedef struct data_page {
    uint32_t width, height;  /* accumulation texels; 0: no target moves the mesh */
    float most[DATA_LAYERS]; /* of sums: the component that is white, or black where it is negative; 0: all is grey */
    uint8_t *rgba;           /* [DATA_LAYERS][height][width][4], vertex 0 first; clear where there is no vertex */
    void *memory;            /* of the sums */
} data_page;

/* Prints an error and returns an exit code; 0 on success. */
int data_page_open(data_page *p, const noh_mesh *mesh);
void data_page_close(data_page *p);

/* mesh: as at data_page_open */
void data_page_base(data_page *p, const noh_mesh *mesh);
/* weights[target_count]: finite. gain: at 1 the largest component of each layer is black or white */
void data_page_sums(data_page *p, const noh_mesh *mesh, const float *weights, float gain);

/* One target at weight 1.
 * ranges  target below target_count */
void data_page_delta(data_page *p, const noh_mesh *mesh, uint32_t target, float gain);

#endif
