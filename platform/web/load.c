/* load.c: the pack arrives: as it is, or in the wire form, which is unpacked piece by piece; and what memory a stage
 * for it takes.
 *
 * A program's memory is: static data and stack, which the linker lays out; the pack; the block of the stage. The page
 * runs the program twice: first in memory that may grow, to take the pack in and to plan, then in memory of what the
 * plan says, which cannot. */
#include <emscripten.h>

#include "web.h"

#define PIECE_BYTES 16384u
#define PACK_ALIGN 64u

extern uint8_t __heap_base; /* by the linker: the first byte behind static data and stack */

static uint8_t head[NOH_WIRE_HEAD_BYTES] __attribute__((aligned(16)));
static struct {
    uint8_t *pack; /* the file, or the block that the wire form is unpacked in */
    uint32_t bytes;
    uint8_t *piece;
    noh_wire *wire; /* NULL: a pack as it is */
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

/* ---- a pack as it is ---- */

/* What memory a pack of so many bytes and a block of so many behind it take in all. */
EMSCRIPTEN_KEEPALIVE uint32_t web_memory_for(uint32_t pack_bytes, uint32_t block_bytes)
{
    return (uint32_t)(first_byte() + aligned(pack_bytes) + block_bytes);
}

/* Where the pack is to be written. NULL: the memory has no room for it. */
EMSCRIPTEN_KEEPALIVE void *web_pack(uint32_t bytes)
{
    in.pack = (uint8_t *)first_byte();
    in.bytes = bytes;
    in.wire = NULL;
    return web_memory_for(bytes, 0) <= memory_bytes() ? in.pack : NULL;
}

/* ---- the wire form ---- */

/* Where the page is to write the first web_head_bytes of the file. */
EMSCRIPTEN_KEEPALIVE void *web_head(void)
{
    return head;
}
EMSCRIPTEN_KEEPALIVE uint32_t web_head_bytes(void)
{
    return sizeof head;
}
/* What memory it takes to unpack what begins so; 0: see web_error. */
EMSCRIPTEN_KEEPALIVE uint32_t web_wire_memory(void)
{
    noh_wire_info info;
    if (noh_wire_info_read(head, sizeof head, &info, &web.error)) return 0;
    in.bytes = info.block_bytes;
    return (uint32_t)(web_memory_for(info.block_bytes, NOH_WIRE_STATE_BYTES) + PIECE_BYTES);
}

/* Begin, in that memory: where the page is to write pieces, web_piece_bytes at most, the head among them. NULL: see
 * web_error. */
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
/* So many bytes were written there. */
EMSCRIPTEN_KEEPALIVE int web_wire_push(uint32_t bytes)
{
    return (int)noh_wire_push(in.wire, in.piece, bytes, &web.error);
}
/* 0: nothing can be shown yet; 1: the coarsest levels can; 2: all of it. */
EMSCRIPTEN_KEEPALIVE int web_wire_shows(void)
{
    noh_pack pack;
    if (noh_wire_whole(in.wire)) return 2;
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

/* Open what has arrived; web_loaded_at and web_loaded_bytes tell where it then lies. */
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

/* By how much the memory is to grow before web_plan. */
EMSCRIPTEN_KEEPALIVE uint32_t web_plan_grows(void)
{
    const size_t bytes = web_cast_scratch(&web.pack);
    return bytes > web.block_bytes ? (uint32_t)(bytes - web.block_bytes) : 0u;
}

/* The bytes of the block that shows what was loaded, in whatever light, for good; 0: see web_error. As web_open. */
EMSCRIPTEN_KEEPALIVE uint32_t web_plan(int path, uint32_t characters, int alive)
{
    size_t most = 0;
    if (characters < 1u || characters > WEB_CHARACTERS_MAX) {
        (void)noh_fail(&web.error, NOH_ERR_ARG, "characters: 1 to 16", characters, WEB_CHARACTERS_MAX);
        return 0;
    }
    if (web_open_context()) return 0;
    web.block_bytes = memory_bytes() - (size_t)web.block;
    for (int lit = 0; lit < (web.elsewhere ? 1 : 2); lit++) {
        const web_wants wants = { characters, (noh_morph_path)path, lit, alive, 0, web.elsewhere };
        if (web_cast_plan(&web.cast, &web.pack, &wants, web.block, web.block_bytes, &web.caps, &web.error)) return 0;
        most = web.cast.bytes > most ? web.cast.bytes : most;
    }
    return (uint32_t)most;
}

/* What a context can do, which is asked once: a program tells it to the next one of the same context. */
EMSCRIPTEN_KEEPALIVE void *web_caps(void)
{
    return &web.caps;
}
EMSCRIPTEN_KEEPALIVE uint32_t web_caps_bytes(void)
{
    return sizeof web.caps;
}
