/* lod_fixture.h: meshes with LOD levels, made in code, and their packs.
 *
 *   lod_face_model     a bumpy sphere with a seam, poles, targets for left and right, and an eye in it
 *   lod_tube_model     skin_asset.h's tube, with a clip that bends it
 *   lod_pack_*         a model's pack, and what its levels were built from
 *   lod_layers_*       accumulation layers of the exact size between guards */
#ifndef NOH_TESTS_SUPPORT_LOD_FIXTURE_H
#define NOH_TESTS_SUPPORT_LOD_FIXTURE_H

#include "convert/lod/lod_levels.h"
#include "skin_asset.h"
#include "support.h"
#include "noh/pack.h"
#include "noh/deform.h"

#define LOD_FACE_TARGETS 12u
#define LOD_FACE_PAIRS 5u
#define LOD_TUBE_HZ 8.0 /* its keys lie on the frames that lod_frames.h looks at */
#define LOD_TUBE_KEYS 7u

typedef struct lod_face {
    uint32_t columns, rows; /* quads of the sphere: (columns + 1) x (rows + 1) vertices */
    uint32_t targets;       /* up to LOD_FACE_TARGETS */
    int eye;                /* a second submesh, blended, that no target moves */
    int everywhere;         /* each target moves every vertex */
} lod_face;

/* Pairs of targets that are mirror images: left and right. */
extern const uint32_t lod_face_pairs[LOD_FACE_PAIRS][2];

/* Free with model_free. A face has room for one more submesh. */
model *lod_face_model(const lod_face *face);
/* A face that a node draws, for levels with virtual joints (lod_settings.face_joints, skin_options.rigid_faces). */
model *lod_drawn_face_model(const lod_face *face);
model *lod_tube_model(const skin_cylinder *tube);

/* Half the angle in radians about x by which joint j is turned in the clip's frame. */
double lod_tube_half_angle(uint32_t joint, uint32_t frame);

typedef struct lod_pack {
    uint8_t *bytes;
    size_t byte_count;
    noh_pack pack;
    noh_mesh mesh;          /* the first, full; points to `pack`: do not copy */
    const model_mesh *from; /* the model's; the model must outlive it */
    mesh_levels *levels;    /* [mesh_count] as built */
    uint32_t mesh_count;
} lod_pack;

/* palette: joints that a draw may use, 0: as many as the format holds. Fails the test where it cannot be made. */
void lod_pack_make(model *m, const lod_settings *settings, uint32_t palette, lod_pack *out);
void lod_pack_make_skinned(model *m, const lod_settings *settings, const skin_options *skin, lod_pack *p);
void lod_pack_free(lod_pack *p);

/* [vertex_count] for each vertex of the pack the model's, found by position and uv alone; to be freed. */
uint32_t *lod_pack_sources(const lod_pack *p);

/* Layers of the exact size, cleared, with guards on both sides. */
typedef struct lod_layers {
    noh_morph_layers layers;
    uint8_t *block;
    size_t bytes;
} lod_layers;
lod_layers lod_layers_make(const noh_mesh *mesh);

/* Fails the test where a guard was written to. */
void lod_layers_free(lod_layers *l);

#endif
