/* fuzz_pack.c: any bytes, opened as a pack and, where that succeeds, used in full.
 *
 * With libFuzzer (make fuzz) LLVMFuzzerTestOneInput is called with mutated bytes. Without
 * (make check) the main below replays the files and folders that it is given, each as a test, and damages each in a few
 * thousand seeded ways (tests/support/fuzz_replay.c).
 *
 * Each input is tried as it is, then with its length and checksums made right: a fuzzer cannot
 * guess a CRC, so only the second way reaches the structural checks. */
#define _XOPEN_SOURCE 700

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/fuzz_replay.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/pack.h"
#include "support/pack_walk.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t count);

static int opened; /* of the last input, for the replay */

/* A failed open must say what and where. */
static void try_bytes(const uint8_t *bytes, size_t count)
{
    noh_error error = { NOH_OK, NULL, 0, 0 };
    noh_pack pack;
    noh_result result = noh_pack_open(bytes, count, &pack, &error);
    opened = result == NOH_OK;
    if (opened) {
        pack_walk(&pack, (uint32_t)count);
    } else if (error.result != result || !error.what || !error.what[0] || error.where > count) {
        fprintf(stderr, "an error without a what or a where: %d\n", (int)result);
        abort();
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t count)
{
    void *copy;
    if (posix_memalign(&copy, 64, count ? count : 1)) {
        return 0;
    }
    memcpy(copy, data, count);
    try_bytes(copy, count);
    if (count >= sizeof(noh_pack_header)) {
        noh_pack_header *header = copy;
        header->magic = NOH_PACK_MAGIC;
        header->version = NOH_PACK_VERSION;
        header->byte_count = (uint32_t)count;
        pack_repair(copy, count);
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
