/* limits.h: the numbers that bound everything. A pack over a limit is refused
 * when it is built, with the limit in the message, and again when it is opened. */
#ifndef NOH_BASE_LIMITS_H
#define NOH_BASE_LIMITS_H

#define NOH_NONE 0xffffffffu              /* an index that is none */

#define NOH_PACK_ALIGN 64u               /* chunks start at multiples of this, and so must a pack in memory (16 is enough) */
#define NOH_PACK_CHUNKS_MAX 4096u
#define NOH_PACK_BYTES_MAX 0x7fffffffu
#define NOH_VERTICES_MAX (1u << 22)      /* per mesh: a 2048 x 2048 texture, which every ES 3.0 has */
#define NOH_INDICES_MAX (1u << 26)
#define NOH_SUBMESHES_MAX 256u
#define NOH_LEVELS_MAX 8u                /* of detail, per mesh */
#define NOH_TARGETS_MAX 1024u            /* per mesh: the gather list keeps 10 bits for a target */
#define NOH_TEXELS_MAX (1u << 22)        /* delta texels of one mesh: the gather list keeps 22 bits */
#define NOH_MORPH_WIDTH_LOG2_MIN 2u
#define NOH_MORPH_WIDTH_LOG2_MAX 11u     /* ES 3.0 guarantees textures of 2048 */
#define NOH_MORPH_HEIGHT_MAX 2048u
#define NOH_NODES_MAX 65535u
#define NOH_MATERIALS_MAX 4096u
#define NOH_TEXTURE_SIZE_MAX 2048u       /* wider or taller images are shrunk by the converter */
#define NOH_JOINTS_MAX 4096u
#define NOH_SKIN_JOINTS_MAX 4096u
#define NOH_JOINT_LEVELS_MAX 8u          /* of a skeleton: levels of detail */
#define NOH_PALETTE_JOINTS_MAX 256u      /* a uniform block of 12 KiB; ES 3.0 guarantees 16. Vertices keep 8 bits for a place */
#define NOH_MOTION_EVENTS_MAX 65536u      /* of one clip in a pack */
#define NOH_MOTION_MARKERS_MAX 4096u
#define NOH_MOTIONS_MAX 65535u           /* clips of one set */
#define NOH_FLOATS_MAX 4096u             /* of one set: morph weights of all nodes, and named floats */
#define NOH_MASKS_MAX 255u               /* of one set */
#define NOH_CLIP_CACHE_CLIPS_MAX 4096u
#define NOH_CLIP_CACHE_SLOTS_MIN 2u      /* a sample between two segments needs both */
#define NOH_CLIP_CACHE_SLOTS_MAX 32768u
#define NOH_NAME_BYTES_MAX 256u          /* with the final zero */
#define NOH_MORPH_INSTANCES_MAX 65536u

/* Bounds that a format or a number's width sets stand where it is described: those of a compressed clip
 * (NOH_CLIP_*_MAX) in clip_format.h, those of time (NOH_DURATION_MAX, NOH_SPEED_MAX, NOH_POSITION_MAX) in time.h. */

/* No call of the library uses more stack than this; a check on the compiler's own figures says so. */
#define NOH_STACK_BYTES 8192u

#endif
