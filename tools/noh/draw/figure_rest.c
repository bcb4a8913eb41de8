/* figure_rest.c: how a figure without a clip stands: as in a clip named idle, otherwise as noh_stand_modifier does; and
 * what drives it from outside. */
#include <string.h>

#include "core/base/name_internal.h"
#include "figure.h"
#include "noh/clip.h"
#include "noh/modules.h"
#include "noh/noh.h"

const char *figure_idle_clip(const noh_pack *pack)
{
    noh_pack_clip clip;
    for (uint32_t i = 0; noh_pack_clip_at(pack, i, &clip, NULL) == NOH_OK; i++) {
        if (clip.header->joint_count && noh_name_has(clip.name, "idle")) return clip.name;
    }
    return NULL;
}

void figure_add_rest(figure *f)
{
    for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
        noh_kind_desc *kind = &f->kinds[k];
        noh_modifier *parts = f->rest_parts[k];
        uint32_t count = 0;
        if (f->desc.stands && !noh_kind_stand_make(kind, &f->stands[k], NULL)) /* else it is no humanoid */
            parts[count++] = noh_stand_modifier(&f->stands[k]);
        if (f->desc.drivers) parts[count++] = f->desc.drivers[k];
        if (!count) continue;
        if (kind->modifier_count) memcpy(parts + count, kind->modifiers, kind->modifier_count * sizeof *parts);
        kind->modifiers = parts;
        kind->modifier_count += count;
    }
}
