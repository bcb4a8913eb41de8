/* format.h: the bytes of a pack. Only tools that read or write packs themselves need it. */

#ifndef NOH_FORMAT_H
#define NOH_FORMAT_H

#include <stdint.h>

#include "base.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ======== the bytes of a pack ========
 * The bytes of a .noh pack, little-endian, read in place.
 *
 * A pack is a header, a chunk table and the chunks. Every chunk begins at the next multiple of 64 after the previous
 * chunk, and every array within a chunk at the next multiple of 16 after the previous array. Offsets therefore follow
 * from the counts; the file stores them too, to keep readers simple, and noh_pack_open checks that both agree. Padding
 * and reserved fields are zero. Names are offsets into the string chunk. There are no pointers to patch.
 *
 * Threads: constant data; any thread. */

#define NOH_PACK_MAGIC 0x50484f4eu /* "NOHP" */
#define NOH_PACK_VERSION 5u

#define NOH_FOURCC(a, b, c, d) ((uint32_t)(a) | ((uint32_t)(b) << 8) | ((uint32_t)(c) << 16) | ((uint32_t)(d) << 24))

/* All types of chunks, in their order in a pack: no chunk refers to a later one. The reader, the checkers and the
 * converter use this list; the guide explains how to add a type.
 * X(NAME, name, tag, many): many is 1 if a pack may have several */
#define NOH_CHUNKS(X)                                            \
    X(STRINGS, strings, NOH_FOURCC('S', 'T', 'R', 'S'), 0)       \
    X(TEXTURE, texture, NOH_FOURCC('T', 'X', 'T', 'R'), 1)       \
    X(MATERIALS, materials, NOH_FOURCC('M', 'A', 'T', 'L'), 0)   \
    X(SKELETON, skeleton, NOH_FOURCC('S', 'K', 'E', 'L'), 1)     \
    X(SKIN, skin, NOH_FOURCC('S', 'K', 'I', 'N'), 1)             \
    X(MESH, mesh, NOH_FOURCC('M', 'E', 'S', 'H'), 1)             \
    X(TRANSFER, transfer, NOH_FOURCC('T', 'R', 'N', 'S'), 1)     \
    X(INFLUENCES, influences, NOH_FOURCC('I', 'N', 'F', 'L'), 1) \
    X(WRINKLES, wrinkles, NOH_FOURCC('W', 'R', 'N', 'K'), 1)     \
    X(FAR_JOINTS, far_joints, NOH_FOURCC('F', 'A', 'R', 'J'), 1) \
    X(NODES, nodes, NOH_FOURCC('N', 'O', 'D', 'E'), 0)           \
    X(CLIP, clip, NOH_FOURCC('M', 'O', 'T', 'N'), 1)             \
    X(GRAPH, graph, NOH_FOURCC('G', 'R', 'P', 'H'), 1)           \
    X(RECIPE, recipe, NOH_FOURCC('R', 'C', 'P', 'E'), 0)         \
    X(RAGDOLL, ragdoll, NOH_FOURCC('R', 'G', 'D', 'L'), 0)       \
    X(SPRINGS, springs, NOH_FOURCC('S', 'P', 'R', 'G'), 1)       \
    X(HAIR, hair, NOH_FOURCC('H', 'A', 'I', 'R'), 0)             \
    X(TERRAIN, terrain, NOH_FOURCC('T', 'E', 'R', 'R'), 0)       \
    X(COVER, cover, NOH_FOURCC('C', 'O', 'V', 'R'), 1)           \
    X(MATCH, match, NOH_FOURCC('M', 'T', 'C', 'H'), 0)           \
    X(EXTRAS, extras, NOH_FOURCC('X', 'T', 'R', 'A'), 1)

/* NOH_CHUNK_STRINGS and so on: a place in the list. */
#define NOH_CHUNK_TYPE(NAME, name, tag, many) NOH_CHUNK_##NAME,
typedef enum noh_chunk_type { NOH_CHUNKS(NOH_CHUNK_TYPE) NOH_CHUNK_TYPES } noh_chunk_type;
#undef NOH_CHUNK_TYPE

/* NOH_TAG_STRINGS and so on: what a pack's chunk table says, noh_pack_chunk.type. */
#define NOH_CHUNK_TAG(NAME, name, tag, many) NOH_TAG_##NAME = (int)(tag),
typedef enum noh_chunk_tag { NOH_CHUNKS(NOH_CHUNK_TAG) } noh_chunk_tag;
#undef NOH_CHUNK_TAG

typedef struct noh_pack_header {
    uint32_t magic;
    uint32_t version;
    uint32_t byte_count; /* of the whole file, a multiple of 64 */
    uint32_t chunk_count;
    uint32_t crc;             /* CRC-32C of the header (this field as 0) and the chunk table */
    uint32_t library_version; /* NOH_VERSION_NUMBER of the writer, for reports only; 0: before 0.2.0 */
    uint32_t reserved[10];
} noh_pack_header;

typedef struct noh_pack_chunk {
    uint32_t type;      /* noh_chunk_tag */
    uint32_t name;      /* string offset */
    uint32_t name_hash; /* FNV-1a of the name */
    uint32_t offset;    /* from the start of the file, a multiple of 64 */
    uint32_t bytes;     /* without padding */
    uint32_t crc;       /* CRC-32C of these bytes */
    uint32_t reserved[2];
} noh_pack_chunk;

/* ---- CHUNK_MESH ---- */

#define NOH_MESH_TANGENTS 1u
#define NOH_MESH_UVS 2u
#define NOH_MESH_COLORS 4u
#define NOH_MESH_DUAL_QUATERNION 8u /* skinned by dual quaternions, otherwise by matrices */
/* Each vertex has a texel reference: the mesh has several palettes, or LOD levels, where moved and unmoved vertices
 * alternate. */
#define NOH_MESH_TEXELS 16u
/* Targets move texture coordinates: each vertex has a reference to a second accumulation texel, for its UV. The
 * position accumulated there is the distance that the picture slides over the surface along u and v; uv_per_unit
 * converts it to texture coordinates. Such a mesh also has UVS and TEXELS. */
#define NOH_MESH_UV_TARGETS 32u

/* Attribute record, interleaved, 4 bytes per attribute, in this order; attributes without their flag are absent:
 *   normal   int16 x 2, octahedral: n.xy / 32767 unfolds to a unit vector; always present
 *   tangent  int16 x 2, octahedral; y has 15 bits above bit 0, which is 1 for handedness -1 (TANGENTS)
 *   uv       unorm 16:16, uv = uv_offset + uv_scale * value (UVS)
 *   color    unorm 8:8:8:8, linear rgb with a square-root curve, alpha straight (COLORS)
 *   extras   extra_words words, which CHUNK_EXTRAS describes
 *   uv texel the accumulation texel of its UV, or NOH_TEXEL_NONE if no target moves the UV (UV_TARGETS)
 *   texel    low 22 bits the vertex's accumulation texel, above them its palette (TEXELS). Without levels: the vertex
 *            whose texel it shares, which has a texel if it is below touched_count; with levels, or with UV_TARGETS:
 *            the texel, or NOH_TEXEL_NONE */
#define NOH_TEXEL_VERTEX_BITS 22u
#define NOH_TEXEL_NONE ((1u << NOH_TEXEL_VERTEX_BITS) - 1u)

/* The header of the full mesh is followed by the headers of its coarser LOD levels, each a complete mesh. A level's
 * vertices, delta texels and (per target) rectangles are the first ones of the finer level's arrays. Its indices,
 * submeshes and targets follow the finer level's. A level can therefore be used and loaded without the finer ones.
 *
 * A pack may lack the finest levels of a mesh (`noh strip`): the first header is then of the finest level present.
 * Levels keep their numbers, and errors remain distances to the full mesh; bounds, boxes and other fields that all
 * levels share also remain the full mesh's; only the arrays are shorter. */
typedef struct noh_mesh_header {
    uint32_t flags; /* NOH_MESH_* */
    uint32_t vertex_count;
    uint32_t index_count;
    uint32_t index_bytes; /* 2 or 4 */
    uint32_t submesh_count;
    uint32_t target_count;
    uint32_t rect_count;
    uint32_t texel_count;
    uint32_t pair_count;        /* vertices moved by targets: delta texels that are not zero */
    uint32_t source_pair_count; /* pairs in the asset, for reports */
    uint32_t touched_count;     /* accumulation texels of vertices and UVs; without texel references, vertices
                                 * 0..touched_count-1 have one */
    uint32_t morph_width_log2;  /* texel t: x = t & (width - 1), y = t >> width_log2 */
    uint32_t morph_height;
    uint32_t attribute_stride;
    uint32_t positions_offset;          /* float[vertex_count][3] */
    uint32_t attributes_offset;         /* uint8_t[vertex_count][attribute_stride] */
    uint32_t indices_offset;            /* uint16_t or uint32_t [index_count], triangles */
    uint32_t submeshes_offset;          /* noh_submesh[submesh_count] */
    uint32_t targets_offset;            /* noh_target[target_count] */
    uint32_t weights_offset;            /* float[target_count], the asset's default weights */
    uint32_t rects_offset;              /* noh_rect[rect_count], in target order */
    uint32_t texels_offset;             /* uint32_t[texel_count][3], in rectangle order, row by row */
    float bounds_min[3], bounds_max[3]; /* of the rest positions */
    float uv_offset[2], uv_scale[2];
    float f16_position_bound;  /* largest error of a half-float accumulator for all |weights| <= 2, model units */
    float f16_direction_bound; /* the same error for normals and tangents, per component */
    float world_scale;         /* world units (metres) per model unit: the largest scale of the nodes that draw it */
    uint32_t texels_one_rect;  /* for reports: texels with one rectangle per target in the asset's vertex order */
    /* float[target_count][6]: smallest and largest x, y, z of the target's position deltas, including 0 */
    uint32_t target_boxes_offset;
    uint32_t skin;              /* the n-th skin chunk; NOH_NONE: a rigid mesh, whose next fields, to
                                 * joint_boxes_offset, are 0 */
    uint32_t influence_count;   /* joints per vertex: 0, 1, 2, 4 or 8 */
    uint32_t influences_offset; /* uint32_t[vertex_count][NOH_INFLUENCE_WORDS] */
    uint32_t palette_count;     /* more than 1 if one palette cannot hold all joints: the mesh is split by triangle */
    uint32_t palettes_offset;   /* noh_palette[palette_count] */
    uint32_t palette_joint_count;
    uint32_t palette_joints_offset; /* uint16_t[palette_joint_count], indices into the skin's joints */
    /* float[joint_count of the skin][6]: smallest and largest x, y, z of the rest positions of the vertices that the
     * joint moves; smallest above largest if it moves none */
    uint32_t joint_boxes_offset;
    uint32_t level;         /* 0: the full mesh; level_first in the chunk's first header, then increasing by 1 */
    uint32_t level_count;   /* 1..NOH_LOD_LEVELS_MAX, the same in all levels of the mesh; includes levels that the pack
                             * lacks */
    float level_error_rest; /* certified: the largest distance between this level's surface and the full one, both ways,
                             * at rest, model units. This and the next four are 0 in the full mesh */
    float level_error_rest_p99; /* at rest, for 99 % of the area */
    float level_error_targets;  /* with each target alone at weight 1 */
    float level_error_pairs;    /* with left and right targets together */
    float level_error_clip;     /* over frames of the clips in the build */
    /* the farthest that targets without rectangles in this level would move a vertex, all at weight 1 */
    float level_skipped;
    float influence_errors[3]; /* largest error of a vertex over these frames with only its 4, 2, 1 heaviest joints,
                                * model units; 0 in a mesh without levels */
    uint32_t level_first;      /* the finest level in the pack; below level_count */
    uint32_t source_crc;       /* CRC-32C of the unstripped chunk, with level 0; 0 if level_first is 0 */
    float uv_per_unit; /* with UV_TARGETS: texture coordinates per model unit in a UV's texel, above 0; otherwise 0 */
    uint32_t extra_words; /* of extra attributes in each record: 0 to NOH_EXTRA_WORDS_ROOM(flags) */
    uint32_t reserved[4];
} noh_mesh_header;

/* Vertex attributes have 16 locations: texels of texture coordinates take one of the two of extra attributes. */
#define NOH_EXTRA_WORDS_ROOM(flags) ((flags)&NOH_MESH_UV_TARGETS ? 4u : 8u)

/* Influences of a vertex, in words. The first joint is the strongest: its weight is 1 minus the other weights, so sums
 * are exact. The other weights are multiples of 2^-22. Joints are 8-bit indices into the vertex's palette; joints
 * without a weight repeat the first.
 *   1  j0
 *   2  j0 | j1 << 8, then w1
 *   4  j0 | j1 << 8 | j2 << 16 | j3 << 24, then w1, w2, w3
 *   8  the same, j4 to j7, then w1 to w7
 * Weights are packed from the lowest bit of their words up: w1 has 22 bits (it may be one half), the others 21 (at most
 * a third). */
#define NOH_INFLUENCE_WORDS(count) ((count) == 8u ? 7u : (count) == 4u ? 3u : (count))
#define NOH_WEIGHT_ONE 0x400000u /* 2^22 */

/* A range of palette_joints: the matrices of one draw. */
typedef struct noh_palette {
    uint32_t first_joint, joint_count; /* 1..NOH_PALETTE_JOINTS_MAX */
} noh_palette;

/* A range of triangles with one material and one palette, and the range of their vertices. */
typedef struct noh_submesh {
    uint32_t first_index, index_count;
    uint32_t material; /* into the material chunk, or NOH_NONE */
    uint32_t first_vertex, vertex_count;
    uint32_t palette; /* 0 in a rigid mesh */
} noh_submesh;

#define NOH_TARGET_IDENTITY 1u /* noh_target.flags: changes the identity of a face; not an expression */

/* A morph target. A delta texel is three words, word i for axis i: from the top bit down `position_bits`, `normal_bits`
 * and `tangent_bits` in two's complement; value = integer * scale. */
typedef struct noh_target {
    uint32_t name, name_hash;
    uint32_t first_rect, rect_count;
    uint32_t first_texel, texel_count;
    uint32_t pair_count;
    uint8_t position_bits, normal_bits, tangent_bits;
    uint8_t flags; /* NOH_TARGET_* */
    float position_scale, normal_scale, tangent_scale;
    float radius;                      /* farthest movement of a vertex at weight 1, model units */
    float position_error;              /* certified largest error at weight 1, model units */
    float normal_error, tangent_error; /* per component */
    int16_t lips; /* by how much it opens the lips at weight 1: half of their gap, in 1/4096 of the mouth's depth, as
                   * NOH_SURFACE_TEETH has it */
    uint16_t reserved1;
} noh_target;

/* A rectangle of accumulation texels; delta texels are stored in the order of rectangles. */
typedef struct noh_rect {
    uint16_t x, y, w, h;
} noh_rect;

/* ---- CHUNK_TRANSFER, none or one for a mesh, in the order of meshes: header, then three arrays. The share of
 * environment light that each vertex of the mesh receives (light.h). A level of the mesh uses the first vertex_count
 * records and the deltas of its delta texels. ---- */

#define NOH_TRANSFER_ON_NORMAL 1u /* lobe axes are the normals; records have no axis */

/* Record of a vertex:
 *   occlusion  unorm 8: the share of light that reaches a white matte surface in the bind pose; with `bounce`,
 *              including one reflection
 *   shape      snorm 8 x (order - 1): for bands 1 and up, the mean of the Legendre polynomial P_l of the angle to the
 *              lobe's axis
 *   axis       snorm 8 x 2, octahedral, model space; absent with ON_NORMAL
 * No byte of shape, axis or delta is -128. */
#define NOH_TRANSFER_RECORD_BYTES(order, flags) ((order) + ((flags)&NOH_TRANSFER_ON_NORMAL ? 0u : 2u))

typedef struct noh_transfer_header {
    uint32_t mesh;                                    /* the n-th mesh chunk */
    uint32_t order;                                   /* 4 or 6 */
    uint32_t flags;                                   /* NOH_TRANSFER_* */
    uint32_t vertex_count, texel_count, target_count; /* of the mesh, at the finest level in the pack */
    uint32_t records_offset; /* uint8_t[vertex_count][NOH_TRANSFER_RECORD_BYTES(order, flags)] */
    uint32_t scales_offset;  /* float[target_count], 0 or above */
    uint32_t deltas_offset;  /* int8_t[texel_count], in the order of the delta texels: delta * scale is the change of
                              * occlusion at weight 1 of the target */
    uint32_t ray_count;      /* for reports: directions traced per vertex, over the whole sphere */
    uint32_t bounce;         /* 0..255: share of light that occluders reflect, in 255ths; 0: records have no reflected
                              * light */
    uint32_t reserved[5];
} noh_transfer_header;

/* ---- CHUNK_INFLUENCES, none or one for a mesh, in the order of meshes: header, then four arrays. All joints of the
 * vertices with more than NOH_INFLUENCES_MAX joints (deform.h); the mesh itself stores their strongest joints.
 * Levels of the mesh use the first vertices of the list. ---- */

typedef struct noh_influences_header {
    uint32_t mesh;            /* the n-th mesh chunk, a skinned one */
    uint32_t vertex_count;    /* of the list; 0: all were in stripped levels */
    uint32_t influence_count; /* sum over all vertices of the list */
    uint32_t most;            /* largest count of a vertex, at most NOH_SKIN_LIST_MAX */
    uint32_t vertices_offset; /* uint32_t[vertex_count] of the mesh, ascending */
    uint32_t firsts_offset;   /* uint32_t[vertex_count + 1]: first influence of each vertex; begins with 0 and ends with
                               * influence_count */
    uint32_t weights_offset;  /* float[influence_count], above 0, at most 1; the weights of a vertex sum to 1 within
                               * 2^-16 */
    uint32_t joints_offset;   /* uint16_t[influence_count] of the skin's joints */
    uint32_t reserved[8];
} noh_influences_header;

/* ---- CHUNK_WRINKLES, none or one for a mesh, in the order of meshes: header, then the arrays. How much each target
 * wrinkles each of twelve regions, and colours each of four (pack.h). more_textures of a material place the first on the
 * skin, the four channels of color_texture the others: a texel's channel is how far its region covers it. ---- */

#define NOH_WRINKLE_FOLDS 12u   /* regions of a wrinkle map */
#define NOH_WRINKLE_COLORS 4u   /* regions of colour */
#define NOH_WRINKLE_REGIONS 16u /* both, in this order */

typedef struct noh_wrinkles_header {
    uint32_t mesh;           /* the n-th mesh chunk */
    uint32_t target_count;   /* of the mesh */
    uint32_t matrix_offset;  /* uint8_t[target_count][NOH_WRINKLE_FOLDS], 255: all at weight 1 */
    uint32_t colors_offset;  /* 0: no colours. uint8_t[NOH_WRINKLE_COLORS + target_count][4]: the regions' colours, 255
                              * times the square roots of linear r, g, b, then 0; then for each target how much it
                              * colours each region, 255: all at weight 1 */
    uint32_t color_material; /* colours show on submeshes of this material; 0 without colours */
    uint32_t color_texture;  /* LINEAR; 0 without colours */
    uint32_t reserved[2];
} noh_wrinkles_header;

/* ---- CHUNK_FAR_JOINTS, none or one for a mesh, in the order of meshes: header, then three arrays. Virtual joints, which
 * stand for the targets in coarse levels of the mesh: further joints of its skin, each a copy of another entry of the
 * skin, that targets move on top (noh_mesh_move_far_joints, deform.h). The vertices of these levels have weights for
 * them, and no accumulation texels. Libraries older than this chunk refuse a pack with it (unknown type). ---- */

typedef struct noh_far_joints_header {
    uint32_t mesh;           /* the n-th mesh chunk, a skinned one without dual quaternions */
    uint32_t level;          /* the finest level whose vertices they move, above 0 */
    uint32_t joint_count;    /* 1..NOH_FAR_JOINTS_MAX */
    uint32_t target_count;   /* of the mesh */
    uint32_t first_joint;    /* of them, among the skin's joints */
    uint32_t centres_offset; /* float[joint_count][3], mesh space */
    uint32_t scales_offset;  /* float[joint_count][2], 0 or above: of moves, model units, and of turns, radians */
    uint32_t motions_offset; /* uint32_t[target_count][joint_count][2]: the move b and the turn w about the centre at
                              * weight 1, each x, y and z in 10 bits of two's complement from the lowest bit up, and two
                              * bits 0; value = integer * scale. A point p is moved by b + cross(w, p - centre) */
    float normal_error;      /* certified: the farthest that a vertex normal is off with each target alone at weight 1,
                              * radians */
    float normal_error_p99;  /* for 99 % of the pairs of vertices and targets */
    uint32_t reserved[6];
} noh_far_joints_header;
NOH_STATIC_ASSERT(sizeof(noh_far_joints_header) == 64, far_joints_header);

/* ---- CHUNK_EXTRAS, none or one for a mesh, in the order of meshes: header, names, then rows. The extra attributes of
 * its vertices, for shaders of the game's own: noh_mesh_extra (low_core.h) and noh_extra (shaders_es/README.md). All
 * meshes of a pack have the same ones in the same order. ---- */

typedef struct noh_extras_header {
    uint32_t mesh;         /* the n-th mesh chunk */
    uint32_t count;        /* 1..NOH_EXTRAS_MAX */
    uint32_t word_count;   /* extra_words of the mesh, above 0 */
    uint32_t names_offset; /* noh_extra_name[count] */
    uint32_t rows_offset;  /* noh_extra_row[count] */
    uint32_t reserved[3];
} noh_extras_header;
NOH_STATIC_ASSERT(sizeof(noh_extras_header) == 32, extras_header);

typedef struct noh_extra_name {
    uint32_t name, name_hash;
    float error; /* the farthest that a component of a vertex is off */
    uint32_t reserved;
} noh_extra_name;

/* Component c of an attribute is offset[c] + step[c] * n, n being `bits` bits of the words from bit
 * first_bit + c * bits. Numbers are floats, so that a row is uniforms as it is. */
typedef struct noh_extra_row {
    float offset[4], step[4]; /* step: 0 or above; components that there are not: 0 */
    float first_bit;          /* a multiple of `bits` */
    float bits;               /* 8 or 16 */
    float component_count;    /* 0..4; 0: this mesh does not have it, and the rest of the row is 0 */
    float reserved;
} noh_extra_row;
NOH_STATIC_ASSERT(sizeof(noh_extra_row) == 48, extra_row);

/* ---- CHUNK_NODES: header, then noh_node[node_count] at 16, then float[weight_count]. ---- */

typedef struct noh_nodes_header {
    uint32_t node_count;
    uint32_t weight_count;
    uint32_t nodes_offset;
    uint32_t weights_offset;
} noh_nodes_header;

typedef struct noh_node {
    uint32_t name, name_hash;
    uint32_t parent;                             /* a lower index or NOH_NONE */
    uint32_t mesh;                               /* the n-th mesh chunk, or NOH_NONE */
    float translation[3], rotation[4], scale[3]; /* local */
    float world[12];       /* 3 rows of 4: world position = rows * (x, y, z, 1). The identity for the node of a skinned
                            * mesh, which its joints place in model space */
    uint32_t first_weight; /* default weights of this node; NOH_NONE: the mesh's */
    uint32_t flags;
} noh_node;

/* ---- CHUNK_MATERIALS: noh_material[]. ---- */

#define NOH_MATERIAL_BLEND 1u
#define NOH_MATERIAL_MASK 2u
#define NOH_MATERIAL_DOUBLE_SIDED 4u
#define NOH_MATERIAL_UNLIT 8u
#define NOH_MATERIAL_UNTINTED 16u /* an instance's tint does not change its colour; the tint's alpha still applies */
/* more_textures[0] is a mask of codes, NOH_TEXTURE_RGBA8 and `nearest`, and the others are NOH_NONE. A byte b of
 * channel c encodes region 3 * c + b / 90; its weight is b % 90 times 0.014, at most 1, and 0 if b % 90 is above 75 */
#define NOH_MATERIAL_WRINKLE_CODES 32u
/* The use of a specular_texture's alpha; with such a texture exactly one is set */
#define NOH_MATERIAL_SPECULAR_WEIGHT 64u     /* multiplies f0 and the reflectance at grazing angles */
#define NOH_MATERIAL_SPECULAR_ROUGHNESS 128u /* multiplies roughness */
#define NOH_MATERIAL_TOON_SHADE 256u         /* a toon's shade has a texture of its own; without: the base colour's */
#define NOH_MATERIAL_OUTLINE_LIT 512u        /* the base colour multiplies the colour of the outline */
#define NOH_MATERIAL_TOON_MASKS 1024u        /* pixels of a toon read the red and blue of its third texture */

/* The lighting model of a material. noh_material.surface_values (x, y, z, w) and then surface_more hold, for
 *   skin   x millimetres per world unit, for scattering; 0: 1000. Then the inside of the mouth, in the bind pose and
 *          mesh space: yzw its centre, at the foremost teeth; surface_more: half its width, half its height, 1 over the
 *          depth where no light arrives, and half the lips' gap at rest, in such depths, or 0
 *          for 0.24. Zeros: none
 *   eye    xyz the gaze in the bind pose and mesh space, with the iris radius as its length, after the joints' scales;
 *          w the sine of the angle at the eyeball's centre between the gaze and the rim of the iris. surface_more: the
 *          edges of the upper and lower lid in front of the eyeball, in radii of it: at a distance a from the gaze,
 *          away from the nose, the edge is at the height x + y a + z a^2. Zeros: unknown
 *   teeth  nearness to the lips, 1 at the foremost teeth, 0 where no light arrives: dot(xyz, position in the bind pose)
 *          + w; zeros: unknown. surface_more: above 0 if known; 0; 0; half the lips' gap at rest, in depths of the
 *          mouth, or 0 for 0.24
 *   toon   xyz the colour in shade divided by the base colour, or with NOH_MATERIAL_TOON_SHADE the factor of its
 *          texture; w, -1 to 1, how far light extends past the terminator. surface_more, as in VRMC_materials_mtoon: 0,
 *          0 to 1: hardness of the edge; 1 colour of the rim; 2, at least 0: its Fresnel power; 3 its lift; 4 width of
 *          the outline, in world units, or below 0 in heights of the picture; 0: none; 5 colour of the outline. Colours
 *          are r + 256 g + 65536 b, where 0 to 255 are 255 times the square roots of linear values
 *   hair   xy the direction of the strands in the texture, unit, from root to tip; the rest zeros
 * A plain surface has zeros. */
#define NOH_SURFACE_PLAIN 0u
#define NOH_SURFACE_SKIN 1u
#define NOH_SURFACE_EYE 2u
#define NOH_SURFACE_TEETH 3u /* also gums and tongue: lit only through the lips */
#define NOH_SURFACE_TOON 4u  /* two tones with an edge between them, rim, matcap, outline; no gloss */
#define NOH_SURFACE_HAIR 5u  /* cards of hair: two highlights around the strands; no mirror */

/* The weight of a wrinkle map: by the surface's change of area in the pose; by twelve regions, weighted by the
 * expression; by the first weight map's red, always, and its green and blue as regions 3 and 6. */
#define NOH_WRINKLE_BY_AREA 1u
#define NOH_WRINKLE_BY_REGION 2u
#define NOH_WRINKLE_BY_CHANNEL 4u

/* noh_material.more_textures of a toon */
#define NOH_TOON_SHADE 0u  /* rgb in shade, with NOH_MATERIAL_TOON_SHADE; NOH_NONE: white */
#define NOH_TOON_MATCAP 1u /* rgb added, by the normal seen from the eye */
/* Data: g multiplies the width of the outline, sampled at vertices; with NOH_MATERIAL_TOON_MASKS
 * (255 r - 128) / 127 is added to the cosine of the light, and b multiplies rim and matcap. */
#define NOH_TOON_WIDTH 2u

/* Textures are indices of texture chunks, or NOH_NONE; colour textures are sRGB, the others LINEAR. The mesh's texture
 * coordinates include any texture transform of the source. */
typedef struct noh_material {
    uint32_t name, name_hash;
    uint32_t flags;
    uint32_t base_color_texture; /* rgb colour, a alpha */
    float base_color[4];         /* linear */
    float metallic, roughness, alpha_cutoff;
    float normal_scale;        /* of the normal map's x and y */
    float occlusion_strength;  /* 0..1: strength of the map's occlusion */
    float emissive[3];         /* linear, may be above 1 */
    float f0[3];               /* reflectance of non-metals at normal incidence; usually 0.04. May exceed 1 if maps
                                  * reduce it; the result is clamped to the reflectance at grazing angles */
    uint32_t normal_texture;   /* tangent space, +y up: rgb = 0.5 + 0.5 * xyz. Needs a mesh with tangents */
    uint32_t surface_texture;  /* r occlusion; g, b multiply roughness, metallic; a multiplies f0 and the reflectance
                                  * at grazing angles */
    uint32_t emissive_texture; /* rgb multiplies `emissive` */
    uint32_t wrinkle_texture;  /* a second normal map, with wrinkles */
    /* With a wrinkle map rgba of the three: coverage of a texel by each of twelve regions, sampled at vertices; or a
     * mask sampled at pixels: NOH_MATERIAL_WRINKLE_CODES. Of a toon, which has no wrinkle map: NOH_TOON_* */
    uint32_t more_textures[3];
    uint32_t surface;          /* NOH_SURFACE_* */
    float surface_values[4];   /* of the surface, above */
    uint16_t wrinkle_models;   /* NOH_WRINKLE_BY_*; the largest weight counts; 0 without a wrinkle map */
    int16_t priority;          /* of blended materials: drawn after lower ones of the same figure; -128..127 */
    float surface_more[6];     /* of the surface, above */
    uint32_t specular_texture; /* with NOH_MATERIAL_SPECULAR_*: rgb multiplies f0; a by the flag. Otherwise 0 */
    float f90_loss;            /* 0..1: non-metals reflect 1 - f90_loss at grazing angles */
} noh_material;

/* ---- CHUNK_TEXTURE: header, then the mip levels one after another, top row first. Each level has half the width and
 * height of the previous one, rounded down, at least 1. ---- */

#define NOH_WRAP_REPEAT 0u
#define NOH_WRAP_CLAMP 1u
#define NOH_WRAP_MIRROR 2u

#define NOH_TEXTURE_LINEAR 1u /* the bytes are data; otherwise sRGB with straight alpha */

/* Format of a level's bytes: texels, or blocks of texels, which cover the level from its top left corner and may extend
 * past its edges (ETC2 and EAC: OpenGL ES 3.0, appendix C, 4 x 4 texels; ASTC: OpenGL ES 3.2, appendix C). Packs older
 * than block formats have zeros here. */
#define NOH_TEXTURE_RGBA8 0u     /* uint8_t[height][width][4] */
#define NOH_TEXTURE_ETC2_RGB 1u  /* 8 bytes per block; alpha is 1 */
#define NOH_TEXTURE_ETC2_RGBA 2u /* 16 bytes per block: alpha as EAC, then RGB */
/* 16 bytes per block: x and y of a normal map, 11 bits each; z completes the unit vector. LINEAR, not `nearest` */
#define NOH_TEXTURE_EAC_RG 3u
/* 8 bytes per block: alpha is 0 or 1, and colours are 0 where alpha is 0, so a filtered colour divided by its alpha
 * ignores such texels */
#define NOH_TEXTURE_ETC2_RGBA1 4u
/* 16 bytes per block of as many texels, LDR. A normal map without blue has x and y alone; z completes the unit vector.
 * The library does not decode them: noh_gl_api.astc is needed, and picking takes their alpha as 1. `noh build` keeps
 * textures in ETC2 whose alpha cuts or blends */
#define NOH_TEXTURE_ASTC_4X4 5u /* 8 bits per texel */
#define NOH_TEXTURE_ASTC_5X5 6u /* 5.12 */
#define NOH_TEXTURE_ASTC_6X6 7u /* 3.56 */
#define NOH_TEXTURE_ASTC_8X8 8u /* 2 */

typedef struct noh_texture_header {
    uint32_t width, height;
    uint32_t wrap_s, wrap_t; /* NOH_WRAP_* */
    uint32_t nearest;        /* 1: no filtering */
    uint32_t pixels_offset;
    uint32_t level_count; /* all mip levels, down to 1 x 1; 1 with `nearest` */
    uint32_t flags;       /* NOH_TEXTURE_LINEAR, or 0 */
    uint32_t format;      /* NOH_TEXTURE_RGBA8... */
    float error;          /* for reports: mean square difference of the first level's bytes from the source, over the
                           * channels used; 0: none */
    uint32_t trim;        /* hash of the columns and rows removed because no triangle reads them: only textures with
                           * equal hashes fit the same texture coordinates. 0: none removed */
    uint16_t whole_width, whole_height; /* width and height before trimming; 0 if trim is 0 */
} noh_texture_header;

/* ---- CHUNK_SKELETON: header, then four arrays. Joints are ordered so that each LOD level is a prefix: roots first,
 * then by decreasing distance to the farthest descendant in the bind pose. ---- */

#define NOH_PACK_JOINT_ROOT 0xffffu /* parent of a joint that has none */

typedef struct noh_skeleton_header {
    uint32_t joint_count;
    uint32_t hash;           /* of names and parents; matches clips of one pack with meshes of another */
    float unit_cm;           /* centimetres per unit of the translations */
    uint32_t parents_offset; /* uint16_t[joint_count], parents first, or NOH_PACK_JOINT_ROOT */
    uint32_t bind_offset;    /* float[joint_count][10]: rotation xyzw, translation, scale; local */
    uint32_t names_offset;   /* uint32_t[joint_count] */
    uint32_t level_count;    /* 1..NOH_LOD_LEVELS_MAX */
    uint32_t levels_offset;  /* uint32_t[level_count]: number of joints posed at each level, decreasing from
                              * joint_count; every level has all roots */
} noh_skeleton_header;

/* ---- CHUNK_SKIN: header, then two arrays. ---- */

/* A skin may contain a joint of the skeleton several times, with different inverse bind matrices. */
typedef struct noh_skin_header {
    uint32_t joint_count;
    uint32_t skeleton;      /* the n-th skeleton chunk */
    uint32_t joints_offset; /* uint16_t[joint_count], joints of that skeleton */
    /* float[joint_count][12], rows as in noh_node.world: from mesh space to joint space */
    uint32_t inverse_bind_offset;
} noh_skin_header;

/* ---- CHUNK_CLIP: header, callback keys and sync markers in time order, the errors of coarser skeletons, then the
 * compressed clip (low_motion.h): joints of a skeleton, morph weights of nodes, named floats. Errors are in the
 * skeleton's unit; in a clip without joints in metres. ---- */

#define NOH_CLIP_UPDATE_RATES 4u /* every frame, 30, 15 and 8 Hz: noh_update_rate of low_stage.h */

typedef struct noh_clip_header {
    uint32_t skeleton_hash; /* 0 without joints */
    uint32_t skeleton;      /* in this pack, the one that the clip was built with; NOH_NONE without joints */
    uint32_t joint_count;   /* 0: animates floats only */
    uint32_t raw_bytes;     /* uncompressed size: 40 per joint and frame, 4 per float */
    uint32_t event_count;
    uint32_t events_offset; /* noh_clip_event[event_count] */
    uint32_t marker_count;
    uint32_t markers_offset;      /* noh_clip_marker[marker_count] */
    uint32_t joint_error_count;   /* LOD levels of its skeleton; 0 without joints */
    uint32_t joint_errors_offset; /* float[joint_error_count]: largest error of a point when only the joints of a level
                                   * are sampled and the others follow their parents; 0 for level 0, and not
                                   * decreasing */
    uint32_t clip_bytes;
    uint32_t clip_offset;
    /* Largest error of a point when the clip is posed at an update rate and blended in between; 0 for the first rate,
     * and not decreasing. A loop continues from its end, as with root motion: the jump back to its start is not
     * counted. */
    float update_rate_error[NOH_CLIP_UPDATE_RATES];
    /* 0: the errors are for the meshes that the clip was built with. joint_errors bound all points no farther from a
     * joint than the farthest vertex that it moves with a weight of 0.05 or more.
     * update_rate_error is exact for a few hundred vertices, including the farthest of each joint, and does not bound
     * points between them. Above 0: built without meshes; both bound points at this
     * distance from each joint (--shell-cm), in the skeleton's unit. */
    float error_shell;
    /* The root joint in the source's first and last frame: rotation x, y, z, w, then translation. Root motion uses
     * these because the compression error would add up with each loop. 0 without joints. */
    float root_ends[2][7];
} noh_clip_header;

typedef struct noh_clip_event {
    uint32_t tick; /* 1/48,000 s */
    uint32_t name, name_hash;
    uint8_t payload[8];
    float weight_min; /* below this weight the key does not fire */
} noh_clip_event;

/* A moment that synchronised clips have in common, such as a foot touching the ground. */
typedef struct noh_clip_marker {
    uint32_t tick;            /* increasing */
    uint32_t name, name_hash; /* the hash is its id */
} noh_clip_marker;

/* ---- CHUNK_RECIPE, none or one: header, rows. The face recipe (face.h): targets of the meshes by name, and the use
 * of each. ---- */

typedef struct noh_recipe_header {
    uint32_t row_count, rows_offset;
    uint32_t reserved[2];
} noh_recipe_header;

typedef struct noh_recipe_row {
    uint32_t target, target_hash;
    /* a name of noh_face_channel_name; or '+' and the name of a target that drives a corrective (low_life.h; rows of
     * one corrective are consecutive); or a rule for the target's weight (low_life.h): `range-min` and in the next
     * row `range-max`; '-' and the name of its opposite; '=' and the name of the first target of its group; ':' and
     * the name of an expression that moves it, which is a target too. Of
     * joint-head, joint-neck, joint-chest, joint-eye-left and joint-eye-right the target is a joint (modules.h).
     * Of override-lids, override-eyes, override-speech and binary the target is the upper channel of an emotion, or
     * an expression, and the weight a noh_override, or 1 (noh_face_rules, face.h). Of `phone-` and one or two mouth
     * shapes, phone-aa-ih, the target is a phone that has them, for `noh speak` */
    uint32_t channel, channel_hash;
    float weight; /* -4..4; for a corrective's driver its peak, above 0, at most 1; for a range its limit */
    uint32_t reserved[3];
} noh_recipe_row;

/* ---- CHUNK_RAGDOLL, none or one: header, rows. The bodies of a ragdoll by their first joints, and the limits of these
 * joints: as in noh_ragdoll_row (low_life.h), in any order, each joint once. Libraries older than this chunk refuse
 * a pack with it (unknown type). ---- */

typedef struct noh_pack_ragdoll_header {
    uint32_t row_count, rows_offset; /* 1..NOH_RAGDOLL_BODIES_MAX */
    uint32_t reserved[2];
} noh_pack_ragdoll_header;

typedef struct noh_pack_ragdoll_row {
    uint32_t joint, joint_hash;
    uint32_t hinge;           /* 0 or 1 */
    uint32_t toward;          /* 0 forward, 1 backward, 2 upward */
    float bend_min, bend_max; /* radians, -pi..0 and 0..pi */
    float side, twist;        /* radians, 0..pi */
    float friction;           /* N m for a body of 70 kg, 0..10,000 */
    uint32_t reserved[3];
} noh_pack_ragdoll_row;

/* ---- CHUNK_SPRINGS, none or one for a skeleton, in the order of skeletons: header, then three arrays. Swinging chains
 * of joints (modules.h), and capsules that they collide with. ---- */

/* A swinging joint. */
typedef struct noh_spring_row {
    uint32_t joint;
    float stiffness;  /* pull towards the rest direction, metres per second, 0..; as in VRM, usually 0..4 */
    float drag;       /* share of speed lost per 1/60 s, 0..1 */
    float radius;     /* collision radius of its end, metres, 0.. */
    float gravity[3]; /* pull of gravity, metres per second, world space */
} noh_spring_row;

/* Consecutive rows, each joint a child of the previous one; the first joint has a parent. */
typedef struct noh_spring_chain {
    uint32_t first_row, row_count; /* 1..NOH_SPRING_JOINTS_MAX; the previous chain's rows end before first_row */
    uint32_t collides;             /* bit i: collides with collider i */
    float end[3];                  /* end of the last joint's bone, in its space, in the skeleton's unit */
} noh_spring_chain;

/* A capsule attached to a joint; a sphere if `from` and `to` are equal. */
typedef struct noh_spring_capsule {
    uint32_t joint;
    float from[3], to[3]; /* in the joint's space, in the skeleton's unit */
    float radius;         /* metres, 0.. */
} noh_spring_capsule;

typedef struct noh_springs_header {
    uint32_t skeleton;                         /* the n-th skeleton chunk */
    uint32_t joint_count;                      /* of the skeleton */
    uint32_t row_count, rows_offset;           /* noh_spring_row[row_count], each joint at most once */
    uint32_t chain_count, chains_offset;       /* noh_spring_chain[chain_count]; a chain attached to another comes after
                                                * it */
    uint32_t collider_count, colliders_offset; /* noh_spring_capsule[collider_count] */
    uint32_t reserved[4];
} noh_springs_header;

/* ---- CHUNK_HAIR, none or one: header, points, patches, spheres. A haircut for low_life.h. Head space is model space
 * in the bind pose, in metres, moving with the joint. Libraries older than this chunk refuse a pack with it (unknown
 * type). ---- */

typedef struct noh_pack_hair_header {
    uint32_t joint, joint_hash;       /* the hair moves with it; "": with the actor */
    uint32_t hair_count, point_count; /* control hairs, points of each; limits as in low_life.h */
    uint32_t patch_count;             /* 1..NOH_HAIR_PATCHES_MAX */
    uint32_t sphere_count;            /* 0..NOH_HAIR_SPHERES_MAX */
    uint32_t strip_count;             /* in full detail, 1..NOH_HAIR_STRIPS_MAX */
    uint32_t segment_count;           /* of a strip, 1..NOH_HAIR_SEGMENTS_MAX */
    uint32_t points_offset;           /* float[hair_count][point_count][3] at rest, root to tip */
    uint32_t patches_offset;          /* uint32_t[patch_count][4]: control hairs at the corners 00, 10, 01, 11 */
    uint32_t spheres_offset;          /* float[sphere_count][4]: centre, radius */
    uint32_t seed;                    /* of gusts */
    float metres;                     /* per model unit, above 0 */
    float pull, pull_at_tip;          /* these and the next two as in noh_hair_desc */
    float damping, gravity;
    float width_root, width_tip;       /* of a strip, above 0 */
    float curl_radius;                 /* at the tip, 0.. */
    float curl_turns;                  /* from root to tip */
    float scatter;                     /* how far a strip deviates from its patch, at the tip, 0.. */
    float middle[3];                   /* centre of the skull; hair faces away from it */
    float color_root[3], color_tip[3]; /* linear, 0..1 */
    float gloss;                       /* 0..4; 1: combed, dry hair */
} noh_pack_hair_header;

/* ---- CHUNK_TERRAIN, none or one: header, heights. A height field (body.h), which noh_terrain_of (body.h) uses in
 * place: 257 x 257 heights take 132,146 bytes. Libraries older than this chunk refuse a pack with it (unknown type).
 * ---- */

typedef struct noh_pack_terrain_header {
    uint32_t width, depth;   /* 2..NOH_TERRAIN_SIZE_MAX */
    float origin[3];         /* of heights[0][0] = 0, metres */
    float spacing;           /* metres between heights, above 0 */
    float scale;             /* metres per unit of height, 0.. */
    uint32_t heights_offset; /* uint16_t[depth][width], rows along +X, consecutive rows along +Z */
    uint32_t reserved[4];
} noh_pack_terrain_header;
NOH_STATIC_ASSERT(sizeof(noh_pack_terrain_header) == 48, pack_terrain_header);

/* ---- CHUNK_COVER, none or several: header, bits. The triangles that a garment hides of one mesh of its wearer, of all
 * levels in the wearer's pack (noh build --wear). Libraries older than this chunk refuse a pack with it. ---- */

typedef struct noh_pack_cover_header {
    uint32_t mesh, mesh_hash; /* string offset and hash of the name of the wearer's mesh */
    uint32_t triangle_count;  /* of all levels, the finest first, as their indices lie in the pack; at least 1 */
    uint32_t indices_crc;     /* CRC-32C of these indices: the bits are for no other mesh */
    uint32_t hidden_count;
    uint32_t bits_offset; /* uint32_t[(triangle_count + 31) / 32]: bit t & 31 of word t / 32: triangle t is hidden */
    uint32_t reserved[2];
} noh_pack_cover_header;
NOH_STATIC_ASSERT(sizeof(noh_pack_cover_header) == 32, pack_cover_header);

/* ---- CHUNK_MATCH, none or one: header, then seven arrays. A table for motion matching (noh_match_module, modules.h;
 * noh build --match). A row describes a moment of a clip by 27 features in the actor's own space, in model units and
 * seconds: positions of two feet (0 to 5), their velocities (6 to 11), the velocity of the hips (12 to 14), where the
 * actor will be on the ground after 1/3, 2/3 and 1 s (15 to 20: x, z) and where it will face then (21 to 26: sine and
 * cosine of its heading). Feature 27 is 0.
 *
 * A number of a row is scale * (feature - mean), rounded, -127..127. Features from 20 on have half the scale, and count
 * four times. Rows lie in the order of a kd tree, in groups of 8: [14 pairs of features][8 rows][2]; the last group
 * repeats the last row. Boxes hold the least and the greatest numbers of 16, 64 and 512 rows, in groups of 8 boxes:
 * [least, greatest][14][8][2]; boxes past the last are 127 and -127. Libraries older than this chunk refuse a pack with
 * it. ---- */

#define NOH_MATCH_FEATURES 28u /* with the last, which is 0 */
#define NOH_MATCH_COARSE 20u   /* features from here on have half the scale */
#define NOH_MATCH_GROUP_BYTES (8u * NOH_MATCH_FEATURES)
#define NOH_MATCH_LEVELS 3u /* boxes of 16, 64 and 512 rows */

typedef struct noh_pack_match_header {
    uint32_t root_axes, root_up;             /* root motion that the features assume: noh_kind_desc.root_axes, and y */
    uint32_t row_count;                      /* 1..NOH_MATCH_ROWS_MAX */
    uint32_t row_ticks;                      /* between two rows of a clip */
    uint32_t clip_count, clips_offset;       /* noh_pack_match_clip[] */
    uint32_t tag_count, tags_offset;         /* noh_pack_match_tag[], at most NOH_MATCH_TAGS_MAX */
    uint32_t numbers_offset;                 /* float[2][NOH_MATCH_FEATURES]: means, scales */
    uint32_t order_offset;                   /* uint16_t[row_count]: each row's number by clip and time */
    uint32_t rows_offset;                    /* int8_t[groups of 8][14][8][2] */
    uint32_t boxes_offset[NOH_MATCH_LEVELS]; /* int8_t[groups of 8 boxes][2][14][8][2] */
    uint32_t reserved[2];
} noh_pack_match_header;

typedef struct noh_pack_match_clip {
    uint32_t name, name_hash;
    uint32_t first_row, row_count; /* by number; the n-th row is at tick n * row_ticks */
    uint32_t tags;                 /* a bit for each of the chunk's tags */
    uint32_t reserved;
} noh_pack_match_clip;

typedef struct noh_pack_match_tag {
    uint32_t name, name_hash;
} noh_pack_match_tag;

NOH_STATIC_ASSERT(sizeof(noh_pack_match_header) == 64, pack_match_header);
NOH_STATIC_ASSERT(sizeof(noh_pack_match_clip) == 24, pack_match_clip);
NOH_STATIC_ASSERT(sizeof(noh_pack_match_tag) == 8, pack_match_tag);

/* ---- CHUNK_GRAPH, none or several: header, then ten arrays. An animation graph (low_motion.h) whose nodes,
 * parameters, clips and joints have names; graph.h checks it and binds it to clips and a skeleton when it is opened.
 * Kinds, conditions, curves, loops and flags are constants of graph.h, low_motion.h and clip.h. ---- */

#define NOH_PACK_GRAPH_NONE 0xffffu

#define NOH_PACK_NODE_CLIP 0u
#define NOH_PACK_NODE_BLEND 1u
#define NOH_PACK_NODE_ADD 2u
#define NOH_PACK_NODE_MASK 3u
#define NOH_PACK_NODE_SPACE_1D 4u
#define NOH_PACK_NODE_SPACE_2D 5u
#define NOH_PACK_NODE_MACHINE 6u
#define NOH_PACK_NODE_SELECT 7u
#define NOH_PACK_NODE_ONE_SHOT 8u

typedef struct noh_pack_graph_header {
    uint32_t node_count, nodes_offset;             /* noh_pack_graph_node[], children first; the last one is the root */
    uint32_t child_count, children_offset;         /* uint16_t[], indices of nodes; child_count is node_count - 1 */
    uint32_t clip_count, clips_offset;             /* noh_pack_graph_clip[] */
    uint32_t transition_count, transitions_offset; /* noh_pack_graph_transition[] */
    uint32_t point_count, points_offset;           /* float[] of blend spaces: SPACE_1D thresholds, SPACE_2D x and y */
    uint32_t space_count, spaces_offset;           /* noh_pack_graph_space[] */
    uint32_t triangle_count, triangles_offset;     /* uint8_t[][3], indices of a space's points, counter-clockwise */
    uint32_t param_count, params_offset;           /* noh_pack_graph_param[] */
    uint32_t mask_count, masks_offset;             /* noh_pack_graph_mask[] */
    uint32_t name_count, names_offset; /* noh_pack_graph_name[]: values of ENUM parameters, joints of masks, clips */
    uint32_t machine_count;            /* MACHINE, SELECT and ONE_SHOT nodes */
    uint32_t reserved[3];
} noh_pack_graph_header;

/* Unused fields are 0, unused params NOH_PACK_GRAPH_NONE. */
typedef struct noh_pack_graph_node {
    uint32_t name, name_hash;
    uint16_t kind; /* NOH_PACK_NODE_* */
    uint16_t first_child, child_count;
    uint16_t param, param_y;
    /* SPACE_1D: points, one per child; SPACE_2D: its space, 1; MACHINE: its transitions; ADD: none, or 1, the name of
     * its reference clip */
    uint16_t first_item, item_count;
    uint16_t mask;  /* MASK, ONE_SHOT: 1 + index; ONE_SHOT also 0 */
    uint16_t index; /* CLIP: its number among the clips; MACHINE, SELECT, ONE_SHOT: its number among these; in stored
                     * order */
    uint8_t curve, flags;
    float value;
    uint32_t fade_ticks, fade_out_ticks;
} noh_pack_graph_node;

typedef struct noh_pack_graph_clip {
    uint32_t name, name_hash; /* of a clip in the clip set */
    uint32_t start_tick;
    int32_t speed; /* 1/65,536, not 0 */
    uint8_t loop;  /* 0: the clip's own */
    uint8_t sync_group;
    uint8_t paused; /* 1: starts at speed 0 */
    uint8_t reserved;
} noh_pack_graph_clip;

typedef struct noh_pack_graph_transition {
    uint16_t from, to; /* children of its machine; from NOH_PACK_GRAPH_NONE: any */
    uint16_t condition, param;
    float threshold;
    uint32_t duration_ticks;
    uint16_t curve, flags;
} noh_pack_graph_transition;

typedef struct noh_pack_graph_space {
    uint16_t first_point; /* in points: two floats per child of its node */
    uint16_t point_count;
    uint16_t first_triangle, triangle_count;
} noh_pack_graph_space;

#define NOH_PARAM_NUMBER 0u
#define NOH_PARAM_INTEGER 1u
#define NOH_PARAM_ENUM 2u    /* minimum 0, maximum value_count - 1 */
#define NOH_PARAM_TRIGGER 3u /* 0..1, initially 0 */

typedef struct noh_pack_graph_param {
    uint32_t name, name_hash;
    float minimum, maximum, initial;
    uint16_t kind;                     /* NOH_PARAM_* */
    uint16_t first_value, value_count; /* ENUM: its values, in names */
    uint16_t reserved;
} noh_pack_graph_param;

/* Joints start at weight 0, then entries apply in order; all floats (morph weights, named floats) have one weight. */
typedef struct noh_pack_graph_mask {
    uint32_t name, name_hash;
    uint16_t first_joint, joint_count; /* in names */
    uint8_t floats;                    /* 255: full weight */
    uint8_t reserved[3];
} noh_pack_graph_mask;

typedef struct noh_pack_graph_name {
    uint32_t name, name_hash;
    uint8_t weight;  /* of a joint, 255: full */
    uint8_t subtree; /* 1: with all its descendants */
    uint8_t reserved[2];
} noh_pack_graph_name;

NOH_STATIC_ASSERT(sizeof(noh_pack_graph_header) == 96, graph_header);
NOH_STATIC_ASSERT(sizeof(noh_pack_graph_node) == 40, graph_node);
NOH_STATIC_ASSERT(sizeof(noh_pack_graph_clip) == 20, graph_clip);
NOH_STATIC_ASSERT(sizeof(noh_pack_graph_transition) == 20, graph_transition);
NOH_STATIC_ASSERT(sizeof(noh_pack_graph_space) == 8, graph_space);
NOH_STATIC_ASSERT(sizeof(noh_pack_graph_param) == 28, graph_param);
NOH_STATIC_ASSERT(sizeof(noh_pack_graph_mask) == 16, graph_mask);
NOH_STATIC_ASSERT(sizeof(noh_pack_graph_name) == 12, graph_name);
NOH_STATIC_ASSERT(sizeof(noh_pack_ragdoll_header) == 16, ragdoll_header);
NOH_STATIC_ASSERT(sizeof(noh_pack_ragdoll_row) == 48, ragdoll_row);
NOH_STATIC_ASSERT(sizeof(noh_springs_header) == 48, springs_header);
NOH_STATIC_ASSERT(sizeof(noh_spring_row) == 28, spring_row);
NOH_STATIC_ASSERT(sizeof(noh_spring_chain) == 24, spring_chain);
NOH_STATIC_ASSERT(sizeof(noh_spring_capsule) == 32, spring_capsule);

NOH_STATIC_ASSERT(sizeof(noh_pack_hair_header) == 128, hair_header);
NOH_STATIC_ASSERT(sizeof(noh_skeleton_header) == 32, skeleton_header);
NOH_STATIC_ASSERT(sizeof(noh_skin_header) == 16, skin_header);
NOH_STATIC_ASSERT(sizeof(noh_palette) == 8, palette);
NOH_STATIC_ASSERT(NOH_VERTICES_MAX <= 1u << NOH_TEXEL_VERTEX_BITS, texel_vertex);
NOH_STATIC_ASSERT(NOH_SUBMESHES_MAX <= 1u << (32u - NOH_TEXEL_VERTEX_BITS), texel_palette);
NOH_STATIC_ASSERT(sizeof(noh_clip_header) == 124, clip_header);
NOH_STATIC_ASSERT(sizeof(noh_clip_event) == 24, clip_event);
NOH_STATIC_ASSERT(sizeof(noh_clip_marker) == 12, clip_marker);
NOH_STATIC_ASSERT(sizeof(noh_pack_header) == 64, pack_header);
NOH_STATIC_ASSERT(sizeof(noh_pack_chunk) == 32, pack_chunk);
NOH_STATIC_ASSERT(sizeof(noh_mesh_header) == 256, mesh_header);
NOH_STATIC_ASSERT(sizeof(noh_submesh) == 24, submesh);
NOH_STATIC_ASSERT(sizeof(noh_target) == 64, target);
NOH_STATIC_ASSERT(sizeof(noh_rect) == 8, rect);
NOH_STATIC_ASSERT(sizeof(noh_node) == 112, node);
NOH_STATIC_ASSERT(sizeof(noh_material) == 160, material);
NOH_STATIC_ASSERT(sizeof(noh_texture_header) == 48, texture_header);
NOH_STATIC_ASSERT(sizeof(noh_transfer_header) == 64, transfer_header);
NOH_STATIC_ASSERT(sizeof(noh_influences_header) == 64, influences_header);
NOH_STATIC_ASSERT(sizeof(noh_wrinkles_header) == 32, wrinkles_header);

#ifdef __cplusplus
}
#endif

#endif
