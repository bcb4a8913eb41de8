/* figure_face.c: live faces of a figure: eyes, emotions, time. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "figure.h"

int figure_find_eyes(const noh_kind_desc *kind, noh_kind_face *face, noh_error *error)
{
    const size_t bytes = noh_kind_find_eyes_size(kind);
    void *scratch = malloc(bytes + 1u);
    memset(face, 0, sizeof *face);
    const int found = scratch && !noh_kind_find_eyes(kind, scratch, bytes, face->face.eyes, error);
    free(scratch);
    return found;
}

uint32_t figure_find_faces(const noh_kind_desc *kinds, uint32_t kind_count, noh_kind_face *faces)
{
    uint32_t found = 0;
    for (uint32_t k = 0; k < kind_count; k++) {
        if (figure_find_eyes(&kinds[k], &faces[k], NULL)) found |= 1u << k;
    }
    return found;
}

int figure_feel(figure *f, const option_list *emotions)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    for (int i = 0; i < emotions->count; i++) {
        const char *text = emotions->items[i], *equals = strchr(text, '=');
        char name[32];
        double amount = 1.0;
        const size_t length = equals ? (size_t)(equals - text) : strlen(text);
        if (length >= sizeof name || (equals && tool_number(equals + 1, &amount))) {
            return tool_usage("--feel must be EMOTION=AMOUNT, not '%s'", text);
        }
        memcpy(name, text, length);
        name[length] = '\0';
        for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
            if (!(f->faces_found >> k & 1u)) continue;
            if (noh_actor_set_emotion(f->stage, f->actors[k], name, (float)amount, 1, 0, 0, &error)) {
                return tool_usage("--feel %s: %s", text, error.what);
            }
        }
    }
    return 0;
}

/* Each actor turned by an angle about y from where it began. leaps: as if it had always been there */
static int turn_to(figure *f, double degrees, int leaps)
{
    const double half = degrees * (3.14159265358979 / 360.0);
    noh_error error = { NOH_OK, "", 0, 0 };
    for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
        const noh_place place = { .rotation = { 0.0f, (float)sin(half), 0.0f, (float)cos(half) }, .scale = 1.0f };
        noh_result result = noh_actor_set_place(f->stage, f->actors[k], &place, &error);
        if (!result && leaps) result = noh_actor_cut(f->stage, f->actors[k], &error);
        if (result) return tool_fail_error("--turn", &error);
    }
    return 0;
}

int figure_live(figure *f, double seconds, double turn)
{
    const uint32_t step = NOH_TICKS_PER_SECOND / 60u;
    const noh_appearance own = f->look;
    noh_appearance posed = own;
    int64_t ticks = noh_ticks_from_seconds(seconds > 0.0 ? seconds : 0.0);
    noh_error error = { NOH_OK, "", 0, 0 };
    int status, begins = 1;
    posed.posed = 1;
    status = figure_set_look(f, &posed);
    while (!status && ticks > 0) {
        const uint32_t now = ticks < (int64_t)step ? (uint32_t)ticks : step;
        const figure_body *body = f->desc.body;
        status = body ? figure_body_place(body, f->stage, f->kinds, f->actors, f->stage_desc.kind_count) : 0;
        ticks -= now;
        if (!status && turn != 0.0) status = turn_to(f, -turn * (double)ticks / NOH_TICKS_PER_SECOND, begins);
        begins = 0;
        if (!status && noh_stage_frame(f->stage, now, NULL, NULL, NULL, &error)) {
            status = tool_fail_error("frame", &error);
        }
    }
    return status ? status : figure_set_look(f, &own);
}
