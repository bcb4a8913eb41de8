/* crowd_place.c: what is measured once, and where everybody stands and what they play. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "crowd.h"

#define NEAREST_M 1.5f
#define HALF_ANGLE_RAD 0.68f /* somewhat more than a view of 16 : 9 shows */
#define BEHIND 8u            /* every eighth stands behind the camera */
#define SAMPLE_TICKS 1600u
#define POINTS 128u          /* vertices by which the errors of rates are measured */
#define BETWEEN 1.02f        /* what a sphere grows by, for what lies between two samples */

/* ---- measuring ---- */

static void to_joint(const float *inverse_bind, const float position[3], float place[3])
{
    for (int r = 0; r < 3; r++) {
        const float *row = inverse_bind + 4 * r;
        place[r] = row[0] * position[0] + row[1] * position[1] + row[2] * position[2] + row[3];
    }
}

/* For each joint the farthest vertex that hangs on it, moved by the farthest target; below 0: none does. */
static void measure_margins(crowd *c)
{
    const crowd_plan *p = c->plan;
    float farthest = 0.0f;
    for (uint32_t t = 0; t < p->mesh.header->target_count; t++) {
        c->reach_m[t] = p->mesh.targets[t].max_displacement;
        farthest = c->reach_m[t] > farthest ? c->reach_m[t] : farthest;
    }
    for (uint32_t j = 0; j < c->skeleton.joint_count; j++) {
        c->margin_m[j] = -1.0f;
    }
    for (uint32_t v = 0; v < p->mesh.header->vertex_count; v++) {
        uint32_t joints[NOH_INFLUENCES_MAX];
        float weights[NOH_INFLUENCES_MAX];
        const uint32_t count = noh_mesh_influences(&p->mesh, v, joints, weights);
        for (uint32_t k = 0; k < count; k++) {
            const uint32_t j = p->skin.joints[joints[k]];
            float place[3], margin;
            if (weights[k] > 0.0f) {
                to_joint(p->skin.inverse_bind + 12u * (size_t)joints[k], p->mesh.positions + 3u * (size_t)v, place);
                margin = farthest + sqrtf(place[0] * place[0] + place[1] * place[1] + place[2] * place[2]);
                c->margin_m[j] = margin > c->margin_m[j] ? margin : c->margin_m[j];
            }
        }
    }
}

/* Vertices of the coarsest level, evenly out of all: they are the first ones of the mesh. holds[POINTS][NOH_INFLUENCES_MAX] */
static noh_time_points choose_points(const crowd_plan *p, noh_time_hold *holds)
{
    const noh_mesh coarsest = noh_mesh_at_level(&p->mesh, p->level_count - 1u);
    const uint32_t count = coarsest.header->vertex_count < POINTS ? coarsest.header->vertex_count : POINTS;
    const noh_time_points points = { holds, count, NOH_INFLUENCES_MAX };
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t v = (uint32_t)((uint64_t)i * coarsest.header->vertex_count / count);
        uint32_t joints[NOH_INFLUENCES_MAX];
        float weights[NOH_INFLUENCES_MAX];
        const uint32_t used = noh_mesh_influences(&p->mesh, v, joints, weights);
        for (uint32_t k = 0; k < used; k++) {
            noh_time_hold *h = &holds[i * NOH_INFLUENCES_MAX + k];
            h->joint = p->skin.joints[joints[k]];
            h->weight = weights[k];
            to_joint(p->skin.inverse_bind + 12u * (size_t)joints[k], p->mesh.positions + 3u * (size_t)v, h->place);
        }
    }
    return points;
}

static int measure_all(crowd *c, void *memory, size_t bytes, const noh_time_probe *probe, noh_time_hold *holds)
{
    const noh_time_points points = choose_points(c->plan, holds);
    noh_error error = { NOH_OK, "", 0, 0 };
    for (uint32_t m = 0; m < c->anim.motion_count; m++) {
        float *errors = c->rate_error_m + NOH_RATE_COUNT * (size_t)m;
        if (noh_time_points_measure(memory, bytes, probe, &points, m, errors, &error)) {
            return tool_fail_error("crowd", &error);
        }
    }
    return 0;
}

/* The errors of rates. A converter does this once; here it is done when the pack is loaded. */
static int measure_rates(crowd *c)
{
    noh_time_probe probe;
    size_t bytes;
    noh_time_hold *holds = calloc(POINTS * NOH_INFLUENCES_MAX, sizeof *holds);
    void *memory;
    int status;
    memset(&probe, 0, sizeof probe);
    probe.set = &c->anim;
    probe.skeleton = &c->skeleton;
    probe.float_reach_m = c->floats;
    bytes = noh_time_points_size(&probe);
    memory = malloc(bytes);
    memset(c->floats, 0, c->anim.float_count * sizeof *c->floats);
    if (c->first_weight != NOH_NONE) {
        memcpy(c->floats + c->first_weight, c->reach_m, c->plan->mesh.header->target_count * sizeof *c->floats);
    }
    status = memory && holds ? measure_all(c, memory, bytes, &probe, holds) : tool_fail("crowd", "out of memory");
    free(memory);
    free(holds);
    return status;
}

static int make_table(crowd *c)
{
    const crowd_plan *p = c->plan;
    noh_error error = { NOH_OK, "", 0, 0 };
    for (uint32_t i = 0; i < p->level_count; i++) {
        const noh_mesh level = noh_mesh_at_level(&p->mesh, i);
        c->levels[i].vertex_count = level.header->vertex_count;
        c->levels[i].triangle_count = level.header->index_count / 3u;
        c->levels[i].influence_count = level.header->influence_count;
        c->levels[i].error_m = crowd_level_error(&level);
    }
    c->table.meshes = c->levels;
    c->table.mesh_level_count = p->level_count;
    c->table.rate_error_m = c->rate_error_m;
    c->settings.pixels = p->options.pixels;
    return noh_detail_table_check(&c->table, &error) || noh_detail_settings_check(&c->settings, &error) ? tool_fail_error(c->file->path, &error)
                                                                                                     : 0;
}

/* One sphere that holds every pose of every clip: what is culled by before there is a pose. Its centre is over the
 * place where a body stands. */
static void measure_sphere(crowd *c)
{
    noh_bounds b;
    noh_local_to_model(&c->skeleton, c->skeleton.bind_pose, c->skeleton.joint_count, c->scratch.model);
    noh_sphere_of_joints(&c->skeleton, c->scratch.model, c->margin_m, c->skeleton.joint_count, &b);
    c->sphere[1] = b.centre[1];
    for (uint32_t m = 0; m < c->anim.motion_count; m++) {
        for (uint32_t tick = 0; tick <= c->motions[m].duration_ticks; tick += SAMPLE_TICKS) {
            float way[3], reach;
            noh_root_sample_rest(&c->anim, m, tick, c->anim.joint_count, c->scratch.local, c->scratch.floats);
            noh_local_to_model(&c->skeleton, c->scratch.local, c->anim.joint_count, c->scratch.model);
            noh_sphere_of_joints(&c->skeleton, c->scratch.model, c->margin_m, c->anim.joint_count, &b);
            for (int i = 0; i < 3; i++) {
                way[i] = b.centre[i] - c->sphere[i];
            }
            reach = (sqrtf(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]) + b.radius) * BETWEEN;
            c->sphere[3] = reach > c->sphere[3] ? reach : c->sphere[3];
        }
    }
}

/* ---- placing ---- */

/* Steps of sequences that fill a square evenly, together, and a line (powers of the plastic and the golden ratio). */
#define SPREAD_X 3242174889u
#define SPREAD_Y 2447445414u
#define SPREAD_LINE 2654435769u

static float spread(uint32_t n, uint32_t step)
{
    return (float)((n * step) >> 8) / 16777216.0f;
}

void crowd_move(crowd *c, uint32_t body, float x, float z, float heading_rad)
{
    crowd_body *b = &c->bodies[body];
    const float sine = sinf(heading_rad), cosine = cosf(heading_rad);
    const float world[12] = { cosine, 0.0f, sine, x, 0.0f, 1.0f, 0.0f, 0.0f, -sine, 0.0f, cosine, z };
    memcpy(b->world, world, sizeof world);
    b->centre[0] = x;
    b->centre[1] = c->sphere[1];
    b->centre[2] = z;
}

static int moves_joints(const crowd *c, uint32_t motion)
{
    return (c->motions[motion].flags & NOH_MOTION_NO_JOINTS) == 0;
}

/* The n-th, counted round and round, of the motions that move joints, or of those that move none; NOH_NONE: none. */
static uint32_t nth_motion(const crowd *c, uint32_t n, int joints)
{
    uint32_t count = 0, m = 0;
    for (uint32_t i = 0; i < c->anim.motion_count; i++) {
        count += moves_joints(c, i) == joints;
    }
    if (count == 0) {
        return NOH_NONE;
    }
    for (n %= count; moves_joints(c, m) != joints || n-- > 0; m++) {
    }
    return m;
}

static void start(crowd *c, uint32_t body, uint32_t track, uint32_t motion)
{
    noh_track_desc d;
    if (motion == NOH_NONE) {
        return;
    }
    memset(&d, 0, sizeof d);
    d.motion = motion;
    d.position_ticks = (int64_t)(spread(body + 1u, SPREAD_Y) * 1e6f);
    d.speed = (int32_t)((0.8f + 0.4f * spread(body + 1u, SPREAD_LINE)) * 65536.0f);
    noh_controller_start(noh_character_controller(crowd_character(c, body)), &c->anim, track, &d, NULL);
}

static void place_body(crowd *c, uint32_t i)
{
    float distance_m = NEAREST_M + (CROWD_FIELD_M - NEAREST_M) * sqrtf(spread(i + 1u, SPREAD_X));
    float angle = (2.0f * spread(i + 1u, SPREAD_Y) - 1.0f) * HALF_ANGLE_RAD;
    float side = i % BEHIND == BEHIND - 1u ? 1.0f : -1.0f;
    crowd_move(c, i, distance_m * sinf(angle), side * distance_m * cosf(angle), 6.2831853f * spread(i + 1u, SPREAD_LINE));
    start(c, i, 0, nth_motion(c, i, 1));
    start(c, i, 1, nth_motion(c, i / 3u, 0));
}

int crowd_place(crowd *c)
{
    const float *given = c->plan->options.rate_error_m;
    int status;
    measure_margins(c);
    measure_sphere(c);
    if (given) {
        memcpy(c->rate_error_m, given, c->anim.motion_count * NOH_RATE_COUNT * sizeof *given);
    }
    status = given || c->plan->options.plain ? 0 : measure_rates(c);
    if (!status) status = make_table(c);
    for (uint32_t i = 0; i < c->plan->options.count && !status; i++) {
        place_body(c, i);
    }
    return status;
}
