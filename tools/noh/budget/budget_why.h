/* budget_why.h: what `auto` weighs when it chooses a morph path (gl_morph_cost.c), term by term. */
#ifndef NOH_NOH_BUDGET_BUDGET_WHY_H
#define NOH_NOH_BUDGET_BUDGET_WHY_H

#include "cli/json.h"
#include "noh/noh_gl.h"

void budget_why_print(const noh_gl_morph_plan *plan);
void budget_why_json(json *j, const noh_gl_morph_plan *plan);

#endif
