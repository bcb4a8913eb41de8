/* drop_scene.c: ragdolls thrown at random, each from its own height over one floor. Dolls do not meet each other. */

#include "drop_scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "life/physics/ragdoll_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/low_life.h"
#include "cli/message.h"
#include "platform.h"

#define FRICTION 0.6f
#define HEIGHT \
    1.5f           /* of the first body, metres; of characters that reach further from it, a tenth more than they do \
                     */
#define SPEED 3.0f /* metres per second, sideways */

/* -1..1; xorshift */
static float random_float(uint32_t *state)
{
    *state ^= *state << 13;
    *state ^= *state >> 17;
    *state ^= *state << 5;
    return (float)(*state >> 8) / 8388608.0f - 1.0f;
}

/* ---- the rig ---- */

static int make_rig(const pack_file *file, noh_ragdoll_rig *rig)
{
    noh_ragdoll_source source = { .pack = &file->pack };
    noh_ragdoll_row rows[NOH_RAGDOLL_BODIES_MAX];
    const noh_skeleton_header *header;
    noh_error error = { NOH_OK, "", 0, 0 };
    uint32_t count;
    if (noh_pack_skeleton_at(&file->pack, 0, &source.joints, &header, &error)) {
        return tool_fail(file->path, "the pack has no skeleton, and so no ragdoll");
    }
    source.metres = header->unit_cm / 100.0f;
    if (noh_ragdoll_find_rows(&source, rows, &count, &error) ||
        noh_ragdoll_rig_make(&source, rows, count, rig, &error)) {
        return tool_fail_error(file->path, &error);
    }
    return 0;
}

int drop_scene_can(const pack_file *file)
{
    noh_ragdoll_source source = { .pack = &file->pack };
    noh_ragdoll_row rows[NOH_RAGDOLL_BODIES_MAX];
    uint32_t count;
    return noh_pack_skeleton_at(&file->pack, 0, &source.joints, NULL, NULL) == NOH_OK &&
           noh_ragdoll_find_rows(&source, rows, &count, NULL) == NOH_OK;
}

/* ---- throws ---- */

static void random_rotation(uint32_t *state, float q[4])
{
    float square = 0.0f;
    while (square < 0.01f || square > 1.0f) { /* even over all rotations */
        square = 0.0f;
        for (int i = 0; i < 4; i++) {
            q[i] = random_float(state);
            square += q[i] * q[i];
        }
    }
    noh_quat_normalize(q);
}

/* From the first body to the farthest end of another. */
static float reach_of(const noh_ragdoll_rig *rig)
{
    float reach = 0.0f;
    for (uint32_t i = 0; i < rig->body_count; i++) {
        const noh_ragdoll_body *b = &rig->bodies[i];
        float square = 0.0f;
        for (int k = 0; k < 3; k++) {
            const float d = b->position[k] - rig->bodies[0].position[k];
            square += d * d;
        }
        const float far = sqrtf(square) + b->half + b->radius;
        reach = far > reach ? far : reach;
    }
    return reach;
}

static void throw_doll(drop_scene *s, uint32_t doll, uint32_t *state)
{
    noh_ragdoll_pose poses[NOH_RAGDOLL_BODIES_MAX];
    noh_ragdoll_motion motions[NOH_RAGDOLL_BODIES_MAX];
    const noh_ragdoll_body *first = &s->rig.bodies[0];
    const float reach = reach_of(&s->rig), height = 1.1f * reach > HEIGHT ? 1.1f * reach : HEIGHT;
    float turn[4], speed[3] = { 0.0f, 0.0f, 0.0f };
    random_rotation(state, turn);
    speed[0] = SPEED * random_float(state);
    speed[2] = SPEED * random_float(state);
    memset(motions, 0, sizeof motions);
    for (uint32_t i = 0; i < s->rig.body_count; i++) {
        const uint32_t column = doll % 4u, row = doll / 4u;
        const noh_ragdoll_body *b = &s->rig.bodies[i];
        for (int k = 0; k < 3; k++) poses[i].position[k] = b->position[k] - first->position[k];
        noh_quat_rotate(turn, poses[i].position, poses[i].position);
        poses[i].position[0] += 2.0f * (float)column - 3.0f;
        poses[i].position[1] += height;
        poses[i].position[2] += 2.0f * (float)row - 3.0f;
        noh_quat_mul(turn, b->rotation, poses[i].rotation);
        memcpy(motions[i].velocity, speed, sizeof speed);
    }
    (void)noh_ragdoll_place(s->set, doll, poses, motions, NULL);
}

int drop_scene_open(drop_scene *s, const pack_file *file, uint32_t dolls, double seconds, uint32_t substeps,
                    uint32_t seed)
{
    const noh_ragdolls_desc desc = { &s->rig, dolls, substeps, 0 };
    noh_error error = { NOH_OK, "", 0, 0 };
    uint32_t state = seed * 2654435761u + 0x9e3779b9u;
    int status;
    void *memory;
    memset(s, 0, sizeof *s);
    status = make_rig(file, &s->rig);
    if (status) return status;
    s->bytes = noh_ragdolls_size(&desc);
    memory = malloc(s->bytes);
    if (!memory) return tool_fail(file->path, "out of memory");
    if (noh_ragdolls_init(memory, s->bytes, &desc, &s->set, &error)) {
        free(memory);
        return tool_fail_error(file->path, &error);
    }
    s->dolls = dolls;
    s->steps = (uint32_t)(seconds * 60.0 + 0.5);
    s->floor.normal[1] = 1.0f;
    s->world.planes = &s->floor;
    s->world.plane_count = 1;
    s->world.friction = FRICTION;
    for (uint32_t i = 0; i < dolls; i++) {
        state = state ? state : 1u;
        throw_doll(s, i, &state);
    }
    return 0;
}

void drop_scene_close(drop_scene *s)
{
    free(s->set);
    s->set = NULL;
}

/* ---- steps ---- */

static void keep_larger(float *most, float value)
{
    *most = value > *most ? value : *most;
}

static void measure(drop_scene *s)
{
    for (uint32_t i = 0; i < s->dolls; i++) {
        noh_ragdoll_measures m;
        noh_ragdoll_measure(s->set, i, &s->world, &m);
        keep_larger(&s->worst.limit, m.limit);
        keep_larger(&s->worst.penetration, m.penetration);
        keep_larger(&s->worst.separation, m.separation);
        s->separation_sum += (double)m.separation;
    }
}

void drop_scene_step(drop_scene *s)
{
    const uint32_t awake = s->dolls - drop_scene_asleep(s);
    const uint64_t start = noh_thread_clock_ns();
    (void)noh_ragdolls_step(s->set, &s->world, NOH_RAGDOLL_STEP_TICKS);
    s->cpu_ns += (double)(noh_thread_clock_ns() - start);
    s->step++;
    measure(s);
    s->awake_steps += awake;
    s->settled = awake ? (double)s->step / 60.0 : s->settled;
    s->worst.separation_mean = (float)(s->separation_sum / ((double)s->step * s->dolls));
}

uint32_t drop_scene_asleep(const drop_scene *s)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < s->dolls; i++) count += noh_ragdoll_sleeps(s->set, i) ? 1u : 0u;
    return count;
}

uint32_t drop_scene_hash(const drop_scene *s)
{
    uint32_t hash = 2166136261u;
    for (uint32_t i = 0; i < s->dolls; i++) {
        noh_ragdoll_pose poses[NOH_RAGDOLL_BODIES_MAX];
        const uint8_t *bytes = (const uint8_t *)poses;
        noh_ragdoll_bodies(s->set, i, poses);
        for (size_t k = 0; k < s->rig.body_count * sizeof *poses; k++) hash = (hash ^ bytes[k]) * 16777619u;
    }
    return hash;
}
