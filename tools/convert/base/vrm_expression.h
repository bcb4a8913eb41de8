/* vrm_expression.h: the expressions that VRM names, and the channels of a face (base/recipe_read.h) that show them. */
#ifndef NOH_CONVERT_BASE_VRM_EXPRESSION_H
#define NOH_CONVERT_BASE_VRM_EXPRESSION_H

#ifdef __cplusplus
extern "C" {
#endif

/* The channel as a recipe has it, such as aa or joy-upper; "blink" stands for both eyes. NULL: the expression is an
 * author's own. old: as VRM 0.0 names them, in any case */
const char *vrm_expression_channel(const char *name, int old);

#ifdef __cplusplus
}
#endif
#endif
