/* skin_asset.h: a glTF asset as a pack, with the oracle's reading of the same file: which vertex is which. */
#ifndef NOH_TESTS_SUPPORT_SKIN_ASSET_H
#define NOH_TESTS_SUPPORT_SKIN_ASSET_H

#include "gltf_oracle.h"
#include "support.h"
#include "convert/skin/skins.h"
#include "noh/pack.h"

/* The vertex of the file that a vertex of the pack was made from. */
typedef struct skin_source {
    uint32_t node, primitive, vertex; /* of the file */
} skin_source;

typedef struct skin_asset {
    oracle *o;
    uint8_t *bytes;
    size_t byte_count;
    noh_pack pack;
    skin_source **sources;  /* [mesh_count][source_count] */
    uint32_t *source_count; /* [mesh_count] */
    double size;           /* of the drawn rest pose's bounding box: its diagonal */
} skin_asset;

/* Build and open an asset, or skip the test where it is not there. */
void skin_asset_open(skin_asset *a, const char *name, const skin_options *options);
void skin_asset_close(skin_asset *a);

/* Every mesh's positions as the oracle draws them: out[vertex_count][3] for mesh m of the pack. `weights` are the
 * weights of the node that draws it. */
void skin_asset_expected(const skin_asset *a, uint32_t mesh, const double *worlds, const double *weights, double *out);

/* A skeleton's model-space matrices out of the oracle's local transforms, by the library. matrices to be freed. */
float *skin_asset_model(const skin_asset *a, uint32_t skeleton, const double *locals);

/* The matrices that move a mesh: [skin's joint_count][12], to be freed. */
float *skin_asset_matrices(const skin_asset *a, const noh_mesh *mesh, const double *locals);

/* ---- models made in code ---- */

/* A tube along y from 0 to `length`, and a chain of joints in it, evenly spaced. Room for two more nodes. */
typedef struct skin_cylinder {
    uint32_t around, rings, joints, influences; /* influences: 1 to 8 per vertex */
    uint32_t targets;
    int tangents;
    float length, radius;
} skin_cylinder;
model *skin_cylinder_model(const skin_cylinder *c);

/* Bind, encode and write a model; the bytes are aligned. orders: NULL, or [mesh_count after binding] new-to-old
 * vertex orders (to be freed). */
uint8_t *skin_pack_of(model *m, const skin_options *options, float error_um, size_t *count, uint32_t **orders);

/* The same with the model's clips. */
uint8_t *skin_pack_with_clips(model *m, float error_um, size_t *count);

#endif
