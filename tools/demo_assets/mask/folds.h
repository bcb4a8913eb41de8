/* The thickness of lids and lips: strips that fold inwards from the slits. */
#ifndef MASK_FOLDS_H
#define MASK_FOLDS_H

#include "model.h"

V3 lid_fold_place(const Seed *seed, const Pose *pose);
V3 lip_fold_place(const Seed *seed, const Pose *pose);

#endif
