#include "view/view_pad.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/message.h"

#define SYNC_GROUP 1u

int view_pad_has(const view_pad *pad, uint32_t clip)
{
    for (uint32_t i = 0; i < pad->count; i++) {
        if (pad->clips[i] == clip) return 1;
    }
    return 0;
}

int view_pad_plays(const view_pad *pad, uint32_t kind, uint32_t track)
{
    for (uint32_t i = 0; pad->plays && kind == pad->kind && i < pad->count; i++) {
        if (pad->tracks[i] == track) return 1;
    }
    return 0;
}

/* ---- weights ---- */

static void weigh(view_pad *pad, view_model *m)
{
    const noh_blend_space_2d space = { pad->count, pad->triangle_count, &pad->points[0][0], &pad->triangles[0][0] };
    memset(pad->weights, 0, sizeof pad->weights);
    if (!pad->count) {
        return;
    }
    noh_blend_space_2d_weights(&space, pad->at[0], pad->at[1], pad->weights);
    for (uint32_t i = 0; pad->plays && i < pad->count; i++) {
        view_set_weight(m, pad->kind, pad->tracks[i], pad->weights[i]);
    }
}

static void triangulate(view_pad *pad, view_model *m)
{
    noh_error error;
    if (pad->count && noh_blend_space_2d_triangulate(pad->count, &pad->points[0][0], &pad->triangles[0][0],
                                                     &pad->triangle_count, &error)) {
        pad->triangle_count = 0; /* two clips in one place: along a line */
    }
    weigh(pad, m);
}

static float held(float x)
{
    return x < -1.0f ? -1.0f : x > 1.0f ? 1.0f : x;
}

void view_pad_move(view_pad *pad, view_model *m, float x, float y)
{
    pad->at[0] = held(x);
    pad->at[1] = held(y);
    weigh(pad, m);
}

void view_pad_move_clip(view_pad *pad, view_model *m, uint32_t i, float x, float y)
{
    pad->points[i][0] = held(x);
    pad->points[i][1] = held(y);
    triangulate(pad, m);
}

/* ---- which clips ---- */

/* In a ring, the first at the top. */
static void lay_out(view_pad *pad)
{
    for (uint32_t i = 0; i < pad->count; i++) {
        const double angle = 6.283185307179586 * i / pad->count;
        pad->points[i][0] = (float)(0.8 * sin(angle));
        pad->points[i][1] = (float)(0.8 * cos(angle));
    }
}

static int add(view_pad *pad, const view_model *m, uint32_t clip, int32_t speed)
{
    const view_clip *c = &m->clips[clip];
    if (pad->count == VIEW_PAD_CLIPS) {
        return tool_fail(m->path, "the pad holds %u clips: take one off first", VIEW_PAD_CLIPS);
    }
    if (!pad->count) {
        for (pad->kind = 0; c->clips[pad->kind] == NOH_NONE;) pad->kind++;
    } else if (c->clips[pad->kind] == NOH_NONE) {
        return tool_fail(m->path, "'%s' and '%s' move different skeletons", c->name, m->clips[pad->clips[0]].name);
    }
    pad->speeds[pad->count] = speed;
    pad->clips[pad->count++] = clip;
    return 0;
}

static void take_off(view_pad *pad, uint32_t clip)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < pad->count; i++) {
        if (pad->clips[i] == clip) continue;
        pad->speeds[kept] = pad->speeds[i];
        pad->clips[kept++] = pad->clips[i];
    }
    pad->count = kept;
}

int view_pad_toggle(view_pad *pad, view_model *m, uint32_t clip)
{
    int status = 0;
    view_pad_stop(pad, m);
    if (view_pad_has(pad, clip)) {
        take_off(pad, clip);
    } else {
        status = add(pad, m, clip, 0);
    }
    lay_out(pad);
    triangulate(pad, m);
    return status;
}

/* ---- playing ---- */

static int can_be_synced(const view_pad *pad, const noh_clip_set *set, const view_model *m)
{
    for (uint32_t i = 0; i < pad->count; i++) {
        const uint32_t ticks = set->clips[m->clips[pad->clips[i]].clips[pad->kind]].duration_ticks;
        if (ticks < NOH_SYNC_DURATION_MIN || ticks > NOH_SYNC_DURATION_MAX) return 0;
    }
    return 1;
}

int view_pad_play(view_pad *pad, view_model *m)
{
    const noh_clip_set *set;
    const noh_actor actor = m->figure->actors[pad->kind];
    const noh_controller *c = noh_actor_controller(m->figure->stage, actor, &set);
    view_pad_stop(pad, m);
    pad->synced = can_be_synced(pad, set, m);
    for (uint32_t i = 0; i < pad->count; i++) {
        const noh_play play = { .fade_ticks = 1,
                                .speed = pad->speeds[i],
                                .loop = NOH_LOOP_REPEAT,
                                .sync_group = pad->synced ? SYNC_GROUP : 0,
                                .flags = i ? NOH_PLAY_BESIDE : 0 };
        noh_error error = { NOH_OK, "", 0, 0 };
        if (!i) (void)noh_actor_stop(m->figure->stage, actor, VIEW_BODY, 1, NULL);
        if (noh_actor_play(m->figure->stage, actor, VIEW_BODY, m->clips[pad->clips[i]].name, &play, &error)) {
            return tool_fail_error(m->path, &error);
        }
        pad->tracks[i] = (uint32_t)(noh_actor_track(m->figure->stage, actor, VIEW_BODY) - noh_controller_track(c, 0));
    }
    pad->plays = pad->count > 0;
    weigh(pad, m);
    return 0;
}

void view_pad_stop(view_pad *pad, view_model *m)
{
    if (pad->plays) {
        (void)noh_actor_stop(m->figure->stage, m->figure->actors[pad->kind], VIEW_BODY, 1, NULL);
    }
    pad->plays = 0;
}

void view_pad_frame(view_pad *pad, const view_model *m)
{
    const noh_controller *c = noh_actor_controller(m->figure->stage, m->figure->actors[pad->kind], NULL);
    for (uint32_t i = 0; pad->plays && i < pad->count; i++) {
        const noh_track *t = noh_controller_track(c, pad->tracks[i]);
        if (t->mode == NOH_TRACK_OFF || t->clip != m->clips[pad->clips[i]].clips[pad->kind]) pad->plays = 0;
    }
}

/* ---- blend spaces of the pack ---- */

static uint32_t find_clip(const view_model *m, const char *name)
{
    for (uint32_t i = 0; i < m->clip_count; i++) {
        if (strcmp(m->clips[i].name, name) == 0) return i;
    }
    return NOH_NONE;
}

/* A graph's node that is a blend space of clips which the model has; or NULL. */
static const noh_pack_graph_node *space_node(const view_model *m, const noh_pack_graph *g, uint32_t node)
{
    const noh_pack_graph_node *n = &g->nodes[node];
    if (n->kind != NOH_PACK_NODE_SPACE_2D || n->child_count > VIEW_PAD_CLIPS) {
        return NULL;
    }
    for (uint32_t i = 0; i < n->child_count; i++) {
        const noh_pack_graph_node *child = &g->nodes[g->children[n->first_child + i]];
        if (child->kind != NOH_PACK_NODE_CLIP || find_clip(m, noh_graph_pack_clip_name(g, child->index)) == NOH_NONE) {
            return NULL;
        }
    }
    return n;
}

static const noh_pack_graph_node *find_space(const view_model *m, uint32_t n, noh_pack_graph *g)
{
    for (uint32_t i = 0; noh_pack_graph_at(&m->file.pack, i, g, NULL) == NOH_OK; i++) {
        for (uint32_t node = 0; node < g->header->node_count; node++) {
            const noh_pack_graph_node *found = space_node(m, g, node);
            if (found && !n--) return found;
        }
    }
    return NULL;
}

int view_pad_space(const view_model *m, uint32_t n, char *name, size_t bytes)
{
    noh_pack_graph g;
    const noh_pack_graph_node *node = find_space(m, n, &g);
    if (node) snprintf(name, bytes, "%s / %s", g.name, noh_pack_string(&m->file.pack, node->name));
    return node != NULL;
}

/* Its points, into the square. */
static void scale_points(view_pad *pad, const float *points)
{
    float low[2] = { points[0], points[1] }, high[2] = { points[0], points[1] };
    for (uint32_t i = 0; i < 2u * pad->count; i++) {
        low[i % 2] = fminf(low[i % 2], points[i]);
        high[i % 2] = fmaxf(high[i % 2], points[i]);
    }
    for (uint32_t i = 0; i < 2u * pad->count; i++) {
        const float range = high[i % 2] - low[i % 2];
        pad->points[i / 2][i % 2] = range > 0.0f ? 1.6f * (points[i] - low[i % 2]) / range - 0.8f : 0.0f;
    }
}

int view_pad_take(view_pad *pad, view_model *m, uint32_t n)
{
    noh_pack_graph g;
    const noh_pack_graph_node *node = find_space(m, n, &g);
    int status = node ? 0 : tool_fail(m->path, "no graph of the pack has this blend space");
    view_pad_stop(pad, m);
    pad->count = 0;
    for (uint32_t i = 0; !status && i < node->child_count; i++) {
        const noh_pack_graph_node *child = &g.nodes[g.children[node->first_child + i]];
        status = add(pad, m, find_clip(m, noh_graph_pack_clip_name(&g, child->index)), g.clips[child->index].speed);
    }
    if (!status && pad->count) scale_points(pad, g.points + g.spaces[node->first_item].first_point);
    triangulate(pad, m);
    return status;
}
