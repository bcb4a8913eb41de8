/* load_draw.c: the draws of a load, at chosen LOD levels or at the finest. */
#include "load.h"

void load_set_detail(load *l, uint32_t item, const noh_detail *detail, int64_t clock)
{
    load_detail *d = &l->details[item];
    const int fades = l->renderer.fades;
    noh_detail_part parts[2] = { { detail->mesh, 0.0f, 1.0f }, { 0, 0.0f, 0.0f } };
    d->part_count = fades ? noh_detail_parts(detail, clock, parts) : 1;
    for (uint32_t i = 0; i < d->part_count; i++) {
        d->parts[i] = (noh_gl_detail){ parts[i].level, parts[i].from, parts[i].to };
    }
    noh_gl_morph_set_level(l->morph.morph, l->item_instances[item], fades ? noh_detail_drawn(detail, clock) : detail->mesh);
}

static void draw_item(load *l, uint32_t item, int pass)
{
    const noh_gl_morph_binding morph = noh_gl_morph_binding_of(l->morph.morph, l->item_instances[item]);
    const load_detail *d = &l->details[item];
    noh_gl_skin_binding joints;
    const noh_gl_skin_binding *skin = load_skin_binding(l, item, &joints);
    for (uint32_t i = 0; i < d->part_count; i++) {
        noh_gl_draw_mesh(&l->renderer, &l->meshes[l->scene->items[item].mesh], scene_world(l->scene, l->file, item), &morph, skin,
                         &d->parts[i], l->pictures, pass);
    }
}

void load_draw(load *l, const noh_gl_camera *camera)
{
    noh_gl_draw_begin(&l->renderer, camera);
    for (int pass = NOH_DRAW_OPAQUE; pass <= NOH_DRAW_BLENDED; pass++) {
        for (uint32_t i = 0; i < l->scene->item_count; i++) {
            draw_item(l, i, pass);
        }
    }
    noh_gl_draw_end(&l->renderer);
}
