#include "model.h"

#include "ear.h"
#include "eye.h"
#include "face.h"
#include "face_grid.h"
#include "folds.h"
#include "shared/grab.h"
#include "hair.h"
#include "mouth.h"
#include "wood.h"

#include <stdlib.h>

uint32_t model_seed(Model *model, int part, const Seed *seed)
{
    Part *p = &model->parts[part];
    if (p->seed_count == p->seed_space) {
        p->seed_space = p->seed_space ? 2 * p->seed_space : 256;
        p->seeds = grab(p->seeds, p->seed_space, (int)sizeof *p->seeds);
    }
    p->seeds[p->seed_count] = *seed;
    return (uint32_t)p->seed_count++;
}

void model_triangle(Model *model, int part, uint32_t a, uint32_t b, uint32_t c)
{
    Part *p = &model->parts[part];
    if (a == b || b == c || c == a) {
        return;
    }
    if (p->index_count + 3 > p->index_space) {
        p->index_space = p->index_space ? 2 * p->index_space : 1024;
        p->indices = grab(p->indices, p->index_space, (int)sizeof *p->indices);
    }
    p->indices[p->index_count++] = a;
    p->indices[p->index_count++] = b;
    p->indices[p->index_count++] = c;
}

void model_quad(Model *model, int part, uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
    model_triangle(model, part, a, b, c);
    model_triangle(model, part, a, c, d);
}

V3 model_place(const Seed *seed, const Pose *pose)
{
    switch (seed->region) {
    case ON_SKIN: {
        FacePoint point = { seed->s, seed->t, seed->eye, seed->mouth };
        return face_place(point, pose);
    }
    case ON_LIP_FOLD: return lip_fold_place(seed, pose);
    case ON_LID_FOLD: return lid_fold_place(seed, pose);
    case ON_EAR: return ear_place(seed);
    case ON_STROKE: return stroke_place(seed, pose);
    case ON_RIM: return rim_place(seed, pose);
    case ON_BACK: return back_place(seed, pose);
    case ON_BALL: return ball_place(seed, pose);
    case ON_TEETH: return teeth_place(seed, pose);
    case ON_TONGUE: return tongue_place(seed, pose);
    case ON_BAG: return bag_place(seed, pose);
    }
    return v3(0, 0, 0);
}

void model_build(Model *model)
{
    face_grid_build(model);
    hair_build(model);
    ears_build(model);
    wood_build(model);
    eyes_build(model);
    mouth_build(model);
}

void model_free(Model *model)
{
    for (int i = 0; i < PART_COUNT; i++) {
        free(model->parts[i].seeds);
        free(model->parts[i].indices);
        free(model->parts[i].colours);
    }
}
