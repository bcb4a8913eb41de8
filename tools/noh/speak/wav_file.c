#include "wav_file.h"

#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "platform.h"

#define HEADER_BYTES 44u

static void put(uint8_t *to, uint32_t value, int bytes)
{
    for (int i = 0; i < bytes; i++) to[i] = (uint8_t)(value >> (8 * i));
}

/* RIFF, all numbers little-endian: the size of what follows, the format (1: PCM, one channel), the samples. */
static void put_header(uint8_t *to, uint32_t data_bytes, uint32_t sample_rate)
{
    memcpy(to, "RIFF", 4);
    put(to + 4, HEADER_BYTES - 8u + data_bytes, 4);
    memcpy(to + 8, "WAVEfmt ", 8);
    put(to + 16, 16, 4);
    put(to + 20, 1, 2);
    put(to + 22, 1, 2);
    put(to + 24, sample_rate, 4);
    put(to + 28, 2u * sample_rate, 4);
    put(to + 32, 2, 2);
    put(to + 34, 16, 2);
    memcpy(to + 36, "data", 4);
    put(to + 40, data_bytes, 4);
}

int wav_write(const char *path, const int16_t *samples, size_t count, uint32_t sample_rate)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    const size_t bytes = HEADER_BYTES + 2u * count;
    uint8_t *file = bytes < UINT32_MAX ? malloc(bytes) : NULL;
    int status = file ? 0 : tool_fail(path, "out of memory");
    if (!status) {
        put_header(file, (uint32_t)(2u * count), sample_rate);
        for (size_t i = 0; i < count; i++) put(file + HEADER_BYTES + 2u * i, (uint16_t)samples[i], 2);
        if (noh_file_write(path, file, bytes, &error)) status = tool_fail(path, "cannot write: %s", error.what);
    }
    free(file);
    return status;
}
