/* fuzz_clip.c: any bytes, given to the clip decoder alone and, where it accepts them, played.
 *
 * There is no checksum in the way: a pack checks it before it gives out these bytes. The skeleton is as large as the
 * clip says, with a bind pose made up. Samples are taken forwards, backwards and past the ends, of all joints and of
 * prefixes, through a cache of two segments, some of them requested in advance.
 *
 * With libFuzzer (make fuzz) or replayed (make check), see tests/support/fuzz_replay.h. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/fuzz_replay.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_motion.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t count);

#define BLOCK_MAX (64u << 20) /* a clip that needs more would take too long */
#define SAMPLES 12u
#define CANARY 0xa5u
#define CANARIES 64u

static int accepted; /* the last input, for the replay */

static void *block_of(size_t bytes)
{
    uint8_t *block = malloc(bytes + CANARIES);
    if (!block) {
        abort();
    }
    memset(block + bytes, CANARY, CANARIES);
    return block;
}

static void check_canaries(const uint8_t *block, size_t bytes)
{
    for (size_t i = 0; i < CANARIES; i++) {
        if (block[bytes + i] != CANARY) {
            fprintf(stderr, "written past a block of %zu bytes\n", bytes);
            abort();
        }
    }
}

static void play(const noh_clip *clip)
{
    noh_clip_cache_desc desc = { &clip, 1, 2 };
    noh_clip_info info;
    noh_clip_cache *cache;
    const size_t bytes = noh_clip_cache_size(&desc, NULL);
    uint8_t *memory;
    noh_transform *pose;
    float *floats;
    noh_clip_info_of(clip, &info);
    if (!bytes || bytes > BLOCK_MAX) {
        return;
    }
    memory = block_of(bytes);
    pose = malloc(info.joint_count * sizeof *pose + 1u);
    floats = malloc(info.float_count * sizeof *floats + 1u);
    if (!pose || !floats || noh_clip_cache_init(memory, bytes, &desc, &cache, NULL) != NOH_OK) {
        abort();
    }
    for (uint32_t i = 0; i < SAMPLES; i++) {
        /* 0, 5/11, 10/11, 4/11 ... of the clip, and a little past both ends */
        const int64_t ticks = (int64_t)((info.duration_ticks + 1600u) / 11u * (i * 5u % 12u)) - 800;
        const uint32_t joints = i % 3u ? info.joint_count : info.joint_count * i / SAMPLES;
        noh_clip_cache_begin_frame(cache);
        if (i % 2u) {
            noh_clip_cache_want(cache, 0, ticks, info.joint_count / 2u);
            noh_clip_cache_work(cache, 100u * i);
        }
        noh_clip_sample(cache, 0, ticks, joints, pose, i % 4u ? floats : NULL);
    }
    check_canaries(memory, bytes);
    free(memory);
    free(pose);
    free(floats);
}

/* A skeleton as these bytes need it; a clip cannot be opened with any other. */
static uint32_t joints_of(noh_clip_desc *desc)
{
    noh_error error = { NOH_OK, NULL, 0, 0 };
    if (noh_clip_size(desc, &error)) {
        return 0;
    }
    if (error.result == NOH_OK || !error.what || !error.what[0]) {
        fprintf(stderr, "refused without a reason\n");
        abort();
    }
    return error.result == NOH_ERR_ARG && error.need <= NOH_CLIP_JOINTS_MAX ? (uint32_t)error.need : 0u;
}

static void open_clip(noh_clip_desc *desc)
{
    const size_t bytes = noh_clip_size(desc, NULL);
    noh_clip *clip;
    uint8_t *memory;
    if (!bytes || bytes > BLOCK_MAX) {
        return;
    }
    memory = block_of(bytes);
    if (noh_clip_init(memory, bytes - 1u, desc, &clip, NULL) != NOH_ERR_MEMORY ||
        noh_clip_init(memory, bytes, desc, &clip, NULL) != NOH_OK) {
        fprintf(stderr, "noh_clip_size and noh_clip_init disagree\n");
        abort();
    }
    accepted = 1;
    play(clip);
    check_canaries(memory, bytes);
    free(memory);
}

static const noh_transform *bind_pose(void)
{
    static noh_transform bind[NOH_CLIP_JOINTS_MAX];
    for (uint32_t j = 0; j < NOH_CLIP_JOINTS_MAX && !(bind[j].scale[0] > 0.0f); j++) {
        const noh_transform t = { { 0.5f, -0.5f, 0.5f, 0.5f }, { 0.0f, (float)j, 0.0f }, { 1.0f, 1.0f, 1.0f } };
        bind[j] = t;
    }
    return bind;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t count)
{
    uint8_t *copy = malloc(count ? count : 1u);
    noh_clip_desc desc;
    if (!copy) {
        return 0;
    }
    memcpy(copy, data, count);
    memset(&desc, 0, sizeof desc);
    desc.bytes = copy;
    desc.byte_count = count;
    desc.bind = bind_pose();
    desc.joint_count = 0;
    accepted = 0;
    desc.joint_count = joints_of(&desc);
    open_clip(&desc);
    desc.sample_rate_needed = 1; /* most are halved */
    open_clip(&desc);
    free(copy);
    return 0;
}

#ifndef NOH_LIBFUZZER

static int try_input(const uint8_t *bytes, size_t count)
{
    LLVMFuzzerTestOneInput(bytes, count);
    return accepted;
}

int main(int argument_count, char **arguments)
{
    return fuzz_replay(argument_count, arguments, try_input);
}

#endif
