/* wire.h: packs as they are sent: a few times smaller, unpacked while they arrive.
 *
 * `noh pack` makes the wire form (.nohz) of a pack. A noh_wire takes it in pieces of any size and builds the pack in a
 * block of the caller's. A pack with LOD levels comes as two: first a pack of the coarsest levels, with all clips,
 * materials and textures, then the whole one, for which only meshes are sent again. Each is checked by
 * noh_pack_open before it is handed out, so what noh_wire_pack returns is a pack like any other, and a stage can begin
 * with the coarse one and go on with the whole one as `finer` (stage.h).
 *
 * Memory: the state has the same size for every file, NOH_WIRE_STATE_BYTES. The block has the whole pack at its start,
 * behind it the coarse one, and behind that the room in which meshes are put together; when all has arrived only the
 * first noh_wire_info.pack_bytes are needed, if the coarse pack is no longer used.
 *
 * The same file gives the same bytes on every machine.
 *
 * Threads: a noh_wire belongs to one thread at a time. The packs that it has handed out are read-only, as any pack. */
#ifndef NOH_WIRE_WIRE_H
#define NOH_WIRE_WIRE_H

#include "core/pack/pack.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_WIRE_VERSION 2u         /* that is written; those from 1 on are read */
#define NOH_WIRE_HEAD_BYTES 64u     /* of a file: enough for noh_wire_info_read */
#define NOH_WIRE_STATE_BYTES 49152u /* no noh_wire is larger */

typedef struct noh_wire noh_wire;

/* What the first bytes of a file say. */
typedef struct noh_wire_info {
    uint32_t file_bytes;
    uint32_t block_bytes;  /* to unpack it in */
    uint32_t pack_bytes;   /* of the whole pack, at the block's start */
    uint32_t coarse_bytes; /* of the pack that comes first; 0: there is none */
} noh_wire_info;

/* Read the first NOH_WIRE_HEAD_BYTES of a file.
 * errors  DATA they are not those of a wire form, or damaged; VERSION of another version (need: ours) */
noh_result noh_wire_info_read(const void *bytes, size_t byte_count, noh_wire_info *info, noh_error *error);

typedef struct noh_wire_desc {
    void *block;        /* aligned to NOH_MEMORY_ALIGN; stays the caller's, and holds the packs */
    size_t block_bytes; /* noh_wire_info.block_bytes or more */
} noh_wire_desc;

/* Bytes of a noh_wire, at most NOH_WIRE_STATE_BYTES. */
size_t noh_wire_size(void);

/* errors  ARG memory, desc or block NULL or misaligned; MEMORY (need: the bytes needed) */
noh_result noh_wire_init(void *memory, size_t bytes, const noh_wire_desc *desc, noh_wire **wire, noh_error *error);

/* The next bytes of the file, as many as there are. After an error the noh_wire refuses all that follows; packs that
 * were handed out before stay good.
 * errors  DATA the bytes are damaged, or go on behind the file's end (where: the byte in the file, or what
 *         noh_pack_open says); VERSION; MEMORY the block is too small (need: the bytes needed); ARG bytes NULL */
noh_result noh_wire_push(noh_wire *wire, const void *bytes, size_t byte_count, noh_error *error);

/* The best pack that is there: the coarse one, later the whole one.
 * errors  NOT_FOUND none is there yet */
noh_result noh_wire_pack(const noh_wire *wire, noh_pack *pack, noh_error *error);

/* Whether the whole pack is there, and the file has ended. A file that was cut short never is. */
int noh_wire_whole(const noh_wire *wire);

/* Bytes of the file that were taken. */
uint32_t noh_wire_taken(const noh_wire *wire);

#ifdef __cplusplus
}
#endif

#endif
