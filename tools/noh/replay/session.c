#include "session.h"

#include <stdlib.h>
#include <string.h>

const char *session_part_name(session_part part)
{
    static const char *const names[SESSION_PARTS] = { "state",  "events",   "places",  "floats",
                                                      "joints", "palettes", "vertices" };
    return names[part];
}

void session_free(session *s)
{
    free(s->inputs);
    free(s->hashes);
    memset(s, 0, sizeof *s);
}

int session_add(session *s, const session_input *input)
{
    if (s->input_count == s->input_room) {
        const uint32_t room = s->input_room ? 2u * s->input_room : 64u;
        session_input *grown = realloc(s->inputs, room * sizeof *grown);
        if (!grown) return 1;
        s->inputs = grown;
        s->input_room = room;
    }
    s->inputs[s->input_count++] = *input;
    return 0;
}

uint32_t session_differ(const session_hashes *a, const session_hashes *b, uint32_t frames, uint32_t *parts)
{
    *parts = 0;
    for (uint32_t f = 0; f < frames; f++) {
        for (uint32_t p = 0; p < SESSION_PARTS; p++) {
            *parts |= (uint32_t)(a[f].part[p] != b[f].part[p]) << p;
        }
        if (*parts) return f;
    }
    return frames;
}
