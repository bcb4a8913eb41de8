/* deform.h: morph targets, skins, bounds and picking on the CPU: the reference for the GPU, and the way without one. */

#ifndef NOH_DEFORM_H
#define NOH_DEFORM_H

#include <stdint.h>

#include "base.h"
#include "format.h"
#include "pack.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ======== morph targets ========
 * Morph targets accumulated on the CPU: the reference for every GPU path, the fallback without one, and the
 * surface used for picking.
 *
 * Only differences are accumulated, in three layers (position, normal, tangent), one accumulation texel for each vertex
 * that any target moves. For each target, in index order, and each of its delta texels:
 *   layer += weight * delta
 * with one product and one sum per value, never fused. noh_morph_accumulate uses the instructions that the library was
 * compiled for (AVX2, SSE2, NEON, else scalar); with gcc and clang on x86 the processor is queried for AVX2. All give
 * the scalar bits.
 *
 * source  Microsoft, SparseMorphTargets (DirectX SDK): additive blending of sparse rectangles into three render
 *         targets. There the accumulator starts as the mesh; here it starts at 0, so that half floats round the small
 *         differences and not the coordinates. The outer loop over targets, the inner one over moved vertices:
 *         Granberg, Character Animation with Direct3D, 2009, chapter 8 (whose listing indexes the weights by vertex)
 *
 * Threads: no state; any thread, each with its own layers. */

#define NOH_MORPH_GROUP 16u /* size of an aligned group of consecutive accumulation texels */

/* Accumulated differences of one instance, in model units. The layers are adjacent in memory, each [morph_height <<
 * morph_width_log2][3]. */
typedef struct noh_morph_layers {
    float *position, *normal;
    float *tangent; /* NULL: two layers; tangents are not morphed, but the bind pose's still turn with the normal */
} noh_morph_layers;

/* Exact size of three layers of a mesh in bytes; 0 for a mesh that no target moves. Two layers take two thirds of
 * it. */
size_t noh_morph_layers_size(const noh_mesh *mesh);

/* Place three layers in memory[bytes], aligned to NOH_MEMORY_ALIGN, and clear them. For a mesh without accumulation
 * texels memory may be NULL.
 * errors  ARG memory NULL or misaligned; MEMORY too small (need: the bytes) */
noh_result noh_morph_layers_init(void *memory, size_t bytes, const noh_mesh *mesh, noh_morph_layers *layers,
                                 noh_error *error);

/* Accumulate all targets whose weight is not zero into cleared layers.
 * shapes  weights[target_count]
 * ranges  any finite value; below 0 and above 1 extrapolate */
void noh_morph_accumulate(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers);

/* The inner loops for one instruction set. All give the same bits. */
typedef struct noh_morph_kernel {
    const char *name; /* "avx2", "sse2", "neon" or "scalar" */
    void (*accumulate)(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers);
    /* Accumulate only groups of NOH_MORPH_GROUP texels with groups[] not 0; texels of other groups become undefined,
     * but are never read */
    void (*accumulate_some)(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers,
                            const uint8_t *groups);
    /* noh_morph_finish */
    void (*finish)(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t first, uint32_t count, void *out);
} noh_morph_kernel;

/* Compute a vertex as drawn: position, normal, tangent and texture coordinates of the bind pose plus their differences.
 * The normal is normalised; the tangent is made orthogonal to it and normalised, and keeps its handedness. A direction
 * that vanishes becomes the bind pose's.
 * ranges  index below vertex_count */
void noh_morph_vertex(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t index, noh_vertex *out);

/* Add the targets' change of a vertex's texture coordinates to uv[2], the coordinates of the bind pose.
 * noh_morph_vertex includes this. Does nothing for a mesh without NOH_MESH_UV_TARGETS.
 * ranges  index below vertex_count */
void noh_morph_uv(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t index, float uv[2]);

/* ======== finished vertices ========
 * Final vertices in the formats of a pack's attributes, for a vertex buffer that replaces the mesh's
 * own, so that no shader adds anything.
 *
 *   noh_morph_finished_stride   bytes of a vertex
 *   noh_morph_finish            vertices from accumulated layers
 *
 * A finished vertex has its position as three floats, with the bits of noh_morph_vertex; its normal as an octahedral
 * pair of 16-bit integers; and, if the mesh has tangents, its tangent as such a pair with the handedness in the lowest
 * bit, like the mesh's own attributes. Each pair is the nearest one to the direction: a decoded normal is within
 * NOH_FINISHED_NORMAL_ERROR of noh_morph_vertex's, a tangent within NOH_FINISHED_TANGENT_ERROR. Every processor gives
 * the scalar bits. Texture coordinates stay in the mesh's own buffer; for targets that change them
 * (NOH_MESH_UV_TARGETS) use noh_morph_uv.
 *
 * source  the octahedron: Meyer, Suessmuth, Sussner, Stamminger, Greiner: On floating-point normal vectors, 2010;
 *         errors of its pairs: Cigolle et al., A Survey of Efficient Representations for Independent Unit Vectors, 2014
 *
 * Threads: no state; any thread. */

/* Radians. Half a step of 1 / 32767 along both axes is up to 6.5e-5 where the octahedron is nearest to its centre; the
 * second number of a tangent has steps twice as large. */
#define NOH_FINISHED_NORMAL_ERROR 6.6e-5f
#define NOH_FINISHED_TANGENT_ERROR 1.1e-4f

/* Get the bytes of a finished vertex: 20 with tangents, else 16. */
uint32_t noh_morph_finished_stride(const noh_mesh *mesh);

/* Finish the vertices first to first + count - 1. Writes in order and never reads `out`, which may be mapped GPU
 * memory.
 * layers  accumulated; without a tangent layer the bind pose's tangents turn with the normal. NULL: the bind pose
 * shapes  out[count][noh_morph_finished_stride(mesh)], aligned to 4
 * ranges  first + count at most vertex_count */
void noh_morph_finish(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t first, uint32_t count, void *out);

/* ======== bounds ========
 * The bounding box of a deformed mesh, computed without reading its vertices.
 *
 * The pack holds for each joint the box of the bind positions that it moves, and for each target the box of its
 * differences. A vertex moved by several joints lies in the hull of the positions that each joint alone would give it.
 * So the union of the joints' boxes, grown by the weighted boxes of the targets and moved by the joints, contains every
 * vertex. A small margin covers rounding in the vertices' arithmetic.
 *
 * Dual quaternions leave that hull: joints that turn against each other put a vertex on an arc. Its points are at most
 * 0.62 times as far from the hull as the joints put the vertex apart (Jung's theorem, for turns of up to 180 degrees
 * about one centre); the largest such distance is found over all pairs of joints whose boxes overlap. If joints also
 * move or stretch against each other, the bound is tested, not proven.
 *
 * A box is 6 floats: minimum x, y, z, then maximum x, y, z. Boxes of skinned meshes are in model space.
 *
 * Threads: no state; any thread. */

/* Compute the box of a rigid mesh.
 * shapes  world[12], NULL: mesh space; weights[target_count], NULL: no morph targets */
void noh_mesh_box(const noh_mesh *mesh, const float *world, const float *weights, float box[6]);

/* Compute the box of a skinned mesh.
 * shapes  matrices[skin's joint_count][12] (noh_skin_matrices); weights as above */
void noh_skin_box(const noh_mesh *mesh, const float *matrices, const float *weights, float box[6]);

/* Increase joint radii to contain a mesh: each becomes at least the distance of the farthest corner of the joint's box
 * (noh_mesh.joint_boxes), extended by the targets' boxes, in the joint's space. Start with -1 for every joint and add
 * each drawn mesh. A rigid mesh adds nothing. The radii hold for linear blend skinning; dual quaternions may exceed
 * them slightly.
 * shapes  weights[target_count]: the expected weight farthest from 0 of each target, all at once; NULL: 1 each;
 *         joint_radius_m[joint_count of the skin's skeleton]
 * units   the units of the joints' matrices */
void noh_mesh_add_joint_radii(const noh_mesh *mesh, const float *weights, float *joint_radius_m);

/* ======== skins by dual quaternions ========
 * Skinning that keeps volume where joints twist.
 *
 * Linear blending of matrices flattens the mesh between two joints that twist against each other ("candy wrapper");
 * blending rigid motions as dual quaternions does not.
 *
 * A joint's matrix M (position = A p + t) is split as A = R H, R a rotation and H symmetric (polar decomposition):
 * first the mesh is stretched, then it moves rigidly. r_i = R_i as a quaternion (x, y, z, w); d_i = 1/2 (t_i, 0) r_i
 * For a vertex with weights w_i, joint 0 the strongest:
 *   s_i  = +1, or -1 where dot(r_i, r_0) < 0        (r and -r are one rotation: take the shorter way)
 *   H    = w_0 H_0 + w_1 H_1 + ...                  (stretches are blended linearly)
 *   r    = w_0 s_0 r_0 + ...,  d = w_0 s_0 d_0 + ...
 *   r, d are divided by |r|
 *   t    = 2 (r_w d - d_w r + cross(r, d)), the vector parts except for _w   (d's component along r cancels)
 *   position = rotate(r, H p) + t
 *   normal   = unit(rotate(r, s C n)), C the cofactors of H, s the sign of its determinant
 *   tangent  = unit(rotate(r, H t)), its handedness times s
 *   rotate(r, v) = v + 2 cross(r, cross(r, v) + r_w v)
 * A single joint moves its vertices exactly as its matrix does, including scale and mirroring.
 *
 * source  Kavan, Collins, Zara, O'Sullivan: Geometric skinning with approximate dual quaternion blending, 2008,
 *         including the stretch in a first phase (section 4.2)
 *
 * Threads: no state; any thread. */

/* One joint: its rigid motion in 2 x 4 floats, and its stretch. */
typedef struct noh_dual_quaternion {
    float real[4]; /* xyzw, unit */
    float dual[4];
    float stretch[9]; /* [3][3] rows, symmetric */
} noh_dual_quaternion;

/* Split the matrices of all joints of a skin, once per instance and frame (noh_skin_matrices).
 * shapes  matrices[count][12], out[count] */
void noh_skin_dual_quaternions(const float *matrices, uint32_t count, noh_dual_quaternion *out);

/* Compute a vertex as drawn, in model space.
 * shapes  joints[skin's joint_count]; layers NULL: no morph targets
 * ranges  index below vertex_count, of a skinned mesh */
void noh_skin_vertex_dual(const noh_mesh *mesh, const noh_dual_quaternion *joints, const noh_morph_layers *layers,
                          uint32_t index, noh_vertex *out);

/* Skin a range of vertices; parameters as for noh_skin_vertices. */
void noh_skin_vertices_dual(const noh_mesh *mesh, const noh_dual_quaternion *joints, const noh_morph_layers *layers,
                            uint32_t first, uint32_t count, float *positions, float *normals, float *tangents);

/* ======== picking ========
 * Ray intersection with a mesh as it is drawn, morphed and posed.
 *
 * The mesh is not copied. Each joint's box is moved by its matrix; a triangle is tested only if the ray hits the boxes
 * of the joints near its corners, and only then are its corners morphed and skinned. Rigid meshes work too. Both sides
 * of a triangle count.
 *
 * The ray passes through invisible surfaces: where a material with an alpha cutoff has alpha below it, and where a
 * blended material's alpha, times the tint's, rounds to 0 of 255. Any visible blended surface is hit. Alpha is the
 * texture of the mesh's pack at its first mip level, filtered bilinearly, times the alpha of material and vertex
 * colour. An actor's texture set is ignored, and at a distance, where coarser mip levels are drawn, an edge may be off
 * by a pixel.
 *
 * source  Moller and Trumbore, Fast, minimum storage ray/triangle intersection, 1997; picking for decals: Granberg,
 *         Character Animation with Direct3D, 2009, chapters 3 and 14 (which clones the mesh and excludes rigid ones)
 *
 * Threads: no state; any thread, each with its own scratch. */

/* A mesh as it is drawn. */
typedef struct noh_pick_surface {
    const noh_mesh *mesh;
    const float *world;    /* [12] of a rigid mesh; NULL: mesh space */
    const float *matrices; /* [skin's joint_count][12]; required for a skinned mesh, unused for a rigid one */
    const noh_dual_quaternion *dual_quaternions; /* [skin's joint_count] if the mesh is drawn with them; else NULL */
    /* NULL: corners near the ray are morphed one by one with `weights`: slower, but needs no memory */
    const noh_morph_layers *layers;
    const float *weights; /* [target_count] the weights of the layers; NULL: no morph targets */
    const uint8_t *tint;  /* [4] the tint it is drawn with; only alpha is used; NULL: white */
} noh_pick_surface;

typedef struct noh_pick_hit {
    float distance;             /* in lengths of the ray's direction: 0..distance_max */
    uint32_t submesh, triangle; /* triangle: its first index / 3 */
    float barycentric[3];       /* weights of its corners; their sum is 1 */
    float point[3];             /* as drawn */
    float bind_point[3];        /* the same point in the bind pose, for a decal that stays on the skin */
    /* index into the skin's joints: the joint with the largest weight at the point; NOH_NONE for a rigid mesh */
    uint32_t joint;
} noh_pick_hit;

/* Exact size of the scratch for noh_pick in bytes: two boxes per joint; 0 for a rigid mesh. */
size_t noh_pick_scratch_size(const noh_mesh *mesh);

/* Find the nearest hit at origin + distance * direction, with distance 0..distance_max.
 * memory  scratch[noh_pick_scratch_size], aligned to NOH_MEMORY_ALIGN, NULL if that is 0; holds nothing between calls
 * errors  NOT_FOUND nothing is hit; ARG matrices NULL, a direction of length 0, or scratch NULL or misaligned; MEMORY
 *         scratch too small (need: the bytes). *hit is then unchanged */
noh_result noh_pick(const noh_pick_surface *surface, const float origin[3], const float direction[3],
                    float distance_max, void *scratch, size_t scratch_bytes, noh_pick_hit *hit, noh_error *error);

/* ======== skins ========
 * Skinned meshes on the CPU, after morph targets: the reference for the GPU, the fallback without one, and the
 * surface used for picking.
 *
 * For each vertex, with its joints' matrices M_i and weights w_i, which sum to 1:
 *   M = w_0 M_0 + w_1 M_1 + ... in this order, one product and one sum per element
 *   position = M (p, 1)
 *   normal   = unit(s C n), C the cofactors of M's 3 x 3 part, s the sign of its determinant
 *   tangent  = unit(M t), its handedness times s
 * s C is the inverse transpose times the absolute determinant: normals stay orthogonal to the surface under any scale,
 * and unlike the inverse, the cofactors exist where an axis has no length.
 *
 * Meshes with NOH_MESH_DUAL_QUATERNION use noh_skin_vertices_dual instead. The SIMD path is chosen when the library is
 * compiled; each gives the bits of noh_skin_vertex.
 *
 * source  Granberg, Character Animation with Direct3D, 2009, chapters 3 and 8 (whose shader moves normals by M itself);
 *         the implied last weight: Microsoft, Geometry Blending, DirectX 9.0 documentation
 *
 * Threads: no state; any thread. */

/* Compute the matrices for vertices of a skin's meshes: model[joint] * inverse bind, once per instance and frame.
 * shapes  model[the skeleton's joint_count][12] (noh_local_to_model), matrices[skin's joint_count][12] */
void noh_skin_matrices(const noh_skin *skin, const float *model, float *matrices);

/* Move the virtual joints of a mesh by its targets: after noh_skin_matrices, before the matrices are used. They stand for
 * the targets in the coarse levels of packs built with --lod-faces joints (noh_far_joints_header, format.h); such levels
 * have no accumulation texels. Does nothing for other levels and other meshes. Other entries are not read.
 *   M' = M (I + [w], b - cross(w, c)),  b and w the sums of weight * motion over the targets, in index order
 * shapes  weights[target_count]; matrices[skin's joint_count][12]
 * ranges  weights: any finite value
 * source  Le and Deng, Smooth Skinning Decomposition with Rigid Bones, 2012; here motions are linear, like targets */
void noh_mesh_move_far_joints(const noh_mesh *mesh, const float *weights, float *matrices);

/* Compute a vertex as drawn, in model space. layers NULL: no morph targets.
 * ranges  index below vertex_count, of a skinned mesh */
void noh_skin_vertex(const noh_mesh *mesh, const float *matrices, const noh_morph_layers *layers, uint32_t index,
                     noh_vertex *out);

/* Compute only the position of a vertex, with the same bits. */
void noh_skin_position(const noh_mesh *mesh, const float *matrices, const noh_morph_layers *layers, uint32_t index,
                       float out[3]);

/* Skin vertices first..first+count-1 of a skinned mesh, in model space.
 * shapes  matrices[skin's joint_count][12]; positions[count][3], normals[count][3] unit, tangents[count][4] unit and
 *         handedness, zeros if the mesh has none; each may be NULL: not wanted. layers NULL: no morph targets
 * ranges  first + count at most vertex_count */
void noh_skin_vertices(const noh_mesh *mesh, const float *matrices, const noh_morph_layers *layers, uint32_t first,
                       uint32_t count, float *positions, float *normals, float *tangents);

/* ======== vertices of many joints ========
 * Skinning on the CPU of vertices with any number of joints.
 *
 * Drawn meshes, and everything compared with them, use up to NOH_INFLUENCES_MAX joints per vertex: the strongest. If a
 * model has more and was built with `noh build --influences N`, N above that, its pack also lists all joints of those
 * vertices, up to NOH_SKIN_LIST_MAX each. Use the list for simulation, baking and pictures without a GPU: call
 * noh_skin_vertices first, then noh_skin_list_vertices, which overwrites the listed vertices. Dual quaternion meshes
 * have no list.
 *
 * source  Granberg, Character Animation with Direct3D, 2009, chapter 3: a mesh may have any number of influences when
 *         the CPU skins it
 *
 * Threads: no state; any thread. */

/* The list of one mesh and all its LOD levels; points into the pack. */
typedef struct noh_skin_list {
    const noh_influences_header *header;
    const uint32_t *vertices; /* [vertex_count] ascending */
    const uint32_t *firsts;   /* [vertex_count + 1] */
    const float *weights;     /* [influence_count] */
    const uint16_t *joints;   /* [influence_count] indices into the skin's joints */
} noh_skin_list;

/* Get the list of a mesh by index.
 * errors  NOT_FOUND no vertex of the mesh has more than NOH_INFLUENCES_MAX joints, or the pack was built without the
 *         list */
noh_result noh_pack_skin_list(const noh_pack *pack, uint32_t mesh, noh_skin_list *list, noh_error *error);

/* Get the number of listed vertices below `vertex`: its place in the list, if it is there. */
uint32_t noh_skin_list_place(const noh_skin_list *list, uint32_t vertex);

/* Overwrite the listed ones of vertices first..first+count-1, moved by all their joints; other vertices are not
 * changed. Arrays and ranges as for noh_skin_vertices.
 * returns  the number of vertices written */
uint32_t noh_skin_list_vertices(const noh_skin_list *list, const noh_mesh *mesh, const float *matrices,
                                const noh_morph_layers *layers, uint32_t first, uint32_t count, float *positions,
                                float *normals, float *tangents);

#ifdef __cplusplus
}
#endif

#endif
