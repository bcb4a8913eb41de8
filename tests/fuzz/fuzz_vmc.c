/* fuzz_vmc.c: any bytes as a packet of a capture (tools/noh/capture), and again on top of what it left. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "capture/vmc.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t count);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t count)
{
    static vmc v;
    memset(&v, 0, sizeof v);
    for (int i = 0; i < 2; i++) vmc_take(&v, data, count);
    if (v.messages + v.bad > 2 * count || v.value_count > VMC_VALUES_MAX) abort();
    for (uint32_t b = 0; b < VMC_BONES; b++) {
        const float *q = v.bones[b].rotation, length = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
        if (v.bones[b].is_known && !(length > 0.99f && length < 1.01f)) abort();
    }
    return 0;
}
