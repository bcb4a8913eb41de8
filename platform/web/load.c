/* load.c: receives the pack, plain or in the wire form, which is unpacked piece by piece, and plans the memory of its
 * stage.
 *
 * A program's memory has three parts: static data and stack, laid out by the linker; the pack; the block of the stage.
 * The page runs the program twice: first in growable memory, to load the pack and to plan, then in memory of exactly
 * the planned size, which cannot grow. */
#include <emscripten.h>

#include "web.h"

#define PIECE_BYTES 16384u
#define PACK_ALIGN 64u

extern uint8_t __heap_base; /* set by the linker: the first byte after static data and stack */

static uint8_t head[NOH_WIRE_HEAD_BYTES] __attribute__((aligned(16)));
static struct {
    uint8_t *pack; /* the file, or the block of the unpacked wire form */
    uint32_t bytes;
    uint8_t *piece;
    noh_wire *wire; /* NULL: a plain pack */
} in;

static size_t aligned(size_t at)
{
    return (at + PACK_ALIGN - 1u) / PACK_ALIGN * PACK_ALIGN;
}

static size_t first_byte(void)
{
    return aligned((size_t)&__heap_base);
}

static size_t memory_bytes(void)
{
    return __builtin_wasm_memory_size(0) * 65536u;
}

/* ---- a plain pack ---- */

/* The memory size for a pack and a block after it. */
EMSCRIPTEN_KEEPALIVE uint32_t web_memory_for(uint32_t pack_bytes, uint32_t block_bytes)
{
    return (uint32_t)(first_byte() + aligned(pack_bytes) + block_bytes);
}

/* Where the page writes the pack. NULL: the memory is too small. */
EMSCRIPTEN_KEEPALIVE void *web_pack(uint32_t bytes)
{
    in.pack = (uint8_t *)first_byte();
    in.bytes = bytes;
    in.wire = NULL;
    return web_memory_for(bytes, 0) <= memory_bytes() ? in.pack : NULL;
}

/* ---- the wire form ---- */

/* Where the page writes the first web_head_bytes of the file. */
EMSCRIPTEN_KEEPALIVE void *web_head(void)
{
    return head;
}
EMSCRIPTEN_KEEPALIVE uint32_t web_head_bytes(void)
{
    return sizeof head;
}
/* The memory size to unpack the file with this head; 0: see web_error. */
EMSCRIPTEN_KEEPALIVE uint32_t web_wire_memory(void)
{
    noh_wire_info info;
    if (noh_wire_info_read(head, sizeof head, &info, &web.error)) return 0;
    in.bytes = info.block_bytes;
    return (uint32_t)(web_memory_for(info.block_bytes, NOH_WIRE_STATE_BYTES) + PIECE_BYTES);
}

/* Begin to unpack in memory of this size. Returns where the page writes pieces of at most web_piece_bytes, starting
 * with the head. NULL: see web_error. */
EMSCRIPTEN_KEEPALIVE void *web_wire(void)
{
    uint8_t *state = (uint8_t *)first_byte() + aligned(in.bytes);
    noh_wire_desc desc;
    in.pack = (uint8_t *)first_byte();
    in.piece = state + NOH_WIRE_STATE_BYTES;
    desc.block = in.pack;
    desc.block_bytes = in.bytes;
    return noh_wire_init(state, NOH_WIRE_STATE_BYTES, &desc, &in.wire, &web.error) ? NULL : in.piece;
}
EMSCRIPTEN_KEEPALIVE uint32_t web_piece_bytes(void)
{
    return PIECE_BYTES;
}
/* Unpack a piece of this many bytes. */
EMSCRIPTEN_KEEPALIVE int web_wire_push(uint32_t bytes)
{
    return (int)noh_wire_push(in.wire, in.piece, bytes, &web.error);
}
/* 0: nothing to show yet; 1: the coarsest levels; 2: the whole pack. */
EMSCRIPTEN_KEEPALIVE int web_wire_shows(void)
{
    noh_pack pack;
    if (noh_wire_is_complete(in.wire)) return 2;
    return noh_wire_pack(in.wire, &pack, NULL) == NOH_OK;
}

/* ---- planning ---- */

noh_result web_load(noh_pack *pack)
{
    noh_result result;
    uint8_t *end = in.pack + aligned(in.bytes);
    result = in.wire ? noh_wire_pack(in.wire, pack, &web.error) : noh_pack_open(in.pack, in.bytes, pack, &web.error);
    if (in.wire) end = in.piece + PIECE_BYTES;
    web.block = end;
    web.block_bytes = (size_t)memory_bytes() - (size_t)end;
    return result;
}

/* Open the received pack; web_loaded_at and web_loaded_bytes then return its address and size. */
EMSCRIPTEN_KEEPALIVE int web_loaded(void)
{
    return (int)web_load(&web.pack);
}
EMSCRIPTEN_KEEPALIVE const void *web_loaded_at(void)
{
    return web.pack.bytes;
}
EMSCRIPTEN_KEEPALIVE uint32_t web_loaded_bytes(void)
{
    return web.pack.byte_count;
}

/* The number of bytes by which the memory must grow before web_plan. */
EMSCRIPTEN_KEEPALIVE uint32_t web_plan_grows(void)
{
    const size_t bytes = web_cast_scratch(&web.pack);
    return bytes > web.block_bytes ? (uint32_t)(bytes - web.block_bytes) : 0u;
}

/* The bytes of a block that is enough for the loaded pack in any light; 0: see web_error. Arguments as for web_open. */
EMSCRIPTEN_KEEPALIVE uint32_t web_plan(int path, uint32_t characters, int alive, int shading)
{
    size_t most = 0;
    if (characters < 1u || characters > WEB_CHARACTERS_MAX) {
        (void)noh_fail(&web.error, NOH_ERR_ARG, "characters must be 1 to 16", characters, WEB_CHARACTERS_MAX);
        return 0;
    }
    if (web_open_context()) return 0;
    web.block_bytes = memory_bytes() - (size_t)web.block;
    for (int lit = 0; lit < (web.elsewhere ? 1 : 2); lit++) {
        const web_wants wants = { characters, (noh_morph_path)path, lit, alive,
                                  0,          web.elsewhere,        0,   (noh_shading)shading };
        if (web_cast_plan(&web.cast, &web.pack, &wants, web.block, web.block_bytes, &web.caps, &web.error)) return 0;
        most = web.cast.bytes > most ? web.cast.bytes : most;
    }
    return (uint32_t)most;
}

/* The capabilities of a context. They are probed once and copied to the next program on the same context. */
EMSCRIPTEN_KEEPALIVE void *web_caps(void)
{
    return &web.caps;
}
EMSCRIPTEN_KEEPALIVE uint32_t web_caps_bytes(void)
{
    return sizeof web.caps;
}
