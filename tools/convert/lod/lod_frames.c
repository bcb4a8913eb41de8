/* lod_frames.c: linear blend skinning of single frames, and which frames to take. */
#include "lod_frames.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/clips/channel_sample.h"
#include "convert/model/model_build.h"
#include "convert/base/quat.h"

#define LOOKED_AT_HZ 8.0
#define SNAP_S 1e-6

/* ---- matrices: three columns and the translation ---- */

static void multiply(const double *a, const double *b, double *out)
{
    for (int column = 0; column < 4; column++) {
        for (int row = 0; row < 3; row++) {
            double sum = column == 3 ? a[9 + row] : 0.0;
            for (int k = 0; k < 3; k++) {
                sum += a[k * 3 + row] * b[column * 3 + k];
            }
            out[column * 3 + row] = sum;
        }
    }
}

static void from_columns(const double *m16, double *out)
{
    for (int i = 0; i < 12; i++) {
        out[i] = m16[i / 3 * 4 + i % 3];
    }
}

/* The inverse of an affine matrix; zeros if there is none. */
static void invert(const double *m, double *out)
{
    double rows[3][3], determinant;
    vec_cross(m + 3, m + 6, rows[0]);
    vec_cross(m + 6, m, rows[1]);
    vec_cross(m, m + 3, rows[2]);
    determinant = vec_dot(m, rows[0]);
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 3; column++) {
            out[column * 3 + row] = determinant != 0.0 ? rows[row][column] / determinant : 0.0;
        }
    }
    for (int row = 0; row < 3; row++) {
        out[9 + row] = -(out[row] * m[9] + out[3 + row] * m[10] + out[6 + row] * m[11]);
    }
}

/* ---- poses of the nodes ---- */

typedef struct node_pose {
    double translation[3], rotation[4], scale[3];
} node_pose;

static void rest_poses(const model *m, node_pose *out)
{
    for (uint32_t i = 0; i < m->node_count; i++) {
        for (int k = 0; k < 4; k++) {
            out[i].rotation[k] = m->nodes[i].rotation[k];
        }
        for (int k = 0; k < 3; k++) {
            out[i].translation[k] = m->nodes[i].translation[k];
            out[i].scale[k] = m->nodes[i].scale[k];
        }
    }
}

static void sample_clip(const model *m, uint32_t clip, double time_s, node_pose *out)
{
    rest_poses(m, out);
    for (uint32_t i = 0; i < m->clips[clip].channel_count; i++) {
        const model_channel *c = &m->clips[clip].channels[i];
        node_pose *node = &out[c->node];
        double *to = c->path == MODEL_PATH_TRANSLATION ? node->translation
                     : c->path == MODEL_PATH_ROTATION  ? node->rotation
                                                       : node->scale;
        if (c->path != MODEL_PATH_WEIGHTS) {
            (void)channel_sample(c, time_s, SNAP_S, to);
        }
    }
}

/* [node_count][12] */
static void world_matrices(const model *m, const node_pose *poses, double *out)
{
    for (uint32_t i = 0; i < m->node_count; i++) {
        double local[12];
        quat_columns(poses[i].rotation, local);
        for (int k = 0; k < 9; k++) {
            local[k] *= poses[i].scale[k / 3];
        }
        memcpy(local + 9, poses[i].translation, sizeof poses[i].translation);
        if (m->nodes[i].parent == MODEL_NONE) {
            memcpy(out + (size_t)i * 12u, local, sizeof local);
        } else {
            multiply(out + (size_t)m->nodes[i].parent * 12u, local, out + (size_t)i * 12u);
        }
    }
}

/* ---- skinning ---- */

uint32_t lod_skinned_node(const model *m, uint32_t mesh)
{
    for (uint32_t i = 0; i < m->node_count; i++) {
        if (m->nodes[i].mesh == mesh && m->nodes[i].skin != MODEL_NONE && m->meshes[mesh].joint_weights) {
            return i;
        }
    }
    return MODEL_NONE;
}

static void inverse_bind(const model_skin *skin, uint32_t joint, double *out)
{
    double columns[16];
    for (int i = 0; i < 16; i++) {
        columns[i] = skin->inverse_bind[(size_t)joint * 16u + (size_t)i];
    }
    from_columns(columns, out);
}

/* For each joint, the matrix from the mesh at rest to the mesh in the pose; at rest the mesh is where its first joint
 * puts it. */
static void joint_matrices(const model *m, const model_node *node, const double *worlds, double *out)
{
    const model_skin *skin = &m->skins[node->skin];
    double joint[12], bind[12], rest[12], to_mesh[12], posed[12];
    from_columns(m->nodes[skin->joints[0]].world, joint);
    inverse_bind(skin, 0, bind);
    multiply(joint, bind, rest);
    invert(rest, to_mesh);
    for (uint32_t j = 0; j < skin->joint_count; j++) {
        inverse_bind(skin, j, bind);
        multiply(worlds + (size_t)skin->joints[j] * 12u, bind, posed);
        multiply(to_mesh, posed, out + (size_t)j * 12u);
    }
}

/* Skin a vertex by its `most` heaviest joints. */
static void skin_vertex(const model_mesh *mesh, const double *joints, size_t v, uint32_t most, float *out)
{
    const float *p = mesh->position + v * 3u;
    double sum[3] = { 0.0, 0.0, 0.0 }, total = 0.0;
    for (size_t i = v * MODEL_INFLUENCES_MAX; i < v * MODEL_INFLUENCES_MAX + most; i++) {
        const double *m = joints + (size_t)mesh->joints[i] * 12u, weight = mesh->joint_weights[i];
        if (!(weight > 0.0)) break; /* zeros come last */
        for (int row = 0; row < 3; row++) {
            sum[row] += weight * (m[row] * p[0] + m[3 + row] * p[1] + m[6 + row] * p[2] + m[9 + row]);
        }
        total += weight;
    }
    for (int row = 0; row < 3; row++) {
        out[row] = (float)(most < MODEL_INFLUENCES_MAX ? sum[row] / total : sum[row]);
    }
}

/* Raise errors[LOD_CAPS] to the errors of the caps in a frame. */
static void measure_caps(const model_mesh *mesh, const double *joints, const float *frame, float *errors)
{
    static const uint32_t caps[LOD_CAPS] = { 4, 2, 1 };
    for (uint32_t k = 0; k < LOD_CAPS; k++) {
        for (size_t v = 0; v < mesh->vertex_count && mesh->influence_max > caps[k]; v++) {
            float capped[3], dx, dy, dz, distance;
            skin_vertex(mesh, joints, v, caps[k], capped);
            dx = capped[0] - frame[v * 3u];
            dy = capped[1] - frame[v * 3u + 1u];
            dz = capped[2] - frame[v * 3u + 2u];
            distance = sqrtf(dx * dx + dy * dy + dz * dz);
            errors[k] = distance > errors[k] ? distance : errors[k];
        }
        if (k && errors[k] < errors[k - 1u]) {
            errors[k] = errors[k - 1u];
        }
    }
}

/* cap_error: NULL, or [LOD_CAPS] to be raised. */
static int skin_frame(const model *m, uint32_t node, const node_pose *poses, float *out, float *cap_error)
{
    const model_mesh *mesh = &m->meshes[m->nodes[node].mesh];
    double *worlds = model_zeros(m->node_count, 12 * sizeof *worlds);
    double *joints = model_zeros(m->skins[m->nodes[node].skin].joint_count, 12 * sizeof *joints);
    if (worlds && joints) {
        world_matrices(m, poses, worlds);
        joint_matrices(m, &m->nodes[node], worlds, joints);
        for (size_t v = 0; v < mesh->vertex_count; v++) {
            skin_vertex(mesh, joints, v, MODEL_INFLUENCES_MAX, out + v * 3u);
        }
        if (cap_error) {
            measure_caps(mesh, joints, out, cap_error);
        }
    }
    free(worlds);
    free(joints);
    return !worlds || !joints;
}

int lod_frame_pose(const model *m, uint32_t node, uint32_t clip, double time_s, float *out)
{
    node_pose *poses = model_zeros(m->node_count, sizeof *poses);
    int failed = !poses;
    if (!failed) {
        sample_clip(m, clip, time_s, poses);
        failed = skin_frame(m, node, poses, out, NULL);
    }
    free(poses);
    return failed;
}

/* ---- choosing ---- */

typedef struct moment {
    uint32_t clip;
    double time_s, distance; /* from the nearest of those taken */
} moment;

static int moves_joints(const model *m, uint32_t node, uint32_t clip)
{
    const model_skin *skin = &m->skins[m->nodes[node].skin];
    for (uint32_t i = 0; i < m->clips[clip].channel_count; i++) {
        const model_channel *c = &m->clips[clip].channels[i];
        for (uint32_t j = 0; j < skin->joint_count; j++) {
            if (c->path != MODEL_PATH_WEIGHTS && skin->joints[j] == c->node) {
                return 1;
            }
        }
    }
    return 0;
}

static uint32_t list_moments(const model *m, uint32_t node, moment *out)
{
    uint32_t count = 0;
    for (uint32_t c = 0; c < m->clip_count; c++) {
        uint32_t steps = (uint32_t)((double)m->clips[c].duration_s * LOOKED_AT_HZ);
        if (!moves_joints(m, node, c)) {
            continue;
        }
        for (uint32_t i = 0; i <= steps; i++, count++) {
            if (out) {
                out[count].clip = c;
                out[count].time_s = (double)i / LOOKED_AT_HZ;
            }
        }
    }
    return count;
}

/* The difference of two poses: the angles between the rotations of the skin's joints. */
static double difference(const model_skin *skin, const node_pose *a, const node_pose *b)
{
    double sum = 0.0;
    for (uint32_t j = 0; j < skin->joint_count; j++) {
        double d = quat_dot(a[skin->joints[j]].rotation, b[skin->joints[j]].rotation);
        sum += 1.0 - d * d;
    }
    return sum;
}

/* Lower every moment's distance to that from the pose `taken`. */
static void near_by(const model *m, const model_skin *skin, moment *list, uint32_t count, const node_pose *taken,
                    node_pose *scratch)
{
    for (uint32_t i = 0; i < count; i++) {
        double d;
        sample_clip(m, list[i].clip, list[i].time_s, scratch);
        d = difference(skin, taken, scratch);
        list[i].distance = d < list[i].distance ? d : list[i].distance;
    }
}

static int choose(const model *m, uint32_t node, moment *list, uint32_t count, uint32_t wanted, lod_frames *out)
{
    const model_skin *skin = &m->skins[m->nodes[node].skin];
    size_t floats = (size_t)m->meshes[m->nodes[node].mesh].vertex_count * 3u;
    node_pose *taken = model_zeros(m->node_count, sizeof *taken),
              *scratch = model_zeros(m->node_count, sizeof *scratch);
    int failed = !taken || !scratch;
    for (uint32_t i = 0; i < count; i++) {
        list[i].distance = HUGE_VAL;
    }
    if (!failed) {
        rest_poses(m, taken);
    }
    while (!failed && out->count < wanted) {
        uint32_t best = 0;
        near_by(m, skin, list, count, taken, scratch);
        for (uint32_t i = 1; i < count; i++) {
            best = list[i].distance > list[best].distance ? i : best;
        }
        if (!(list[best].distance > 0.0)) {
            break;
        }
        out->moments[out->count].clip = list[best].clip;
        out->moments[out->count].time_s = list[best].time_s;
        out->poses[out->count] = model_zeros(floats, sizeof(float));
        sample_clip(m, list[best].clip, list[best].time_s, taken);
        failed = !out->poses[out->count] || skin_frame(m, node, taken, out->poses[out->count], out->cap_error);
        out->count++;
    }
    free(taken);
    free(scratch);
    return failed;
}

int lod_frames_choose(const model *m, uint32_t node, uint32_t count, lod_frames *out)
{
    uint32_t moments = list_moments(m, node, NULL);
    moment *list = model_zeros((size_t)moments + 1u, sizeof *list);
    int failed;
    memset(out, 0, sizeof *out);
    out->poses = model_zeros((size_t)count + 1u, sizeof *out->poses);
    out->moments = model_zeros((size_t)count + 1u, sizeof *out->moments);
    failed = !list || !out->poses || !out->moments;
    if (!failed && moments) {
        list_moments(m, node, list);
        failed = choose(m, node, list, moments, count, out);
    }
    free(list);
    if (failed) {
        lod_frames_free(out);
    }
    return failed;
}

int lod_frames_again(const model *m, uint32_t node, lod_frames *f)
{
    for (uint32_t i = 0; i < f->count; i++) {
        const size_t floats = 3u * (size_t)m->meshes[m->nodes[node].mesh].vertex_count;
        float *pose = model_zeros(floats, sizeof *pose);
        if (!pose || lod_frame_pose(m, node, f->moments[i].clip, f->moments[i].time_s, pose)) {
            free(pose);
            return 1;
        }
        free(f->poses[i]);
        f->poses[i] = pose;
    }
    return 0;
}

void lod_frames_free(lod_frames *f)
{
    for (uint32_t i = 0; f->poses && i < f->count; i++) {
        free(f->poses[i]);
    }
    free(f->poses);
    free(f->moments);
    f->poses = NULL;
    f->moments = NULL;
    f->count = 0;
}
