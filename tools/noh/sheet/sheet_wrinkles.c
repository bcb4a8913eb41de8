#include "sheet_wrinkles.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "noh/base.h"
#include "noh/face.h"
#include "noh/format.h"
#include "noh/noh.h"
#include "noh/pack.h"
#include "sheet_lods.h"

#define LINKS_MAX 1024u

static const struct {
    const char *name;
    noh_appearance look;
} rows[SHEET_WRINKLE_ROWS] = { { "without", { .smoothed = 255 } },
                               { "by area", { .wrinkle_models = NOH_WRINKLE_BY_AREA } },
                               { "by region", { .wrinkle_models = NOH_WRINKLE_BY_REGION } },
                               { "by channel", { .wrinkle_models = NOH_WRINKLE_BY_CHANNEL } },
                               { "as built", { 0 } } };

static const struct {
    const char *name;
    uint32_t emotion;
} emotions[SHEET_WRINKLE_FACES] = { { "anger", NOH_EMOTION_ANGER },
                                    { "joy", NOH_EMOTION_JOY },
                                    { "surprise", NOH_EMOTION_SURPRISE },
                                    { "sadness", NOH_EMOTION_SADNESS },
                                    { "disgust", NOH_EMOTION_DISGUST } };

static int find_mesh(sheet_wrinkles *s, const pack_file *file)
{
    noh_wrinkles wrinkles;
    for (uint32_t i = 0; noh_pack_mesh_at(&file->pack, i, &s->mesh, NULL) == NOH_OK; i++) {
        if (noh_wrinkles_of(&s->mesh, &wrinkles, NULL) == NOH_OK) return 0;
    }
    return tool_fail(file->path, "no mesh has wrinkles (`noh build --wrinkles auto` makes them)");
}

/* The weights of an emotion, by the rows of the recipes that the mesh has targets for. */
static int feel(const sheet_wrinkles *s, uint32_t emotion)
{
    const uint32_t count = s->mesh.header->target_count;
    float channels[NOH_CHANNEL_COUNT] = { 0.0f };
    noh_face_link *links = malloc(LINKS_MAX * sizeof *links);
    uint32_t link_count;
    if (!links) return tool_fail("sheet", "out of memory");
    link_count = noh_face_recipe_bind(NULL, 0, s->names, count, links, LINKS_MAX);
    channels[NOH_CHANNEL_UPPER + emotion] = channels[NOH_CHANNEL_MOUTH + emotion] = 1.0f;
    memset(s->weights, 0, count * sizeof *s->weights);
    noh_face_apply(links, link_count < LINKS_MAX ? link_count : LINKS_MAX, channels, s->weights);
    free(links);
    return 0;
}

/* Recipes know the targets of many heads, not of all. */
static int check_emotions(const sheet_wrinkles *s, const pack_file *file)
{
    for (uint32_t e = 0; e < SHEET_WRINKLE_FACES; e++) {
        const int status = feel(s, emotions[e].emotion);
        if (status) return status;
        for (uint32_t t = 0; t < s->mesh.header->target_count; t++) {
            if (s->weights[t] != 0.0f) return 0;
        }
    }
    return tool_fail(file->path, "no recipe fits its targets: choose them with --target");
}

int sheet_wrinkles_open(sheet_wrinkles *s, const pack_file *file, const option_list *faces)
{
    int status;
    memset(s, 0, sizeof *s);
    s->faces = faces;
    status = find_mesh(s, file);
    if (status) return status;
    s->names = calloc((size_t)s->mesh.header->target_count + 1u, sizeof *s->names);
    s->weights = calloc((size_t)s->mesh.header->target_count + 1u, sizeof *s->weights);
    if (!s->names || !s->weights) return tool_fail(file->path, "out of memory");
    for (uint32_t i = 0; i < s->mesh.header->target_count; i++) {
        s->names[i] = noh_pack_string(s->mesh.pack, s->mesh.targets[i].name);
    }
    return faces->count ? 0 : check_emotions(s, file);
}

void sheet_wrinkles_close(sheet_wrinkles *s)
{
    free(s->names);
    free(s->weights);
    s->names = NULL;
    s->weights = NULL;
}

uint32_t sheet_wrinkles_columns(const sheet_wrinkles *s)
{
    return s->faces->count ? (uint32_t)s->faces->count : SHEET_WRINKLE_FACES;
}

int sheet_wrinkles_hold(const sheet_wrinkles *s, figure *f, uint32_t tile)
{
    const uint32_t columns = sheet_wrinkles_columns(s), column = tile % columns;
    int status = figure_set_look(f, &rows[tile / columns].look);
    if (status) return status;
    if (s->faces->count) return sheet_hold_face(f, s->faces->items[column]);
    status = feel(s, emotions[column].emotion);
    for (uint32_t t = 0; t < s->mesh.header->target_count && !status; t++) {
        if (s->weights[t] != 0.0f) status = figure_hold(f, s->names[t], (double)s->weights[t]);
    }
    return status;
}

void sheet_wrinkles_label(const sheet_wrinkles *s, uint32_t tile, char *text, size_t bytes)
{
    const uint32_t columns = sheet_wrinkles_columns(s), column = tile % columns;
    const char *face = s->faces->count ? s->faces->items[column] : emotions[column].name;
    snprintf(text, bytes, "%s, %s", face, rows[tile / columns].name);
}
