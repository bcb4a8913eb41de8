/* load.c: the pack arrives: as it is, or in the wire form, which is unpacked piece by piece. */
#include <emscripten.h>

#include "web.h"

#define PIECE_BYTES 16384u

static uint8_t pack_bytes[NOH_WEB_PACK_BYTES] __attribute__((aligned(64)));
static uint8_t piece[PIECE_BYTES];
static uint8_t state[NOH_WIRE_STATE_BYTES] __attribute__((aligned(16)));
static noh_wire *wire; /* NULL: a pack as it is */
static uint32_t file_bytes;

/* Where the page is to write a pack as it is; NULL if it has more bytes than the page was built for. */
EMSCRIPTEN_KEEPALIVE void *web_pack(uint32_t bytes)
{
    wire = NULL;
    file_bytes = bytes;
    return bytes <= sizeof pack_bytes ? pack_bytes : NULL;
}
EMSCRIPTEN_KEEPALIVE uint32_t web_pack_room(void)
{
    return sizeof pack_bytes;
}

/* A wire form begins: where the page is to write its pieces, web_piece_bytes at most. NULL: see web_error. */
EMSCRIPTEN_KEEPALIVE void *web_wire(void)
{
    const noh_wire_desc desc = { pack_bytes, sizeof pack_bytes };
    return noh_wire_init(state, sizeof state, &desc, &wire, &web.error) ? NULL : piece;
}
EMSCRIPTEN_KEEPALIVE uint32_t web_piece_bytes(void)
{
    return sizeof piece;
}
/* So many bytes were written there. */
EMSCRIPTEN_KEEPALIVE int web_wire_push(uint32_t bytes)
{
    return (int)noh_wire_push(wire, piece, bytes, &web.error);
}
/* 0: nothing can be shown yet; 1: the coarsest levels can; 2: all of it. */
EMSCRIPTEN_KEEPALIVE int web_wire_shows(void)
{
    noh_pack pack;
    if (noh_wire_whole(wire)) return 2;
    return noh_wire_pack(wire, &pack, NULL) == NOH_OK;
}

noh_result web_load(noh_pack *pack)
{
    return wire ? noh_wire_pack(wire, pack, &web.error) : noh_pack_open(pack_bytes, file_bytes, pack, &web.error);
}
