#include "loop_check.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"
#include "raw_set.h"

static double length(const double *v)
{
    return sqrt(vec_dot(v, v));
}

/* The points at both ends of one axis, in the two poses, in the skeleton's unit. */
static double axis_difference(const double *a, const double *b, int axis, double shell)
{
    const double size = length(a + axis * 3), out = size > 0.0 ? shell / size : 0.0;
    double largest = 0.0;
    for (int side = -1; side <= 1; side += 2) {
        double d[3];
        for (int i = 0; i < 3; ++i) d[i] = b[9 + i] - a[9 + i] + side * out * (b[axis * 3 + i] - a[axis * 3 + i]);
        largest = fmax(largest, length(d));
    }
    return largest;
}

static double joint_difference(const double *a, const double *b, double shell)
{
    double largest = 0.0;
    for (int axis = 0; axis < 3; ++axis) largest = fmax(largest, axis_difference(a, b, axis, shell));
    return largest;
}

static void compare_joints(const raw_skeleton *skeleton, const double *first, const double *last, double shell_cm,
                           double *worst, uint32_t *joint)
{
    *worst = 0.0;
    *joint = skeleton->joint_count ? 0 : MODEL_NONE;
    for (uint32_t j = 0; j < skeleton->joint_count; ++j) {
        const size_t at = (size_t)j * 12;
        double cm = joint_difference(first + at, last + at, shell_cm / skeleton->unit_cm) * skeleton->unit_cm;
        if (cm > *worst) {
            *worst = cm;
            *joint = j;
        }
    }
}

/* --- without the travel --- */

#define TRAVEL_CM 0.01 /* a smaller distance is the noise of a joint that stands still */

static double local_travel_cm(const raw_skeleton *skeleton, const raw_clip *clip, const double *first, uint32_t j)
{
    const float *a = clip->translations + (size_t)j * 3,
                *b = a + (size_t)(clip->frame_count - 1) * clip->joint_count * 3;
    const double d[3] = { (double)b[0] - (double)a[0], (double)b[1] - (double)a[1], (double)b[2] - (double)a[2] };
    const uint32_t parent = skeleton->joints[j].parent;
    return length(d) * skeleton->unit_cm * (parent == MODEL_NONE ? 1.0 : length(first + (size_t)parent * 12));
}

/* In a copy of the last frame, move the topmost joint of each chain that travels back to where it began. */
static void put_back(const raw_skeleton *skeleton, const raw_clip *clip, const double *first, uint8_t *below,
                     raw_clip *frame)
{
    const size_t joints = clip->joint_count, last = (size_t)(clip->frame_count - 1) * joints;
    memcpy(frame->rotations, clip->rotations + last * 4, joints * 4 * sizeof(float));
    memcpy(frame->translations, clip->translations + last * 3, joints * 3 * sizeof(float));
    memcpy(frame->scales, clip->scales + last * 3, joints * 3 * sizeof(float));
    for (uint32_t j = 0; j < joints; ++j) {
        const uint32_t parent = skeleton->joints[j].parent;
        below[j] = parent != MODEL_NONE && below[parent];
        if (below[j] || !(local_travel_cm(skeleton, clip, first, j) > TRAVEL_CM)) continue;
        below[j] = 1;
        memcpy(frame->rotations + (size_t)j * 4, clip->rotations + (size_t)j * 4, 4 * sizeof(float));
        memcpy(frame->translations + (size_t)j * 3, clip->translations + (size_t)j * 3, 3 * sizeof(float));
    }
}

static int compare_in_place(const raw_skeleton *skeleton, const raw_clip *clip, const double *first, double *pose,
                            double shell_cm, raw_loop_check *out)
{
    raw_clip frame = { 0 };
    uint8_t *below = model_zeros(clip->joint_count, 1);
    int failed = !below || raw_clip_alloc(&frame, 1, clip->joint_count);
    if (!failed) {
        put_back(skeleton, clip, first, below, &frame);
        raw_pose_object(skeleton, &frame, 0, pose);
        compare_joints(skeleton, first, pose, shell_cm, &out->in_place_cm, &out->in_place_joint);
    }
    raw_clip_clear(&frame);
    free(below);
    return failed;
}

static void compare_floats(const raw_clip *clip, raw_loop_check *out)
{
    for (uint32_t i = 0; i < clip->float_count; ++i) {
        const raw_floats *f = &clip->floats[i];
        const float *last = f->values + (size_t)(clip->frame_count - 1) * f->width;
        double sum_cm = 0.0;
        for (uint32_t k = 0; k < f->width; ++k) {
            double d = fabs((double)last[k] - (double)f->values[k]);
            sum_cm += f->radius ? d * (double)f->radius[k] : 0.0;
            out->float_units = f->radius ? out->float_units : fmax(out->float_units, d);
        }
        out->float_cm = fmax(out->float_cm, sum_cm);
    }
}

int raw_clip_check_loop(const raw_skeleton *skeleton, const raw_clip *clip, double shell_cm, raw_loop_check *out)
{
    const size_t size = (size_t)skeleton->joint_count * 12;
    memset(out, 0, sizeof *out);
    out->joint = out->in_place_joint = MODEL_NONE;
    compare_floats(clip, out);
    if (clip->joint_count == 0) return 0;
    double *poses = model_zeros(size * 2, sizeof *poses);
    if (!poses) return 1;
    double *first = poses, *last = poses + size;
    raw_pose_object(skeleton, clip, 0, first);
    raw_pose_object(skeleton, clip, clip->frame_count - 1, last);
    compare_joints(skeleton, first, last, shell_cm, &out->difference_cm, &out->joint);
    int failed = compare_in_place(skeleton, clip, first, last, shell_cm, out);
    free(poses);
    return failed;
}
