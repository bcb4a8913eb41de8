/* walkers_soles.c: the soles in a walker's clips, and the foot it stands on. */
#include <string.h>

#include "motion/anim/root_motion_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/crowd.h"
#include "noh/low_stage.h"
#include "noh/noh.h"
#include "stage/actors/walkers_internal.h"
#include "stage/character/character_internal.h"

#define LOWER 0.0004f   /* leg lengths: changes to the other foot if that is lower by this */
#define AIR_FROM 0.002f /* leg lengths above the standing foot: a foot starts to be in the air, */
#define AIR_TO 0.008f   /* and is free */

/* ---- init ---- */

/* Heel, ball and toes: halfway between both sides, at the height of the lower one. */
static void parts_of(const noh_feet_leg *leg, const float *model, float parts[WALKER_PARTS][3])
{
    for (uint32_t p = 0; p < NOH_FEET_POINTS; p++) {
        const noh_feet_point *point = &leg->points[p];
        const float *m = model + 12u * point->joint, *at = point->at;
        float *part = parts[p / 2u], here[3];
        for (int i = 0; i < 3; i++) {
            here[i] = m[4 * i] * at[0] + m[4 * i + 1] * at[1] + m[4 * i + 2] * at[2] + m[4 * i + 3];
        }
        part[0] = p % 2u ? 0.5f * (part[0] + here[0]) : here[0];
        part[1] = p % 2u && part[1] < here[1] ? part[1] : here[1];
        part[2] = p % 2u ? 0.5f * (part[2] + here[2]) : here[2];
    }
}

/* How far a leg is ahead of the other and above it, summed over its parts. */
static void ahead_of(const noh_walkers *w, uint32_t clip, uint32_t i, uint32_t leg, float *ahead, float *above)
{
    float middle[2] = { 0.0f, 0.0f }, low[2] = { 1e30f, 1e30f };
    for (uint32_t n = 0; n < 2u * WALKER_PARTS; n++) {
        const uint32_t other = n / WALKER_PARTS;
        const float *at = w->soles[clip].at[i][other ? 1u - leg : leg][n % WALKER_PARTS];
        middle[other] += at[0] * w->forward[0] + at[2] * w->forward[1];
        low[other] = at[1] < low[other] ? at[1] : low[other];
    }
    *ahead = middle[0] - middle[1];
    *above = low[0] - low[1];
}

float noh_walkers_pass_at(const noh_walkers *w, uint32_t leg, uint32_t i)
{
    float rest, before, after, above;
    ahead_of(w, WALKER_IDLE, 0, leg, &rest, &above);
    ahead_of(w, WALKER_WALK, i, leg, &before, &above);
    ahead_of(w, WALKER_WALK, i + 1u, leg, &after, &above);
    return ((float)i + (rest - before) / (after - before)) / (float)WALKER_SWAY;
}

/* Find where a swinging leg is as far ahead of the other as in standing: once in each of its steps. */
static uint32_t find_passes(const noh_walkers *w, uint32_t leg)
{
    uint32_t passes = 0;
    float rest, ahead, above, before, above_before;
    ahead_of(w, WALKER_IDLE, 0, leg, &rest, &above);
    ahead_of(w, WALKER_WALK, 0, leg, &before, &above_before);
    for (uint32_t i = 0; i < WALKER_SWAY; i++, before = ahead, above_before = above) {
        ahead_of(w, WALKER_WALK, i + 1u, leg, &ahead, &above);
        const float lower = above < above_before ? above : above_before;
        if (before < rest && ahead >= rest && lower >= AIR_TO * w->leg) passes |= 1u << i;
    }
    return passes;
}

static void know_steps(noh_walkers *w)
{
    if (w->leg_count != 2u || w->clips[WALKER_IDLE].clip == NOH_NONE) return;
    for (uint32_t l = 0; l < 2u; l++) w->passes[l] = find_passes(w, l);
    w->knows_steps = w->passes[0] && w->passes[1] ? 1u : 0u;
}

void noh_walkers_measure_soles(noh_walkers *w, noh_stage *stage, const noh_stage_kind *k, const noh_feet_rig *rig)
{
    const noh_character_desc desc = noh_stage_character_desc(k, 0);
    noh_character_scratch scratch;
    const uint32_t joints = k->set.joint_count;
    if (rig->last >= joints || rig->leg_count < 2u || !(rig->length > 0.0f) ||
        noh_character_scratch_init(stage->jobs[0].scratch, stage->scratch_bytes, &desc, &scratch, NULL)) {
        return;
    }
    w->leg_count = rig->leg_count;
    w->leg = rig->length;
    for (uint32_t c = 0; c < WALKER_CLIPS; c++) {
        if (w->clips[c].clip == NOH_NONE) continue;
        for (uint32_t i = 0; i <= WALKER_SWAY; i++) {
            const uint32_t tick = (uint32_t)((uint64_t)w->clips[c].ticks * i / WALKER_SWAY);
            noh_root_sample_rest(&k->set, w->clips[c].clip, tick, joints, scratch.local, scratch.floats);
            noh_local_to_model(&k->skeleton, scratch.local, joints, scratch.model);
            for (uint32_t l = 0; l < rig->leg_count; l++) parts_of(&rig->legs[l], scratch.model, w->soles[c].at[i][l]);
        }
    }
    know_steps(w);
}

/* ---- a step ---- */

void noh_walkers_soles_at(const noh_walkers *w, const float shares[WALKER_CLIPS], const float weights[WALKER_CLIPS],
                          walker_feet *feet)
{
    memset(feet, 0, sizeof *feet);
    for (uint32_t c = 0; c < WALKER_CLIPS; c++) {
        if (!(weights[c] > 0.0f)) continue;
        const float at = shares[c] * (float)WALKER_SWAY;
        const uint32_t i = at < (float)(WALKER_SWAY - 1u) ? (uint32_t)at : WALKER_SWAY - 1u;
        const float part = at - (float)i;
        const float *from = &w->soles[c].at[i][0][0][0], *to = &w->soles[c].at[i + 1u][0][0][0];
        float *sum = &feet->at[0][0][0];
        for (uint32_t n = 0; n < NOH_FEET_LEGS_MAX * WALKER_PARTS * 3u; n++)
            sum[n] += weights[c] * (from[n] + part * (to[n] - from[n]));
    }
}

static uint32_t lowest_of(const float parts[WALKER_PARTS][3])
{
    uint32_t lowest = 0;
    for (uint32_t p = 1; p < WALKER_PARTS; p++) lowest = parts[p][1] < parts[lowest][1] ? p : lowest;
    return lowest;
}

/* The part on the ground that is nearest to the axis of the body: the walker turns about it, and it stays in place. */
static uint32_t pivot_of(const float parts[WALKER_PARTS][3], float slack)
{
    const uint32_t lowest = lowest_of(parts);
    uint32_t nearest = lowest;
    float least = 1e30f;
    for (uint32_t p = 0; p < WALKER_PARTS; p++) {
        const float square = parts[p][0] * parts[p][0] + parts[p][2] * parts[p][2];
        if (parts[p][1] > parts[lowest][1] + slack || square >= least) continue;
        least = square;
        nearest = p;
    }
    return nearest;
}

uint32_t noh_walkers_stand(const noh_walkers *w, const walker_feet *feet, uint32_t was)
{
    uint32_t leg = was / WALKER_PARTS % NOH_FEET_LEGS_MAX, part = lowest_of(feet->at[leg]);
    for (uint32_t l = 0; l < w->leg_count; l++) {
        const uint32_t other = lowest_of(feet->at[l]);
        if (feet->at[l][other][1] < feet->at[leg][part][1] - LOWER * w->leg) {
            leg = l;
            part = other;
        }
    }
    return leg * WALKER_PARTS + pivot_of(feet->at[leg], LOWER * w->leg);
}

float noh_walkers_free(const noh_walkers *w, const walker_feet *feet, uint32_t stands)
{
    const uint32_t leg = stands / WALKER_PARTS, other = 1u - leg;
    const float above = feet->at[other][lowest_of(feet->at[other])][1] - feet->at[leg][stands % WALKER_PARTS][1];
    const float part = (above - AIR_FROM * w->leg) / ((AIR_TO - AIR_FROM) * w->leg);
    return part < 0.0f ? 0.0f : part > 1.0f ? 1.0f : part;
}
