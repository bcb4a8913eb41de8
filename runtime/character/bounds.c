#include "character/bounds.h"

#include "base/math.h"

#define ROUNDING 1.000002f /* of the sums and roots below */

/* A ball around a posed joint, in which is what hangs on this joint or on one that follows it. */
typedef struct ball {
    const float *matrix;
    float radius;
} ball;

static float bone_length(const noh_skeleton *s, uint32_t joint)
{
    const float *t = s->bind_pose[joint].translation;
    return noh_sqrt(noh_dot3(t, t));
}

/* The length of the longest column: how much the matrix stretches a margin. */
static float longest_axis(const float *m)
{
    float longest = 0.0f;
    for (int c = 0; c < 3; c++) {
        float square = m[c] * m[c] + m[4 + c] * m[4 + c] + m[8 + c] * m[8 + c];
        longest = square > longest ? square : longest;
    }
    return noh_sqrt(longest);
}

static ball ball_of(const noh_skeleton *s, const float *model, float margin, uint32_t joint, uint32_t posed_count)
{
    ball b;
    while (joint >= posed_count) {
        NOH_ASSERT(s->parents[joint] != NOH_JOINT_ROOT);
        margin += bone_length(s, joint);
        joint = s->parents[joint];
    }
    b.matrix = model + 12u * (size_t)joint;
    b.radius = margin * longest_axis(b.matrix) * ROUNDING;
    return b;
}

static void add_to_box(noh_bounds *bounds, ball b)
{
    for (int i = 0; i < 3; i++) {
        float low = b.matrix[4 * i + 3] - b.radius, high = b.matrix[4 * i + 3] + b.radius;
        bounds->low[i] = low < bounds->low[i] ? low : bounds->low[i];
        bounds->high[i] = high > bounds->high[i] ? high : bounds->high[i];
    }
}

static float reach_from(const float *centre, ball b)
{
    float d[3];
    for (int i = 0; i < 3; i++) {
        d[i] = b.matrix[4 * i + 3] - centre[i];
    }
    return noh_sqrt(noh_dot3(d, d)) * ROUNDING + b.radius;
}

void noh_sphere_of_joints(const noh_skeleton *skeleton, const float *model, const float *margin_m, uint32_t joint_count, noh_bounds *bounds)
{
    const float far_away = 3e38f;
    for (int i = 0; i < 3; i++) {
        bounds->low[i] = far_away;
        bounds->high[i] = -far_away;
        bounds->centre[i] = 0.0f;
    }
    bounds->radius = 0.0f;
    for (uint32_t j = 0; j < skeleton->joint_count; j++) {
        if (margin_m[j] >= 0.0f) {
            add_to_box(bounds, ball_of(skeleton, model, margin_m[j], j, joint_count));
        }
    }
    if (bounds->low[0] > bounds->high[0]) {
        return;
    }
    for (int i = 0; i < 3; i++) {
        bounds->centre[i] = 0.5f * bounds->low[i] + 0.5f * bounds->high[i];
    }
    for (uint32_t j = 0; j < skeleton->joint_count; j++) {
        float reach = margin_m[j] >= 0.0f ? reach_from(bounds->centre, ball_of(skeleton, model, margin_m[j], j, joint_count)) : 0.0f;
        bounds->radius = reach > bounds->radius ? reach : bounds->radius;
    }
}

float noh_sphere_of_skeleton(const noh_skeleton *skeleton, const float *margin_m)
{
    float radius = 0.0f;
    for (uint32_t j = 0; j < skeleton->joint_count; j++) {
        float reach = margin_m[j];
        for (uint32_t at = j; reach >= 0.0f && skeleton->parents[at] != NOH_JOINT_ROOT; at = skeleton->parents[at]) {
            reach += bone_length(skeleton, at);
        }
        radius = reach > radius ? reach : radius;
    }
    return radius * ROUNDING;
}
