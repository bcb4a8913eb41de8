#include "sheet_tiles.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"

#define AROUND_S 0.3 /* shown before and after a transition */

/* ---- targets ---- */

/* A name longer than packs can hold is cut; it will not be found. */
static void set_target(sheet_target *out, const char *name, size_t length, double weight)
{
    snprintf(out->name, sizeof out->name, "%.*s", (int)(length < sizeof out->name ? length : sizeof out->name), name);
    out->weight = weight;
}

/* NAME, or NAME=WEIGHT where a number follows the last equals sign. */
static void read_target(const char *text, sheet_target *out)
{
    const char *equals = strrchr(text, '=');
    double weight = 1.0;
    int has_weight = equals && !tool_number(equals + 1, &weight);
    set_target(out, text, has_weight ? (size_t)(equals - text) : strlen(text), has_weight ? weight : 1.0);
}

/* The targets named by --target; each must exist. */
static int list_only(sheet_tiles *t)
{
    int status = 0;
    t->targets = calloc((size_t)t->only.count, sizeof *t->targets);
    if (!t->targets) {
        return tool_fail(t->file->path, "out of memory");
    }
    for (int i = 0; i < t->only.count && !status; i++) {
        read_target(t->only.items[i], &t->targets[t->target_count]);
        status = scene_check_target(&t->rest, t->file, t->targets[t->target_count++].name);
    }
    return status;
}

static void add_name(sheet_tiles *t, const char *name)
{
    for (uint32_t i = 0; i < t->target_count; i++) {
        if (strcmp(t->targets[i].name, name) == 0) {
            return;
        }
    }
    set_target(&t->targets[t->target_count++], name, strlen(name), 1.0);
}

/* Every target name of every mesh, once. */
static int list_names(sheet_tiles *t)
{
    size_t total = 0;
    if (t->only.count) {
        return list_only(t);
    }
    for (uint32_t m = 0; m < t->file->pack.mesh_count; m++) {
        total += t->rest.meshes[m].header->target_count;
    }
    t->targets = calloc(total + 1, sizeof *t->targets);
    if (!t->targets) {
        return tool_fail(t->file->path, "out of memory");
    }
    for (uint32_t m = 0; m < t->file->pack.mesh_count; m++) {
        for (uint32_t i = 0; i < t->rest.meshes[m].header->target_count; i++) {
            add_name(t, noh_pack_string(&t->file->pack, t->rest.meshes[m].targets[i].name));
        }
    }
    return 0;
}

static void pose_target(sheet_tiles *t, const sheet_target *shown)
{
    for (uint32_t i = 0; i < t->posed.item_count; i++) {
        const noh_mesh *mesh = &t->posed.meshes[t->posed.items[i].mesh];
        uint32_t target = noh_mesh_find_target(mesh, shown->name);
        if (target < mesh->header->target_count) {
            t->posed.items[i].weights[target] = (float)shown->weight;
        }
    }
}

static void label_target(const sheet_target *shown, char *text, size_t bytes)
{
    if (shown->weight == 1.0) {
        snprintf(text, bytes, "%s", shown->name);
    } else {
        snprintf(text, bytes, "%s %g", shown->name, shown->weight);
    }
}

/* ---- clips ---- */

static double fraction(uint32_t i, uint32_t count)
{
    return count > 1 ? (double)i / (double)(count - 1) : 0.0;
}

static double blend_weight(const sheet_tiles *t, uint32_t tile)
{
    return fraction(tile / t->clip_tiles, SHEET_BLEND_ROWS);
}

/* A loop ends where it starts, so the last column is left out. */
static double blend_phase(const sheet_tiles *t, uint32_t tile)
{
    return (double)(tile % t->clip_tiles) / (double)t->clip_tiles;
}

static double lead_s(const sheet_tiles *t)
{
    return t->clip_seconds / 2.0;
}

static double tile_time(const sheet_tiles *t, uint32_t tile)
{
    double from, to;
    if (!t->to) {
        return t->clip_seconds * fraction(tile, t->clip_tiles);
    }
    from = lead_s(t) > AROUND_S ? lead_s(t) - AROUND_S : 0.0;
    to = lead_s(t) + t->over_s + AROUND_S;
    return from + (to - from) * fraction(tile, t->clip_tiles);
}

static int pose_pair(sheet_tiles *t, uint32_t tile)
{
    scene_pair pair;
    memset(&pair, 0, sizeof pair);
    pair.from = t->clip;
    pair.to = t->blend ? t->blend : t->to;
    pair.mix = t->blend ? SCENE_MIX_BLEND : t->inertia ? SCENE_MIX_INERTIA : SCENE_MIX_FADE;
    pair.weight = t->blend ? blend_weight(t, tile) : 0.0;
    pair.lead_s = lead_s(t);
    pair.over_s = t->over_s;
    return scene_set_pair(&t->posed, t->file, &pair, t->blend ? blend_phase(t, tile) : tile_time(t, tile));
}

/* ---- all ---- */

int sheet_tiles_open(sheet_tiles *t, const pack_file *file)
{
    int status;
    t->file = file;
    t->clip = t->clips.count ? t->clips.items[0] : NULL;
    status = scene_init(&t->rest, file);
    if (!status) status = scene_init(&t->posed, file);
    if (!status) status = list_names(t);
    if (!status) status = scene_open_anim(&t->posed, file, t->anim);
    if (!status && t->clip) status = scene_clip_seconds(&t->posed, file, t->clip, &t->clip_seconds);
    return status;
}

void sheet_tiles_close(sheet_tiles *t)
{
    free(t->targets);
    scene_free(&t->rest);
    scene_free(&t->posed);
}

uint32_t sheet_tiles_count(const sheet_tiles *t)
{
    if (!t->clip) {
        return t->target_count + 1;
    }
    return t->blend ? t->clip_tiles * SHEET_BLEND_ROWS : t->clip_tiles;
}

uint32_t sheet_tiles_columns(const sheet_tiles *t)
{
    return t->clip && t->blend ? t->clip_tiles : 0;
}

/* Tile 0 of a sheet of targets is the rest pose. */
int sheet_tiles_pose(sheet_tiles *t, uint32_t tile)
{
    for (uint32_t i = 0; i < t->rest.item_count; i++) {
        memcpy(t->posed.items[i].weights, t->rest.items[i].weights,
               sizeof(float) * t->rest.meshes[t->rest.items[i].mesh].header->target_count);
    }
    if (t->clip) {
        return t->blend || t->to ? pose_pair(t, tile)
                                 : scene_set_clips(&t->posed, t->file, &t->clips, tile_time(t, tile));
    }
    if (tile) {
        pose_target(t, &t->targets[tile - 1]);
    }
    return 0;
}

void sheet_tiles_label(const sheet_tiles *t, uint32_t tile, char *text, size_t bytes)
{
    double time_s;
    if (!t->clip && tile) {
        label_target(&t->targets[tile - 1], text, bytes);
        return;
    }
    if (!t->clip) {
        snprintf(text, bytes, "(rest)");
        return;
    }
    time_s = tile_time(t, tile);
    if (t->blend) {
        snprintf(text, bytes, "%.0f%% %s", 100.0 * blend_weight(t, tile), t->blend);
    } else if (t->to && time_s < lead_s(t)) {
        snprintf(text, bytes, "%s %+.2f s", t->clip, time_s - lead_s(t));
    } else if (t->to) {
        snprintf(text, bytes, "%s %+.2f s", time_s < lead_s(t) + t->over_s ? (t->inertia ? "inertia" : "fade") : t->to,
                 time_s - lead_s(t));
    } else {
        snprintf(text, bytes, "%s %.2f s", t->clip, time_s);
    }
}
