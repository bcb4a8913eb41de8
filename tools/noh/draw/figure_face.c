/* figure_face.c: faces of a figure that live: where the eyes are, found by what blinks. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "figure.h"

#define LINKS_MAX 512u
#define BEHIND_LIDS 0.19f /* of the distance of the eyes: their centres lie behind the lids */

/* The names of a kind's floats. By malloc. */
static const char **float_names(const noh_stage *stage, uint32_t kind, uint32_t count)
{
    const char **names = calloc((size_t)count + 1u, sizeof *names);
    for (uint32_t i = 0; names && i < count; i++) names[i] = noh_stage_name(stage, kind, NOH_NAME_FLOAT, i);
    return names;
}

/* Hold what shuts one eye. Returns how many targets that are. */
static uint32_t hold_lid(figure *f, const char *const *names, const noh_face_link *links, uint32_t count, int eye,
                         double value)
{
    uint32_t held = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (links[i].channel != NOH_CHANNEL_BLINK_LEFT + eye) continue;
        held += !figure_hold(f, names[links[i].target], value);
    }
    return held;
}

typedef struct lid {
    double at[2][3], weight[2]; /* to the left of the middle, and to the right */
} lid;

static void add_moved(const noh_vertex *rest, const noh_vertex *shut, uint32_t count, const float world[12], lid *sum)
{
    for (uint32_t v = 0; v < count; v++) {
        double at[3], moved = 0.0;
        int side;
        for (int i = 0; i < 3; i++) {
            const double way = (double)shut[v].position[i] - (double)rest[v].position[i];
            moved += way * way;
        }
        moved = sqrt(moved);
        for (int r = 0; r < 3; r++) {
            at[r] = (double)world[4 * r + 3];
            for (int i = 0; i < 3; i++) at[r] += (double)world[4 * r + i] * (double)rest[v].position[i];
        }
        side = at[0] < 0.0;
        for (int i = 0; i < 3; i++) sum->at[side][i] += moved * at[i];
        sum->weight[side] += moved;
    }
}

/* The vertices of all meshes of a kind at rest and with one eye shut. */
static int measure_lid(figure *f, uint32_t kind, const char *const *names, const noh_face_link *links, uint32_t count,
                       int eye, lid *sum)
{
    int status = 0;
    for (uint32_t m = 0; m < f->plan.kinds[kind].mesh_count && !status; m++) {
        noh_mesh mesh;
        noh_actor_mesh shown;
        noh_vertex *rest, *shut;
        (void)hold_lid(f, names, links, count, eye, 0.0);
        status = figure_pose(f);
        rest = status ? NULL : figure_deform(f, kind, m, 0, &mesh, &shown);
        (void)hold_lid(f, names, links, count, eye, 1.0);
        if (rest) status = figure_pose(f);
        shut = rest && !status ? figure_deform(f, kind, m, 0, &mesh, &shown) : NULL;
        if (shut) add_moved(rest, shut, mesh.header->vertex_count, shown.world, sum);
        status = status || !shut;
        free(rest);
        free(shut);
    }
    (void)hold_lid(f, names, links, count, eye, 0.0);
    return status;
}

static int place_eyes(const lid *sum, float eyes[2][3])
{
    double apart = 0.0;
    for (int e = 0; e < 2; e++) {
        if (!(sum->weight[e] > 0.0)) return 0;
        for (int i = 0; i < 3; i++) eyes[e][i] = (float)(sum->at[e][i] / sum->weight[e]);
        apart += e ? -(double)eyes[e][0] : (double)eyes[e][0];
    }
    for (int e = 0; e < 2; e++) eyes[e][2] -= (float)(BEHIND_LIDS * apart);
    return apart > 1e-3;
}

/* 1: found. */
static int find_eyes(figure *probe, uint32_t kind, float eyes[2][3])
{
    const uint32_t floats = probe->plan.kinds[kind].float_count;
    const char **names = float_names(probe->stage, kind, floats);
    noh_face_link *links = calloc(LINKS_MAX, sizeof *links);
    lid sum;
    int status = !names || !links;
    memset(&sum, 0, sizeof sum);
    if (!status) {
        uint32_t count = noh_face_recipe_bind(NULL, 0, names, floats, links, LINKS_MAX);
        count = count < LINKS_MAX ? count : LINKS_MAX;
        for (int eye = 0; eye < 2 && !status; eye++) {
            status = measure_lid(probe, kind, names, links, count, eye, &sum);
        }
    }
    free(names);
    free(links);
    return !status && place_eyes(&sum, eyes);
}

uint32_t figure_find_faces(const figure_desc *desc, noh_kind_face *faces)
{
    figure_desc d = *desc;
    figure *probe = calloc(1, sizeof *probe);
    uint32_t found = 0;
    d.clips = NULL;
    d.more_clip_count = 0;
    d.graphs = NULL;
    d.alive = 0;
    d.held_float_count = FIGURE_HELD_ALL;
    if (probe && !figure_open(probe, &d, NULL)) {
        for (uint32_t k = 0; k < probe->stage_desc.kind_count; k++) {
            memset(&faces[k], 0, sizeof faces[k]);
            if (find_eyes(probe, k, faces[k].face.eyes)) found |= 1u << k;
        }
        figure_close(probe);
    }
    free(probe);
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
            return tool_usage("--feel wants EMOTION=AMOUNT, not '%s'", text);
        }
        memcpy(name, text, length);
        name[length] = '\0';
        for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
            if (!(f->faces_found >> k & 1u)) continue;
            if (noh_actor_feel(f->stage, f->actors[k], name, (float)amount, 1, 0, 0, &error)) {
                return tool_usage("--feel %s: %s", text, error.what);
            }
        }
    }
    return 0;
}

int figure_live(figure *f, double seconds)
{
    const uint32_t step = NOH_TICKS_PER_SECOND / 60u;
    const noh_look own = f->look;
    noh_look posed = own;
    int64_t ticks = noh_ticks_from_seconds(seconds > 0.0 ? seconds : 0.0);
    noh_error error = { NOH_OK, "", 0, 0 };
    int status;
    posed.posed = 1;
    status = figure_set_look(f, &posed);
    while (!status && ticks > 0) {
        const uint32_t now = ticks < (int64_t)step ? (uint32_t)ticks : step;
        if (noh_stage_frame(f->stage, now, NULL, NULL, NULL, &error)) status = tool_fail_error("face", &error);
        ticks -= now;
    }
    return status ? status : figure_set_look(f, &own);
}
