/* raw_pose.c: raw poses in object space. */
#include "raw_set.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"
#include "convert/base/quat.h"

static void local_matrix(const float *rotation, const float *translation, const float *scale, double *out)
{
    double q[4];
    for (int i = 0; i < 4; ++i) q[i] = (double)rotation[i];
    (void)quat_normalize(q); /* stored, it has unit length only to a float's precision */
    quat_columns(q, out);
    for (int i = 0; i < 9; ++i) out[i] *= (double)scale[i / 3];
    for (int i = 0; i < 3; ++i) out[9 + i] = (double)translation[i];
}

static void multiply(const double *a, const double *b, double *out)
{
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 3; ++row) {
            double sum = column == 3 ? a[9 + row] : 0.0;
            for (int k = 0; k < 3; ++k) sum += a[k * 3 + row] * b[column * 3 + k];
            out[column * 3 + row] = sum;
        }
}

void raw_pose_below(uint32_t parent, const double *local, size_t joint, double *pose)
{
    if (parent == MODEL_NONE)
        memcpy(pose + joint * 12, local, 12 * sizeof *local);
    else
        multiply(pose + (size_t)parent * 12, local, pose + joint * 12);
}

void raw_pose_object(const raw_skeleton *skeleton, const raw_clip *clip, uint32_t frame, double *out)
{
    for (uint32_t j = 0; j < skeleton->joint_count; ++j) {
        const raw_joint *joint = &skeleton->joints[j];
        const size_t at = clip ? (size_t)frame * clip->joint_count + j : 0;
        const int bound = !clip || clip->joint_count == 0;
        double local[12];
        local_matrix(bound ? joint->rotation : clip->rotations + at * 4,
                     bound ? joint->translation : clip->translations + at * 3,
                     bound ? joint->scale : clip->scales + at * 3, local);
        raw_pose_below(joint->parent, local, j, out);
    }
}

/* Raise the radii of a joint and of all above it to include `point`. */
static void raise_radius(const raw_skeleton *skeleton, const double *pose, uint32_t joint, const double *point,
                         double *out)
{
    for (uint32_t j = joint; j != MODEL_NONE; j = skeleton->joints[j].parent)
        out[j] = fmax(out[j], vec_distance(pose + (size_t)j * 12 + 9, point) * skeleton->unit_cm);
}

static void end_point(const raw_joint *joint, const double *matrix, double *out)
{
    for (int row = 0; row < 3; ++row) {
        out[row] = matrix[9 + row];
        for (int k = 0; k < 3; ++k) out[row] += matrix[k * 3 + row] * (double)joint->end[k];
    }
}

int raw_skeleton_radius(const raw_skeleton *skeleton, double *out, double *size_cm)
{
    double *pose = model_zeros(skeleton->joint_count, 12 * sizeof *pose);
    if (!pose) return 1;
    raw_pose_object(skeleton, NULL, 0, pose);
    for (uint32_t j = 0; j < skeleton->joint_count; ++j) out[j] = 0.0;
    *size_cm = 0.0;
    for (uint32_t j = 0; j < skeleton->joint_count; ++j) {
        double end[3];
        end_point(&skeleton->joints[j], pose + (size_t)j * 12, end);
        raise_radius(skeleton, pose, j, pose + (size_t)j * 12 + 9, out);
        raise_radius(skeleton, pose, j, end, out);
    }
    for (uint32_t j = 0; j < skeleton->joint_count; ++j) *size_cm = fmax(*size_cm, out[j]);
    free(pose);
    return 0;
}
