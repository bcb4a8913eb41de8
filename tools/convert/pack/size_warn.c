#include "size_warn.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "convert/clips/raw_set.h"
#include "convert/model/model_build.h"
#include "convert/skin/joint_radius.h"

#define PERSON_CM 180.0
#define PERSON_ERROR_CM 0.01
#define PERSON_SHELL_CM 3.0
#define SHARE_MOST 2e-3  /* of the size: above it an error shows */
#define SHARE_LEAST 2e-6 /* below it bytes are spent on nothing */
#define USUAL_LEAST_CM 20.0
#define USUAL_MOST_CM 400.0

double meshes_cm(const model *m)
{
    double size = 0.0;
    for (uint32_t i = 0; m && i < m->mesh_count; i++) {
        const model_mesh *mesh = &m->meshes[i];
        for (size_t axis = 0; axis < 3; axis++) {
            double low = HUGE_VAL, high = -HUGE_VAL;
            for (size_t v = 0; v < mesh->vertex_count; v++) {
                low = fmin(low, (double)mesh->position[v * 3 + axis]);
                high = fmax(high, (double)mesh->position[v * 3 + axis]);
            }
            size = fmax(size, 100.0 * (high - low) * (double)model_mesh_scale(m, i));
        }
    }
    return size;
}

/* Floats of four bytes hold seven digits: a figure that is a millionth of its distance is a few of them wide. */
#define NEAREST_MM 1e-3
#define FARTHEST 1e5 /* times its size */

/* A picture of it would be empty, or its vertices would lie on each other. */
int extent_warn(model *m)
{
    const double size = meshes_cm(m);
    double away = 0.0;
    if (!m->mesh_count) return 0;
    for (uint32_t n = 0; n < m->node_count; n++) {
        const model_node *node = &m->nodes[n];
        if (node->mesh == MODEL_NONE || node->skin != MODEL_NONE) continue;
        const double *x = node->world;
        if (fmax(fmax(vec_dot(x, x), vec_dot(x + 4, x + 4)), vec_dot(x + 8, x + 8)) < 1e-24 &&
            model_warn(m, "node '%.60s': a scale of 0 hides its mesh: remove the node, or set its scale to 1",
                       node->name ? node->name : "")) {
            return 1;
        }
        away = fmax(away, 100.0 * sqrt(vec_dot(x + 12, x + 12)));
    }
    if (!(size > 0.0)) return model_warn(m, "all vertices of a mesh lie on one point: it cannot be seen");
    if (size < NEAREST_MM / 10.0) {
        return model_warn(m, "all meshes are %.3g cm large, too small to be seen: export them scaled by %.0e", size,
                          PERSON_CM / size);
    }
    if (away > FARTHEST * size) {
        return model_warn(
            m,
            "its meshes are %.3g cm large and lie %.3g cm from the origin, where floats are too coarse for "
            "them: move it to the origin before it is exported",
            size, away);
    }
    return 0;
}

#define WEIGHT_MOST 100.0

static double largest_of(const raw_clip *clip, const raw_floats *floats)
{
    double most = 0.0;
    for (size_t i = 0; i < (size_t)clip->frame_count * floats->width; i++) {
        most = fmax(most, fabs((double)floats->values[i]));
    }
    return most;
}

int weights_warn(model *m, raw_set *const *sets, uint32_t set_count)
{
    for (uint32_t i = 0; i < set_count; i++) {
        for (uint32_t c = 0; c < sets[i]->clip_count; c++) {
            const raw_clip *clip = &sets[i]->clips[c];
            for (uint32_t f = 0; f < clip->float_count; f++) {
                const double most = clip->floats[f].node == MODEL_NONE ? 0.0 : largest_of(clip, &clip->floats[f]);
                if (most <= WEIGHT_MOST) continue;
                if (model_warn(
                        m,
                        "clip '%.60s': a target's weight reaches %.3g, which moves vertices %.3g times as far as "
                        "the target: 1 is all of it; if these are percents, divide them by 100",
                        clip->name, most, most)) {
                    return 1;
                }
            }
        }
    }
    return 0;
}

/* The longest side of a box about joints in the bind pose and what each moves; 0: there is nothing to measure. */
static double size_cm(const model *m, const raw_set *set, uint32_t index, int *failed)
{
    const uint32_t count = set->skeleton.joint_count;
    double *pose = malloc(((size_t)count + 1u) * 12u * sizeof *pose), size = 0.0;
    float *radius = malloc((count + 1u) * sizeof *radius);
    *failed = !pose || !radius;
    if (!*failed) {
        (void)joint_radius(m, index, count, radius);
        raw_pose_object(&set->skeleton, NULL, 0, pose);
    }
    for (int axis = 0; axis < 3 && !*failed; axis++) {
        double low = 0.0, high = 0.0;
        for (uint32_t j = 0; j < count; j++) {
            const double *matrix = pose + 12u * (size_t)j, at = matrix[9 + axis];
            const double around = fmax((double)radius[j], 0.0) * sqrt(vec_dot(matrix, matrix)); /* of its own space */
            low = j ? fmin(low, at - around) : at - around;
            high = j ? fmax(high, at + around) : at + around;
        }
        size = fmax(size, high - low);
    }
    free(pose);
    free(radius);
    return count ? size * set->skeleton.unit_cm : meshes_cm(m);
}

/* To one digit. */
static double rounded(double x)
{
    const double unit = pow(10.0, floor(log10(x)));
    return fmax(floor(x / unit + 0.5), 1.0) * unit;
}

/* The factor of a unit in which the size would be usual, or 0. */
static double unit_slip(double size)
{
    static const double factors[] = { 100.0, 0.01, 1000.0, 0.001, 39.37, 1.0 / 39.37 };
    for (size_t i = 0; i < sizeof factors / sizeof factors[0]; i++) {
        if (size * factors[i] >= USUAL_LEAST_CM && size * factors[i] <= USUAL_MOST_CM) return factors[i];
    }
    return 0.0;
}

static int warn(model *m, raw_set *set, double size, double error_cm, int fits)
{
    const double error = fmin(fmax(rounded(size * PERSON_ERROR_CM / PERSON_CM), 1e-6), 400.0);
    const double shell = fmin(fmax(rounded(size * PERSON_SHELL_CM / PERSON_CM), 1e-3), 1e5);
    const double slip = unit_slip(size);
    char unit[160] = "";
    if (fits) {
        set->error_cm = error;
        set->shell_cm = shell;
    }
    if (slip > 0.0) {
        (void)snprintf(unit, sizeof unit,
                       "; if it should be %.3g cm large, its unit is wrong: export it scaled by %.3g", size * slip,
                       slip);
    }
    return model_warn(
        m,
        "skeleton '%.60s' and what it moves are %.3g cm large, for which --error-cm %g is %s: --error-cm %g "
        "--shell-cm %g %s%s",
        set->skeleton.name ? set->skeleton.name : "", size, error_cm,
        error_cm > size * SHARE_MOST ? "visibly coarse" : "finer than visible", error, shell,
        fits ? "were used" : "fit this size", unit);
}

int size_warn(model *m, raw_set *const *sets, uint32_t set_count, double error_cm)
{
    const double error = error_cm > 0.0 ? error_cm : PERSON_ERROR_CM;
    for (uint32_t i = 0; i < set_count; i++) {
        int failed;
        double size;
        if (!sets[i]->clip_count) continue;
        size = size_cm(m, sets[i], i, &failed);
        if (failed) return 1;
        if (!(size > 1e-6) || (error <= size * SHARE_MOST && error >= size * SHARE_LEAST)) continue;
        if (warn(m, sets[i], size, error, !(error_cm > 0.0) && error > size * SHARE_MOST)) return 1;
    }
    return 0;
}
