/* choices.h: what a face gets that its artist neither asked for nor refused.
 *
 * A model is a face if the targets of one of its meshes blink both eyes and open the mouth, by the recipes and names
 * that noh knows. What is chosen depends on the model's content alone, so the same files give the same bytes. A choice
 * that cannot be carried out leaves the model as it was. */
#ifndef NOH_CONVERT_CHOICES_H
#define NOH_CONVERT_CHOICES_H

#include <stdio.h>

#include "convert/clips/raw_set.h"
#include "convert/lod/lod_levels.h"
#include "convert/model/model.h"

/* Bits of what may be chosen: the options that were not given. Folds have WRINKLES_OF_FACES (wrinkle_make.h). */
enum {
    CHOICE_EYES = 1, /* joints for eyeballs of a mesh without joints (eye_split.h) */
    CHOICE_LIPS = 2  /* a target that brings the lower lip to the teeth (lip_target.h) */
};

/* Eyes and lips, as far as `bits` has them, before clips and skins are made of the model. report: a line on each;
 * NULL: quiet. What could not be made of eyes that nothing turns is a warning of the model. 0, or 1 when out of
 * memory. */
int choices_shape(model *m, unsigned bits, FILE *report, model_error *error);

/* LOD levels of a face, which go to *levels, with LOD_FAST. sets [set_count]: all clips that are encoded. */
void choices_levels(const model *m, raw_set *const *sets, uint32_t set_count, lod_settings *levels, FILE *report);

#endif
