/* low_core.h: memory, small mathematics, texels: for engines built of parts (noh_low.h). */

#ifndef NOH_LOW_CORE_H
#define NOH_LOW_CORE_H

#include <stddef.h>
#include <stdint.h>

#include "base.h"
#include "pack.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ======== memory ========
 * Allocation within one block of the caller's memory.
 *
 * An arena without a block only measures, so the same code carves an object and computes its size.
 *
 *   noh_arena_open      the block of an init, checked
 *   noh_arena_over      a block known to be valid
 *   noh_arena_measure   no block: count only
 *   noh_arena_carve     the next bytes
 *
 * Threads: an arena is for one thread at a time. */

/* Alignment of every init's block and of every pack; malloc provides it. Objects within a block are aligned to 16
 * bytes; with 32-bit pointers 8 are enough for the block, because vectors are loaded unaligned there (SSE2 needs
 * 16). */
#if UINTPTR_MAX == 0xffffffffu && !defined(__i386__) && !defined(_M_IX86)
#define NOH_MEMORY_ALIGN 8u
#else
#define NOH_MEMORY_ALIGN 16u
#endif

typedef struct noh_arena {
    uint8_t *base;
    size_t bytes; /* of the block */
    size_t used;  /* carved so far; may exceed `bytes`, carving then returns NULL */
} noh_arena;

/* Open the block of an init. Every init begins with this call, so all refuse the same memory.
 * ranges  need: the exact bytes that will be carved
 * errors  ARG memory is NULL or not aligned to NOH_MEMORY_ALIGN; MEMORY it is too small (where: its bytes). `need` is
 *         then the bytes needed, and the arena is untouched */
noh_result noh_arena_open(noh_arena *arena, void *memory, size_t bytes, size_t need, noh_error *error);

/* An arena over memory[bytes], which must be aligned to NOH_MEMORY_ALIGN. */
noh_arena noh_arena_over(void *memory, size_t bytes);

/* An arena that only measures. */
noh_arena noh_arena_measure(void);

/* Carve bytes at an alignment.
 * ranges   alignment is a power of two, at most 16
 * returns  NULL if the block is exhausted or the arena only measures; `used` still counts the bytes, and is SIZE_MAX
 *          once the sum does not fit a size_t */
void *noh_arena_carve(noh_arena *arena, size_t bytes, size_t alignment);

/* ======== hashes ========
 * FNV-1a for finding names, and CRC-32C for detecting damaged bytes.
 *
 * Threads: no state; any thread. */

/* Hash a zero-terminated name (FNV-1a, 32 bits). Different names can have equal hashes, so searches compare the names
 * too.
 * source  Fowler, Noll, Vo: draft-eastlake-fnv */
uint32_t noh_hash_name(const char *name);

/* Compute the CRC-32C (Castagnoli, reflected 0x82f63b78) of bytes, continued from `crc`; start with 0. It detects every
 * single flipped bit and every error burst of up to 32 bits.
 * source  RFC 3720, appendix B.4 */
uint32_t noh_crc32c(uint32_t crc, const void *bytes, size_t count);

/* ======== quaternions ========
 * Quaternions x, y, z, w; of unit length unless noted.
 *
 *   noh_quat_mul          first b, then a
 *   noh_quat_conjugate    the inverse of a unit quaternion
 *   noh_quat_dot
 *   noh_quat_normalize    to length 1; the identity for length 0
 *   noh_quat_rotate       a vector
 *   noh_quat_nlerp        between two rotations, along the shorter arc
 *   noh_quat_to_rotation  to axis times angle, 0 to pi
 *   noh_quat_from_rotation
 *
 * Threads: no state; any thread. */

/* out may be a or b. */
void noh_quat_mul(const float a[4], const float b[4], float out[4]);
void noh_quat_conjugate(const float q[4], float out[4]);
void noh_quat_normalize(float q[4]);

/* Rotate a vector. out may be v. q need not be exactly unit: the error is of second order. */
void noh_quat_rotate(const float q[4], const float v[3], float out[3]);

/* Interpolate linearly and normalise: the arc of slerp at a speed that varies slightly. b is negated if dot(a, b) is
 * negative, to take the shorter arc: q and -q are the same rotation.
 * ranges  t 0..1; out may be a or b
 * source  Granberg, Character Animation with Direct3D, 2009, chapter 4 (which omits the sign) */
void noh_quat_nlerp(const float a[4], const float b[4], float t, float out[4]);

/* Convert to and from a rotation vector: unit axis times angle, 0 to pi. */
void noh_quat_to_rotation(const float q[4], float rotation[3]);
void noh_quat_from_rotation(const float rotation[3], float q[4]);

static inline float noh_quat_dot(const float a[4], const float b[4])
{
    return (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3]);
}

/* ======== trigonometry ========
 * Trigonometry for sampling and simulation, without libm.
 *
 * Chebyshev fits of the reduced functions, from sums, products, quotients and square roots only: the same bits on every
 * machine. Errors compare the float result with the exact function of the float argument, measured by the tests over
 * the stated range.
 *
 * A turn is an angle as a uint32_t, 2^32 for the full circle. It wraps by itself and adds without rounding, so a
 * heading never drifts.
 * Threads: no state; any thread. */

#define NOH_PI 3.14159265358979f

/* Sine and cosine of a turn.
 * errors  at most 1.2e-7 absolute; exact at quarter turns; the sine near 0 at most 3e-7 relative */
void noh_sin_cos_turn(uint32_t turn, float *sine, float *cosine);

/* ======== packs ======== */

/* The bytes of a block of texels; 0: the format has no blocks. */
uint32_t noh_texture_block_bytes(uint32_t format);

/* ======== meshes ========
 * Meshes and skins of a pack, as pointers into the pack's bytes, and decoded vertices.
 *
 * Threads: views are read-only; any number of threads. */

/* Byte offset of an attribute in a vertex's record; -1: the mesh has none. */
int noh_mesh_tangent_offset(const noh_mesh *mesh);
int noh_mesh_uv_offset(const noh_mesh *mesh);
int noh_mesh_color_offset(const noh_mesh *mesh);

/* A vertex's accumulation texel (header->touched_count or more: none, no target moves the vertex), and its palette (0
 * unless the mesh is split into several). */
uint32_t noh_mesh_accumulation_texel(const noh_mesh *mesh, uint32_t vertex);
uint32_t noh_mesh_palette(const noh_mesh *mesh, uint32_t vertex);

/* Get an extra attribute of a vertex (noh build --attributes), for renderers without the library's shaders.
 * index    the place in that list, which mesh->extras describes (format.h)
 * value    components that the attribute does not have are 0
 * returns  its components: 1..4; 0: the mesh does not have it */
uint32_t noh_mesh_extra(const noh_mesh *mesh, uint32_t index, uint32_t vertex, float value[4]);

/* Get the joints and weights of a vertex of a skinned mesh.
 * shapes   joints[influence_count] indices into the skin's joints, weights[influence_count]
 * ranges  the weights sum to exactly 1 in float32; the first is the largest, except for rounding
 * returns  influence_count */
uint32_t noh_mesh_influences(const noh_mesh *mesh, uint32_t vertex, uint32_t joints[NOH_INFLUENCES_MAX],
                             float weights[NOH_INFLUENCES_MAX]);

/* ======== compressed textures ========
 * Decode the blocks of compressed textures exactly like a GPU.
 *
 *   noh_etc2_decode   a row of blocks to texels
 *   noh_eac_decode    one channel of a block
 *
 * For contexts without ETC2 (desktop GL below 4.3, WebGL 2 on most desktops), renderers on the CPU, and rays
 * (deform.h), which read alpha. A program that uses none of these does not link the decoders.
 *
 * Threads: no state; any thread. */

/* Decode a row of blocks.
 * shapes  blocks[count], of 8 or 16 bytes by the format; texels[4][4 * count][4]: RGBA8, exactly as OpenGL ES 3.0
 *         specifies. With NOH_TEXTURE_EAC_RG a texel is two halves instead of four bytes: red and green within 2^-12 of
 *         their 11 bits
 * ranges  format is NOH_TEXTURE_ETC2_RGB, _ETC2_RGBA, _ETC2_RGBA1 or _EAC_RG; any bytes are valid blocks
 * source  OpenGL ES 3.0.6, appendix C.1 */
void noh_etc2_decode(uint32_t format, const uint8_t *blocks, uint32_t count, uint8_t *texels);

/* Decode an 8-byte EAC block to values[4][4], rows top to bottom: 0..255, or 0..2047 with eleven. */
void noh_eac_decode(const uint8_t block[8], int eleven, uint16_t values[16]);

#ifdef __cplusplus
}
#endif

#endif
