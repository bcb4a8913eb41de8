#include "nell.h"

#include "clips.h"
#include "colour.h"
#include "mask/ear.h"
#include "mask/eye.h"
#include "mask/mouth.h"
#include "mask/occlusion.h"
#include "mask/targets.h"
#include "parts.h"
#include "skin.h"

#include <stdlib.h>

static V3 nell_place(const Seed *seed, const Pose *pose)
{
    switch (seed->region) {
    case ON_LIP_FOLD: return lip_place(seed, pose);
    case ON_LID_FOLD: return lid_place(seed, pose);
    case ON_EAR: return nell_ear_place(seed);
    case ON_BALL: return nell_ball_place(seed, pose);
    case ON_TEETH: return nell_teeth_place(seed, pose);
    case ON_TONGUE: return nell_tongue_place(seed, pose);
    case ON_BAG: return nell_bag_place(seed, pose);
    case ON_LASH: return lash_place(seed, pose);
    case ON_BROW: return brow_place(seed, pose);
    case ON_SCALP: return scalp_place(seed);
    case ON_LOCK: return lock_place(seed);
    case ON_CLOTH: return sweater_place(seed);
    default: return skin_place(skin_point(seed), pose);
    }
}

Figure nell_build(void)
{
    static const FigureMaterial materials[NELL_PARTS] = { { "skin", 0.48 },  { "hair", 0.62 },  { "eyes", 0.08 },
                                                          { "teeth", 0.22 }, { "mouth", 0.75 }, { "sweater", 0.90 } };
    double *open[PARTS_MAX];
    Figure nell = { .name = "nell",
                    .materials = materials,
                    .target_count = ALL_TARGETS,
                    .animation_count = NELL_CLIPS,
                    .animation = nell_clip,
                    .model = model_begin(NELL_PARTS, nell_place) };
    skin_build(&nell.model);
    ears_build(&nell.model);
    eyes_build(&nell.model);
    mouth_build(&nell.model);
    brows_build(&nell.model);
    nell_hair_build(&nell.model);
    sweater_build(&nell.model);
    figure_place(&nell);
    occlusion_bake(&nell.model, nell.frames, open);
    nell_colour(&nell.model, nell.frames, open);
    for (int i = 0; i < NELL_PARTS; i++) {
        free(open[i]);
    }
    return nell;
}
