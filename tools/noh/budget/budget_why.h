/* budget_why.h: the terms by which `auto` chooses a morph path (gl_morph_cost.c). */
#ifndef NOH_NOH_BUDGET_BUDGET_WHY_H
#define NOH_NOH_BUDGET_BUDGET_WHY_H

#include "cli/json.h"
#include "noh/noh_gl.h"

void budget_why_print(const noh_gl_morph_plan *plan);
void budget_why_json(json *j, const noh_gl_morph_plan *plan);

#endif
