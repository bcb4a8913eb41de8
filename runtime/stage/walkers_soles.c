/* walkers_soles.c: where the soles of a walker's clips are, and the foot that it stands on. */
#include <string.h>

#include "anim/controller_pose.h"
#include "pose/local_to_model.h"
#include "stage/walkers_internal.h"

#define LOWER 0.0004f /* of a leg: lower by so much, and it stands on the other foot */

/* ---- init ---- */

/* The heel, the ball and the toes: the middle of both sides, at the height of the lower one. */
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
    return leg * WALKER_PARTS + part;
}
