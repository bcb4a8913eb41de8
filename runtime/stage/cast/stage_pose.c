/* stage_pose.c: the second phase of a frame: poses of those that are due, floats and palettes of all that are shown, of
 * one actor after another, while its pose is in the nearest cache. Each job takes actors of its own, samples through
 * its own view of the clips, and writes palettes where the order of drawing has put its actors. */
#include <string.h>

#include "stage/cast/stage_internal.h"
#include "noh/low_motion.h"
#include "stage/character/character_internal.h"
#include "stage/character/lod_internal.h"
#include "motion/clip/clip_view_internal.h"
#include "noh/clip.h"
#include "noh/low_life.h"
#include "noh/deform.h"
#include "noh/noh.h"
#include "noh/modules.h"
#include "noh/low_stage.h"

/* The set of a kind, sampled by a job's own view. */
static noh_clip_set job_set(const noh_stage_job_part *job, const noh_stage_kind *kind)
{
    noh_clip_set set = kind->set;
    if (kind->bank) {
        set.sample = job->views[kind->bank_kind]->clips.sample;
        set.user = job->views[kind->bank_kind]->clips.user;
    }
    return set;
}

/* Get the floats of the clips: the set's floats as shown, then the defaults of the others. A float that no clip moves
 * takes the value of a float with the same name. */
static void take_floats(const noh_stage_kind *k, const noh_character *ch, float *floats)
{
    const uint32_t own = k->bank || (k->modifier_bytes && k->float_count) ? k->set.float_count : 0;
    if (!ch->time.posed) {
        memcpy(floats, k->named.defaults, k->float_count * sizeof *floats);
        return;
    }
    if (own) {
        const float *shown = noh_character_floats(ch, floats);
        if (shown != floats) memcpy(floats, shown, own * sizeof *floats);
    }
    memcpy(floats + own, k->named.defaults + own, (k->float_count - own) * sizeof *floats);
    for (uint32_t f = k->named.first_renamed; f < k->float_count; f++) floats[f] = floats[k->named.sources[f]];
}

static void hold(const noh_stage_kind *k, uint32_t index, float *floats)
{
    const noh_stage_held *held = k->held + (size_t)index * k->desc->held_float_count;
    for (uint32_t h = 0; h < k->desc->held_float_count; h++) {
        if (!(held[h].amount > 0.0f)) continue;
        for (uint32_t f = 0; f < k->float_count; f++) {
            if (f == held[h].index ||
                (k->named.name_hashes[f] == k->named.name_hashes[held[h].index] && k->named.name_hashes[f])) {
                floats[f] = floats[f] * (1.0f - held[h].amount) + held[h].value * held[h].amount;
            }
        }
    }
}

void noh_stage_take_floats(const noh_stage_kind *k, uint32_t index)
{
    float *floats = k->floats + (size_t)index * k->float_count;
    take_floats(k, noh_stage_character(k, index), floats);
    hold(k, index, floats); /* held floats override clips and modules */
    noh_weight_rules_apply(k->targets.weight_rules, k->targets.weight_rule_count, floats);
    if (k->targets.corrective_count) noh_stage_correct(k, index, floats);
}

void noh_stage_move_far_joints(const noh_stage_kind *k, uint32_t index, uint32_t mesh, uint32_t level, float *matrices)
{
    const noh_stage_mesh *m = &k->meshes[mesh];
    const noh_mesh at = noh_mesh_at_lod(&m->mesh, k->plan->levels[level].mesh_levels[mesh]);
    noh_mesh_move_far_joints(&at, k->weights + (size_t)index * k->weight_count + m->first_weight, matrices);
}

/* The weights of all meshes, one after another, without targets whose effect is too small to see. */
static void take_weights(noh_stage *s, const noh_stage_kind *k, noh_stage_actor *a, noh_character *ch,
                         const float *floats, float *weights)
{
    noh_lod_settings settings = s->desc.lod;
    if (a->look.pixels > 0.0f) settings.pixels = a->look.pixels;
    for (uint32_t m = 0; m < k->plan->mesh_count; m++) {
        const noh_stage_mesh *mesh = &k->meshes[m];
        memcpy(weights + mesh->first_weight, floats + mesh->first_float,
               mesh->mesh.header->target_count * sizeof *weights);
    }
    if (k->weight_count && !noh_stage_is_full(s, a)) {
        (void)noh_lod_targets(&ch->lod, &settings, weights, k->target_radii, k->weight_count, weights);
    }
}

static uint64_t late_of(const noh_stage *s, const noh_stage_job_part *job)
{
    uint64_t late = 0;
    for (uint32_t i = 0; i < s->desc.kind_count; i++) {
        if (job->views[i]) late += noh_clip_view_stats_of(job->views[i]->samples).decoded_late;
    }
    return late;
}

/* What the actors of a kind are posed with, one after another. */
typedef struct poser {
    noh_stage_kind *k;
    noh_clip_set set;
    noh_character_scratch scratch;
} poser;

static void open_poser(const noh_stage *s, const noh_stage_job_part *job, noh_stage_kind *k, poser *p)
{
    const noh_character_desc desc = noh_stage_character_desc(k, 0);
    p->k = k;
    p->set = job_set(job, k);
    (void)noh_character_scratch_init(job->scratch, s->scratch_bytes, &desc, &p->scratch, NULL);
}

/* ---- the order of a frame ----
 *
 * Before these, for all actors: noh_stage_step (time, callback keys, root motion, ragdolls' bodies), the game's places
 * (crowd/, crowd.h), noh_stage_look_at (LOD). After these: attached actors, and noh_gl_morph_update, which
 * accumulates targets (noh_stage_frame_end); then what the game draws: actors, marks, hair. */

/* Over clips and graphs, in the order of the slots: the face, so that eyes, blinks, breath and speech are there; the
 * kind's own modifiers in the order of its desc, such as look-at, feet, hands and hair; the ragdoll over them;
 * springs. */
static void modify(const noh_stage_kind *k, uint32_t index, noh_modifier_work *w)
{
    for (uint32_t slot = NOH_SLOT_FACE; slot < NOH_SLOT_COUNT; slot++) {
        const noh_stage_module *m = &k->modules[slot];
        if (!m->type || !m->type->modify) continue;
        w->state = m->states + index * m->stride;
        w->user = m->shared;
        m->type->modify(w);
    }
}

/* The pose: joints and the floats that go with them. Of a wearer, what its garments follow is kept. */
static void pose(const noh_stage *s, const noh_stage_job_part *job, poser *p, uint32_t i)
{
    noh_stage_kind *k = p->k;
    noh_character *ch = noh_stage_character(k, i);
    const int64_t clock = noh_character_pose_clock(ch);
    const int64_t ahead = clock - noh_character_clock(ch);
    const noh_module_type *type = k->modules[NOH_SLOT_SOURCE].type;
    noh_clip_set set = p->set;
    noh_stage_sampler sampler;
    if (type) type->source->sample(s, job, k, i, ahead, 0, &set, &sampler);
    noh_character_update_begin(ch, &set, &p->scratch); /* local poses, blended */
    noh_stage_wear_pose(s, job, k, i, p->scratch.local);
    if (k->modifier_bytes) {
        noh_modifier_work w;
        noh_stage_begin_modifiers(s, job, k, i, clock, &p->scratch, &w);
        modify(k, i, &w);
    }
    if (s->shown[k->first_actor + i].worn)
        memcpy(job->wearer, p->scratch.local, k->skeleton.joint_count * sizeof *job->wearer);
    noh_character_update_end(ch, &k->skeleton, k->skeleton.joint_count ? k->joint_radii : NULL, &p->scratch);
    noh_stage_wear_palette(s, k, i);
}

/* Write weights of targets and palettes, blended from the two latest poses if the actor updates below frame rate. */
static void show(noh_stage *s, noh_stage_job_part *job, noh_stage_kind *k, uint32_t i)
{
    noh_character *ch = noh_stage_character(k, i);
    noh_stage_shown *shown = &s->shown[k->first_actor + i];
    noh_stage_actor *a = &s->actors[k->first_actor + i];
    float error_pixels;
    if (!ch->time.posed) {
        return; /* over budget: not shown yet */
    }
    noh_stage_take_floats(k, i);
    noh_stage_wear_floats(s, k, i);
    if (!a->parent && noh_stage_turns(k)) noh_stage_own_matrix(s, k, a, shown->world);
    if (!a->parent && shown->updates) noh_stage_measure_shown(s, k, i, job->matrices);
    take_weights(s, k, a, ch, k->floats + (size_t)i * k->float_count, k->weights + (size_t)i * k->weight_count);
    if (s->gpu && shown->views) s->desc.gpu->pose(s, k, i, job->matrices); /* palettes; sees when it was shown last */
    shown->frame = s->frame;
    error_pixels = a->parent ? 0.0f : noh_stage_error_pixels(s, k, i);
    if (error_pixels > job->error_pixels) job->error_pixels = error_pixels;
}

/* Pose an actor if it is due, and show it. */
static void pose_and_show(noh_stage *s, noh_stage_job_part *job, poser *p, uint32_t index)
{
    noh_stage_kind *of = noh_stage_kind_of(s, index);
    const noh_stage_shown *shown = &s->shown[index];
    if (of != p->k) {
        open_poser(s, job, of, p);
    }
    if (shown->updates) {
        pose(s, job, p, index - of->first_actor);
        job->updated++;
    }
    if (shown->views || shown->updates || s->actors[index].look.posed) show(s, job, of, index - of->first_actor);
}

static void keep_time(const noh_stage *s, uint32_t garment, uint32_t wearer)
{
    const noh_stage_kind *k = noh_stage_kind_of(s, garment), *of = noh_stage_kind_of(s, wearer);
    noh_character_keep_time(noh_stage_character(k, garment - k->first_actor),
                            noh_stage_character(of, wearer - of->first_actor));
}

void noh_stage_pose_todo(noh_stage *s, uint32_t number, uint32_t first, uint32_t end)
{
    noh_stage_job_part *job = &s->jobs[number];
    poser p;
    const uint64_t late = late_of(s, job);
    p.k = NULL;
    job->updated = 0;
    job->error_pixels = 0.0f;
    for (uint32_t t = first; t < end; t++) {
        const uint32_t index = s->todo[t], worn = s->shown[index].worn;
        for (uint32_t g = worn; g; g = s->shown[g - 1u].next_worn) keep_time(s, g - 1u, index);
        pose_and_show(s, job, &p, index);
        for (uint32_t g = worn; g; g = s->shown[g - 1u].next_worn) pose_and_show(s, job, &p, g - 1u);
    }
    job->decoded_late = late_of(s, job) - late;
}
