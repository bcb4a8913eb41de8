/* view_setting.h: a stage of the viewer's model with its options, and its drawings other than meshes. A model has one,
 * and a second one while paths or levels are compared. */
#ifndef NOH_NOH_VIEW_VIEW_SETTING_H
#define NOH_NOH_VIEW_VIEW_SETTING_H

#include "view/view_model.h"
#include "noh/base.h"

typedef struct setting {
    figure *figure;
    int show_bones;
    bones *bones[NOH_STAGE_KINDS_MAX]; /* of each kind with joints */
} setting;

/* Prints an error and returns an exit code; 0 on success. */
int setting_open(const view_model *m, gpu *g, const view_model_desc *desc, setting *s);
void setting_close(setting *s);
/* Copies tracks, changes and places to another stage with the same clips and layers; a graph restarts. */
void setting_carry(const figure *from, figure *to);
/* The tracks alone, as they are between two steps. */
void setting_carry_tracks(const figure *from, figure *to);

#endif
