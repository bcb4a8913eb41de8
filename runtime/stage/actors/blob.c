#include "core/base/assert_internal.h"
#include "deform/pick/bounds_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/format.h"
#include "noh/low_life.h"
#include "noh/marks.h"
#include "noh/noh.h"
#include "noh/pack.h"

#include <string.h>

#include "core/base/math_internal.h"
#include "stage/cast/stage_internal.h"

#define SHARE 0.67f        /* drawn of the light that a disc blocks */
#define FAINTEST 0.02f     /* blobs below this darkness are left out */
#define SPREAD 1.6f        /* size of a blob relative to the body above it */
#define HEIGHT_SPREAD 1.0f /* its growth with the height of the body */
#define REACH 4.0f         /* greatest height of a body, in radii */

/* ---- the rig ---- */

static float size_of(const noh_blob_body *b)
{
    float square = 0.0f;
    for (int i = 0; i < 9; i++) square += b->half[i / 3][i % 3] * b->half[i / 3][i % 3];
    return square;
}

/* Transform a box (minimum, maximum) to the space of the body. */
static void set_box(noh_blob_body *b, const float *box, const float matrix[12])
{
    for (int row = 0; row < 3; row++) {
        const float *m = matrix + 4 * row;
        b->centre[row] = m[3];
        for (int k = 0; k < 3; k++) {
            b->centre[row] += m[k] * 0.5f * (box[k] + box[3 + k]);
            b->half[k][row] = m[k] * 0.5f * (box[3 + k] - box[k]);
        }
    }
}

/* Add a box. It replaces a smaller one of the same joint, or the smallest of all if the rig is full. */
static void keep(noh_blob_rig *rig, const noh_blob_body *body)
{
    uint32_t to = rig->body_count;
    for (uint32_t i = 0; i < rig->body_count && to == rig->body_count; i++) {
        if (body->joint != NOH_NONE && rig->bodies[i].joint == body->joint) to = i;
    }
    if (to == NOH_BLOBS_MAX) {
        to = 0;
        for (uint32_t i = 1; i < NOH_BLOBS_MAX; i++) {
            if (size_of(&rig->bodies[i]) < size_of(&rig->bodies[to])) to = i;
        }
    }
    if (to < rig->body_count && size_of(&rig->bodies[to]) >= size_of(body)) return;
    rig->body_count += to == rig->body_count;
    rig->bodies[to] = *body;
}

static void keep_skin(noh_blob_rig *rig, const noh_mesh *mesh, const noh_skin *skin)
{
    for (uint32_t j = 0; j < skin->header->joint_count; j++) {
        const float *box = mesh->joint_boxes + 6u * (size_t)j;
        noh_blob_body body = { .joint = skin->joints[j] };
        if (noh_box_is_empty(box)) continue;
        set_box(&body, box, skin->inverse_bind + 12u * (size_t)j);
        keep(rig, &body);
    }
}

static void keep_node(noh_blob_rig *rig, const noh_kind_desc *kind, uint32_t mesh_index, const float *world)
{
    static const float identity[12] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0 };
    noh_blob_body body = { .joint = NOH_NONE };
    float box[6];
    noh_skin skin;
    noh_mesh mesh;
    if (noh_pack_mesh_at(kind->mesh, mesh_index, &mesh, NULL)) return;
    if (noh_pack_skin_at(kind->mesh, mesh.header->skin, &skin, NULL) == NOH_OK) {
        if (skin.header->skeleton == kind->skeleton) keep_skin(rig, &mesh, &skin);
        return;
    }
    memcpy(box, mesh.header->bounds_min, 3 * sizeof *box);
    memcpy(box + 3, mesh.header->bounds_max, 3 * sizeof *box);
    set_box(&body, box, world ? world : identity);
    keep(rig, &body);
}

static int is_wanted(const noh_kind_desc *kind, uint32_t index)
{
    if (!kind->nodes) return 1;
    for (uint32_t i = 0; i < kind->node_count; i++) {
        if (kind->nodes[i] == index) return 1;
    }
    return 0;
}

noh_result noh_blob_rig_make(const noh_kind_desc *kind, noh_blob_rig *rig, noh_error *error)
{
    const noh_pack *pack;
    NOH_ASSERT(kind && kind->mesh && rig);
    pack = kind->mesh;
    rig->body_count = 0;
    for (uint32_t i = 0; i < pack->node_count; i++) {
        const noh_node *node = &pack->nodes[i];
        if (node->mesh != NOH_NONE && is_wanted(kind, i)) keep_node(rig, kind, node->mesh, node->world);
    }
    for (uint32_t i = 0; !pack->node_count && i < pack->runs[NOH_CHUNK_MESH].count; i++) {
        if (is_wanted(kind, i)) keep_node(rig, kind, i, NULL);
    }
    return rig->body_count ? NOH_OK : noh_fail(error, NOH_ERR_NOT_FOUND, "blobs: the kind has no mesh to draw", 0, 0);
}

/* ---- blobs ---- */

/* The ellipse of a box seen from above: half axes of its second moments in x and z. */
static void ellipse(const float half[3][3], float along[2], float across[2])
{
    float xx = 0.0f, xz = 0.0f, zz = 0.0f, mean, root, large, small, axis[2], length;
    for (int k = 0; k < 3; k++) {
        xx += half[k][0] * half[k][0];
        xz += half[k][0] * half[k][2];
        zz += half[k][2] * half[k][2];
    }
    mean = 0.5f * (xx + zz);
    root = noh_sqrt(0.25f * (xx - zz) * (xx - zz) + xz * xz);
    large = noh_sqrt(mean + root);
    small = mean > root ? noh_sqrt(mean - root) : 0.0f;
    axis[0] = xx >= zz ? 0.5f * (xx - zz) + root : xz;
    axis[1] = xx >= zz ? xz : 0.5f * (zz - xx) + root;
    length = noh_sqrt(axis[0] * axis[0] + axis[1] * axis[1]);
    if (!(length > 0.0f)) {
        axis[0] = length = 1.0f;
        axis[1] = 0.0f;
    }
    axis[0] /= length, axis[1] /= length;
    along[0] = axis[0] * large, along[1] = axis[1] * large;
    across[0] = -axis[1] * small, across[1] = axis[0] * small;
}

/* Put an axis in the xz plane on a slope, `more` longer. */
static void lay(const float flat[2], float more, const float normal[3], float out[3])
{
    const float length = noh_sqrt(flat[0] * flat[0] + flat[1] * flat[1]);
    const float scale = length > 0.0f ? (SPREAD * length + more) / length : 0.0f;
    out[0] = flat[0] * scale;
    out[2] = flat[1] * scale;
    out[1] = -(normal[0] * out[0] + normal[2] * out[2]) / normal[1];
}

/* Returns 0 if there is no blob. */
static int blob_of(const float centre[3], const float half[3][3], const noh_ground *ground, noh_blob *out)
{
    float below = 0.0f, along[2], across[2], normal[3], radius, gap, distance;
    for (int k = 0; k < 3; k++) below += half[k][1] < 0.0f ? -half[k][1] : half[k][1];
    ellipse(half, along, across);
    radius = noh_sqrt(
        noh_sqrt((along[0] * along[0] + along[1] * along[1]) * (across[0] * across[0] + across[1] * across[1])));
    if (!(radius > 0.0f)) return 0;
    distance = noh_ground_below(ground, centre, below + REACH * radius, normal);
    if (distance < 0.0f || !(normal[1] > 0.1f)) return 0;
    gap = distance > below ? distance - below : 0.0f;
    out->darkness = SHARE * radius * radius / (radius * radius + 4.0f * gap * gap);
    if (out->darkness < FAINTEST) return 0;
    memcpy(out->centre, centre, sizeof out->centre);
    out->centre[1] -= distance;
    lay(along, HEIGHT_SPREAD * gap, normal, out->along);
    lay(across, HEIGHT_SPREAD * gap, normal, out->across);
    return 1;
}

/* Transform a box to the world. */
static void move_body(const noh_blob_body *b, const float m[12], float centre[3], float half[3][3])
{
    for (int row = 0; row < 3; row++) {
        const float *r = m + 4 * row;
        centre[row] = r[0] * b->centre[0] + r[1] * b->centre[1] + r[2] * b->centre[2] + r[3];
        for (int k = 0; k < 3; k++) {
            half[k][row] = r[0] * b->half[k][0] + r[1] * b->half[k][1] + r[2] * b->half[k][2];
        }
    }
}

uint32_t noh_actor_blobs(const noh_stage *stage, noh_actor actor, const noh_blob_rig *rig, const noh_ground *ground,
                         noh_blob *blobs)
{
    noh_stage_kind *k;
    const noh_stage_actor *a = noh_stage_actor_of(stage, actor, &k);
    uint32_t count = 0;
    NOH_ASSERT(rig && ground && blobs);
    if (a && k->finer.hidden) return 0;
    for (uint32_t i = 0; a && i < rig->body_count; i++) {
        const noh_blob_body *body = &rig->bodies[i];
        float matrix[12], centre[3], half[3][3];
        if (body->joint == NOH_NONE)
            noh_stage_world(stage, (uint32_t)(a - stage->actors), matrix);
        else if (noh_actor_joint(stage, actor, body->joint, matrix, NULL))
            continue;
        move_body(body, matrix, centre, half);
        count += (uint32_t)blob_of(centre, (const float(*)[3])half, ground, &blobs[count]);
    }
    return count;
}
