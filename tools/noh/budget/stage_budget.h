/* stage_budget.h: the bytes of a stage, by its plan. */
#ifndef NOH_NOH_BUDGET_STAGE_BUDGET_H
#define NOH_NOH_BUDGET_STAGE_BUDGET_H

#include "noh/gl_device.h"
#include "noh/noh.h"

typedef struct stage_budget {
    const char *subject; /* the pack or the text that the stage is of, for messages */
    const noh_stage_desc *desc;
    const noh_gl_caps *caps; /* NULL: nothing is drawn */
    noh_stage_plan plan;
    noh_stage_bytes *parts; /* [part_count] of the stage, then what was added */
    uint32_t part_count;
    uint64_t cpu_bytes, gpu_bytes; /* of all parts */
} stage_budget;

/* Plan the stage. Prints an error and returns an exit code; 0 on success, and the budget is then to be freed. */
int stage_budget_make(stage_budget *b, const char *subject, const noh_stage_desc *desc, const noh_gl_caps *caps);
/* Adds a part outside the stage. Returns an exit code. */
int stage_budget_add(stage_budget *b, const char *what, uint64_t cpu_bytes, uint64_t gpu_bytes);
void stage_budget_free(stage_budget *b);

void stage_budget_print(const stage_budget *b);
/* Returns an exit code. */
int stage_budget_json(const stage_budget *b);

#endif
