/* load_draw.c: the draws of a load, at chosen LOD levels or at the finest. */
#include "load.h"

void load_set_lod(load *l, uint32_t item, const noh_lod *lod, int64_t clock)
{
    load_lod *d = &l->lods[item];
    const int fades = l->renderer.fades;
    noh_lod_part parts[2] = { { lod->mesh, 0.0f, 1.0f }, { 0, 0.0f, 0.0f } };
    d->part_count = fades ? noh_lod_parts(lod, clock, parts) : 1;
    for (uint32_t i = 0; i < d->part_count; i++) {
        d->parts[i] = (noh_gl_lod){ parts[i].level, parts[i].from, parts[i].to };
    }
    noh_gl_morph_set_lod(l->morph.morph, l->item_instances[item], fades ? noh_lod_drawn(lod, clock) : lod->mesh);
}

static void draw_item(load *l, uint32_t item, int pass)
{
    const noh_gl_morph_binding morph = noh_gl_morph_binding_of(l->morph.morph, l->item_instances[item]);
    const load_lod *d = &l->lods[item];
    noh_gl_skin_binding joints;
    const noh_gl_skin_binding *skin = load_skin_binding(l, item, &joints);
    for (uint32_t i = 0; i < d->part_count; i++) {
        noh_gl_draw_mesh(&l->renderer, &l->meshes[l->scene->items[item].mesh], scene_world(l->scene, l->file, item),
                         &morph, skin, &d->parts[i], l->pictures, pass);
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
