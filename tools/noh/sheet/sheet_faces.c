#include "sheet_faces.h"

#include <stdlib.h>
#include <string.h>

#include "cli/message.h"

static noh_result open_mesh(sheet_faces *s, noh_error *error)
{
    const size_t bytes = noh_identity_size(&s->mesh), working = noh_identity_scratch_size(&s->mesh);
    void *scratch = malloc(working + 1u);
    noh_result result = NOH_ERR_MEMORY;
    s->memory = malloc(bytes + 1u);
    s->weights = calloc((size_t)s->mesh.header->target_count + 1u, sizeof *s->weights);
    s->names = calloc((size_t)s->mesh.header->target_count + 1u, sizeof *s->names);
    if (scratch && s->memory && s->weights && s->names) {
        for (uint32_t i = 0; i < s->mesh.header->target_count; i++) {
            s->names[i] = noh_pack_string(s->mesh.pack, s->mesh.targets[i].name);
        }
        result = noh_identity_init(s->memory, bytes, scratch, working, &s->mesh, NULL, &s->identity, error);
    }
    free(scratch);
    if (result == NOH_ERR_ARG) { /* no identity targets: people differ by their colours alone */
        memset(&s->identity, 0, sizeof s->identity);
        result = NOH_OK;
    }
    if (result) sheet_faces_close(s);
    return result;
}

int sheet_faces_open(sheet_faces *s, const pack_file *file)
{
    noh_error error = { NOH_OK, "out of memory", 0, 0 };
    noh_result result = NOH_ERR_NOT_FOUND;
    memset(s, 0, sizeof *s);
    for (uint32_t i = 0; result && noh_pack_mesh_at(&file->pack, i, &s->mesh, NULL) == NOH_OK; i++) {
        if (s->mesh.header->target_count) result = open_mesh(s, &error);
    }
    return !result ? 0 : tool_fail(file->path, "%s", result == NOH_ERR_NOT_FOUND ? "no mesh has targets" : error.what);
}

void sheet_faces_close(sheet_faces *s)
{
    free(s->memory);
    free(s->weights);
    free(s->names);
    s->names = NULL;
    s->memory = NULL;
    s->weights = NULL;
}

/* ---- expressions ---- */

static const struct {
    const char *name;
    uint32_t channels[4];
    uint32_t count;
} expressions[SHEET_FACES_SHOWN] = {
    { "rest", { 0 }, 0 },
    { "blink", { NOH_CHANNEL_BLINK_LEFT, NOH_CHANNEL_BLINK_RIGHT }, 2 },
    { "joy", { NOH_CHANNEL_UPPER + NOH_EMOTION_JOY, NOH_CHANNEL_MOUTH + NOH_EMOTION_JOY }, 2 },
    { "surprise", { NOH_CHANNEL_UPPER + NOH_EMOTION_SURPRISE, NOH_CHANNEL_MOUTH + NOH_EMOTION_SURPRISE }, 2 },
    { "anger", { NOH_CHANNEL_UPPER + NOH_EMOTION_ANGER, NOH_CHANNEL_MOUTH + NOH_EMOTION_ANGER }, 2 },
    { "ah", { NOH_CHANNEL_VISEMES + NOH_VISEME_AA }, 1 },
};

const char *sheet_faces_name(uint32_t shown)
{
    return expressions[shown].name;
}

#define LINKS_MAX 1024u

static int add_expression(const sheet_faces *s, uint32_t shown)
{
    const uint32_t count = s->mesh.header->target_count;
    float channels[NOH_CHANNEL_COUNT] = { 0.0f };
    noh_face_link *links = malloc(LINKS_MAX * sizeof *links);
    uint32_t link_count;
    if (!links) return 1;
    link_count = noh_face_recipe_bind(NULL, 0, s->names, count, links, LINKS_MAX);
    link_count = link_count < LINKS_MAX ? link_count : LINKS_MAX;
    if (s->identity.target_count) noh_identity_bind(&s->identity, s->weights, links, link_count);
    for (uint32_t i = 0; i < expressions[shown].count; i++) channels[expressions[shown].channels[i]] = 1.0f;
    noh_face_apply(links, link_count, channels, s->weights);
    free(links);
    return 0;
}

int sheet_faces_hold(const sheet_faces *s, figure *f, uint32_t seed, uint32_t shown)
{
    const uint32_t count = s->mesh.header->target_count;
    noh_appearance look = f->look;
    int status;
    memset(s->weights, 0, count * sizeof *s->weights);
    if (s->identity.target_count) noh_identity_random(&s->identity, seed, 1.0f, s->weights);
    if (shown && add_expression(s, shown)) return tool_fail(f->desc.file->path, "out of memory");
    noh_complexion_random(seed, 1.0f, look.user);
    status = figure_set_look(f, &look);
    for (uint32_t t = 0; t < count && !status; t++) {
        if (s->weights[t] != 0.0f) status = figure_hold(f, s->names[t], (double)s->weights[t]);
    }
    return status;
}
