/* fuzz_wire.c: any bytes, unpacked as a wire form and, where the result is a pack, used in full.
 *
 * Each input is tried as it is, then with its length and the checksums of its header and blocks made right, so that
 * filters see sections and symbols that no writer makes. Everything lies in blocks of exactly the size asked for. */
#define _XOPEN_SOURCE 700

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/fuzz_replay.h"
#include "noh/base.h"
#include "noh/low_core.h"
#include "noh/pack.h"
#include "support/pack_walk.h"
#include "core/wire/wire_internal.h"

#define BLOCK_MAX (16u << 20) /* a header may ask for 2 GB: that is its right, and not looked at here */

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t count);

static int opened; /* of the last input, for the replay */

/* In pieces whose sizes come from the bytes. */
static noh_result push_all(noh_wire *wire, const uint8_t *bytes, size_t count, noh_error *error)
{
    noh_result result = NOH_OK;
    for (size_t at = 0; at < count && !result;) {
        const size_t wanted = 1u + bytes[at] * 17u, now = count - at < wanted ? count - at : wanted;
        result = noh_wire_push(wire, bytes + at, now, error);
        at += now;
    }
    return result;
}

static void try_bytes(const uint8_t *bytes, size_t count)
{
    noh_error error = { NOH_OK, NULL, 0, 0 };
    noh_wire_info info;
    noh_wire_desc desc;
    noh_wire *wire;
    noh_pack pack;
    void *memory = NULL;
    opened = 0;
    if (noh_wire_info_read(bytes, count, &info, &error) || info.block_bytes > BLOCK_MAX) return;
    desc.block_bytes = info.block_bytes;
    if (posix_memalign(&desc.block, 64, info.block_bytes)) return;
    if (posix_memalign(&memory, 64, noh_wire_size()) == 0 &&
        noh_wire_init(memory, noh_wire_size(), &desc, &wire, &error) == NOH_OK) {
        const noh_result result = push_all(wire, bytes, count, &error);
        if (result && (error.result != result || !error.what || !error.what[0])) {
            fprintf(stderr, "an error without a what: %d\n", (int)result);
            abort();
        }
        if (noh_wire_pack(wire, &pack, NULL) == NOH_OK) {
            pack_walk(&pack, (uint32_t)count);
            opened = noh_wire_is_complete(wire);
        }
    }
    free(memory);
    free(desc.block);
}

static void repair(uint8_t *bytes, size_t count)
{
    noh_wire_head *h = (noh_wire_head *)(void *)bytes;
    uint32_t crc;
    h->magic = NOH_WIRE_MAGIC;
    h->version = NOH_WIRE_VERSION;
    h->file_bytes = (uint32_t)count;
    crc = h->crc = noh_crc32c(0, h, offsetof(noh_wire_head, crc));
    for (size_t at = sizeof *h; at + NOH_WIRE_BLOCK_HEAD_BYTES < count;) {
        uint8_t *b = bytes + at;
        const size_t size = ((size_t)b[2] | (size_t)b[3] << 8) & (NOH_WIRE_BLOCK_SECTION - 1u);
        if (size > count - at - NOH_WIRE_BLOCK_HEAD_BYTES) return;
        crc = noh_crc32c(noh_crc32c(crc, b, 4), b + NOH_WIRE_BLOCK_HEAD_BYTES, size);
        memcpy(b + 4, &crc, 4);
        at += NOH_WIRE_BLOCK_HEAD_BYTES + size;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t count)
{
    void *copy;
    if (posix_memalign(&copy, 64, count ? count : 1)) return 0;
    memcpy(copy, data, count);
    try_bytes(copy, count);
    if (!opened && count >= sizeof(noh_wire_head)) {
        repair(copy, count);
        try_bytes(copy, count);
    }
    free(copy);
    return 0;
}

#ifndef NOH_LIBFUZZER

static int try_input(const uint8_t *bytes, size_t count)
{
    LLVMFuzzerTestOneInput(bytes, count);
    return opened;
}

int main(int argument_count, char **arguments)
{
    return fuzz_replay(argument_count, arguments, try_input);
}

#endif
