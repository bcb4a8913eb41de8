/* wire.h: packs compressed for transfer, a few times smaller, and unpacked as they arrive.
 *
 * `noh pack` makes the wire form (.nohz) of a pack. A noh_wire takes the file in pieces of any size and builds the pack
 * in the caller's block. A pack with LOD levels arrives as two: first a pack of the coarsest levels, with all clips,
 * materials and textures, then the whole pack, for which only meshes are sent again. noh_pack_open checks each before
 * noh_wire_pack returns it. A stage can start with the coarse pack and load the whole one as `finer` (stage.h).
 *
 * Memory: the state has the same size for every file, at most NOH_WIRE_STATE_BYTES. The block holds the whole pack at
 * its start, then the coarse pack, then working space for meshes. After the whole file only the first
 * noh_wire_info.pack_bytes are needed, if the coarse pack is no longer used.
 *
 * The same file gives the same bytes on every machine.
 *
 * Threads: a noh_wire belongs to one thread at a time. The packs that it returned are read-only. */
#ifndef NOH_WIRE_WIRE_H
#define NOH_WIRE_WIRE_H

#include "core/pack/pack.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_WIRE_VERSION 2u         /* version written; versions 1 and later can be read */
#define NOH_WIRE_HEAD_BYTES 64u     /* of a file, for noh_wire_info_read */
#define NOH_WIRE_STATE_BYTES 49152u /* largest noh_wire */

typedef struct noh_wire noh_wire;

/* The head of a wire file. */
typedef struct noh_wire_info {
    uint32_t file_bytes;
    uint32_t block_bytes;  /* block for unpacking */
    uint32_t pack_bytes;   /* of the whole pack, at the block's start */
    uint32_t coarse_bytes; /* of the coarse pack; 0: there is none */
} noh_wire_info;

/* Read the first NOH_WIRE_HEAD_BYTES of a file.
 * errors  DATA not a wire file, or damaged; VERSION another version (need: the version of this library) */
noh_result noh_wire_info_read(const void *bytes, size_t byte_count, noh_wire_info *info, noh_error *error);

typedef struct noh_wire_desc {
    void *block;        /* aligned to NOH_MEMORY_ALIGN; owned by the caller; holds the packs */
    size_t block_bytes; /* at least noh_wire_info.block_bytes */
} noh_wire_desc;

/* Bytes of a noh_wire, at most NOH_WIRE_STATE_BYTES. */
size_t noh_wire_size(void);

/* Build a noh_wire in memory[bytes].
 * errors  ARG memory, desc or block is NULL or misaligned; MEMORY memory is too small (need: the bytes) */
noh_result noh_wire_init(void *memory, size_t bytes, const noh_wire_desc *desc, noh_wire **wire, noh_error *error);

/* Take the next bytes of the file, any number. After an error every further push fails; packs returned before stay
 * valid.
 * errors  DATA the bytes are damaged, or continue past the file's end (where: the byte in the file, or as in
 *         noh_pack_open); VERSION; MEMORY the block is too small (need: the bytes); ARG bytes is NULL */
noh_result noh_wire_push(noh_wire *wire, const void *bytes, size_t byte_count, noh_error *error);

/* Get the best pack available: the coarse one, later the whole one.
 * errors  NOT_FOUND no pack is complete yet */
noh_result noh_wire_pack(const noh_wire *wire, noh_pack *pack, noh_error *error);

/* Whether the whole pack is complete and the file has ended; never 1 for a truncated file. */
int noh_wire_whole(const noh_wire *wire);

/* Bytes of the file taken so far. */
uint32_t noh_wire_taken(const noh_wire *wire);

#ifdef __cplusplus
}
#endif

#endif
