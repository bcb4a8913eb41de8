#include "core/base/assert_internal.h"
#include "stage/character/bounds_internal.h"
#include "noh/clip.h"
#include "noh/low_motion.h"
#include "noh/pack.h"

#include "core/base/math_internal.h"

#define ROUNDING 1.000002f /* above the rounding error of the sums and roots below */

/* A ball that contains the vertices of one joint. Its centre is the joint or, if the joint was not posed, the nearest
 * posed ancestor. The distance between the two is at most the sum of the bones in between, whatever their rotations. */
typedef struct ball {
    const float *matrix; /* joint at the centre */
    float radius, stretch;
} ball;

static float bone_length(const noh_skeleton *s, uint32_t joint)
{
    const float *t = s->bind_pose[joint].translation;
    return noh_sqrt(noh_dot3(t, t));
}

/* The largest factor by which a joint's scale stretches its descendants. */
static float largest_scale(const noh_transform *t)
{
    const float x = noh_abs(t->scale[0]), y = noh_abs(t->scale[1]), z = noh_abs(t->scale[2]);
    const float most = x > y ? x : y;
    return most > z ? most : z;
}

static ball ball_of(const noh_skeleton *s, const float *model, float radius, uint32_t joint, uint32_t posed_count)
{
    ball b;
    while (joint >= posed_count) {
        NOH_ASSERT(s->parents[joint] != NOH_JOINT_ROOT);
        radius = radius * largest_scale(&s->bind_pose[joint]) + bone_length(s, joint);
        joint = s->parents[joint];
    }
    b.matrix = model + 12u * (size_t)joint;
    b.stretch = noh_stretch(b.matrix) * ROUNDING;
    b.radius = radius * b.stretch;
    return b;
}

static void add_to_box(noh_bounds *bounds, ball b)
{
    bounds->stretch = b.stretch > bounds->stretch ? b.stretch : bounds->stretch;
    for (int i = 0; i < 3; i++) {
        float low = b.matrix[4 * i + 3] - b.radius, high = b.matrix[4 * i + 3] + b.radius;
        bounds->low[i] = low < bounds->low[i] ? low : bounds->low[i];
        bounds->high[i] = high > bounds->high[i] ? high : bounds->high[i];
    }
}

/* The radius around a centre that contains a ball. */
static float radius_around(const float *centre, ball b)
{
    float d[3];
    for (int i = 0; i < 3; i++) {
        d[i] = b.matrix[4 * i + 3] - centre[i];
    }
    return noh_sqrt(noh_dot3(d, d)) * ROUNDING + b.radius;
}

#define KEPT 64u /* balls kept for the second pass */

/* The box contains all balls. The sphere is not minimal, but centred in the box: a second pass over the joints finds
 * the radius that contains every ball, at most sqrt(3) times the smallest radius. */
void noh_joint_bounds(const noh_skeleton *skeleton, const float *model, const float *joint_radius_m,
                      uint32_t joint_count, noh_bounds *bounds)
{
    const float far_away = 3e38f;
    ball balls[KEPT];
    uint32_t kept = 0, next = 0;
    NOH_ASSERT(skeleton && model && joint_radius_m && bounds && joint_count <= skeleton->joint_count);
    for (int i = 0; i < 3; i++) {
        bounds->low[i] = far_away;
        bounds->high[i] = -far_away;
        bounds->centre[i] = 0.0f;
    }
    bounds->radius = bounds->stretch = 0.0f;
    for (uint32_t j = 0; j < skeleton->joint_count; j++) {
        ball b;
        if (!(joint_radius_m[j] >= 0.0f)) continue;
        b = ball_of(skeleton, model, joint_radius_m[j], j, joint_count);
        add_to_box(bounds, b);
        if (kept < KEPT) balls[kept++] = b;
    }
    if (bounds->low[0] > bounds->high[0]) {
        return;
    }
    for (int i = 0; i < 3; i++) {
        bounds->centre[i] = 0.5f * bounds->low[i] + 0.5f * bounds->high[i];
    }
    for (uint32_t j = 0; j < skeleton->joint_count; j++) {
        float radius;
        if (!(joint_radius_m[j] >= 0.0f)) continue;
        radius = radius_around(bounds->centre,
                               next < kept ? balls[next] : ball_of(skeleton, model, joint_radius_m[j], j, joint_count));
        next++;
        bounds->radius = radius > bounds->radius ? radius : bounds->radius;
    }
}

/* Bones keep their lengths, so a joint is never farther from its root than the sum of the bones between them. */
float noh_skeleton_radius(const noh_skeleton *skeleton, const float *joint_radius_m)
{
    float largest = 0.0f;
    NOH_ASSERT(skeleton && joint_radius_m);
    for (uint32_t j = 0; j < skeleton->joint_count; j++) {
        float radius = joint_radius_m[j];
        for (uint32_t at = j; radius >= 0.0f && skeleton->parents[at] != NOH_JOINT_ROOT; at = skeleton->parents[at]) {
            radius += bone_length(skeleton, at);
        }
        largest = radius > largest ? radius : largest;
    }
    return largest * ROUNDING;
}

/* The extension of a box by targets: the sum of their boxes. Each box contains 0. A negative weight swaps low and
 * high. */
static void add_targets(const noh_mesh *mesh, const float *weights, float deltas[6])
{
    for (int i = 0; i < 6; i++) {
        deltas[i] = 0.0f;
    }
    for (uint32_t t = 0; t < mesh->header->target_count; t++) {
        const float weight = weights ? weights[t] : 1.0f, *box = mesh->target_boxes + 6u * (size_t)t;
        for (int i = 0; i < 6; i++) {
            deltas[i] += weight * (weight < 0.0f ? box[(i + 3) % 6] : box[i]);
        }
    }
}

/* The distance from a joint to the farthest corner of a box. No point of the box is farther away. */
static float farthest_corner(const float *inverse_bind, const float box[6])
{
    float farthest = 0.0f;
    for (int corner = 0; corner < 8; corner++) {
        float at[3], square;
        for (int r = 0; r < 3; r++) {
            const float *row = inverse_bind + 4 * r;
            at[r] = row[3];
            for (int c = 0; c < 3; c++) {
                at[r] += row[c] * box[(corner >> c & 1) * 3 + c];
            }
        }
        square = noh_dot3(at, at);
        farthest = square > farthest ? square : farthest;
    }
    return noh_sqrt(farthest) * ROUNDING;
}

void noh_mesh_add_joint_radii(const noh_mesh *mesh, const float *weights, float *joint_radius_m)
{
    noh_skin skin;
    float deltas[6];
    NOH_ASSERT(mesh && joint_radius_m);
    if (noh_pack_skin_at(mesh->pack, mesh->header->skin, &skin, NULL)) {
        return;
    }
    add_targets(mesh, weights, deltas);
    for (size_t j = 0; j < skin.header->joint_count; j++) {
        const float *rest = mesh->joint_boxes + 6u * j;
        float box[6], radius;
        for (int i = 0; i < 6; i++) {
            box[i] = rest[i] + deltas[i];
        }
        radius = rest[0] <= rest[3] ? farthest_corner(skin.inverse_bind + 12u * j, box) : -1.0f;
        if (radius > joint_radius_m[skin.joints[j]]) {
            joint_radius_m[skin.joints[j]] = radius;
        }
    }
}
