/* budget_why.c: `noh budget --why`. */
#include "budget_why.h"

#include <stdio.h>

void budget_why_print(const noh_gl_morph_plan *plan)
{
    const noh_gl_morph_costs *c = &plan->costs;
    printf("why: %s\n", plan->reason);
    printf("one instance of the first mesh with targets in a frame, drawn %s, with half of the targets active:\n",
           c->draws == 1u ? "once" : "twice");
    printf("  %.0f delta texels in %.0f strips, %.0f blocks of 4 x 4, %.0f pairs; targets move %.0f vertices\n",
           (double)c->texels, (double)c->quads, (double)c->blocks, (double)c->pairs, (double)c->touched);
    printf("  gather and direct send %.0f bytes; a texel takes %u bytes in all layers; tile memory: ",
           (double)c->upload_bytes, c->pixel_bytes);
    if (c->tile_bytes) {
        printf("%u bytes a pixel%s\n", c->tile_bytes,
               c->pixel_bytes > c->tile_bytes ? ", too few: blending counts twice" : "");
    } else {
        puts("none, or not known");
    }
    puts(
        "costs, in texels blended into three layers of RGBA32F (for GPUs measured on one of them; direct is a model):");
    printf("  %-10s %12.0f\n  %-10s %12.0f\n  %-10s %12.0f\n  %-10s %12.0f\n  %-10s %12.0f\n", "mrt", (double)c->mrt,
           "per-layer", (double)c->per_layer, "gather", (double)c->gather, "direct", (double)c->direct, "cpu",
           (double)c->cpu);
    printf("an update of all instances sends at most %llu bytes\n", (unsigned long long)plan->update_bytes);
}

void budget_why_json(json *j, const noh_gl_morph_plan *plan)
{
    const noh_gl_morph_costs *c = &plan->costs;
    json_open(j, "why", '{');
    json_number(j, "texels", (double)c->texels);
    json_number(j, "strips", (double)c->quads);
    json_number(j, "blocks", (double)c->blocks);
    json_number(j, "pairs", (double)c->pairs);
    json_number(j, "touched", (double)c->touched);
    json_number(j, "upload_bytes", (double)c->upload_bytes);
    json_integer(j, "pixel_bytes", c->pixel_bytes);
    json_integer(j, "tile_bytes", c->tile_bytes);
    json_integer(j, "draws", c->draws);
    json_open(j, "costs", '{');
    json_number(j, "mrt", (double)c->mrt);
    json_number(j, "per_layer", (double)c->per_layer);
    json_number(j, "gather", (double)c->gather);
    json_number(j, "direct", (double)c->direct);
    json_number(j, "cpu", (double)c->cpu);
    json_close(j, '}');
    json_integer(j, "update_bytes", plan->update_bytes);
    json_close(j, '}');
}
