/* golden.c: hashes of ten seconds of everything that moves, as a table: of sessions of each pack (tools/noh/replay) and
 * of a crowd. Any compiler and processor must print the same. It needs the library and the C library alone.
 *
 *   golden PACK...               NAME CRC-OF-THE-PACK PART CRC, a line for each part
 *   golden SECONDS SEEDS PACK    the same for simulated SECONDS of random commands, a line for each of SEEDS seeds: an
 *                                actor's joints stay rotations, and in the end the stage does what a new one does */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "stage/crowd/crowd_internal.h"
#include "noh/base.h"
#include "noh/crowd.h"
#include "noh/low_core.h"
#include "noh/modules.h"
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

/* ---- a long time of random commands ---- */

#define CHUNK_FRAMES 2048u /* drawn at once; then all leave and come in again */
#define SAMPLE_FRAMES 199u /* between two hashes of everything */

/* Frames of 1/15 to 1/3 s in even chunks, and of 1/2 to 2.7 s in odd ones: the game is in the background. A day is some
 * 96,000 frames, which emulators play in minutes. */
static float slower(uint32_t seed)
{
    return seed % 2u ? 64.0f : 8.0f;
}

static int joints_turn(const session_stage *s, noh_error *error)
{
    float m[12];
    for (uint32_t a = 0; a < s->actor_count; a++) {
        for (uint32_t j = 0; noh_actor_joint(s->stage, s->actors[a], j, m, NULL) == NOH_OK; j++) {
            for (int i = 0; i < 9; i++) {
                const int x = i / 3, y = i % 3;
                const float dot = m[x] * m[y] + m[4 + x] * m[4 + y] + m[8 + x] * m[8 + y];
                if (fabsf(dot - (float)(x == y)) < 1e-4f) continue;
                *error = (noh_error){ NOH_ERR_ARG, "a joint is no rotation any more", j, 0 };
                return 1;
            }
        }
    }
    return 0;
}

static int leave(session_stage *stage, noh_error *error)
{
    for (uint32_t a = 0; a < stage->actor_count; a++) {
        if (stage->actors[a].id && noh_stage_despawn(stage->stage, stage->actors[a], error)) return 1;
    }
    return 0;
}

/* All come in, and random commands follow until the time is up. Returns 1 and *error, or 0. */
static int play_chunk(session_stage *stage, uint32_t seed, uint64_t until, uint64_t *played, uint32_t *crc,
                      noh_error *error)
{
    session s = { 0 };
    session_hashes h;
    uint32_t next = 0;
    int failed = leave(stage, error) || session_draw(&s, stage, CHUNK_FRAMES, seed);
    stage->ticks = (uint32_t)(slower(seed) * (float)SESSION_FRAME_TICKS);
    for (uint32_t i = 0; i < s.input_count; i++) {
        if (s.inputs[i].what == SESSION_TICKS) s.inputs[i].numbers[0] *= slower(seed);
    }
    for (uint32_t f = 0; f < CHUNK_FRAMES && *played < until && !failed; f++) {
        uint64_t state;
        session_give(&s, stage, f, &next);
        failed = session_step(stage, error);
        state = noh_stage_hash(stage->stage);
        *crc = noh_crc32c(*crc, &state, sizeof state);
        *played += stage->ticks;
        if (failed || f % SAMPLE_FRAMES) continue;
        session_hash(stage, f, &h);
        *crc = noh_crc32c(*crc, &h, sizeof h);
        failed = joints_turn(stage, error);
    }
    session_free(&s);
    return failed;
}

/* A new actor's face has a seed of its own. */
static void seed_faces(const session_stage *stage)
{
    for (uint32_t a = 0; a < stage->actor_count; a++)
        (void)noh_actor_seed_face(stage->stage, stage->actors[a], a, NULL);
}

/* Play a short session in a stage that has run for long and in a new one. Clocks, and with them state and events, are
 * different; all that is drawn is equal. */
static int plays_the_same(const session *s, session_stage *old, session_stage *fresh, noh_error *error)
{
    uint32_t next[2] = { 0, 0 }, parts;
    for (uint32_t f = 0; f < s->frame_count; f++) {
        session_hashes h[2];
        session_give(s, old, f, &next[0]);
        session_give(s, fresh, f, &next[1]);
        if (f == 0) seed_faces(old), seed_faces(fresh);
        if (session_step(old, error) || session_step(fresh, error)) return 1;
        session_hash(old, f, &h[0]);
        session_hash(fresh, f, &h[1]);
        (void)session_differ(&h[0], &h[1], 1, &parts);
        parts &= ~(1u << SESSION_STATE | 1u << SESSION_EVENTS);
        if (!parts) continue;
        *error = (noh_error){ NOH_ERR_ARG, "after a long time, the stage differs from a new one", f, parts };
        return 1;
    }
    return 0;
}

/* What moves by fixed steps has a part of one left: the new stage starts with the same part of a second. */
static int is_as_new(session_stage *stage, uint64_t played, noh_error *error)
{
    const uint32_t rest = (uint32_t)(played % NOH_TICKS_PER_SECOND);
    session s = { 0 };
    session_stage fresh;
    int failed = leave(stage, error) || session_open(&fresh, stage->pack, ACTORS, error);
    if (failed) return 1;
    stage->ticks = fresh.ticks;
    memcpy(stage->view, fresh.view, sizeof fresh.view);
    failed = noh_stage_step(fresh.stage, rest, NULL, NULL, error) || session_draw(&s, &fresh, FRAMES / 2u, SEED) ||
             plays_the_same(&s, stage, &fresh, error);
    session_free(&s);
    session_close(&fresh);
    return failed;
}

static int long_row(const char *path, uint32_t seconds, uint32_t seed)
{
    noh_error error = { NOH_OK, "out of memory", 0, 0 };
    const uint64_t until = (uint64_t)seconds * NOH_TICKS_PER_SECOND;
    uint64_t played = 0;
    session_stage stage;
    noh_file file;
    noh_pack pack;
    uint32_t crc = 0;
    int failed;
    if (noh_file_map(path, &file, &error)) return fail(path, error.what);
    failed = noh_pack_open(file.data, file.bytes, &pack, &error) || session_open(&stage, &pack, ACTORS, &error);
    if (!failed) {
        for (uint32_t chunk = 0; played < until && !failed; chunk++)
            failed = play_chunk(&stage, seed * 65536u + chunk, until, &played, &crc, &error);
        failed = failed || is_as_new(&stage, played, &error);
        session_close(&stage);
    }
    if (!failed)
        printf("%s %08x %us-seed%u %08x\n", base_name(path), noh_crc32c(0, file.data, file.bytes), seconds, seed, crc);
    else
        fprintf(stderr, "golden: at %llu, %u\n", (unsigned long long)error.where, (unsigned)error.need);
    noh_file_unmap(&file);
    return failed ? fail(path, error.what) : 0;
}

int main(int argc, char **argv)
{
    int failed;
    if (argc == 4 && atoi(argv[1]) > 0) {
        failed = 0;
        for (int seed = 1; seed <= atoi(argv[2]) && !failed; seed++)
            failed = long_row(argv[3], (uint32_t)atoi(argv[1]), (uint32_t)seed);
        return failed;
    }
    failed = crowd_row();
    for (int i = 1; i < argc && !failed; i++) failed = pack_rows(argv[i]);
    return failed;
}
