/* weight_rule.c: turns rows of a pack's recipe that limit targets into rules, and applies them. The channel of such a
 * row is `range-min` or `range-max`; '-' and the name of the opposite; '=' and the name of its group's first target;
 * ':' and the name of an expression; or `binary`. */
#include "noh/base.h"
#include "noh/format.h"
#include "noh/low_life.h"
#include "noh/pack.h"

#include "core/base/assert_internal.h"
#include "core/base/name_internal.h"
#include "life/face/recipe_internal.h"

/* ---- binding ---- */

static const char *channel_of(const noh_pack *pack, uint32_t row)
{
    return noh_pack_string(pack, pack->recipe_rows[row].channel);
}

static const char *target_of(const noh_pack *pack, uint32_t row)
{
    return noh_pack_string(pack, pack->recipe_rows[row].target);
}

static int is_corrective(const noh_pack *pack, const char *target)
{
    for (uint32_t row = 0; row < pack->recipe_row_count; row++) {
        if (channel_of(pack, row)[0] == '+' && noh_names_equal(target_of(pack, row), target)) return 1;
    }
    return 0;
}

/* The mesh's target of a name; NOH_NONE if there is none, or if it follows from other targets. */
static uint32_t find(const noh_mesh *mesh, const char *name)
{
    return is_corrective(mesh->pack, name) ? NOH_NONE : noh_mesh_find_target(mesh, name);
}

static int read_range(const noh_mesh *mesh, uint32_t row, noh_weight_rule *rule)
{
    const noh_pack *pack = mesh->pack;
    const noh_recipe_row *low = &pack->recipe_rows[row];
    uint32_t target;
    if (row + 1u >= pack->recipe_row_count || !noh_names_equal(channel_of(pack, row), "range-min") ||
        !noh_names_equal(channel_of(pack, row + 1u), "range-max") || low[1].target != low->target ||
        !(low->weight <= 0.0f && low[1].weight >= 0.0f))
        return 0;
    target = find(mesh, target_of(pack, row));
    if (target == NOH_NONE) return 0;
    *rule = (noh_weight_rule){ NOH_WEIGHT_RANGE, (uint16_t)target, 0, 0, low->weight, low[1].weight };
    return 1;
}

/* A row whose channel is a mark and the name of another target. */
static int read_pair(const noh_mesh *mesh, uint32_t row, char mark, noh_weight_rule_kind kind, float high,
                     noh_weight_rule *rule)
{
    const char *channel = channel_of(mesh->pack, row);
    uint32_t target, other;
    if (channel[0] != mark) return 0;
    target = find(mesh, target_of(mesh->pack, row));
    other = find(mesh, channel + 1);
    if (target == NOH_NONE || other == NOH_NONE || target == other) return 0;
    *rule = (noh_weight_rule){ (uint16_t)kind, (uint16_t)target, (uint16_t)other, 0, 0.0f, high };
    return 1;
}

/* A group is named by its rows' channel, and identified by the first of its targets that the mesh has. */
static int read_share(const noh_mesh *mesh, uint32_t row, noh_weight_rule *rule)
{
    const noh_pack *pack = mesh->pack;
    uint32_t target, first = NOH_NONE;
    if (channel_of(pack, row)[0] != '=') return 0;
    target = find(mesh, target_of(pack, row));
    if (target == NOH_NONE) return 0;
    for (uint32_t i = 0; i <= row && first == NOH_NONE; i++) {
        if (noh_names_equal(channel_of(pack, i), channel_of(pack, row))) first = find(mesh, target_of(pack, i));
    }
    *rule = (noh_weight_rule){ NOH_WEIGHT_SHARE, (uint16_t)target, (uint16_t)first, 0, 0.0f, 0.0f };
    return 1;
}

static int read_binary(const noh_mesh *mesh, uint32_t row, noh_weight_rule *rule)
{
    uint32_t target;
    if (!noh_names_equal(channel_of(mesh->pack, row), "binary")) return 0;
    target = find(mesh, target_of(mesh->pack, row));
    if (target == NOH_NONE) return 0;
    *rule = (noh_weight_rule){ NOH_WEIGHT_BINARY, (uint16_t)target, 0, 0, 0.0f, 0.0f };
    return 1;
}

static int read_row(const noh_mesh *mesh, uint32_t row, noh_weight_rule_kind kind, noh_weight_rule *rule)
{
    switch (kind) {
    case NOH_WEIGHT_RANGE: return read_range(mesh, row, rule);
    case NOH_WEIGHT_OPPOSE: return read_pair(mesh, row, '-', kind, 0.0f, rule);
    case NOH_WEIGHT_SHARE: return read_share(mesh, row, rule);
    case NOH_WEIGHT_BINARY: return read_binary(mesh, row, rule);
    case NOH_WEIGHT_ADD: break;
    }
    return read_pair(mesh, row, ':', kind, mesh->pack->recipe_rows[row].weight, rule);
}

static uint32_t bind(const noh_mesh *mesh, noh_weight_rule_kind first, noh_weight_rule_kind last,
                     noh_weight_rule *rules, uint32_t rule_max)
{
    uint32_t count = 0;
    for (uint32_t kind = (uint32_t)first; kind <= (uint32_t)last; kind++) {
        for (uint32_t row = 0; row < mesh->pack->recipe_row_count; row++) {
            noh_weight_rule rule;
            if (!read_row(mesh, row, (noh_weight_rule_kind)kind, &rule)) continue;
            if (count < rule_max) rules[count] = rule;
            count++;
        }
    }
    return count;
}

uint32_t noh_expressions_bind(const noh_mesh *mesh, noh_weight_rule *rules, uint32_t rule_max)
{
    return bind(mesh, NOH_WEIGHT_BINARY, NOH_WEIGHT_ADD, rules, rule_max);
}

uint32_t noh_weight_rules_bind(const noh_mesh *mesh, noh_weight_rule *rules, uint32_t rule_max)
{
    uint32_t count, left;
    NOH_ASSERT(mesh && (rules || !rule_max));
    count = noh_expressions_bind(mesh, rules, rule_max);
    left = count < rule_max ? rule_max - count : 0;
    return count + bind(mesh, NOH_WEIGHT_RANGE, NOH_WEIGHT_SHARE, left ? rules + count : NULL, left);
}

/* ---- weights ---- */

static void keep_range(const noh_weight_rule *rule, float *weight)
{
    if (!(*weight >= rule->low)) {
        *weight = rule->low;
    } else if (*weight > rule->high) {
        *weight = rule->high;
    }
}

static void keep_apart(float *a, float *b)
{
    const float less = *a < *b ? *a : *b;
    if (!(less > 0.0f)) return;
    *a -= less;
    *b -= less;
}

static void add_share(const noh_weight_rule *rule, float shows, float *weight)
{
    const float most = rule->high > 1.0f ? rule->high : 1.0f;
    if (!(shows > 0.0f)) return;
    *weight += rule->high * (shows < 1.0f ? shows : 1.0f);
    *weight = !(*weight > 0.0f) ? 0.0f : *weight < most ? *weight : most;
}

static int are_together(const noh_weight_rule *a, const noh_weight_rule *b)
{
    return b->kind == NOH_WEIGHT_SHARE && b->other == a->other;
}

/* Returns the rule after the group's. */
static uint32_t keep_shares(const noh_weight_rule *rules, uint32_t first, uint32_t rule_count, float *weights)
{
    float sum = 0.0f;
    uint32_t end = first;
    for (; end < rule_count && are_together(&rules[first], &rules[end]); end++) {
        const float weight = weights[rules[end].target];
        sum += weight > 0.0f ? weight : 0.0f;
    }
    for (uint32_t i = first; i < end && sum > 1.0f; i++) {
        float *weight = &weights[rules[i].target];
        if (*weight > 0.0f) *weight /= sum;
    }
    return end;
}

void noh_weight_rules_apply(const noh_weight_rule *rules, uint32_t rule_count, float *weights)
{
    uint32_t i = 0;
    NOH_ASSERT((rules || !rule_count) && (weights || !rule_count));
    while (i < rule_count) {
        const noh_weight_rule *rule = &rules[i];
        if (rule->kind == NOH_WEIGHT_SHARE) {
            i = keep_shares(rules, i, rule_count, weights);
            continue;
        }
        if (rule->kind == NOH_WEIGHT_RANGE) keep_range(rule, &weights[rule->target]);
        if (rule->kind == NOH_WEIGHT_OPPOSE) keep_apart(&weights[rule->target], &weights[rule->other]);
        if (rule->kind == NOH_WEIGHT_BINARY) weights[rule->target] = weights[rule->target] > 0.5f ? 1.0f : 0.0f;
        if (rule->kind == NOH_WEIGHT_ADD) add_share(rule, weights[rule->other], &weights[rule->target]);
        i++;
    }
}
