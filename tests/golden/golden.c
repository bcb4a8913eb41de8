/* golden.c: hashes of ten seconds of everything that moves, as a table: of sessions of each pack (tools/noh/replay) and
 * of a crowd. Any compiler and processor must print the same. It needs the library and the C library alone.
 *
 *   golden PACK...        NAME CRC-OF-THE-PACK PART CRC, a line for each part */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "stage/crowd/crowd_internal.h"
#include "noh/base.h"
#include "noh/crowd.h"
#include "noh/low_core.h"
#include "noh/pack.h"
#include "platform.h"
#include "replay/session.h"

#define FRAMES 600u
#define ACTORS 4u
#define SEED 1u
#define AGENTS 200u
#define CROWD_STEPS 300u

static int fail(const char *subject, const char *what)
{
    fprintf(stderr, "golden: %s: %s\n", subject, what);
    return 1;
}

static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/* A part of all frames. */
static uint32_t crc_of(const session *s, session_part part)
{
    uint32_t crc = 0;
    for (uint32_t f = 0; f < s->frame_count; f++) crc = noh_crc32c(crc, &s->hashes[f].part[part], sizeof crc);
    return crc;
}

/* Draw a session and play it, each on a fresh stage. */
static int play(const noh_pack *pack, session *s, noh_error *error)
{
    session_stage stage;
    int failed;
    if (session_open(&stage, pack, ACTORS, error)) return 1;
    failed = session_draw(s, &stage, FRAMES, SEED);
    session_close(&stage);
    s->hashes = calloc(FRAMES, sizeof *s->hashes);
    if (failed || !s->hashes || session_open(&stage, pack, ACTORS, error)) return 1;
    failed = session_run(s, &stage, s->hashes, error);
    session_close(&stage);
    return failed;
}

static int pack_rows(const char *path)
{
    noh_error error = { NOH_OK, "out of memory", 0, 0 };
    session s = { 0 };
    noh_file file;
    noh_pack pack;
    int failed;
    if (noh_file_map(path, &file, &error)) return fail(path, error.what);
    failed = noh_pack_open(file.data, file.bytes, &pack, &error) || play(&pack, &s, &error);
    for (int p = 0; p < SESSION_PARTS && !failed; p++) {
        printf("%s %08x %s %08x\n", base_name(path), noh_crc32c(0, file.data, file.bytes),
               session_part_name((session_part)p), crc_of(&s, (session_part)p));
    }
    session_free(&s);
    noh_file_unmap(&file);
    return failed ? fail(path, error.what) : 0;
}

/* Agents on a lattice that cross it to the place opposite, with a post in the middle. */
static int crowd_row(void)
{
    static const noh_crowd_obstacle post = { { 0.2f, 0.1f }, { 0.2f, 0.1f }, 1.0f };
    const noh_crowd_desc desc = { .agent_max = AGENTS,
                                  .origin = { -20.0f, -20.0f },
                                  .extent = { 40.0f, 40.0f },
                                  .obstacle_count = 1,
                                  .obstacles = &post };
    const size_t bytes = noh_crowd_size(&desc);
    char *block = malloc(bytes + NOH_MEMORY_ALIGN);
    noh_error error = { NOH_OK, "out of memory", 0, 0 };
    noh_crowd *crowd;
    if (!block || noh_crowd_init(block + (NOH_MEMORY_ALIGN - (uintptr_t)block % NOH_MEMORY_ALIGN) % NOH_MEMORY_ALIGN,
                                 bytes, &desc, &crowd, &error)) {
        free(block);
        return fail("crowd", error.what);
    }
    for (uint32_t i = 0; i < AGENTS; i++) {
        noh_crowd_agent agent = { .radius = 0.25f, .speed = 1.3f, .id = i };
        agent.position[0] = 1.5f * (float)(i % 20u) - 14.0f;
        agent.position[1] = 1.5f * (float)(i / 20u) - 7.0f;
        agent.goal[0] = -agent.position[0];
        agent.goal[1] = -agent.position[1];
        agent.flags = i % 7u == 0 ? NOH_CROWD_ORCA : i % 11u == 0 ? NOH_CROWD_FLOCK : 0u;
        (void)noh_crowd_add(crowd, i, &agent, NULL);
    }
    for (uint32_t i = 0; i < CROWD_STEPS; i++) noh_crowd_step(crowd, NOH_CROWD_STEP_TICKS);
    printf("crowd %08x agents %08x\n", AGENTS, noh_crowd_hash(crowd));
    free(block);
    return 0;
}

int main(int argc, char **argv)
{
    int failed = crowd_row();
    for (int i = 1; i < argc && !failed; i++) failed = pack_rows(argv[i]);
    return failed;
}
