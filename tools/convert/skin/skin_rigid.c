#include "skin_rigid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/affine.h"
#include "mesh_join.h"
#include "convert/model/model_build.h"
#include "convert/clips/raw_set.h"

/* A joined mesh in the making, and its skin: several parts may share a joint and its matrix. */
typedef struct join_job {
    model *m;
    model_clips *made;
    uint32_t set;
    uint8_t *taken;  /* [node_count] drawn as part of a mesh made here */
    uint32_t *nodes; /* [node_count] of the parts */
    uint32_t part_count;
    mesh_part *parts; /* [node_count] */
    model_skin skin;  /* room for all joints of all parts */
} join_job;

/* ---- what may be joined ---- */

static const model_mesh *mesh_of(const join_job *j, uint32_t node)
{
    return &j->m->meshes[j->m->nodes[node].mesh];
}

static int is_rigid(const join_job *j, uint32_t node)
{
    const model_node *n = &j->m->nodes[node];
    return !j->taken[node] && n->mesh != MODEL_NONE && n->skin == MODEL_NONE && j->made->nodes[node].set == j->set;
}

static int is_skinned(const join_job *j, uint32_t node)
{
    const model_node *n = &j->m->nodes[node];
    return !j->taken[node] && n->mesh != MODEL_NONE && n->skin != MODEL_NONE && j->m->skins[n->skin].set == j->set;
}

static const float *weights_of(const join_job *j, uint32_t node)
{
    return j->m->nodes[node].weights ? j->m->nodes[node].weights : mesh_of(j, node)->weights;
}

static const model_channel *weight_channel(const model_clip *clip, uint32_t node)
{
    for (uint32_t i = 0; i < clip->channel_count; i++) {
        if (clip->channels[i].node == node && clip->channels[i].path == MODEL_PATH_WEIGHTS) {
            return &clip->channels[i];
        }
    }
    return NULL;
}

static int same_channels(const model_channel *a, const model_channel *b)
{
    size_t values;
    if (!a || !b || a->key_count != b->key_count || a->width != b->width || a->interpolation != b->interpolation) {
        return a == b;
    }
    values = (size_t)a->key_count * a->width * (a->interpolation == MODEL_CUBICSPLINE ? 3u : 1u);
    return memcmp(a->times, b->times, a->key_count * sizeof *a->times) == 0 &&
           memcmp(a->values, b->values, values * sizeof *a->values) == 0;
}

/* The same targets, with the same weights at rest and in every clip. */
static int same_targets(const join_job *j, uint32_t a, uint32_t b)
{
    const model_mesh *x = mesh_of(j, a), *y = mesh_of(j, b);
    int same = x->target_count == y->target_count;
    for (uint32_t t = 0; same && t < x->target_count; t++) {
        same = strcmp(x->targets[t].name, y->targets[t].name) == 0 && weights_of(j, a)[t] == weights_of(j, b)[t];
    }
    for (uint32_t c = 0; same && c < j->m->clip_count; c++) {
        same = same_channels(weight_channel(&j->m->clips[c], a), weight_channel(&j->m->clips[c], b));
    }
    return same;
}

/* The part that gives the joined mesh its targets; part_count if none has any. */
static uint32_t find_owner(const join_job *j)
{
    uint32_t p = 0;
    while (p < j->part_count && !mesh_of(j, j->nodes[p])->target_count) {
        p++;
    }
    return p;
}

/* One set of weights moves the whole mesh, so parts with targets need the same ones. */
static int targets_fit(const join_job *j, uint32_t node)
{
    uint32_t owner = find_owner(j);
    return !mesh_of(j, node)->target_count || owner == j->part_count || same_targets(j, j->nodes[owner], node);
}

static int has_material(const join_job *j, uint32_t material)
{
    for (uint32_t p = 0; p < j->part_count; p++) {
        const model_mesh *mesh = mesh_of(j, j->nodes[p]);
        for (uint32_t s = 0; s < mesh->submesh_count; s++) {
            if (mesh->submeshes[s].material == material) {
                return 1;
            }
        }
    }
    return 0;
}

static int saves_draws(const join_job *j, uint32_t node)
{
    const model_mesh *mesh = mesh_of(j, node);
    for (uint32_t s = 0; s < mesh->submesh_count; s++) {
        if (!has_material(j, mesh->submeshes[s].material)) {
            return 0;
        }
    }
    return 1;
}

/* ---- parts ---- */

/* The place of a joint with this inverse bind matrix in the joined skin. */
static uint32_t add_joint(join_job *j, uint32_t joint, const double bind[16])
{
    uint32_t i = 0, node = j->made->sets[j->set]->skeleton.joints[joint].node;
    float narrow[16];
    for (int k = 0; k < 16; k++) {
        narrow[k] = (float)bind[k];
    }
    while (i < j->skin.joint_count && (j->skin.skeleton_joints[i] != joint ||
                                       memcmp(j->skin.inverse_bind + 16 * (size_t)i, narrow, sizeof narrow) != 0)) {
        i++;
    }
    if (i == j->skin.joint_count) {
        j->skin.skeleton_joints[i] = joint;
        j->skin.joints[i] = node;
        memcpy(j->skin.inverse_bind + 16 * (size_t)i, narrow, sizeof narrow);
        j->skin.joint_count += 1;
    }
    return i;
}

/* From the space of a node to the joint at or above it, by the rest transforms between. */
static void matrix_below(const model *m, uint32_t node, uint32_t joint_node, double out[16])
{
    affine_identity(out);
    for (uint32_t n = node; n != joint_node && n != MODEL_NONE; n = m->nodes[n].parent) {
        double local[16], product[16];
        affine_of_node(&m->nodes[n], local);
        affine_multiply(local, out, product);
        memcpy(out, product, sizeof product);
    }
}

/* If the rest pose has no inverse (a joint of scale zero), vertices stay in their own space, and the mesh can belong to
 * its own node only. */
static int has_rest_place(const join_job *j, uint32_t node)
{
    uint32_t joint = j->made->sets[j->set]->skeleton.joints[j->made->nodes[node].joint].node;
    double inverse[16];
    return !affine_invert(j->m->nodes[joint].world, inverse) && !affine_invert(j->m->nodes[node].world, inverse);
}

static void add_rigid(join_job *j, uint32_t node)
{
    mesh_part *part = &j->parts[j->part_count];
    uint32_t joint = j->made->nodes[node].joint;
    uint32_t joint_node = j->made->sets[j->set]->skeleton.joints[joint].node;
    double bind[16];
    memset(part, 0, sizeof *part);
    part->mesh = mesh_of(j, node);
    if (has_rest_place(j, node)) {
        memcpy(part->place, j->m->nodes[node].world, sizeof part->place);
        affine_invert(j->m->nodes[joint_node].world, bind);
    } else {
        affine_identity(part->place);
        matrix_below(j->m, node, joint_node, bind);
    }
    part->place_rigid = add_joint(j, joint, bind);
    j->nodes[j->part_count++] = node;
}

/* The rest pose's matrix for vertices of the first joint. Returns 1 if it has no inverse. */
static int rest_place(const join_job *j, uint32_t node, double place[16])
{
    const model_skin *skin = &j->m->skins[j->m->nodes[node].skin];
    uint32_t first = mesh_of(j, node)->vertex_count ? mesh_of(j, node)->joints[0] : 0;
    double bind[16], inverse[16];
    affine_of_floats(skin->inverse_bind + 16 * (size_t)first, bind);
    affine_multiply(j->m->nodes[skin->joints[first]].world, bind, place);
    return affine_invert(place, inverse);
}

/* Returns 1 when out of memory. */
static int add_skinned(join_job *j, uint32_t node)
{
    const model_skin *skin = &j->m->skins[j->m->nodes[node].skin];
    mesh_part *part = &j->parts[j->part_count];
    uint32_t *places = model_zeros(skin->joint_count, sizeof *places);
    double inverse[16];
    if (!places) {
        return 1;
    }
    part->mesh = mesh_of(j, node);
    part->places = places;
    rest_place(j, node, part->place);
    affine_invert(part->place, inverse);
    for (uint32_t i = 0; i < skin->joint_count; i++) {
        double bind[16], moved[16];
        affine_of_floats(skin->inverse_bind + 16 * (size_t)i, bind);
        affine_multiply(bind, inverse, moved);
        places[i] = add_joint(j, skin->skeleton_joints[i], moved);
    }
    j->nodes[j->part_count++] = node;
    return 0;
}

/* ---- the joined mesh ---- */

/* The first node with targets: its weights, and its clips' weights, become the joined mesh's. */
static uint32_t drawing_node(const join_job *j)
{
    uint32_t owner = find_owner(j);
    return j->nodes[owner == j->part_count ? 0 : owner];
}

static int grow(void **array, uint32_t count, size_t element_size)
{
    void *grown = realloc(*array, ((size_t)count + 1) * element_size);
    if (grown) {
        *array = grown;
        memset((uint8_t *)grown + count * element_size, 0, element_size);
    }
    return !grown;
}

static const char *joined_name(const join_job *j)
{
    return j->part_count == 1 ? j->parts[0].mesh->name : j->made->sets[j->set]->skeleton.name;
}

static int add_mesh(join_job *j)
{
    model *m = j->m;
    uint32_t node = drawing_node(j), index = m->mesh_count, skin = m->skin_count;
    int failed;
    model_mesh joined;
    failed = mesh_join(j->parts, j->part_count, &joined);
    joined.name = model_string(joined_name(j));
    j->skin.name = model_string(joined_name(j));
    if (grow((void **)&m->meshes, index, sizeof *m->meshes) || grow((void **)&m->skins, skin, sizeof *m->skins)) {
        return 1;
    }
    joined.bound = 1;
    joined.skin = skin;
    m->meshes[m->mesh_count++] = joined;
    m->skins[m->skin_count++] = j->skin;
    memset(&j->skin, 0, sizeof j->skin);
    for (uint32_t p = 0; p < j->part_count; p++) {
        m->nodes[j->nodes[p]].mesh = MODEL_NONE;
        m->nodes[j->nodes[p]].skin = MODEL_NONE;
        j->taken[j->nodes[p]] = 1;
    }
    m->nodes[node].mesh = index;
    m->nodes[node].skin = skin;
    return failed || !joined.name || !m->skins[skin].name;
}

static int begin_skin(join_job *j)
{
    size_t most = 1;
    for (uint32_t n = 0; n < j->m->node_count; n++) {
        most += is_rigid(j, n) ? 1 : is_skinned(j, n) ? j->m->skins[j->m->nodes[n].skin].joint_count : 0;
    }
    memset(&j->skin, 0, sizeof j->skin);
    j->skin.set = j->set;
    j->skin.joints = model_zeros(most, sizeof *j->skin.joints);
    j->skin.skeleton_joints = model_zeros(most, sizeof *j->skin.skeleton_joints);
    j->skin.inverse_bind = model_zeros(most * 16, sizeof *j->skin.inverse_bind);
    j->part_count = 0;
    return !j->skin.joints || !j->skin.skeleton_joints || !j->skin.inverse_bind;
}

static void end_skin(join_job *j)
{
    for (uint32_t p = 0; p < j->part_count; p++) {
        free((void *)(uintptr_t)j->parts[p].places);
    }
    free(j->skin.name);
    free(j->skin.joints);
    free(j->skin.skeleton_joints);
    free(j->skin.inverse_bind);
}

static int collect(join_job *j, uint32_t first, int keep_parts)
{
    int alone = keep_parts || !has_rest_place(j, first), failed = 0;
    add_rigid(j, first);
    for (uint32_t n = first + 1; !alone && n < j->m->node_count; n++) {
        if (is_rigid(j, n) && has_rest_place(j, n) && targets_fit(j, n)) {
            add_rigid(j, n);
        }
    }
    for (uint32_t n = 0; !alone && !failed && n < j->m->node_count; n++) {
        double place[16];
        if (is_skinned(j, n) && saves_draws(j, n) && targets_fit(j, n) && !rest_place(j, n, place)) {
            failed = add_skinned(j, n);
        }
    }
    return failed;
}

static int join_from(join_job *j, uint32_t first, int keep_parts, FILE *report)
{
    uint32_t rigid = 0;
    int failed = begin_skin(j) || collect(j, first, keep_parts);
    for (uint32_t p = 0; p < j->part_count; p++) {
        rigid += !j->parts[p].places;
    }
    if (report && !failed && j->part_count > 1) {
        fprintf(report, "joined %u rigid and %u skinned meshes of skeleton '%s' into one\n", rigid,
                j->part_count - rigid, j->made->sets[j->set]->skeleton.name);
    }
    failed = failed || add_mesh(j);
    end_skin(j);
    return failed;
}

/* ---- meshes that are no longer drawn ---- */

static int is_drawn(const model *m, uint32_t mesh)
{
    for (uint32_t n = 0; n < m->node_count; n++) {
        if (m->nodes[n].mesh == mesh) {
            return 1;
        }
    }
    return 0;
}

static void drop_joined(model *m, const uint8_t *was_drawn, uint32_t count)
{
    for (uint32_t i = count; i-- > 0;) {
        if (was_drawn[i] && !is_drawn(m, i)) {
            model_drop_mesh(m, i);
        }
    }
}

static void list_drawn(const model *m, uint8_t *drawn)
{
    for (uint32_t n = 0; n < m->node_count; n++) {
        if (m->nodes[n].mesh != MODEL_NONE) {
            drawn[m->nodes[n].mesh] = 1;
        }
    }
}

/* Nodes whose mesh was joined to another node's have no weights to animate; the other node's are the same. */
static void drop_channels(const join_job *j, model_clip *clip)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < clip->channel_count; i++) {
        model_channel *channel = &clip->channels[i];
        if (channel->path == MODEL_PATH_WEIGHTS && j->taken[channel->node] &&
            j->m->nodes[channel->node].mesh == MODEL_NONE) {
            free(channel->times);
            free(channel->values);
        } else {
            clip->channels[kept++] = *channel;
        }
    }
    clip->channel_count = kept;
}

static void drop_floats(const join_job *j, raw_clip *clip)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < clip->float_count; i++) {
        raw_floats *floats = &clip->floats[i];
        if (floats->node != MODEL_NONE && j->taken[floats->node] && j->m->nodes[floats->node].mesh == MODEL_NONE) {
            raw_floats_clear(floats);
        } else {
            clip->floats[kept++] = *floats;
        }
    }
    clip->float_count = kept;
}

static void drop_weights(join_job *j)
{
    for (uint32_t c = 0; c < j->m->clip_count; c++) {
        drop_channels(j, &j->m->clips[c]);
    }
    for (uint32_t i = 0; i < j->made->set_count; i++) {
        for (uint32_t c = 0; c < j->made->sets[i]->clip_count; c++) {
            drop_floats(j, &j->made->sets[i]->clips[c]);
        }
    }
}

static int join_all(join_job *j, int keep_parts, FILE *report)
{
    int failed = 0;
    for (j->set = 0; j->set < j->made->set_count; j->set++) {
        for (uint32_t n = 0; !failed && n < j->m->node_count; n++) {
            if (is_rigid(j, n)) {
                failed = join_from(j, n, keep_parts, report);
            }
        }
    }
    return failed;
}

int skin_rigid_meshes(model *m, model_clips *made, int keep_parts, FILE *report)
{
    uint32_t mesh_count = m->mesh_count;
    uint8_t *was_drawn = model_zeros(mesh_count, 1);
    join_job j;
    int failed;
    memset(&j, 0, sizeof j);
    j.m = m;
    j.made = made;
    j.taken = model_zeros(m->node_count, 1);
    j.nodes = model_zeros(m->node_count, sizeof *j.nodes);
    j.parts = model_zeros(m->node_count, sizeof *j.parts);
    failed = !was_drawn || !j.taken || !j.nodes || !j.parts;
    if (!failed) {
        list_drawn(m, was_drawn);
        failed = join_all(&j, keep_parts, report);
    }
    if (!failed) {
        drop_weights(&j);
        drop_joined(m, was_drawn, mesh_count);
    }
    free(was_drawn);
    free(j.taken);
    free(j.nodes);
    free(j.parts);
    return failed;
}
