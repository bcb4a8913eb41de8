#include "sheet_tiles.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "noh/clip.h"
#include "noh/noh.h"
#include "noh/pack.h"
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
        status = figure_check_target(t->file, t->targets[t->target_count++].name);
    }
    return status;
}

/* The only target there and back over time. Tile 0, at rest, is where it begins. */
static int list_ping_pong(sheet_tiles *t)
{
    const int64_t half = noh_ticks_from_seconds(t->half_s);
    sheet_target whole;
    int status;
    if (t->only.count != 1) return tool_usage("--ping-pong needs one --target");
    read_target(t->only.items[0], &whole);
    status = figure_check_target(t->file, whole.name);
    if (status) return status;
    t->targets = calloc((size_t)t->clip_tiles, sizeof *t->targets);
    if (!t->targets) return tool_fail(t->file->path, "out of memory");
    for (uint32_t i = 1; i < t->clip_tiles; i++) {
        const int64_t ticks = 2 * half * i / t->clip_tiles;
        sheet_target *shown = &t->targets[t->target_count++];
        *shown = whole;
        shown->weight *= (double)noh_ping_pong(ticks, half);
        shown->time_s = (double)ticks / NOH_TICKS_PER_SECOND;
    }
    return 0;
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
    const noh_pack *pack = &t->file->pack;
    size_t total = 0;
    noh_mesh mesh;
    if (t->half_s > 0.0) return list_ping_pong(t);
    if (t->only.count) {
        return list_only(t);
    }
    for (uint32_t m = 0; noh_pack_mesh_at(pack, m, &mesh, NULL) == NOH_OK; m++) {
        total += mesh.header->target_count;
    }
    t->targets = calloc(total + 1, sizeof *t->targets);
    if (!t->targets) {
        return tool_fail(t->file->path, "out of memory");
    }
    for (uint32_t m = 0; noh_pack_mesh_at(pack, m, &mesh, NULL) == NOH_OK; m++) {
        for (uint32_t i = 0; i < mesh.header->target_count; i++) {
            add_name(t, noh_pack_string(pack, mesh.targets[i].name));
        }
    }
    return 0;
}

static void label_target(const sheet_target *shown, char *text, size_t bytes)
{
    if (shown->time_s > 0.0) {
        snprintf(text, bytes, "%s %.2f, %.2f s", shown->name, shown->weight, shown->time_s);
    } else if (shown->weight == 1.0) {
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
    if (t->push) return SHEET_FALL_S * fraction(tile, t->clip_tiles);
    if (!t->to) {
        return t->clip_seconds * fraction(tile, t->clip_tiles);
    }
    from = lead_s(t) > AROUND_S ? lead_s(t) - AROUND_S : 0.0;
    to = lead_s(t) + t->over_s + AROUND_S;
    return from + (to - from) * fraction(tile, t->clip_tiles);
}

/* Both clips at the same phase; one of weight 0 is not played. */
static int pose_blend(const sheet_tiles *t, figure *f, uint32_t tile)
{
    const char *const names[2] = { t->clip, t->blend };
    const float weight = (float)blend_weight(t, tile), weights[2] = { 1.0f - weight, weight };
    int status = 0;
    for (int i = 0; i < 2 && !status; i++) {
        double seconds = 0.0;
        noh_play play = { .weight = weights[i], .flags = NOH_PLAY_BESIDE };
        status = figure_clip_seconds(f, names[i], &seconds);
        play.start_ticks = (int64_t)(blend_phase(t, tile) * seconds * NOH_TICKS_PER_SECOND + 0.5);
        if (!status && weights[i] > 0.0f) status = figure_play(f, names[i], &play);
    }
    return status;
}

static int step(figure *f, double seconds)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    const uint32_t ticks = (uint32_t)noh_ticks_from_seconds(seconds);
    return noh_stage_step(f->stage, ticks, NULL, NULL, &error) ? tool_fail_error("clip", &error) : 0;
}

static int pose_transition(const sheet_tiles *t, figure *f, uint32_t tile)
{
    const double time_s = tile_time(t, tile), before_s = time_s < lead_s(t) ? time_s : lead_s(t);
    const noh_play first = { .fade_ticks = 1 };
    const noh_play then = { .fade_ticks = (uint32_t)noh_ticks_from_seconds(t->over_s),
                            .flags = t->inertia ? NOH_PLAY_INERTIA : 0 };
    int status = figure_play(f, t->clip, &first);
    if (!status) status = step(f, before_s);
    if (status || time_s < lead_s(t)) {
        return status;
    }
    status = figure_play(f, t->to, &then);
    return status ? status : step(f, time_s - lead_s(t));
}

/* ---- people ---- */

static uint32_t face_columns(const sheet_tiles *t)
{
    return t->expressions ? SHEET_FACES_SHOWN : 1u;
}

/* ---- all ---- */

void sheet_tiles_want(const sheet_tiles *t, figure_desc *desc)
{
    desc->track_count = t->blend || t->to || t->clips.count < 2 ? 2u : (uint32_t)t->clips.count;
    desc->held_float_count = t->face_count || t->wrinkled ? FIGURE_HELD_ALL : 1u;
    desc->complexions = t->face_count > 0;
    desc->inertia = t->inertia;
    desc->falls = t->push != NULL;
    desc->face_layer = t->clips.count > 1;
}

int sheet_tiles_open(sheet_tiles *t, const pack_file *file)
{
    t->file = file;
    t->clip = t->clips.count ? t->clips.items[0] : NULL;
    if (t->wrinkled) return sheet_wrinkles_open(&t->wrinkles, file, &t->only);
    return t->face_count ? sheet_faces_open(&t->faces, file) : list_names(t);
}

int sheet_tiles_measure(sheet_tiles *t, const figure *f)
{
    const char *other = t->blend ? t->blend : t->to;
    double seconds;
    const int status = t->clip ? figure_clip_seconds(f, t->clip, &t->clip_seconds) : 0;
    if (t->life_s > 0.0) t->clip_seconds = t->life_s;
    return status || !other ? status : figure_clip_seconds(f, other, &seconds);
}

void sheet_tiles_close(sheet_tiles *t)
{
    free(t->targets);
    sheet_faces_close(&t->faces);
    if (t->wrinkled) sheet_wrinkles_close(&t->wrinkles);
}

uint32_t sheet_tiles_count(const sheet_tiles *t)
{
    if (t->wrinkled) {
        return sheet_wrinkles_columns(&t->wrinkles) * SHEET_WRINKLE_ROWS;
    }
    if (t->face_count) {
        return t->face_count * face_columns(t);
    }
    if (!t->clip && !(t->life_s > 0.0)) {
        return t->target_count + 1;
    }
    return t->blend ? t->clip_tiles * SHEET_BLEND_ROWS : t->clip_tiles;
}

uint32_t sheet_tiles_columns(const sheet_tiles *t)
{
    if (t->wrinkled) return sheet_wrinkles_columns(&t->wrinkles);
    return t->face_count && t->expressions ? SHEET_FACES_SHOWN : t->clip && t->blend ? t->clip_tiles : 0;
}

/* Tile 0 of a sheet of targets is the rest pose. */
int sheet_tiles_pose(const sheet_tiles *t, figure *f, uint32_t tile)
{
    int status = figure_reset(f);
    if (status) {
        return status;
    }
    if (t->wrinkled) {
        status = sheet_wrinkles_hold(&t->wrinkles, f, tile);
    } else if (t->face_count) {
        status = sheet_faces_hold(&t->faces, f, t->seed + tile / face_columns(t), tile % face_columns(t));
    } else if (t->blend) {
        status = pose_blend(t, f, tile);
    } else if (t->to) {
        status = pose_transition(t, f, tile);
    } else if (t->push) {
        status = figure_play_options(f, &t->clips, 0.0);
        if (!status) status = figure_fall(f, t->impulse, tile_time(t, tile));
    } else if (t->clip || t->life_s > 0.0) {
        status = figure_play_options(f, &t->clips, t->lives ? 0.0 : tile_time(t, tile));
        if (!status && t->alive) status = figure_feel(f, &t->emotions);
        if (!status && t->lives) status = figure_live(f, tile_time(t, tile), 0.0);
    } else if (tile) {
        status = figure_hold(f, t->targets[tile - 1].name, t->targets[tile - 1].weight);
    }
    return status ? status : figure_pose(f);
}

void sheet_tiles_label(const sheet_tiles *t, uint32_t tile, char *text, size_t bytes)
{
    double time_s;
    if (t->wrinkled) {
        sheet_wrinkles_label(&t->wrinkles, tile, text, bytes);
        return;
    }
    if (t->face_count) {
        snprintf(text, bytes, "%u%s%s", t->seed + tile / face_columns(t), t->expressions ? " " : "",
                 t->expressions ? sheet_faces_name(tile % face_columns(t)) : "");
        return;
    }
    if (t->life_s > 0.0) {
        snprintf(text, bytes, "%.2f s", tile_time(t, tile));
        return;
    }
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
        snprintf(text, bytes, "%s %.2f s", t->push ? "pushed" : t->clip, t->push ? time_s - 0.5 : time_s);
    }
}
