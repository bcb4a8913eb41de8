/* budget_phone.h: the share of a frame that a pack's shaders take on a GPU of a phone, by the figures of `make phones`
 * (tools/phones/table.txt). A model: cycles or instructions of Mesa's compilers, without memory and caches. */
#ifndef NOH_NOH_BUDGET_BUDGET_PHONE_H
#define NOH_NOH_BUDGET_BUDGET_PHONE_H

#include "cli/json.h"
#include "noh/noh.h"
#include "noh/pack.h"

typedef struct budget_phone {
    const struct phone_gpu *gpu;
    uint32_t size[2];
    noh_shading shading;
} budget_phone;

/* name: of a GPU. Prints an error and returns an exit code; 0 on success. */
int budget_phone_choose(const char *name, budget_phone *p);
void budget_phone_print(const budget_phone *p, const noh_pack *pack);
void budget_phone_json(json *j, const budget_phone *p, const noh_pack *pack);

#endif
