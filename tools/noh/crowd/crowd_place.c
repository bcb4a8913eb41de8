/* crowd_place.c: the errors that the pack states, and the places and clips of the bodies. */
#include <math.h>
#include <string.h>

#include "crowd.h"
#include "cli/message.h"

#define NEAREST_M 1.5f
#define HALF_ANGLE_RAD 0.68f /* a little more than a 16 : 9 view shows */
#define BEHIND 8u            /* every eighth body is behind the camera */
#define SAMPLE_TICKS 1600u
#define BETWEEN 1.02f /* enlarges a sphere for the motion between two samples */

/* ---- LOD ---- */

/* Update rate errors of the clips as the crowd plays them. The pack states those of a clip that is played once and
 * stops. Here such clips play ping-pong: at a turn the velocity reverses instead of stopping, and the error of an
 * extrapolated pose doubles. The error at a clip's beginning is not in the pack and is taken to be no larger than that
 * at its end. */
static void read_rates(crowd *c)
{
    for (uint32_t m = 0; m < c->set.clip_count; m++) {
        const float turns = c->clips[m].loop == NOH_LOOP_PING_PONG ? 2.0f : 1.0f;
        for (uint32_t r = 0; r < NOH_UPDATE_RATE_COUNT; r++) {
            const size_t at = NOH_UPDATE_RATE_COUNT * (size_t)m + r;
            c->update_error_m[at] = c->lod.table.update_error_m[at] * turns;
        }
    }
}

static int read_lod(crowd *c, void *memory)
{
    const crowd_plan *p = c->plan;
    const noh_lod_pack_desc desc = crowd_lod_desc(p, c->bank);
    noh_error error = { NOH_OK, "", 0, 0 };
    if (noh_lod_pack_init(memory, p->lod_bytes, &desc, &c->lod, &error)) {
        return tool_fail_error(c->file->path, &error);
    }
    read_rates(c);
    c->table = c->lod.table;
    c->table.update_error_m = c->update_error_m;
    c->settings.pixels = p->options.pixels;
    return noh_lod_table_check(&c->table, &error) || noh_lod_settings_check(&c->settings, &error)
               ? tool_fail_error(c->file->path, &error)
               : 0;
}

/* One sphere around every pose of every clip, so that bodies are culled without being posed. Its centre is above the
 * body's place, at the height of the bind pose's; the radius is the largest at any sample of any clip. */
static void measure_sphere(crowd *c)
{
    noh_bounds b;
    noh_local_to_model(&c->skeleton, c->skeleton.bind_pose, c->skeleton.joint_count, c->scratch.model);
    noh_joint_bounds(&c->skeleton, c->scratch.model, c->lod.joint_radius_m, c->skeleton.joint_count, &b);
    c->sphere[1] = b.centre[1];
    for (uint32_t m = 0; m < c->set.clip_count; m++) {
        for (uint32_t tick = 0; tick <= c->clips[m].duration_ticks; tick += SAMPLE_TICKS) {
            float way[3], reach;
            noh_root_sample_rest(&c->set, m, tick, c->set.joint_count, c->scratch.local, c->scratch.floats);
            noh_local_to_model(&c->skeleton, c->scratch.local, c->set.joint_count, c->scratch.model);
            noh_joint_bounds(&c->skeleton, c->scratch.model, c->lod.joint_radius_m, c->set.joint_count, &b);
            for (int i = 0; i < 3; i++) {
                way[i] = b.centre[i] - c->sphere[i];
            }
            reach = (sqrtf(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]) + b.radius) * BETWEEN;
            c->sphere[3] = reach > c->sphere[3] ? reach : c->sphere[3];
        }
    }
}

/* ---- placing ---- */

/* Steps of additive recurrences n * step mod 2^32: X and Y together fill a square evenly (1/p and 1/p^2, p the plastic
 * number: M. Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018), LINE an interval (1/phi). */
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

static int moves_joints(const crowd *c, uint32_t clip)
{
    return (c->clips[clip].flags & NOH_CLIP_FLOATS_ONLY) == 0;
}

/* The n-th clip, modulo their count, of those with joints (joints 1) or of those without (0); NOH_NONE: there is none.
 */
static uint32_t nth_clip(const crowd *c, uint32_t n, int joints)
{
    uint32_t count = 0, m = 0;
    for (uint32_t i = 0; i < c->set.clip_count; i++) {
        count += moves_joints(c, i) == joints;
    }
    if (count == 0) {
        return NOH_NONE;
    }
    for (n %= count; moves_joints(c, m) != joints || n-- > 0; m++) {}
    return m;
}

static void start(crowd *c, uint32_t body, uint32_t track, uint32_t clip)
{
    noh_track_desc d;
    if (clip == NOH_NONE) {
        return;
    }
    memset(&d, 0, sizeof d);
    d.clip = clip;
    d.position_ticks = (int64_t)(spread(body + 1u, SPREAD_Y) * 1e6f);
    d.speed = (int32_t)((0.8f + 0.4f * spread(body + 1u, SPREAD_LINE)) * 65536.0f);
    noh_controller_start(noh_character_controller(crowd_character(c, body)), &c->set, track, &d, NULL);
}

static void place_body(crowd *c, uint32_t i)
{
    float distance_m = NEAREST_M + (CROWD_FIELD_M - NEAREST_M) * sqrtf(spread(i + 1u, SPREAD_X));
    float angle = (2.0f * spread(i + 1u, SPREAD_Y) - 1.0f) * HALF_ANGLE_RAD;
    float side = i % BEHIND == BEHIND - 1u ? 1.0f : -1.0f;
    crowd_move(c, i, distance_m * sinf(angle), side * distance_m * cosf(angle),
               6.2831853f * spread(i + 1u, SPREAD_LINE));
    start(c, i, 0, nth_clip(c, i, 1));
    start(c, i, 1, nth_clip(c, i / 3u, 0));
}

int crowd_place(crowd *c, void *memory)
{
    const int status = read_lod(c, memory);
    if (!status) {
        measure_sphere(c);
    }
    for (uint32_t i = 0; i < c->plan->options.count && !status; i++) {
        place_body(c, i);
    }
    return status;
}
