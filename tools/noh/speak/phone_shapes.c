#include "phone_shapes.h"

#include <stddef.h>
#include <stdio.h>
#include <string.h>

static const noh_pack *pack; /* NULL: no face */

void phone_shapes_of(const noh_pack *face)
{
    pack = face;
}

/* A shape by its name, which ends at '-' or with the text. */
static noh_viseme shape_named(const char *name)
{
    char word[16];
    (void)snprintf(word, sizeof word, "%.*s", (int)strcspn(name, "-"), name);
    const uint32_t channel = noh_face_channel_find(word);
    return channel < NOH_CHANNEL_VISEMES || channel >= NOH_CHANNEL_COUNT ? NOH_VISEME_COUNT
                                                                         : (noh_viseme)(channel - NOH_CHANNEL_VISEMES);
}

noh_viseme phone_shape(const char *phone, noh_viseme *second)
{
    for (uint32_t i = 0; pack && i < pack->recipe_row_count; i++) {
        const noh_recipe_row *row = &pack->recipe_rows[i];
        const char *channel = noh_pack_string(pack, row->channel), *other;
        if (strncmp(channel, "phone-", 6) != 0 || strcmp(noh_pack_string(pack, row->target), phone) != 0) continue;
        other = strchr(channel + 6, '-');
        if (second) *second = other ? shape_named(other + 1) : NOH_VISEME_COUNT;
        return shape_named(channel + 6);
    }
    return noh_viseme_of_phone(phone, second);
}
