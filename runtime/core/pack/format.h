/* format.h: the bytes of a .noh pack, little-endian, read where they lie.
 *
 * A pack is a header, a chunk table and the chunks. Every chunk begins at the next multiple of 64 after the one before
 * it, and every array inside a chunk at the next multiple of 16 after the array before it. Offsets therefore follow
 * from the counts; the file carries them all the same, so that readers are simple, and noh_pack_open demands that both
 * agree. Padding and reserved fields are zero. Names are offsets into the string chunk. There are no pointers, so
 * nothing needs patching.
 *
 * Threads: constant data; any thread. */
#ifndef NOH_PACK_FORMAT_H
#define NOH_PACK_FORMAT_H

#include "core/base/limits.h"
#include "core/base/result.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_PACK_MAGIC 0x50484f4eu /* "NOHP" */
#define NOH_PACK_VERSION 5u

#define NOH_FOURCC(a, b, c, d) ((uint32_t)(a) | ((uint32_t)(b) << 8) | ((uint32_t)(c) << 16) | ((uint32_t)(d) << 24))
#define NOH_CHUNK_STRINGS NOH_FOURCC('S', 'T', 'R', 'S')
#define NOH_CHUNK_MESH NOH_FOURCC('M', 'E', 'S', 'H')
#define NOH_CHUNK_NODES NOH_FOURCC('N', 'O', 'D', 'E')
#define NOH_CHUNK_MATERIALS NOH_FOURCC('M', 'A', 'T', 'L')
#define NOH_CHUNK_TEXTURE NOH_FOURCC('T', 'X', 'T', 'R')
#define NOH_CHUNK_SKELETON NOH_FOURCC('S', 'K', 'E', 'L')
#define NOH_CHUNK_CLIP NOH_FOURCC('M', 'O', 'T', 'N')
#define NOH_CHUNK_SKIN NOH_FOURCC('S', 'K', 'I', 'N')
#define NOH_CHUNK_GRAPH NOH_FOURCC('G', 'R', 'P', 'H')
#define NOH_CHUNK_RECIPE NOH_FOURCC('R', 'C', 'P', 'E')
#define NOH_CHUNK_RAGDOLL NOH_FOURCC('R', 'G', 'D', 'L')
#define NOH_CHUNK_HAIR NOH_FOURCC('H', 'A', 'I', 'R')
#define NOH_CHUNK_TRANSFER NOH_FOURCC('T', 'R', 'N', 'S')
#define NOH_CHUNK_INFLUENCES NOH_FOURCC('I', 'N', 'F', 'L')
#define NOH_CHUNK_WRINKLES NOH_FOURCC('W', 'R', 'N', 'K')
#define NOH_CHUNK_SPRINGS NOH_FOURCC('S', 'P', 'R', 'G')
#define NOH_CHUNK_TERRAIN NOH_FOURCC('T', 'E', 'R', 'R')

typedef struct noh_pack_header {
    uint32_t magic;
    uint32_t version;
    uint32_t byte_count; /* of the whole file, a multiple of 64 */
    uint32_t chunk_count;
    uint32_t crc;             /* CRC-32C of the header (this field as 0) and the chunk table */
    uint32_t library_version; /* NOH_VERSION_NUMBER of the noh that wrote it, for reports: any value opens; 0: before
                                 0.2.0 */
    uint32_t reserved[10];
} noh_pack_header;

typedef struct noh_pack_chunk {
    uint32_t type;
    uint32_t name;      /* string offset */
    uint32_t name_hash; /* FNV-1a of the name */
    uint32_t offset;    /* from the start of the file, a multiple of 64 */
    uint32_t bytes;     /* without padding */
    uint32_t crc;       /* CRC-32C of those bytes */
    uint32_t reserved[2];
} noh_pack_chunk;

/* ---- CHUNK_STRINGS: bytes of zero-terminated UTF-8 strings; the first is "". ---- */

/* ---- CHUNK_MESH ---- */

#define NOH_MESH_TANGENTS 1u
#define NOH_MESH_UVS 2u
#define NOH_MESH_COLORS 4u
#define NOH_MESH_DUAL_QUATERNION 8u /* skinned by dual quaternions, else by matrices */
/* Each vertex has a texel reference: the mesh is split into several palettes, or has LOD levels, in which moved and
 * unmoved vertices alternate. */
#define NOH_MESH_TEXELS 16u
/* Targets move texture coordinates: each vertex has a reference to a second accumulation texel, that of its UV. The
 * position that is accumulated there is how far the picture slides over the surface, along u and v, as a length:
 * uv_per_unit makes texture coordinates of it. A mesh with it has UVS and TEXELS, too. */
#define NOH_MESH_UV_TARGETS 32u

/* Attribute record, interleaved, 4 bytes each and in this order; those whose flag is not set are absent:
 *   normal   int16 x 2, octahedral: n.xy / 32767 unfolds to a unit vector; always there
 *   tangent  int16 x 2, octahedral; y has 15 bits above bit 0, which is 1 for handedness -1 (TANGENTS)
 *   uv       unorm 16:16, uv = uv_offset + uv_scale * value (UVS)
 *   color    unorm 8:8:8:8, linear rgb with a square-root curve, alpha straight (COLORS)
 *   uv texel the accumulation texel of its UV, or NOH_TEXEL_NONE where no target moves that (UV_TARGETS)
 *   texel    low 22 bits the vertex's accumulation texel, above them its palette (TEXELS). Without levels: the vertex
 *            whose texel it shares, which has one if it is below touched_count; with levels, or with UV_TARGETS: the
 *            texel, or NOH_TEXEL_NONE */
#define NOH_TEXEL_VERTEX_BITS 22u
#define NOH_TEXEL_NONE ((1u << NOH_TEXEL_VERTEX_BITS) - 1u)

/* The header of the full mesh is followed by those of its coarser LOD levels, each a mesh of its own. A level shares
 * the finer level's arrays of vertices and delta texels and, target by target, of rectangles: it has the first so many
 * of each. Its indices, submeshes and targets follow the finer level's. So a level can be used, and loaded, as if there
 * were no finer one.
 *
 * A pack may lack the finest levels of a mesh (`noh strip`): the first header is then that of the finest level there
 * is. Levels keep their numbers, and errors remain distances to the full mesh; bounds, boxes and the other fields that
 * all levels share are the full mesh's too, only the arrays are shorter. */
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
    uint32_t source_pair_count; /* what the asset had, for reports */
    uint32_t touched_count;     /* accumulation texels, of vertices and of UVs; without texel references vertices
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
    float f16_position_bound;  /* largest error of a half-float accumulator, model units, all |weights| <= 2 */
    float f16_direction_bound; /* the same for normals and tangents, per component */
    float world_scale;         /* world units (metres) per model unit: the largest scale of the nodes that draw it */
    uint32_t texels_one_rect;  /* for reports: one rectangle per target, the asset's vertex order */
    /* float[target_count][6]: smallest and largest x, y, z of its position deltas and of 0 */
    uint32_t target_boxes_offset;
    uint32_t skin;              /* the n-th skin chunk, or NOH_NONE: a rigid mesh, and all below is 0 */
    uint32_t influence_count;   /* joints per vertex: 0, 1, 2, 4 or 8 */
    uint32_t influences_offset; /* uint32_t[vertex_count][NOH_INFLUENCE_WORDS] */
    uint32_t palette_count;     /* 1, or more where one palette cannot hold all joints: the mesh is split by triangle */
    uint32_t palettes_offset;   /* noh_palette[palette_count] */
    uint32_t palette_joint_count;
    uint32_t palette_joints_offset; /* uint16_t[palette_joint_count], indices into the skin's joints */
    /* float[the skin's joint_count][6]: smallest and largest x, y, z of the rest positions of the vertices that this
     * joint moves; the smallest above the largest where it moves none */
    uint32_t joint_boxes_offset;
    uint32_t level;         /* 0: the full mesh; level_first in the chunk's first header, then rising by 1 */
    uint32_t level_count;   /* 1..NOH_LOD_LEVELS_MAX, of the mesh: the same in all its levels; with those it lacks */
    float level_error_rest; /* certified: the largest distance between this level's surface and the full one, both ways,
                             * model units; all 0 in the full mesh. At rest, */
    float level_error_rest_p99; /* nearer than this for 99 % of the area; */
    float level_error_targets;  /* with each target alone at weight 1, */
    float level_error_pairs;    /* with the targets for left and right together, */
    float level_error_clip;     /* over frames of the clips that the pack was built with */
    /* the farthest that the targets without rectangles in this level would move a vertex, all at weight 1 */
    float level_skipped;
    float influence_errors[3]; /* the farthest that a vertex is off, over those frames, when only its 4, 2, 1 heaviest
                                * joints move it, model units; 0 in a mesh without levels */
    uint32_t level_first;      /* the finest level in the pack; below level_count */
    uint32_t source_crc; /* CRC-32C of the chunk that the levels were cut from, with level 0; 0 where level_first is */
    float uv_per_unit;   /* with UV_TARGETS: texture coordinates for a model unit in a UV's texel, above 0; else 0 */
    uint32_t reserved[5];
} noh_mesh_header;

/* Influences of a vertex, in words. The first joint is the strongest: its weight is what the others leave of 1, so sums
 * are exact. The others' weights are multiples of 2^-22. Joints are 8-bit indices into the vertex's palette; those
 * without a weight repeat the first.
 *   1  j0
 *   2  j0 | j1 << 8, then w1
 *   4  j0 | j1 << 8 | j2 << 16 | j3 << 24, then w1, w2, w3
 *   8  the same, j4 to j7, then w1 to w7
 * Weights follow each other from the lowest bit of their words up: w1 has 22 bits (it may be one half), the others 21
 * (they are at most a third). */
#define NOH_INFLUENCE_WORDS(count) ((count) == 8u ? 7u : (count) == 4u ? 3u : (count))
#define NOH_WEIGHT_ONE 0x400000u /* 2^22 */

/* A run of palette_joints: the matrices that one draw needs. */
typedef struct noh_palette {
    uint32_t first_joint, joint_count; /* 1..NOH_PALETTE_JOINTS_MAX */
} noh_palette;

/* A range of triangles with one material and one palette, and the range of vertices that it uses. */
typedef struct noh_submesh {
    uint32_t first_index, index_count;
    uint32_t material; /* into the material chunk, or NOH_NONE */
    uint32_t first_vertex, vertex_count;
    uint32_t palette; /* 0 in a rigid mesh */
} noh_submesh;

#define NOH_TARGET_IDENTITY 1u /* noh_target.flags: it makes one face differ from another, and is no expression */

/* One morph target. A delta texel is three words, word i for axis i: from the top bit down `position_bits`,
 * `normal_bits`, `tangent_bits` of two's complement; value = integer * scale. */
typedef struct noh_target {
    uint32_t name, name_hash;
    uint32_t first_rect, rect_count;
    uint32_t first_texel, texel_count;
    uint32_t pair_count;
    uint8_t position_bits, normal_bits, tangent_bits;
    uint8_t flags; /* NOH_TARGET_* */
    float position_scale, normal_scale, tangent_scale;
    float radius;                      /* the farthest that it moves a vertex at weight 1, model units */
    float position_error;              /* largest error at weight 1, model units: certified by the converter */
    float normal_error, tangent_error; /* per component */
    uint32_t reserved1;
} noh_target;

/* A rectangle of accumulation texels; its delta texels follow those of the rectangle before it. */
typedef struct noh_rect {
    uint16_t x, y, w, h;
} noh_rect;

/* ---- CHUNK_TRANSFER, none or one for a mesh, in the order of meshes: header, then three arrays. How much of the light
 * around it each vertex of the mesh receives (transfer.h). Levels of the mesh use the first so many records, and
 * the deltas that belong to their delta texels. ---- */

#define NOH_TRANSFER_ON_NORMAL 1u /* lobes lie about the normals, records have no axis */

/* Record of a vertex:
 *   occlusion  unorm 8: the share of a white matte surface's light that reaches it in the bind pose; with `bounce` also
 *              by one reflection
 *   shape      snorm 8 x (order - 1): for bands 1 and up the mean of the Legendre polynomial P_l of the angle to the
 *              lobe's axis
 *   axis       snorm 8 x 2, octahedral, model space; absent with ON_NORMAL
 * No byte of shape, axis or delta is -128. */
#define NOH_TRANSFER_RECORD_BYTES(order, flags) ((order) + ((flags)&NOH_TRANSFER_ON_NORMAL ? 0u : 2u))

typedef struct noh_transfer_header {
    uint32_t mesh;                                    /* the n-th mesh chunk */
    uint32_t order;                                   /* 4 or 6 */
    uint32_t flags;                                   /* NOH_TRANSFER_* */
    uint32_t vertex_count, texel_count, target_count; /* the mesh's, at the finest level that the pack has */
    uint32_t records_offset; /* uint8_t[vertex_count][NOH_TRANSFER_RECORD_BYTES(order, flags)] */
    uint32_t scales_offset;  /* float[target_count], not below 0 */
    uint32_t deltas_offset;  /* int8_t[texel_count], in the order of the delta texels: delta * scale is the difference
                              * of occlusion at weight 1 of the target */
    uint32_t ray_count;      /* for reports: directions that were tried for each vertex, over the whole sphere */
    uint32_t bounce;         /* 0..255: 255ths of its light that what stands in the way reflects; 0: light that was
                              * reflected is not in the records */
    uint32_t reserved[5];
} noh_transfer_header;

/* ---- CHUNK_INFLUENCES, none or one for a mesh, in the order of meshes: header, then four arrays. All joints of those
 * vertices that more than NOH_INFLUENCES_MAX move (skin_list.h); the mesh itself has the strongest of them. Levels
 * of the mesh use the first so many vertices of the list. ---- */

typedef struct noh_influences_header {
    uint32_t mesh;            /* the n-th mesh chunk, a skinned one */
    uint32_t vertex_count;    /* of the list; 0: stripped levels had them all */
    uint32_t influence_count; /* of all vertices of the list together */
    uint32_t most;            /* of one vertex, at most NOH_SKIN_LIST_MAX */
    uint32_t vertices_offset; /* uint32_t[vertex_count] of the mesh, ascending */
    uint32_t firsts_offset;   /* uint32_t[vertex_count + 1] from 0: where each one's influences begin; the last is
                               * influence_count */
    uint32_t weights_offset;  /* float[influence_count], above 0, at most 1; a vertex's sum to 1 within 2^-16 */
    uint32_t joints_offset;   /* uint16_t[influence_count] of the skin's joints */
    uint32_t reserved[8];
} noh_influences_header;

/* ---- CHUNK_WRINKLES, none or one for a mesh, in the order of meshes: header, then the matrix. How much each target
 * wrinkles each of twelve regions (wrinkles.h), which the wrinkle_weights of a material show. ---- */

#define NOH_WRINKLE_REGIONS 12u

typedef struct noh_wrinkles_header {
    uint32_t mesh;          /* the n-th mesh chunk */
    uint32_t target_count;  /* the mesh's */
    uint32_t matrix_offset; /* uint8_t[target_count][NOH_WRINKLE_REGIONS], 255: all at weight 1 */
    uint32_t reserved[5];
} noh_wrinkles_header;

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
    float world[12];       /* 3 rows of 4: world position = rows * (x, y, z, 1). The identity in the node of a skinned
                            * mesh: its joints place it, and their model space is the world */
    uint32_t first_weight; /* this node's default weights, or NOH_NONE: it has the mesh's */
    uint32_t flags;
} noh_node;

/* ---- CHUNK_MATERIALS: noh_material[]. ---- */

#define NOH_MATERIAL_BLEND 1u
#define NOH_MATERIAL_MASK 2u
#define NOH_MATERIAL_DOUBLE_SIDED 4u
#define NOH_MATERIAL_UNLIT 8u
#define NOH_MATERIAL_UNTINTED 16u /* an instance's tint leaves its colour alone; the tint's alpha counts as ever */
/* wrinkle_weights[0] is a mask of codes, NOH_TEXTURE_RGBA8 and `nearest`, and the others are NOH_NONE: of a byte of
 * channel c, byte / 90 is k of region 3 * c + k; the remainder times 0.014, at most 1, its weight, and 0 above 75 */
#define NOH_MATERIAL_WRINKLE_CODES 32u
/* One of them where there is a specular_texture: what its alpha is */
#define NOH_MATERIAL_SPECULAR_WEIGHT 64u     /* times f0, and times what is reflected at grazing angles */
#define NOH_MATERIAL_SPECULAR_ROUGHNESS 128u /* times roughness */

/* What the surface is made of: decides how it is lit. noh_material.surface_values and surface_more then are, of
 *   skin   x millimetres in a unit of the world, by which light scatters; 0: 1000. Then the inside of a mouth, in the
 *          bind pose, in mesh space: yzw its middle, at the foremost teeth; half its width and its height, and 1 over
 *          the depth in which no light comes. Zeros: there is none
 *   eye    xyz where it looks in the bind pose, in mesh space, as long as the radius of the iris; w the sine of the
 *          angle, about the middle of the ball, from there to the rim of the iris. Then the edges of the upper and of
 *          the lower lid, in front of the ball, in its radii: where a is how far from the nose's side a point is to
 *          where the eye looks, they are at the height x + y a + z a^2. Zeros: not known
 *   teeth  what is open to the light, from 0 to 1: the place in the bind pose times xyz, plus w; zeros: not known.
 *          Then x: how much of that is added for each unit that the place has moved; zeros
 *   toon   xyz its colour in shade over that in light; w, from -1 to 1, how far light reaches over the edge. Then x, from
 *          0 to 1: how hard that edge is; zeros
 * In a plain one they are zeros. */
#define NOH_SURFACE_PLAIN 0u
#define NOH_SURFACE_SKIN 1u
#define NOH_SURFACE_EYE 2u
#define NOH_SURFACE_TEETH 3u /* and gums and tongue: what light reaches through the lips only */
#define NOH_SURFACE_TOON 4u  /* two tones and the edge between them, no gloss */

/* What shows a wrinkle map: the surface's change of area in the pose; twelve regions, weighted by the expression; the
 * first weight map's red always, its green and blue as regions 3 and 6. */
#define NOH_WRINKLE_BY_AREA 1u
#define NOH_WRINKLE_BY_REGION 2u
#define NOH_WRINKLE_BY_CHANNEL 4u

/* Textures are indices of texture chunks, or NOH_NONE; those of colours are sRGB, the others LINEAR. Texture
 * coordinates are those of the mesh: a transform that the source had is in them. */
typedef struct noh_material {
    uint32_t name, name_hash;
    uint32_t flags;
    uint32_t base_color_texture; /* rgb colour, a alpha */
    float base_color[4];         /* linear */
    float metallic, roughness, alpha_cutoff;
    float normal_scale;          /* of the normal map's x and y */
    float occlusion_strength;    /* 0..1: how much of the map's occlusion counts */
    float emissive[3];           /* linear, may be above 1 */
    float f0[3];                 /* reflectance of what is no metal, seen straight on; 0.04 is usual. Above 1 only where
                                  * maps lessen it: what comes out is at most the reflectance at grazing angles */
    uint32_t normal_texture;     /* tangent space, +y up: rgb = 0.5 + 0.5 * xyz. In a mesh with tangents */
    uint32_t surface_texture;    /* r occlusion, g times roughness, b times metallic, a times f0 and what is reflected
                                  * at grazing angles */
    uint32_t emissive_texture;   /* rgb colour, times `emissive` */
    uint32_t wrinkle_texture;    /* a second normal map, that of wrinkles */
    uint32_t wrinkle_weights[3]; /* rgba of the three: how much each of twelve regions covers a texel, read at vertices;
                                  * or a mask that is read at pixels: NOH_MATERIAL_WRINKLE_CODES */
    uint32_t surface;            /* NOH_SURFACE_* */
    float surface_values[4];     /* of that surface, above */
    uint16_t wrinkle_models;     /* NOH_WRINKLE_BY_*: what shows the wrinkle map, the largest of them; 0 without one */
    int16_t priority;            /* where it blends: drawn after lower ones of the same figure; -128..127 */
    float surface_more[6];       /* of that surface, above */
    uint32_t specular_texture;   /* with NOH_MATERIAL_SPECULAR_*: rgb colour, times f0; a as that flag says. Else 0 */
    float f90_loss;              /* 0..1: what is no metal reflects 1 less this at grazing angles */
} noh_material;

/* ---- CHUNK_TEXTURE: header, then the mip levels one behind the other, top row first. A level's sides are half of
 * those before it, rounded down, at least 1. ---- */

#define NOH_WRAP_REPEAT 0u
#define NOH_WRAP_CLAMP 1u
#define NOH_WRAP_MIRROR 2u

#define NOH_TEXTURE_LINEAR 1u /* the bytes are data; else sRGB with straight alpha */

/* What a level's bytes are: texels, or blocks of 4 x 4 texels, which cover the level from its top left corner and may
 * reach over its edges (OpenGL ES 3.0, appendix C). Packs from before there were blocks have zeros here. */
#define NOH_TEXTURE_RGBA8 0u     /* uint8_t[height][width][4] */
#define NOH_TEXTURE_ETC2_RGB 1u  /* 8 bytes a block; alpha is 1 */
#define NOH_TEXTURE_ETC2_RGBA 2u /* 16 bytes a block: alpha as EAC, then RGB */
#define NOH_TEXTURE_EAC_RG \
    3u /* 16 bytes a block, 11 bits a channel: x and y of a normal map, z is what they leave \
        * of 1. LINEAR, without `nearest` */
#define NOH_TEXTURE_ETC2_RGBA1 \
    4u /* 8 bytes a block: alpha is 0 or 1, and colours are 0 where it is 0: those that are filtered are over their \
        * alpha what they would be without such texels */

typedef struct noh_texture_header {
    uint32_t width, height;
    uint32_t wrap_s, wrap_t; /* NOH_WRAP_* */
    uint32_t nearest;        /* 1: no filtering */
    uint32_t pixels_offset;
    uint32_t level_count; /* mip levels: all, down to 1 x 1; with `nearest` 1 */
    uint32_t flags;       /* NOH_TEXTURE_LINEAR, or 0 */
    uint32_t format;      /* NOH_TEXTURE_RGBA8... */
    float error;          /* for reports: mean square of how far bytes of the first level are from those that the
                           * converter had, over the channels that count; 0: not at all */
    uint32_t trim;        /* which columns and rows the converter took out since no triangle reads them, as a hash: only
                            * textures of the same fit the same texture coordinates. 0: none */
    uint16_t whole_width, whole_height; /* the sides before that; 0 where trim is 0 */
} noh_texture_header;

/* ---- CHUNK_SKELETON: header, then four arrays. Joints are in an order in which each LOD level is a prefix: those
 * without a parent first, then by falling distance to the farthest joint below them in the bind pose. ---- */

#define NOH_PACK_JOINT_ROOT 0xffffu /* parent of a joint that has none */

typedef struct noh_skeleton_header {
    uint32_t joint_count;
    uint32_t hash;           /* of names and parents: joins the clips of one pack to the meshes of another */
    float unit_cm;           /* centimetres per unit of the translations */
    uint32_t parents_offset; /* uint16_t[joint_count], parents first, or NOH_PACK_JOINT_ROOT */
    uint32_t bind_offset;    /* float[joint_count][10]: rotation xyzw, translation, scale; local */
    uint32_t names_offset;   /* uint32_t[joint_count] */
    uint32_t level_count;    /* 1..NOH_LOD_LEVELS_MAX */
    uint32_t levels_offset;  /* uint32_t[level_count]: so many joints, the first ones, are posed. The first is
                              * joint_count, then falling; every level has all joints without a parent */
} noh_skeleton_header;

/* ---- CHUNK_SKIN: header, then two arrays. ---- */

/* A skin may hold a joint of the skeleton several times, with different inverse bind matrices. */
typedef struct noh_skin_header {
    uint32_t joint_count;
    uint32_t skeleton;      /* the n-th skeleton chunk */
    uint32_t joints_offset; /* uint16_t[joint_count], joints of that skeleton */
    /* float[joint_count][12], rows as in noh_node.world: from mesh space to joint space */
    uint32_t inverse_bind_offset;
} noh_skin_header;

/* ---- CHUNK_CLIP: header, callback keys and sync markers in time order, the errors of coarser skeletons, then the
 * compressed clip (clip_format.h): joints of a skeleton, morph weights of nodes, named floats. Errors are in the
 * skeleton's unit; in a clip without joints in metres. ---- */

#define NOH_CLIP_UPDATE_RATES 4u /* every frame, 30, 15 and 8 Hz: noh_update_rate of lod.h */

typedef struct noh_clip_header {
    uint32_t skeleton_hash; /* 0 without joints */
    uint32_t skeleton;      /* of this pack: the one that the clip was built with; NOH_NONE without joints */
    uint32_t joint_count;   /* 0: animates floats only */
    uint32_t raw_bytes;     /* 40 per joint and frame, 4 per float: what it would be uncompressed */
    uint32_t event_count;
    uint32_t events_offset; /* noh_clip_event[event_count] */
    uint32_t marker_count;
    uint32_t markers_offset;      /* noh_clip_marker[marker_count] */
    uint32_t joint_error_count;   /* LOD levels of its skeleton; 0 without joints */
    uint32_t joint_errors_offset; /* float[joint_error_count]: the farthest that a point is off when only the joints of
                                   * a level are sampled and the others follow their parents; 0 for level 0, and never
                                   * less than for the level before */
    uint32_t clip_bytes;
    uint32_t clip_offset;
    /* The farthest that a point is off when the clip is posed at an update rate and blended in between; 0 for the
     * first, and never less than for the rate before. A loop counts as going on from where it ended, as with root
     * motion: its leap back to the start is no error. */
    float update_rate_error[NOH_CLIP_UPDATE_RATES];
    /* 0: the errors hold for the meshes that the clip was built with. joint_errors are bounds for everything that is as
     * near to a joint as the farthest vertex that it moves with a weight of 0.05 or more (noh_joint_lod_measure).
     * update_rate_error is exact for some hundred vertices, the farthest of each joint among them, and no bound on what
     * lies between these (noh_time_lod_points_measure).
     * Above 0: there were no meshes, and both are bounds for points at this distance from each joint (--shell-cm), in
     * the skeleton's unit (noh_joint_lod_measure, noh_time_lod_measure). */
    float error_shell;
    /* The root joint in the source's first and last frame: rotation x, y, z, w, then translation. The compressed clip
     * is off by up to its bound, which root motion would add up, pass by pass. 0 without joints. */
    float root_ends[2][7];
} noh_clip_header;

typedef struct noh_clip_event {
    uint32_t tick; /* 1/48,000 s */
    uint32_t name, name_hash;
    uint8_t payload[8];
    float weight_min; /* below it the key does not fire */
} noh_clip_event;

/* A moment that clips which keep step have in common: a foot touches the ground (sync_internal.h). */
typedef struct noh_clip_marker {
    uint32_t tick;            /* increasing */
    uint32_t name, name_hash; /* the hash is its id */
} noh_clip_marker;

/* ---- CHUNK_RECIPE, none or one: header, rows. How a face shows what it shows (recipe.h): targets of its meshes
 * by name, and what each is for. ---- */

typedef struct noh_recipe_header {
    uint32_t row_count, rows_offset;
    uint32_t reserved[2];
} noh_recipe_header;

typedef struct noh_recipe_row {
    uint32_t target, target_hash;
    /* a name, as noh_face_channel_name has it; or '+' and the name of a target that drives a corrective
     * (corrective.h): rows of one corrective follow each other; or a rule for the target's weight
     * (weight_rule.h): `range-min` and in the next row `range-max`; '-' and its opposite's name; '=' and the name
     * of the first target of its group */
    uint32_t channel, channel_hash;
    float weight; /* -4..4; of a corrective's driver its peak, above 0, at most 1; of a range's row its end */
    uint32_t reserved[3];
} noh_recipe_row;

/* ---- CHUNK_RAGDOLL, none or one: header, rows. The bodies of a ragdoll, by the joints that they begin at, and what
 * these can do: as noh_ragdoll_row has it (ragdoll_rig.h), in any order, each joint once. Programs from before
 * there was such a chunk refuse a pack that has one, as of an unknown type. ---- */

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
    float friction;           /* N m in a body of 70 kg, 0..10,000 */
    uint32_t reserved[3];
} noh_pack_ragdoll_row;

/* ---- CHUNK_SPRINGS, none or one for a skeleton, in the order of skeletons: header, then three arrays. Chains of its
 * joints that swing (springs.h), and capsules that they stay out of. ---- */

/* A joint that swings. */
typedef struct noh_spring_row {
    uint32_t joint;
    float stiffness;  /* metres per second by which its rest direction pulls, 0..; VRM's, usually 0..4 */
    float drag;       /* share of its speed that it loses in 1/60 s, 0..1 */
    float radius;     /* of its end against colliders, metres, 0.. */
    float gravity[3]; /* metres per second by which gravity pulls, world */
} noh_spring_row;

/* Rows whose joints each are a child of the one before; the first has a parent. */
typedef struct noh_spring_chain {
    uint32_t first_row, row_count; /* 1..NOH_SPRING_JOINTS_MAX; the rows of the chain before end at the first */
    uint32_t collides;             /* bit i: with collider i */
    float end[3];                  /* where the last joint's bone ends, in its space, in the skeleton's unit */
} noh_spring_chain;

/* A capsule that goes along with a joint; a sphere where `from` and `to` are equal. */
typedef struct noh_spring_capsule {
    uint32_t joint;
    float from[3], to[3]; /* in the joint's space, in the skeleton's unit */
    float radius;         /* metres, 0.. */
} noh_spring_capsule;

typedef struct noh_springs_header {
    uint32_t skeleton;                         /* the n-th skeleton chunk */
    uint32_t joint_count;                      /* that skeleton's */
    uint32_t row_count, rows_offset;           /* noh_spring_row[row_count], each joint in one at most */
    uint32_t chain_count, chains_offset;       /* noh_spring_chain[chain_count] they come in this order: one that hangs
                                                * on another behind it */
    uint32_t collider_count, colliders_offset; /* noh_spring_capsule[collider_count] */
    uint32_t reserved[4];
} noh_springs_header;

/* ---- CHUNK_HAIR, none or one: header, points, patches, spheres. A haircut as haircut.h draws and moves it. Head
 * space is that of the model in its bind pose, in metres, carried by the joint. Programs from before
 * there was such a chunk refuse a pack that has one, as of an unknown type. ---- */

typedef struct noh_pack_hair_header {
    uint32_t joint, joint_hash;       /* that carries it; "": the actor itself */
    uint32_t hair_count, point_count; /* control hairs, points of each: limits of hair.h */
    uint32_t patch_count;             /* 1..NOH_HAIR_PATCHES_MAX */
    uint32_t sphere_count;            /* 0..NOH_HAIR_SPHERES_MAX */
    uint32_t strip_count;             /* in full detail, 1..NOH_HAIR_STRIPS_MAX */
    uint32_t segment_count;           /* of a strip, 1..NOH_HAIR_SEGMENTS_MAX */
    uint32_t points_offset;           /* float[hair_count][point_count][3] at rest, from roots to tips */
    uint32_t patches_offset;          /* uint32_t[patch_count][4]: control hairs at the corners 00, 10, 01, 11 */
    uint32_t spheres_offset;          /* float[sphere_count][4]: centre, radius */
    uint32_t seed;                    /* of gusts */
    float metres;                     /* of one unit of the model, above 0 */
    float pull, pull_at_tip;          /* as in noh_hair_desc, as are the next two */
    float damping, gravity;
    float width_root, width_tip;       /* of a strip, above 0 */
    float curl_radius;                 /* at the tip, 0.. */
    float curl_turns;                  /* from root to tip */
    float scatter;                     /* how far a strip strays from where its patch has it, at the tip, 0.. */
    float middle[3];                   /* of the skull: hair faces away from it */
    float color_root[3], color_tip[3]; /* linear, 0..1 */
    float gloss;                       /* 0..4: 1 is hair that is combed and dry */
} noh_pack_hair_header;

/* ---- CHUNK_TERRAIN, none or one: header, heights. A height field of world.h, which noh_terrain_of (terrain.h)
 * gives where it lies: 257 x 257 heights take 132,146 bytes. Programs from before there was such a chunk refuse a pack
 * that has one, as of an unknown type. ---- */

typedef struct noh_pack_terrain_header {
    uint32_t width, depth;   /* 2..NOH_TERRAIN_SIZE_MAX */
    float origin[3];         /* of heights[0][0] at 0, metres */
    float spacing;           /* metres between heights, above 0 */
    float scale;             /* metres of one unit of a height, 0.. */
    uint32_t heights_offset; /* uint16_t[depth][width], rows along +X, one after the other along +Z */
    uint32_t reserved[4];
} noh_pack_terrain_header;
NOH_STATIC_ASSERT(sizeof(noh_pack_terrain_header) == 48, pack_terrain_header);

/* ---- CHUNK_GRAPH, none or several: header, then ten arrays. An animation graph as graph.h has it, whose nodes,
 * parameters, clips and joints have names: it is checked, and bound to clips and a skeleton, when it is opened
 * (graph_pack.h). Kinds, conditions, curves, loops and flags are the numbers of graph.h, changes.h and
 * time.h. ---- */

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
    uint32_t child_count, children_offset;         /* uint16_t[], indices of nodes: one less than nodes */
    uint32_t clip_count, clips_offset;             /* noh_pack_graph_clip[] */
    uint32_t transition_count, transitions_offset; /* noh_pack_graph_transition[] */
    uint32_t point_count, points_offset;           /* float[], of blend spaces: SPACE_1D thresholds, SPACE_2D x and y */
    uint32_t space_count, spaces_offset;           /* noh_pack_graph_space[] */
    uint32_t triangle_count, triangles_offset;     /* uint8_t[][3], indices of a space's points, counter-clockwise */
    uint32_t param_count, params_offset;           /* noh_pack_graph_param[] */
    uint32_t mask_count, masks_offset;             /* noh_pack_graph_mask[] */
    uint32_t name_count, names_offset; /* noh_pack_graph_name[]: values of ENUM parameters, joints of masks, clips */
    uint32_t machine_count;            /* MACHINE, SELECT and ONE_SHOT nodes */
    uint32_t reserved[3];
} noh_pack_graph_header;

/* Fields that a kind does not have are 0; params that it does not have, NOH_PACK_GRAPH_NONE. */
typedef struct noh_pack_graph_node {
    uint32_t name, name_hash;
    uint16_t kind; /* NOH_PACK_NODE_* */
    uint16_t first_child, child_count;
    uint16_t param, param_y;
    /* SPACE_1D: points, one per child; SPACE_2D: its space, 1; MACHINE: its transitions; ADD: none, or the name of the
     * clip that it adds relative to, 1 */
    uint16_t first_item, item_count;
    uint16_t mask;  /* MASK, ONE_SHOT: 1 + index; ONE_SHOT also 0 */
    uint16_t index; /* CLIP: its number among the clips; MACHINE, SELECT, ONE_SHOT: among these. In stored order */
    uint8_t curve, flags;
    float value;
    uint32_t fade_ticks, fade_out_ticks;
} noh_pack_graph_node;

typedef struct noh_pack_graph_clip {
    uint32_t name, name_hash; /* of a clip of the set that the graph is bound to */
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
    uint16_t first_point; /* in points: two floats for each child of its node */
    uint16_t point_count;
    uint16_t first_triangle, triangle_count;
} noh_pack_graph_space;

#define NOH_PARAM_NUMBER 0u
#define NOH_PARAM_INTEGER 1u
#define NOH_PARAM_ENUM 2u    /* minimum 0, maximum the number of its values less 1 */
#define NOH_PARAM_TRIGGER 3u /* 0..1, 0 at first */

typedef struct noh_pack_graph_param {
    uint32_t name, name_hash;
    float minimum, maximum, initial;
    uint16_t kind;                     /* NOH_PARAM_* */
    uint16_t first_value, value_count; /* ENUM: its values, in names */
    uint16_t reserved;
} noh_pack_graph_param;

/* All joints 0, then its entries in order; floats (morph weights, named floats) all alike. */
typedef struct noh_pack_graph_mask {
    uint32_t name, name_hash;
    uint16_t first_joint, joint_count; /* in names */
    uint8_t floats;                    /* 255: full weight */
    uint8_t reserved[3];
} noh_pack_graph_mask;

typedef struct noh_pack_graph_name {
    uint32_t name, name_hash;
    uint8_t weight;  /* of a joint, 255: full */
    uint8_t subtree; /* 1: and all joints below it */
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
