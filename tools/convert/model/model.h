/* model.h: an asset as the converter holds it, decoded and in model units.
 *
 * A reader fills a `model`; the encoders and the pack writer read nothing else. All arrays are owned by the model and
 * freed by model_free. Units: metres, seconds; right-handed, Y up; quaternions xyzw; matrices column-major. */
#ifndef NOH_CONVERT_MODEL_MODEL_H
#define NOH_CONVERT_MODEL_MODEL_H

#include <stddef.h>
#include <stdint.h>

#include "convert/base/error.h"
#include "noh/format.h"

#ifdef __cplusplus
extern "C" {
#endif

#define MODEL_NONE 0xffffffffu

/* The kind of texels, which decides how mip levels are made and read. */
typedef enum model_texture_use {
    MODEL_TEXTURE_COLOR,
    MODEL_TEXTURE_DATA,
    MODEL_TEXTURE_NORMAL,
    MODEL_TEXTURE_CODES /* bytes that have no mean: read texel by texel, and halved by leaving texels out */
} model_texture_use;

#define MODEL_BLOCKS_NONE 0u
#define MODEL_BLOCKS_ETC2 1u
#define MODEL_BLOCKS_ASTC 2u /* where no material cuts or blends by its alpha; else ETC2 */

typedef struct model_texture {
    char *name;
    uint32_t width, height;
    uint8_t *rgba;                   /* [height][width][4], rows top to bottom, as the image file has them */
    uint32_t wrap_s, wrap_t;         /* glTF enum values: 10497 repeat, 33071 clamp, 33648 mirror */
    uint32_t mag_filter, min_filter; /* glTF enum values, 0 = not given */
    model_texture_use use;
    uint8_t alpha_is_data; /* a value of its own, which is kept and changes no colour */
    uint8_t with_alpha;    /* a material cuts or blends by its alpha: where that is 0, colours do not count */
    uint8_t alpha_unread;  /* it is not stored, and only tells which colours count (texture_solid.h) */
    float alpha_cutoff;    /* of a material that cuts by it: mip levels cover as much; else 0 */
    uint8_t cut_alone;     /* 1: everything that reads it cuts by that, so alphas of 0 and 1 do (texture_cut.h) */
    uint8_t blocks;        /* MODEL_BLOCKS_*: how it is compressed */
    uint32_t size_max;     /* it is halved until no side is longer; 0: NOH_TEXTURE_SIZE_MAX */
    uint32_t cells[2];     /* then divided into columns and rows, 2 to 64 of the same size; 0: not (texture_trim.h) */
    uint64_t kept[2];      /* bit i is 1 if the i-th stays; at least one does */
} model_texture;

typedef enum model_alpha { MODEL_ALPHA_OPAQUE, MODEL_ALPHA_MASK, MODEL_ALPHA_BLEND } model_alpha;

/* Whether a material takes the tint of an instance. */
#define MODEL_TINT_BY_SURFACE 0u /* as its surface and its name say: skin, eyes and teeth do not */
#define MODEL_TINT_ON 1u
#define MODEL_TINT_OFF 2u

typedef struct model_material {
    char *name;
    float base_color[4];         /* linear */
    uint32_t base_color_texture; /* index into textures or MODEL_NONE */
    float metallic, roughness;
    model_alpha alpha;
    float alpha_cutoff;
    uint8_t double_sided, unlit;
    uint8_t tint; /* MODEL_TINT_* */
    int16_t priority;
    float normal_scale, occlusion_strength, emissive[3], f0[3];
    /* as noh_material has them: indices into textures or MODEL_NONE */
    uint32_t normal_texture, surface_texture, emissive_texture, wrinkle_texture, more_textures[3];
    uint32_t color_texture;  /* of the regions that a mesh's targets colour (model_mesh.colors), or MODEL_NONE */
    uint32_t wrinkle_models; /* NOH_WRINKLE_BY_* */
    uint8_t wrinkle_codes;   /* 1: more_textures[0] is a mask (NOH_MATERIAL_WRINKLE_CODES) */
    uint32_t surface;        /* NOH_SURFACE_* of format.h */
    uint8_t surface_given;   /* 1: by --surface or the file's extras, so that no guess changes its looks */
    float surface_values[4], surface_more[6];
    uint8_t toon_shade, outline_lit, toon_masks; /* NOH_MATERIAL_TOON_SHADE, _OUTLINE_LIT, _TOON_MASKS */
    uint32_t specular_texture;                   /* index into textures or MODEL_NONE */
    uint8_t specular_roughness;                  /* 1: its alpha is roughness, else the weight of f0 and f90 */
    float f90_loss;
} model_material;

/* Attributes that the file lacks for a submesh, and that model_complete fills in. */
#define MODEL_MISSING_NORMAL 1u
#define MODEL_MISSING_TANGENT 2u

/* One morph target: dense deltas, zero where the target does not move. */
typedef struct model_target {
    char *name;
    float *position;                               /* [vertex_count][3] */
    float *normal;                                 /* [vertex_count][3]; never NULL after model_complete */
    float *tangent;                                /* [vertex_count][3]; NULL where the mesh has no tangents */
    float *uv;                                     /* [vertex_count][2]; NULL where it moves no texture coordinates */
    uint8_t has_position, has_normal, has_tangent; /* whether the file gave it, in any primitive */
    float lips; /* by how much it opens the lips at weight 1: half of their gap, in depths of the mouth (lip_rim.h) */
    uint8_t identity; /* makes one face differ from another: NOH_TARGET_IDENTITY */
    /* [submesh_count] MODEL_MISSING_* bits: deltas for model_complete to compute; NULL = none */
    uint8_t *missing;
} model_target;

typedef struct model_submesh {
    uint32_t first_index, index_count;   /* into model_mesh.indices; triangles */
    uint32_t material;                   /* index or MODEL_NONE */
    uint32_t first_vertex, vertex_count; /* the vertices of this primitive */
    uint8_t missing;                     /* MODEL_MISSING_* bits; zero once model_complete has run */
} model_submesh;

#define MODEL_INFLUENCES_MAX 32u

/* Extra attributes of vertices that a build keeps (noh build --attributes), in its order. */
typedef struct extra_list {
    uint32_t count;
    char names[NOH_EXTRAS_MAX][NOH_NAME_BYTES_MAX]; /* "TEXCOORD_1", "_WIND" */
    uint8_t bits[NOH_EXTRAS_MAX];                   /* asked for: 8 or 16; 0: as the file has them, 16 for floats */
} extra_list;

/* An extra attribute as a mesh has it. */
typedef struct model_extra {
    uint8_t width;     /* components: 1..4; 0: the mesh does not have it */
    uint8_t bits;      /* of the file's component type, 8 or 16; 0: floats */
    float least, step; /* values of integers are `least` plus multiples of `step`; else 0 */
} model_extra;

/* One glTF mesh: its primitives' vertices one after another, indices rebased. */
typedef struct model_mesh {
    char *name;
    uint32_t vertex_count, index_count, submesh_count, target_count;
    float *position; /* [vertex_count][3] */
    float *normal;   /* [vertex_count][3], unit; computed where the file has none */
    float *tangent;  /* [vertex_count][4], unit + handedness +1/-1; NULL where no primitive has UVs or tangents */
    float *uv; /* [vertex_count][2] (TEXCOORD_0, or the set that the base colour texture uses); NULL where no primitive
                  has them */
    float *color; /* [vertex_count][4] linear (COLOR_0); NULL where no primitive has them */
    float *extra; /* [vertex_count][NOH_EXTRAS_MAX][4] extra attributes, for shaders of a game's own; NULL: none */
    model_extra extras[NOH_EXTRAS_MAX];
    uint32_t *indices;
    model_submesh *submeshes;
    model_target *targets;
    float *weights;         /* [target_count] the mesh's default weights */
    uint32_t influence_max; /* the most joints that move one vertex; 0: the mesh is not skinned */
    uint32_t joint_limit;   /* one above the largest place used in `joints` */
    uint16_t *joints;     /* [vertex_count][MODEL_INFLUENCES_MAX] places in the skin's joints; NULL where not skinned */
    float *joint_weights; /* [vertex_count][MODEL_INFLUENCES_MAX] sum 1, the largest first, zeros last; likewise */
    uint8_t bound;        /* skins_bind has found its skin */
    uint8_t dual_quaternion; /* skinned by dual quaternions, else by matrices */
    uint32_t skin;           /* valid if `bound` */
    uint32_t palette_limit;  /* joints that one draw may use; 0: as many as the format holds */
    char *recipe;            /* lines of a face's recipe (base/recipe_read.h) out of the mesh's extras; NULL: none */
    int recipe_is_made;      /* of VRM's expressions; 0: an artist wrote it */
    uint8_t *wrinkles; /* [target_count][12] how much each target wrinkles each region, 255 all; NULL: no wrinkles */
    uint8_t *colors;   /* as at noh_wrinkles_header.colors_offset, [4 + target_count][4]; NULL: no colours */
    uint32_t color_material; /* with colours: index into materials */
} model_mesh;

typedef struct model_node {
    char *name;
    uint32_t parent;                             /* index or MODEL_NONE; parents come first */
    uint32_t mesh;                               /* index or MODEL_NONE */
    float translation[3], rotation[4], scale[3]; /* local; a matrix is decomposed */
    double
        world[16];  /* column-major, from the local matrices in double precision; skinned meshes are not placed by it */
    float *weights; /* [targets of the mesh] or NULL: the mesh's defaults hold */
    uint32_t skin;  /* index, or MODEL_NONE: it has none, or its skin was left out with a warning */
    char *expression; /* of a VRM animation: the channel of a recipe, or an expression's own name, whose weight is the
                         x of its translation; else NULL */
} model_node;

/* The joints that move a mesh. Vertices in the bind pose become joint-local by inverse_bind. */
typedef struct model_skin {
    char *name;
    uint32_t joint_count;
    uint32_t *joints;          /* [joint_count] nodes; model_mesh.joints are places in this list */
    float *inverse_bind;       /* [joint_count][16] affine and invertible; identities where the file has none */
    uint32_t set;              /* from skins_bind: its skeleton, an index into model_clips.sets */
    uint32_t *skeleton_joints; /* from skins_bind: [joint_count] joints of that skeleton; NULL before */
} model_skin;

typedef enum model_path {
    MODEL_PATH_WEIGHTS,
    MODEL_PATH_TRANSLATION,
    MODEL_PATH_ROTATION,
    MODEL_PATH_SCALE
} model_path;
typedef enum model_interpolation { MODEL_LINEAR, MODEL_STEP, MODEL_CUBICSPLINE } model_interpolation;

typedef struct model_channel {
    uint32_t node;
    model_path path;
    model_interpolation interpolation;
    uint32_t key_count, width; /* width: floats per key value (target count for weights, 3 or 4) */
    float *times;              /* [key_count] seconds, strictly increasing, >= 0 */
    float *values; /* [key_count][width], CUBICSPLINE [key_count][3][width]: in-tangent, value, out-tangent */
} model_channel;

/* A callback key. */
typedef struct model_event {
    char *name;
    double time_s;
    uint8_t payload[8];
    float weight_min;
    uint8_t is_marker; /* a sync marker */
} model_event;

typedef struct model_clip {
    char *name;
    uint32_t channel_count;
    model_channel *channels;
    float duration_s; /* the largest key time */
    uint8_t loop;     /* marked as a loop by its author */
    uint32_t event_count;
    model_event *events; /* in the file's order, times within 0 and duration_s */
} model_clip;

/* A joint that swings, and how. */
typedef struct model_spring_joint {
    uint32_t node;
    float stiffness, drag, radius, gravity[3]; /* as noh_spring_row has them */
} model_spring_joint;

/* A chain of them, each below the one before. */
typedef struct model_spring {
    uint32_t joint_count;
    model_spring_joint *joints;
    uint32_t collides; /* bit i: with collider i */
    float end[3];      /* where the last one's bone ends, in its space */
} model_spring;

typedef struct model_collider {
    uint32_t node;
    float from[3], to[3], radius; /* in the node's space */
} model_collider;

typedef struct model {
    uint32_t mesh_count, node_count, skin_count, clip_count, material_count, texture_count;
    model_mesh *meshes;
    model_node *nodes;
    model_skin *skins;
    model_clip *clips;
    model_material *materials;
    model_texture *textures;
    uint32_t spring_count, collider_count;
    model_spring *springs;     /* of an extension; nodes that are no joints may be among theirs */
    model_collider *colliders; /* [collider_count], at most NOH_SPRING_COLLIDERS_MAX */
    char *spring_lines;        /* lines of springs (springs/springs_read.h) out of extras; NULL: none */
    int for_any_body;          /* 1: a VRM animation: its clips are retargeted (retarget/) */
    extra_list extras;         /* extra attributes that its vertices may have */
    uint32_t warning_count;
    char **warnings; /* sentences for the user, e.g. what was skipped and why */
} model;

/* Read a .gltf or .glb file. Returns 0 and *out on success, else 1 and a filled error (*out = NULL).
 * Calls model_complete. */
int model_read_gltf(const char *path, model **out, model_error *error);

/* The same with extra attributes of its vertices. What no mesh has is left to the caller. */
int model_read_gltf_with(const char *path, const extra_list *extras, model **out, model_error *error);

/* The same of a .glb in memory. `path` names its source file: images lie in the same folder, and a clip without a
 * name takes the file's. extras: NULL: none */
int model_read_glb(const uint8_t *bytes, size_t size, const char *path, const extra_list *extras, model **out,
                   model_error *error);

/* World units per unit of a mesh: the largest scale, in the rest pose, of the nodes that draw it or of the joints that
 * move it; 1 if nothing draws it. */
float model_mesh_scale(const model *m, uint32_t mesh);

/* The mesh's target of this name; MODEL_NONE: there is none. */
uint32_t model_find_target(const model_mesh *mesh, const char *name);
int model_has_target(const model *m, const char *name); /* 1: any mesh has it */

/* All indices into textures that a material has. */
#define MODEL_MAPS 10u
void model_maps(model_material *m, uint32_t *maps[MODEL_MAPS]);
/* Whether a target moves texture coordinates, so that triangles read more than they do at rest. */
int model_moves_uv(const model_mesh *mesh);
/* Whether a texture's name is the name of another with a suffix: a game may show it in the other's place
 * (noh_texture_set). */
int model_replaces_texture(const model_texture *t, const model_texture *of);

/* Fill in missing attributes (NULL arrays and MODEL_MISSING_* bits): normals
 * (crease-aware), tangents where there are UVs, normal and tangent deltas of
 * targets that lack them (from the morphed mesh). Returns 0, or 1 and *error. */
int model_complete(model *m, model_error *error);

/* glTF's default material, without a name. */
model_material model_material_default(void);

/* Give a mesh a copy of a material that other meshes use, too. *material: in, and out the mesh's own, the same if no
 * other mesh uses it. Returns 1: out of memory */
int model_own_material(model *m, model_mesh *mesh, uint32_t *material);

void model_free(model *m);

#ifdef __cplusplus
}
#endif
#endif
