/* figure_rest.c: how a figure without a clip stands: as in a clip named idle, otherwise as noh_stand_modifier does. */
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
    for (uint32_t k = 0; k < f->stage_desc.kind_count && f->desc.stands; k++) {
        noh_kind_desc *kind = &f->kinds[k];
        const uint32_t count = kind->modifier_count;
        if (noh_kind_stand_make(kind, &f->stands[k], NULL)) continue; /* it is no humanoid */
        if (count) memcpy(f->rest_parts[k] + 1, kind->modifiers, count * sizeof *kind->modifiers);
        f->rest_parts[k][0] = noh_stand_modifier(&f->stands[k]);
        kind->modifiers = f->rest_parts[k];
        kind->modifier_count++;
    }
}
