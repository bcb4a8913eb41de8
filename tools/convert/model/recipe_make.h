/* recipe_make.h: the recipe of a model's face: from a text, from the extras of its meshes, and correctives by the names
 * of targets. */
#ifndef NOH_CONVERT_MODEL_RECIPE_MAKE_H
#define NOH_CONVERT_MODEL_RECIPE_MAKE_H

#include "convert/base/recipe_read.h"
#include "convert/model/model.h"

/* Add the lines of the model's extras (model_mesh.recipe) for channels and correctives that the recipe has no row of. A
 * line that cannot be read is left out with a warning. 0, or 1 when out of memory. */
int recipe_add_extras(recipe_text *recipe, model *m);

/* FF with LIP_TARGET (lip_target.h), if a mesh has it and the recipe has no row of FF: the built-in rows and
 * that target. 0, or 1 when out of memory. */
int recipe_add_lips(recipe_text *recipe, const model *m);

/* Add what targets are by the table of names (names.h): the mouth shapes of viseme_*, and for channels that ARKit's
 * names move the targets of their other names, such as Eye_Blink_L. Channels that the recipe has rows of are left as
 * they are. *count: rows. 0, or 1 when out of memory or there are too many rows. */
int recipe_add_known(recipe_text *recipe, const model *m, uint32_t *count);

/* Add rows that name the joints of the face (joint-head, joint-neck, joint-chest, joint-eye-left, joint-eye-right)
 * where a skeleton has them by other names than the runtime's. 0, or 1 when out of memory or there are too many rows.
 */
int recipe_add_joints(recipe_text *recipe, const char *const *joints, uint32_t joint_count);

/* Add correctives by name: jawOpen_smile of jawOpen and smile, jawOpen50 as an in-between of jawOpen, jawOpen50_smile;
 * where all parts are targets of the same mesh, and the recipe does not have them. *count: how many. 0, or 1 when out
 * of memory or there are too many rows. */
int recipe_add_named(recipe_text *recipe, const model *m, uint32_t *count);

#endif
