/* stage_targets.c: rules and correctives of a kind's meshes, over what an actor's floats are in the end, whether clips,
 * faces, parts or the game say it. Rules go first, since correctives follow from weights that are shown. A corrective
 * that is held keeps what it is held at. */
#include "life/face/recipe_internal.h"
#include "stage/cast/stage_internal.h"
#include "noh/low_life.h"

void noh_stage_open_weight_rules(noh_stage_kind *k, uint32_t rule_max)
{
    uint32_t count = 0;
    for (uint32_t m = 0; m < k->plan->mesh_count && rule_max; m++) {
        const noh_stage_mesh *mesh = &k->meshes[m];
        noh_weight_rule *rules = k->targets.weight_rules + count;
        const uint32_t left = rule_max - count;
        const uint32_t own = k->desc->weight_rules ? noh_weight_rules_bind(&mesh->mesh, rules, left)
                                                   : noh_expressions_bind(&mesh->mesh, rules, left);
        for (uint32_t i = count; i < count + own; i++) {
            k->targets.weight_rules[i].target = (uint16_t)(k->targets.weight_rules[i].target + mesh->first_float);
            k->targets.weight_rules[i].other = (uint16_t)(k->targets.weight_rules[i].other + mesh->first_float);
        }
        count += own;
    }
    k->targets.weight_rule_count = count;
}

void noh_stage_open_correctives(noh_stage_kind *k, uint32_t term_max)
{
    uint32_t count = 0;
    for (uint32_t m = 0; m < k->plan->mesh_count; m++) {
        const noh_stage_mesh *mesh = &k->meshes[m];
        const uint32_t own = noh_correctives_bind(&mesh->mesh, k->targets.correctives + count, term_max - count);
        for (uint32_t i = count; i < count + own; i++) {
            k->targets.correctives[i].target = (uint16_t)(k->targets.correctives[i].target + mesh->first_float);
            k->targets.correctives[i].driver = (uint16_t)(k->targets.correctives[i].driver + mesh->first_float);
        }
        count += own;
    }
    k->targets.corrective_count = count;
}

float noh_stage_keep_held(const noh_stage_kind *k, uint32_t index, uint32_t target, float value)
{
    const noh_stage_held *held = k->held + (size_t)index * k->desc->held_float_count;
    for (uint32_t h = 0; h < k->desc->held_float_count; h++) {
        if (!(held[h].amount > 0.0f)) continue;
        if (target != held[h].index && k->named.name_hashes[target] != k->named.name_hashes[held[h].index]) continue;
        value = value * (1.0f - held[h].amount) + held[h].value * held[h].amount;
    }
    return value;
}

void noh_stage_correct(const noh_stage_kind *k, uint32_t index, float *floats)
{
    noh_correctives_apply(k->targets.correctives, k->targets.corrective_count, floats);
    for (uint32_t i = 0; i < k->targets.corrective_count; i++) {
        const uint32_t target = k->targets.correctives[i].target;
        if (i && k->targets.correctives[i - 1u].target == target) continue;
        floats[target] = noh_stage_keep_held(k, index, target, floats[target]);
    }
}
