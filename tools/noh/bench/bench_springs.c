/* bench_springs.c: rows sim/spring: ten characters of a hundred joints that swing beside eight capsules, by each set of
 * instructions, against as many two-bone solves. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench_job.h"
#include "cli/message.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/low_life.h"

#define CHARACTERS 10u
#define CHAINS 10u /* of a character */
#define JOINTS 10u /* of a chain */
#define CAPSULES 8u
#define WORKS 3u /* sets of instructions at most */
#define SAMPLE_NS 5e6

/* spring_lanes.c built again (Makefile, KERNELS) */
typedef uint32_t spring_step(const noh_spring_move *moves, uint32_t count, uint32_t ticks, float *scratch);
typedef void spring_rotations(const noh_spring_move *moves, uint32_t count);
spring_step noh_spring_step_scalar, noh_spring_step_sse2, noh_spring_step_avx2;
spring_rotations noh_spring_rotations_scalar, noh_spring_rotations_sse2, noh_spring_rotations_avx2;

typedef struct spring_work {
    const char *name;
    spring_step *step;
    spring_rotations *rotate;
    noh_spring_joint joints[JOINTS];
    noh_spring_desc desc;
    noh_spring *springs[CHARACTERS * CHAINS];
    noh_spring_collider capsules[CAPSULES];
    float rotations[CHAINS][4u * JOINTS], scratch[NOH_SPRING_SCRATCH_FLOATS(CAPSULES)];
    volatile float seen; /* keeps the results alive */
} spring_work;

/* Strands of 400 mm round a head and down a back; two capsules are head and neck, six are of the trunk and the arms. */
static int make_work(spring_work *w)
{
    const noh_spring_carrier at = { { 0.0f, 1.6f, 0.0f }, { 0.0f, 0.0f, 0.0f, 1.0f } };
    w->desc.joints = w->joints;
    w->desc.joint_count = JOINTS;
    w->desc.collider_count = CAPSULES;
    for (uint32_t j = 0; j < JOINTS; j++) {
        w->joints[j] = (noh_spring_joint){ { 0.0f, -0.04f, 0.0f }, { 0.0f, 0.0f, 0.0f, 1.0f }, 0.5f, 0.3f, 0.02f,
                                           { 0.0f, -0.3f, 0.0f } };
    }
    for (uint32_t k = 0; k < CAPSULES; k++) {
        const float y = 1.6f - 0.1f * (float)k, x = k < 4u ? 0.0f : k & 1u ? 0.2f : -0.2f;
        w->capsules[k] = (noh_spring_collider){ { x, y, 0.0f }, { x, y - 0.15f, 0.0f }, 0.09f };
    }
    for (uint32_t i = 0; i < CHARACTERS * CHAINS; i++) {
        const size_t bytes = noh_spring_size(&w->desc);
        void *memory = malloc(bytes);
        if (!memory || noh_spring_init(memory, bytes, &w->desc, &at, &w->springs[i], NULL) != NOH_OK) {
            free(memory);
            return tool_fail("bench", "out of memory");
        }
    }
    return 0;
}

/* Character by character, as a stage does it: all chains of one in a call. */
static void swing(void *self, uint32_t frame)
{
    spring_work *w = self;
    noh_spring_carrier carriers[CHAINS];
    noh_spring_move moves[CHAINS];
    const float sway = 0.05f * sinf(0.1f * (float)frame);
    for (uint32_t i = 0; i < CHAINS; i++) {
        const float turn = 6.2831853f * (float)i / (float)CHAINS;
        carriers[i] = (noh_spring_carrier){ { 0.1f * cosf(turn) + sway, 1.65f, 0.1f * sinf(turn) },
                                            { 0.0f, sinf(0.5f * turn), 0.0f, cosf(0.5f * turn) } };
    }
    for (uint32_t c = 0; c < CHARACTERS; c++) {
        for (uint32_t i = 0; i < CHAINS; i++) {
            moves[i] = (noh_spring_move){
                w->springs[c * CHAINS + i], &w->desc, &carriers[i], w->capsules, w->rotations[i], NULL
            };
        }
        (void)w->step(moves, CHAINS, NOH_SPRING_STEP_TICKS, w->scratch);
        w->rotate(moves, CHAINS);
        w->seen = w->rotations[0][0];
    }
}

void bench_two_bone(void *self, uint32_t frame)
{
    static const noh_ik_limb limb = {
        { 0.0f, 1.4f, 0.0f }, { 0.0f, 1.1f, 0.02f }, { 0.0f, 0.82f, 0.0f }, 0.0f, 0.0f, 0.0f
    };
    static const float pole[3] = { 0.0f, 0.0f, 1.0f };
    static volatile float seen; /* keeps the results alive */
    (void)self;
    for (uint32_t i = 0; i < BENCH_TWO_BONE_SOLVES; i++) {
        const float target[3] = { 0.001f * (float)(i % 300u), 1.0f + 0.001f * (float)(frame % 50u), 0.2f };
        noh_ik_bend bend;
        noh_ik_two_bone(&limb, target, pole, 1.0f, &bend);
        seen = bend.start[0];
    }
    (void)seen;
}

static uint32_t list_works(spring_work *works)
{
    uint32_t count = 0;
    works[count].name = "scalar";
    works[count].step = noh_spring_step_scalar;
    works[count++].rotate = noh_spring_rotations_scalar;
#if defined(__x86_64__)
    works[count].name = "sse2";
    works[count].step = noh_spring_step_sse2;
    works[count++].rotate = noh_spring_rotations_sse2;
    if (__builtin_cpu_supports("avx2")) {
        works[count].name = "avx2";
        works[count].step = noh_spring_step_avx2;
        works[count++].rotate = noh_spring_rotations_avx2;
    }
#else
    works[count].name = "own";
    works[count].step = noh_spring_step;
    works[count++].rotate = noh_spring_rotations;
#endif
    return count;
}

static int measure(bench_job *job, spring_work *works, uint32_t count)
{
    bench_cells cells;
    memset(&cells, 0, sizeof cells);
    bench_add_cell(&cells, bench_two_bone, NULL);
    for (uint32_t i = 0; i < count; i++) bench_add_cell(&cells, swing, &works[i]);
    const int status = bench_run_cells(&cells, &job->cpu_clock, job->rounds, SAMPLE_NS, "sim/spring");
    for (uint32_t i = 0; i < count && !status; i++) {
        char name[64];
        snprintf(name, sizeof name, "sim/spring/%s", works[i].name);
        bench_add_row(&job->rows, name, "two-bone", bench_median(&cells, 0) / BENCH_TWO_BONE_SOLVES,
                      bench_median(&cells, 1 + i) / (CHARACTERS * CHAINS * JOINTS), "ns/joint and step", cells.rounds);
    }
    bench_free_cells(&cells);
    return status;
}

int bench_springs(bench_job *job)
{
    spring_work *works = calloc(WORKS, sizeof *works);
    const uint32_t count = works ? list_works(works) : 0;
    int status = works ? 0 : tool_fail("bench", "out of memory");
    for (uint32_t i = 0; i < count && !status; i++) status = make_work(&works[i]);
    if (!status) status = measure(job, works, count);
    for (uint32_t k = 0; k < count; k++) {
        for (uint32_t i = 0; i < CHARACTERS * CHAINS; i++) free(works[k].springs[i]);
    }
    free(works);
    return status;
}
