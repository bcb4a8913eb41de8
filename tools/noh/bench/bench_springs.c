/* bench_springs.c: row sim/spring: ten characters of a hundred joints that swing beside eight capsules, against as many
 * two-bone solves. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bench_job.h"
#include "cli/message.h"
#include "sim/ik.h"
#include "sim/spring.h"

#define CHARACTERS 10u
#define CHAINS 10u /* of a character */
#define JOINTS 10u /* of a chain */
#define CAPSULES 8u
#define SOLVES (CHARACTERS * CHAINS * JOINTS)
#define SAMPLE_NS 5e6

typedef struct spring_work {
    noh_spring_joint joints[JOINTS];
    noh_spring_desc desc;
    noh_spring *springs[CHARACTERS * CHAINS];
    noh_spring_collider capsules[CAPSULES];
    float rotations[4u * JOINTS];
    volatile float seen; /* keeps the results alive */
} spring_work;

/* Strands of 400 mm round a head and down a back; two capsules are head and neck, six are of the trunk and the arms. */
static int make_work(spring_work *w)
{
    const noh_spring_carrier at = { { 0.0f, 1.6f, 0.0f }, { 0.0f, 0.0f, 0.0f, 1.0f } };
    memset(w, 0, sizeof *w);
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

static void swing(void *self, uint32_t frame)
{
    spring_work *w = self;
    for (uint32_t i = 0; i < CHARACTERS * CHAINS; i++) {
        const float turn = 6.2831853f * (float)(i % CHAINS) / (float)CHAINS, sway = 0.05f * sinf(0.1f * (float)frame);
        const noh_spring_carrier at = { { 0.1f * cosf(turn) + sway, 1.65f, 0.1f * sinf(turn) },
                                        { 0.0f, sinf(0.5f * turn), 0.0f, cosf(0.5f * turn) } };
        (void)noh_spring_step(w->springs[i], &w->desc, &at, w->capsules, NOH_SPRING_STEP_TICKS);
        noh_spring_rotations(w->springs[i], &w->desc, w->rotations);
        w->seen = w->rotations[0];
    }
}

static void solve(void *self, uint32_t frame)
{
    static const noh_ik_limb limb = {
        { 0.0f, 1.4f, 0.0f }, { 0.0f, 1.1f, 0.02f }, { 0.0f, 0.82f, 0.0f }, 0.0f, 0.0f, 0.0f
    };
    static const float pole[3] = { 0.0f, 0.0f, 1.0f };
    spring_work *w = self;
    for (uint32_t i = 0; i < SOLVES; i++) {
        const float target[3] = { 0.001f * (float)(i % 300u), 1.0f + 0.001f * (float)(frame % 50u), 0.2f };
        noh_ik_bend bend;
        noh_ik_two_bone(&limb, target, pole, 1.0f, &bend);
        w->seen = bend.start[0];
    }
}

int bench_springs(bench_job *job)
{
    spring_work *w = malloc(sizeof *w);
    bench_cells cells;
    int status = w ? make_work(w) : tool_fail("bench", "out of memory");
    memset(&cells, 0, sizeof cells);
    if (!status) {
        bench_add_cell(&cells, solve, w);
        bench_add_cell(&cells, swing, w);
        status = bench_run_cells(&cells, &job->cpu_clock, job->rounds, SAMPLE_NS, "sim/spring");
    }
    if (!status) {
        bench_add_row(&job->rows, "sim/spring", "two-bone", bench_median(&cells, 0) / SOLVES,
                      bench_median(&cells, 1) / SOLVES, "ns/joint and step", cells.rounds);
    }
    bench_free_cells(&cells);
    for (uint32_t i = 0; w && i < CHARACTERS * CHAINS; i++) free(w->springs[i]);
    free(w);
    return status;
}
