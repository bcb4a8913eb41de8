#include "mask.h"

#include "colour.h"
#include "ear.h"
#include "eye.h"
#include "face.h"
#include "face_grid.h"
#include "folds.h"
#include "hair.h"
#include "mouth.h"
#include "occlusion.h"
#include "targets.h"
#include "wood.h"

#include <stdlib.h>

V3 mask_place(const Seed *seed, const Pose *pose)
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

static void build(Model *model)
{
    face_grid_build(model);
    hair_build(model);
    ears_build(model);
    wood_build(model);
    eyes_build(model);
    mouth_build(model);
}

Figure mask_build(void)
{
    static const FigureMaterial materials[PART_COUNT] = {
        { "paint", 0.55 }, { "wood", 0.65 }, { "eyes", 0.12 }, { "teeth", 0.25 }, { "mouth", 0.60 }
    };
    double *open[PARTS_MAX];
    Figure mask = { .name = "mask",
                    .materials = materials,
                    .target_count = MASK_TARGETS,
                    .animation_count = ANIMATION_COUNT,
                    .animation = animation_make,
                    .model = model_begin(PART_COUNT, mask_place) };
    build(&mask.model);
    figure_place(&mask);
    occlusion_bake(&mask.model, mask.frames, open);
    colour_bake(&mask.model, mask.frames, open);
    for (int i = 0; i < PART_COUNT; i++) {
        free(open[i]);
    }
    return mask;
}
