#include "springs_bind.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "convert/model/affine.h"
#include "convert/model/model_build.h"
#include "springs_chain.h"

/* A skeleton while lines are bound to it. */
typedef struct binding {
    const model *m;
    const raw_skeleton *skeleton;
    uint32_t set;
    set_springs *out;
    uint32_t *collider_joints; /* [NOH_SPRING_COLLIDERS_MAX] of out->colliders */
} binding;

/* ---- names ---- */

/* A pattern is a name, or the beginning of one and '*'. */
static int matches(const char *pattern, const char *name)
{
    const size_t size = strlen(pattern);
    return size && pattern[size - 1u] == '*' ? strncmp(pattern, name, size - 1u) == 0 : strcmp(pattern, name) == 0;
}

static int joint_matches(const raw_skeleton *s, uint32_t joint, const char *pattern)
{
    return joint != MODEL_NONE && s->joints[joint].name && matches(pattern, s->joints[joint].name);
}

/* ---- where a chain without `end` ends ---- */

/* The mean of the vertices that a joint moves, in its space; 0: it moves none. */
static int mean_of_skin(const model *m, uint32_t set, uint32_t joint, float out[3])
{
    double sum[3] = { 0.0, 0.0, 0.0 }, total = 0.0;
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        const model_mesh *mesh = &m->meshes[i];
        const model_skin *skin = mesh->bound ? &m->skins[mesh->skin] : NULL;
        if (!skin || skin->set != set || !mesh->joints) continue;
        for (size_t k = 0; k < (size_t)mesh->vertex_count * MODEL_INFLUENCES_MAX; k++) {
            const double weight = (double)mesh->joint_weights[k];
            const uint32_t place = mesh->joints[k];
            const float *p = mesh->position + 3u * (k / MODEL_INFLUENCES_MAX);
            double back[16];
            if (!(weight > 0.0) || place >= skin->joint_count || skin->skeleton_joints[place] != joint) continue;
            affine_of_floats(skin->inverse_bind + 16u * (size_t)place, back);
            for (int a = 0; a < 3; a++) {
                sum[a] += weight * (back[a] * (double)p[0] + back[4 + a] * (double)p[1] + back[8 + a] * (double)p[2] +
                                    back[12 + a]);
            }
            total += weight;
        }
    }
    for (int a = 0; a < 3; a++) out[a] = total > 0.0 ? (float)(sum[a] / total) : 0.0f;
    return total > 0.0 && out[0] * out[0] + out[1] * out[1] + out[2] * out[2] > 1e-8f;
}

/* An end that the file knows; the middle of what the joint moves; or as long as its own bone, straight on. */
static void find_end(const binding *b, uint32_t joint, float out[3])
{
    const raw_joint *j = &b->skeleton->joints[joint];
    const float back[4] = { -j->rotation[0], -j->rotation[1], -j->rotation[2], j->rotation[3] };
    memcpy(out, j->end, 3 * sizeof *out);
    if (out[0] != 0.0f || out[1] != 0.0f || out[2] != 0.0f) return;
    if (!mean_of_skin(b->m, b->set, joint, out)) noh_quat_rotate(back, j->translation, out);
}

/* ---- chains of a text ---- */

/* The first joint below `above` in their order; MODEL_NONE: none. */
static uint32_t child_of(const raw_skeleton *s, uint32_t above, uint32_t after)
{
    for (uint32_t j = after; j < s->joint_count; j++) {
        if (s->joints[j].parent == above) return j;
    }
    return MODEL_NONE;
}

static noh_spring_row row_of(const springs_chain *c, uint32_t joint)
{
    const noh_spring_row row = { joint, c->stiffness, c->drag, c->radius, { 0.0f, -c->gravity, 0.0f } };
    return row;
}

static int add_path(const binding *b, const springs_chain *c, springs_path *p, uint32_t *left_out)
{
    const uint32_t last = p->rows[p->count - 1u].joint, below = child_of(b->skeleton, last, 0);
    if (c->has_end) {
        memcpy(p->end, c->end, sizeof p->end);
    } else if (c->to && below != MODEL_NONE) {
        memcpy(p->end, b->skeleton->joints[below].translation, sizeof p->end);
    } else {
        find_end(b, last, p->end);
    }
    return springs_add_path(b->out, p, left_out);
}

/* All below a joint: straight down by first children, which the order of joints makes the longest way; every other
 * child begins a path of its own. */
static int add_tree(const binding *b, const springs_chain *c, uint32_t top, springs_path *p, uint32_t *left_out)
{
    const uint32_t count = b->skeleton->joint_count;
    for (uint32_t begin = top; begin < count; begin++) {
        const uint32_t parent = b->skeleton->joints[begin].parent;
        uint32_t up = begin;
        while (up != MODEL_NONE && up != top) up = b->skeleton->joints[up].parent;
        /* below the top, and no first child of one that is */
        if (up != top || (begin != top && child_of(b->skeleton, parent, 0) == begin)) continue;
        p->count = 0;
        for (uint32_t j = begin; j != MODEL_NONE; j = child_of(b->skeleton, j, 0)) p->rows[p->count++] = row_of(c, j);
        if (add_path(b, c, p, left_out)) return 1;
    }
    return 0;
}

/* From a joint down to the nearest one that `to` names; 0 joints: there is none. */
static void take_way(const binding *b, const springs_chain *c, uint32_t top, springs_path *p)
{
    p->count = 0;
    for (uint32_t last = top; last < b->skeleton->joint_count && !p->count; last++) {
        uint32_t length = 1, up = last;
        if (!joint_matches(b->skeleton, last, c->to)) continue;
        while (up != top && up != MODEL_NONE) up = b->skeleton->joints[up].parent, length++;
        if (up != top) continue;
        p->count = length;
        for (up = last; length; up = b->skeleton->joints[up].parent) p->rows[--length] = row_of(c, up);
    }
}

static uint32_t collides_with(const binding *b, const springs_chain *c)
{
    uint32_t bits = 0;
    for (uint32_t i = 0; i < b->out->collider_count; i++) {
        int hit = !c->hits;
        for (const char *name = c->hits; name && *name && !hit; name += strlen(name) + 1u) {
            hit = joint_matches(b->skeleton, b->collider_joints[i], name);
        }
        bits |= hit ? 1u << i : 0u;
    }
    return bits;
}

/* *found: joints that the line names; *twice: one that swings already. */
static int bind_chain(const binding *b, const springs_chain *c, uint32_t *found, uint32_t *twice, uint32_t *left_out)
{
    springs_path p = { b->skeleton, malloc((b->skeleton->joint_count + 1u) * sizeof *p.rows), 0, 0, { 0 } };
    int failed = !p.rows;
    p.collides = collides_with(b, c);
    for (uint32_t j = 0; j < b->skeleton->joint_count && !failed; j++) {
        if (!joint_matches(b->skeleton, j, c->joint) ||
            joint_matches(b->skeleton, b->skeleton->joints[j].parent, c->joint))
            continue;
        if (springs_swings(b->out, j)) *twice = j;
        if (!c->to) {
            ++*found;
            failed = add_tree(b, c, j, &p, left_out);
            continue;
        }
        take_way(b, c, j, &p);
        *found += p.count != 0;
        if (p.count) failed = add_path(b, c, &p, left_out);
    }
    free(p.rows);
    return failed;
}

static int bind_collider(binding *b, const springs_collider *c, uint32_t *found)
{
    for (uint32_t j = 0; j < b->skeleton->joint_count; j++) {
        noh_spring_capsule capsule = { j, { 0 }, { 0 }, c->radius };
        uint32_t bit;
        if (!joint_matches(b->skeleton, j, c->joint)) continue;
        memcpy(capsule.from, c->from, sizeof capsule.from);
        memcpy(capsule.to, c->to, sizeof capsule.to);
        if (springs_add_collider(b->out, &capsule, &bit)) return 1;
        if (bit) b->collider_joints[b->out->collider_count - 1u] = j;
        *found += bit != 0;
    }
    return 0;
}

/* ---- a text ---- */

/* The matches of a line in all skeletons. */
typedef struct outcome {
    uint32_t found, left_out, twice; /* twice: a joint, MODEL_NONE: none */
} outcome;

static const char *trouble(const outcome *o, int is_chain)
{
    if (o->twice != MODEL_NONE) return "this joint is already in a chain";
    if (!o->found) {
        return is_chain ? "no skeleton has this joint with the joint after `to` below it"
                        : "no skeleton has this joint, or there are more than 32 colliders";
    }
    return o->left_out ? "a joint has no parent, or no bone with a length: it cannot swing" : NULL;
}

static int tell(model *m, int as_warning, const char *what, const char *joint, uint32_t number, uint32_t *line,
                model_error *error)
{
    if (as_warning) {
        if (!model_warn(m, "springs of '%s' in extras: %s", joint, what)) return 0;
        what = "out of memory";
    }
    *line = number;
    (void)model_fail(error, "", "'%s': %s", joint, what);
    return 1;
}

static int bind_chain_line(const binding *all, uint32_t count, const springs_chain *chain, model *m, int as_warning,
                           uint32_t *line, model_error *error)
{
    outcome o = { 0, 0, MODEL_NONE };
    const char *what;
    int failed = 0;
    for (uint32_t i = 0; i < count && !failed; i++)
        failed = bind_chain(&all[i], chain, &o.found, &o.twice, &o.left_out);
    what = failed ? "out of memory" : trouble(&o, 1);
    return what ? tell(m, as_warning && !failed, what, chain->joint, chain->line, line, error) : 0;
}

static int bind_collider_line(binding *all, uint32_t count, const springs_collider *collider, model *m, int as_warning,
                              uint32_t *line, model_error *error)
{
    outcome o = { 0, 0, MODEL_NONE };
    const char *what;
    int failed = 0;
    for (uint32_t i = 0; i < count && !failed; i++) failed = bind_collider(&all[i], collider, &o.found);
    what = failed ? "out of memory" : trouble(&o, 0);
    return what ? tell(m, as_warning && !failed, what, collider->joint, collider->line, line, error) : 0;
}

int springs_bind_text(const springs_text *text, model *m, raw_set *const *sets, uint32_t set_count, int model_lines,
                      set_springs *out, uint32_t *line, model_error *error)
{
    binding *all = calloc(set_count + 1u, sizeof *all);
    uint32_t *joints = calloc((size_t)(set_count + 1u) * NOH_SPRING_COLLIDERS_MAX, sizeof *joints);
    int failed = !all || !joints;
    if (failed) (void)model_fail_memory(error);
    for (uint32_t i = 0; i < set_count && !failed; i++) {
        all[i] = (binding){ m, &sets[i]->skeleton, i, &out[i], joints + (size_t)i * NOH_SPRING_COLLIDERS_MAX };
        for (uint32_t k = 0; k < out[i].collider_count; k++) all[i].collider_joints[k] = out[i].colliders[k].joint;
    }
    for (uint32_t i = 0; i < text->collider_count && !failed; i++) {
        failed = bind_collider_line(all, set_count, &text->colliders[i], m, model_lines, line, error);
    }
    for (uint32_t i = 0; i < text->chain_count && !failed; i++) {
        failed = bind_chain_line(all, set_count, &text->chains[i], m, model_lines, line, error);
    }
    free(all);
    free(joints);
    return failed;
}

/* ---- an extension ---- */

static uint32_t joint_of_node(const raw_skeleton *s, uint32_t node)
{
    for (uint32_t j = 0; j < s->joint_count; j++) {
        if (s->joints[j].node == node) return j;
    }
    return MODEL_NONE;
}

/* bits[collider_count]: of the model's colliders in the set. */
static int bind_colliders(const model *m, const raw_skeleton *skeleton, set_springs *out, uint32_t *bits)
{
    for (uint32_t i = 0; i < m->collider_count; i++) {
        const model_collider *c = &m->colliders[i];
        noh_spring_capsule capsule = { joint_of_node(skeleton, c->node), { 0 }, { 0 }, c->radius };
        bits[i] = 0;
        if (capsule.joint == MODEL_NONE) continue;
        memcpy(capsule.from, c->from, sizeof capsule.from);
        memcpy(capsule.to, c->to, sizeof capsule.to);
        if (springs_add_collider(out, &capsule, &bits[i])) return 1;
    }
    return 0;
}

/* Joints of the chain that this skeleton has; others end it. */
static int bind_spring(const raw_skeleton *skeleton, const model_spring *spring, const uint32_t *bits, set_springs *out,
                       uint32_t *bound, uint32_t *left_out)
{
    springs_path p = { skeleton, calloc(spring->joint_count + 1u, sizeof *p.rows), 0, 0, { 0 } };
    int failed = !p.rows;
    for (uint32_t i = 0; i < NOH_SPRING_COLLIDERS_MAX; i++) p.collides |= spring->collides >> i & 1u ? bits[i] : 0u;
    memcpy(p.end, spring->end, sizeof p.end);
    for (uint32_t i = 0; i < spring->joint_count && !failed; i++) {
        const model_spring_joint *from = &spring->joints[i];
        const uint32_t joint = joint_of_node(skeleton, from->node);
        const noh_spring_row row = {
            joint, from->stiffness, from->drag, from->radius, { from->gravity[0], from->gravity[1], from->gravity[2] }
        };
        if (joint != MODEL_NONE) p.rows[p.count++] = row;
    }
    *bound += p.count;
    failed = failed || springs_add_path(out, &p, left_out);
    free(p.rows);
    return failed;
}

int springs_bind_nodes(model *m, raw_set *const *sets, uint32_t set_count, set_springs *out)
{
    uint32_t *bits = calloc((size_t)(set_count + 1u) * NOH_SPRING_COLLIDERS_MAX, sizeof *bits);
    uint32_t lost = 0, left_out = 0;
    int failed = !bits;
    for (uint32_t i = 0; i < set_count && !failed; i++) {
        failed = bind_colliders(m, &sets[i]->skeleton, &out[i], bits + (size_t)i * NOH_SPRING_COLLIDERS_MAX);
    }
    for (uint32_t s = 0; s < m->spring_count && !failed; s++) {
        uint32_t bound = 0;
        for (uint32_t i = 0; i < set_count && !failed; i++) {
            failed = bind_spring(&sets[i]->skeleton, &m->springs[s], bits + (size_t)i * NOH_SPRING_COLLIDERS_MAX,
                                 &out[i], &bound, &left_out);
        }
        lost += m->springs[s].joint_count > bound ? m->springs[s].joint_count - bound : 0;
    }
    if (!failed && lost) {
        failed = model_warn(m, "springs: %u of their nodes are not joints of a skeleton and do not swing", lost);
    }
    if (!failed && left_out) {
        failed = model_warn(m, "springs: %u joints have no parent, or no bone with a length, and do not swing",
                            left_out);
    }
    free(bits);
    return failed;
}
