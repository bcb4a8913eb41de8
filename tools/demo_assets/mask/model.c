#include "model.h"

#include "shared/grab.h"

#include <stdlib.h>

uint32_t model_seed(Model *model, int part, const Seed *seed)
{
    Part *p = &model->parts[part];
    if (p->seed_count == p->seed_space) {
        p->seed_space = p->seed_space ? 2 * p->seed_space : 256;
        p->seeds = grab(p->seeds, p->seed_space, (int)sizeof *p->seeds);
    }
    p->seeds[p->seed_count] = *seed;
    return (uint32_t)p->seed_count++;
}

void model_triangle(Model *model, int part, uint32_t a, uint32_t b, uint32_t c)
{
    Part *p = &model->parts[part];
    if (a == b || b == c || c == a) {
        return;
    }
    if (p->index_count + 3 > p->index_space) {
        p->index_space = p->index_space ? 2 * p->index_space : 1024;
        p->indices = grab(p->indices, p->index_space, (int)sizeof *p->indices);
    }
    p->indices[p->index_count++] = a;
    p->indices[p->index_count++] = b;
    p->indices[p->index_count++] = c;
}

void model_quad(Model *model, int part, uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
    model_triangle(model, part, a, b, c);
    model_triangle(model, part, a, c, d);
}

Model model_begin(int part_count, V3 (*place)(const Seed *seed, const Pose *pose))
{
    Model model = { .part_count = part_count };
    for (int i = 0; i < part_count; i++) {
        model.parts[i].place = place;
    }
    return model;
}

void model_free(Model *model)
{
    for (int i = 0; i < model->part_count; i++) {
        free(model->parts[i].seeds);
        free(model->parts[i].indices);
        free(model->parts[i].colours);
    }
}
