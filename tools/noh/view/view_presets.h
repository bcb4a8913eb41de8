/* view_presets.h: faces by name: presets from the pack's recipes, and the user's own, kept in a text file
 * (file/weights_text.h).
 *
 *   view_presets_read       the presets of a model and of the file
 *   view_presets_use        hold a preset's targets, and release the others
 *   view_presets_keep       save the held weights as a user preset, written at once
 *   view_presets_drop       delete a user preset
 *   view_weights_copy, view_weights_paste   the held weights, as text
 *
 * Functions that return int print an error and return an exit code; 0 on success. */
#ifndef NOH_NOH_VIEW_VIEW_PRESETS_H
#define NOH_NOH_VIEW_VIEW_PRESETS_H

#include "view/view_model.h"
#include "noh/base.h"
#include "noh/face.h"

#ifdef __cplusplus
extern "C" {
#endif

#define VIEW_PRESETS_MAX 256u
#define VIEW_PRESET_NAME 64u
#define VIEW_LINKS_MAX 1024u

typedef struct view_preset {
    char name[VIEW_PRESET_NAME];
    int own;
    uint32_t first, count; /* of view_presets.weights */
} view_preset;

typedef struct view_preset_weight {
    char name[NOH_NAME_BYTES_MAX];
    float value;
} view_preset_weight;

typedef struct view_presets {
    char path[1100]; /* the user's own */
    view_preset list[VIEW_PRESETS_MAX];
    uint32_t count;
    view_preset_weight *weights;
    uint32_t weight_count, weight_room;
} view_presets;

/* path  NULL: the model's name with .presets. A missing file has no presets */
int view_presets_read(view_presets *p, const view_model *m, const char *path);
void view_presets_free(view_presets *p);

void view_presets_use(const view_presets *p, uint32_t index, view_model *m);
int view_presets_keep(view_presets *p, const view_model *m, const char *name);
int view_presets_drop(view_presets *p, uint32_t index);

/* The held weights: zero-terminated, by malloc; NULL: nothing is held, or there is no memory. */
char *view_weights_copy(const view_model *m);
/* Hold these targets and release the others. Unknown names are reported, and all others are applied; a text without any
 * known name changes nothing. */
int view_weights_paste(view_model *m, const char *text);

/* The links of the recipes of a model and the built-in ones to its targets, m->targets[].
 * returns  how many of links[VIEW_LINKS_MAX], 0 without memory */
uint32_t view_recipe_links(const view_model *m, noh_face_link *links);

/* Hold a target; release it. */
void view_target_hold(view_target *t, float value);
void view_target_let_go(view_target *t);

#ifdef __cplusplus
}
#endif
#endif
