/* stage_module.c: the slots of a kind's modules: what a desc names, how many bytes that takes, and where these lie. */
#include <string.h>

#include "stage/cast/stage_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/noh.h"

/* States of an actor lie in this order, after a head: as they always have, so that their hashes stay. */
static const uint8_t laid_out[] = { NOH_SLOT_FACE, NOH_SLOT_BODY, NOH_SLOT_MODIFIERS, NOH_SLOT_SPRINGS,
                                    NOH_SLOT_MATCH };

/* ---- of a desc ---- */

noh_module noh_stage_wanted(const noh_kind_desc *d, uint32_t slot)
{
    static const noh_module none, modifiers = { &noh_stage_modifiers_type, NULL };
    switch (slot) {
    case NOH_SLOT_SOURCE: return d->graphs;
    case NOH_SLOT_FACE: return d->face;
    case NOH_SLOT_MODIFIERS: return d->modifier_count ? modifiers : none;
    case NOH_SLOT_BODY: return d->ragdoll;
    case NOH_SLOT_MATCH: return d->match;
    default: return d->springs;
    }
}

static void fill(noh_module *module, const noh_kind_desc *d)
{
    if (module->type && module->type->is_there && !module->type->is_there(d, module->desc)) module->type = NULL;
}

void noh_stage_fill_modules(noh_kind_desc *d)
{
    fill(&d->graphs, d);
    fill(&d->face, d);
    fill(&d->ragdoll, d);
    fill(&d->springs, d);
    fill(&d->match, d);
}

const char *noh_stage_bad_modules(const noh_kind_desc *d, uint32_t job_count)
{
    const char *what = NULL;
    for (uint32_t slot = 0; slot < NOH_SLOT_COUNT && !what; slot++) {
        const noh_module m = noh_stage_wanted(d, slot);
        if (!m.type) continue;
        if (m.type->slot != slot)
            return "graphs, face, ragdoll, springs or match of a kind holds the module of another field";
        what = m.type->bad ? m.type->bad(d, m.desc) : NULL;
        if (!what && m.type->refuse) what = m.type->refuse(m.desc, job_count);
    }
    return what;
}

uint32_t noh_stage_hash_module(const noh_kind_desc *d, uint32_t slot)
{
    const noh_module m = noh_stage_wanted(d, slot);
    return m.type ? m.type->hash(d, m.desc) : 0;
}

int noh_stage_has_modifiers(const noh_kind_desc *d)
{
    int some = 0;
    for (uint32_t slot = NOH_SLOT_SOURCE + 1u; slot < NOH_SLOT_COUNT; slot++) {
        some |= noh_stage_wanted(d, slot).type != NULL;
    }
    return some;
}

noh_result noh_stage_measure_modules(const noh_kind_desc *d, noh_stage_needs *n, noh_error *error)
{
    noh_result result = NOH_OK;
    n->modifier_bytes = noh_stage_has_modifiers(d) ? sizeof(noh_stage_modifier_head) : 0;
    for (uint32_t slot = 0; slot < NOH_SLOT_COUNT && result == NOH_OK; slot++) {
        const noh_module m = noh_stage_wanted(d, slot);
        if (!m.type) continue;
        result = m.type->measure(d, m.desc, n, &n->modules[slot], error);
        if (slot != NOH_SLOT_SOURCE) n->modifier_bytes += n->modules[slot].actor_bytes;
        if (n->modules[slot].scratch_bytes > n->module_scratch_bytes) {
            n->module_scratch_bytes = n->modules[slot].scratch_bytes;
        }
    }
    return result;
}

/* ---- of a kind ---- */

void noh_stage_open_modules(noh_stage_kind *k, const noh_stage_needs *n)
{
    size_t at = sizeof(noh_stage_modifier_head);
    k->modules[NOH_SLOT_SOURCE].stride = n->modules[NOH_SLOT_SOURCE].actor_bytes;
    for (uint32_t i = 0; i < sizeof laid_out; i++) {
        noh_stage_module *m = &k->modules[laid_out[i]];
        m->states = k->modifier_states + at;
        m->stride = k->modifier_bytes;
        at += n->modules[laid_out[i]].actor_bytes;
    }
}

noh_result noh_stage_init_modules(noh_stage_kind *k, noh_error *error)
{
    noh_result result = NOH_OK;
    for (uint32_t slot = 0; slot < NOH_SLOT_COUNT && result == NOH_OK; slot++) {
        const noh_module m = noh_stage_wanted(k->desc, slot);
        if (m.type) result = m.type->init(k, m.desc, error);
    }
    return result;
}

void noh_stage_clear_modules(noh_stage_kind *k, uint32_t index)
{
    const noh_stage_module *source = &k->modules[NOH_SLOT_SOURCE];
    for (uint32_t slot = 0; slot < NOH_SLOT_COUNT; slot++) {
        const noh_module_type *type = k->modules[slot].type;
        if (type && type->despawn) type->despawn(k, index);
    }
    memset(k->modifier_states + index * k->modifier_bytes, 0, k->modifier_bytes);
    memset(source->states + index * source->stride, 0, source->stride);
}

int noh_stage_is_carried(const noh_stage_kind *k, uint32_t index)
{
    int is = 0;
    for (uint32_t slot = 0; slot < NOH_SLOT_COUNT; slot++) {
        const noh_module_type *type = k->modules[slot].type;
        is |= type && type->carries && type->carries(k, index);
    }
    return is;
}

int noh_stage_turns(const noh_stage_kind *k)
{
    int turns = 0;
    for (uint32_t slot = 0; slot < NOH_SLOT_COUNT; slot++) turns |= k->modules[slot].turns;
    return turns;
}

int noh_stage_turn(const noh_stage_kind *k, uint32_t index, float rotation[4], float at[3])
{
    if (!noh_stage_turns(k) || noh_stage_is_carried(k, index)) return 0;
    for (uint32_t slot = 0; slot < NOH_SLOT_COUNT; slot++) {
        if (k->modules[slot].turns) k->modules[slot].type->turn(k, index, rotation, at);
    }
    return 1;
}

noh_controller *noh_stage_inner(const noh_stage_kind *k, uint32_t index)
{
    const noh_module_type *type = k->modules[NOH_SLOT_SOURCE].type;
    return type ? type->source->controller(k, index) : NULL;
}

/* ---- a state from outside ---- */

noh_result noh_stage_check_modules(const noh_stage_kind *k, uint32_t index, const uint8_t *state, const uint8_t *copy,
                                   noh_error *error)
{
    noh_result result = NOH_OK;
    for (uint32_t slot = 0; slot < NOH_SLOT_COUNT && result == NOH_OK; slot++) {
        const noh_stage_module *m = &k->modules[slot];
        if (m->type && m->type->check) {
            result = m->type->check(k, copy + (m->states + index * m->stride - state), error);
        }
    }
    return result;
}

const char *noh_stage_check_pools(const noh_stage_kind *k, const uint8_t *state, const uint8_t *copy)
{
    const char *what = NULL;
    for (uint32_t slot = 0; slot < NOH_SLOT_COUNT && !what; slot++) {
        const noh_stage_module *m = &k->modules[slot];
        if (m->type && m->type->check_pool) what = m->type->check_pool(k, copy + ((const uint8_t *)m->pool - state));
    }
    return what;
}
