#include "view/view_presets.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "noh/base.h"
#include "noh/face.h"
#include "platform.h"
#include "file/text_file.h"
#include "file/weights_text.h"

/* ---- targets ---- */

void view_target_hold(view_target *t, float value)
{
    t->value = value;
    t->held = 1;
}

void view_target_let_go(view_target *t)
{
    t->let_go |= t->held;
    t->held = 0;
}

static view_target *find_target(const view_model *m, const char *name)
{
    for (uint32_t t = 0; t < m->target_count; t++) {
        if (strcmp(m->targets[t].name, name) == 0) return &m->targets[t];
    }
    return NULL;
}

static void let_go_of_all(view_model *m)
{
    for (uint32_t t = 0; t < m->target_count; t++) view_target_let_go(&m->targets[t]);
}

/* ---- as text ---- */

char *view_weights_copy(const view_model *m)
{
    byte_buffer text = { NULL, 0, 0, 0 };
    char line[NOH_NAME_BYTES_MAX + 40u];
    for (uint32_t t = 0; t < m->target_count; t++) {
        const view_target *target = &m->targets[t];
        if (!target->held) continue;
        buffer_append(&text, line, weights_line(line, sizeof line, target->name, target->value));
    }
    if (!text.count || !buffer_append(&text, "", 1)) buffer_free(&text);
    return (char *)text.bytes;
}

/* Whether a text has any weight of the model, and the first name that the model lacks. */
static int has_weights(const view_model *m, const char *text, char unknown[NOH_NAME_BYTES_MAX])
{
    weights_reader reader = { text, 0 };
    weights_item item;
    weights_kind kind;
    int known = 0;
    unknown[0] = 0;
    while ((kind = weights_next(&reader, &item)) != WEIGHTS_END) {
        if (kind == WEIGHTS_VALUE && find_target(m, item.name))
            known = 1;
        else if (kind != WEIGHTS_PRESET && !unknown[0])
            memcpy(unknown, item.name, sizeof item.name);
    }
    return known;
}

int view_weights_paste(view_model *m, const char *text)
{
    char unknown[NOH_NAME_BYTES_MAX];
    weights_reader reader = { text, 0 };
    weights_item item;
    weights_kind kind;
    if (!has_weights(m, text, unknown)) {
        return unknown[0]
                   ? tool_fail("paste", "the text has no weights of this figure, such as smile = 0.5, but '%.80s'",
                               unknown)
                   : tool_fail("paste", "the clipboard has no text");
    }
    let_go_of_all(m);
    while ((kind = weights_next(&reader, &item)) != WEIGHTS_END) {
        view_target *target = kind == WEIGHTS_VALUE ? find_target(m, item.name) : NULL;
        if (target) view_target_hold(target, (float)item.value);
    }
    return unknown[0] ? tool_fail("paste", "this figure has no target '%.80s'; the other weights were applied", unknown)
                      : 0;
}

/* ---- the list ---- */

static int add_weight(view_presets *p, const char *name, float value)
{
    if (p->weight_count == p->weight_room) {
        const uint32_t room = p->weight_room ? 2u * p->weight_room : 256u;
        view_preset_weight *more = realloc(p->weights, room * sizeof *more);
        if (!more) return tool_fail("presets", "out of memory");
        p->weights = more;
        p->weight_room = room;
    }
    snprintf(p->weights[p->weight_count].name, sizeof p->weights[0].name, "%s", name);
    p->weights[p->weight_count++].value = value;
    p->list[p->count - 1u].count++;
    return 0;
}

static int add_preset(view_presets *p, const char *name, int own)
{
    view_preset *preset = &p->list[p->count];
    if (p->count == VIEW_PRESETS_MAX) return tool_fail("presets", "more than %u", VIEW_PRESETS_MAX);
    memset(preset, 0, sizeof *preset);
    snprintf(preset->name, sizeof preset->name, "%s", name);
    preset->own = own;
    preset->first = p->weight_count;
    p->count++;
    return 0;
}

/* The targets that recipes link to these channels, as one preset; none if they link nothing. */
static int add_channels(view_presets *p, const view_model *m, const noh_face_link *links, uint32_t link_count,
                        const uint32_t channels[2], const char *name)
{
    int status = 0, begun = 0;
    for (uint32_t i = 0; i < link_count && !status; i++) {
        if (links[i].channel != channels[0] && links[i].channel != channels[1]) continue;
        if (!begun) status = add_preset(p, name, 0);
        begun = 1;
        if (!status) status = add_weight(p, m->targets[links[i].target].name, links[i].weight);
    }
    return status;
}

uint32_t view_recipe_links(const view_model *m, noh_face_link *links)
{
    const noh_face_recipe own = noh_face_recipe_in_pack(&m->file.pack);
    const noh_face_recipe *recipes[4] = { &own, &noh_face_recipe_arkit, &noh_face_recipe_vrm, &noh_face_recipe_units };
    const char **names = malloc((m->target_count + 1u) * sizeof *names);
    uint32_t count = 0;
    for (uint32_t t = 0; t < m->target_count && names; t++) names[t] = m->targets[t].name;
    if (names) count = noh_face_recipe_bind(recipes, 4, names, m->target_count, links, VIEW_LINKS_MAX);
    free(names);
    return count < VIEW_LINKS_MAX ? count : VIEW_LINKS_MAX;
}

static int add_recipes(view_presets *p, const view_model *m)
{
    noh_face_link *links = malloc(VIEW_LINKS_MAX * sizeof *links);
    const uint32_t count = links ? view_recipe_links(m, links) : 0;
    int status = links ? 0 : tool_fail("presets", "out of memory");
    for (uint32_t e = 0; e < NOH_EMOTION_COUNT && !status; e++) {
        const uint32_t channels[2] = { NOH_CHANNEL_UPPER + e, NOH_CHANNEL_MOUTH + e };
        status = add_channels(p, m, links, count, channels, noh_emotion_name((noh_emotion)e));
    }
    if (!status) {
        const uint32_t lids[2] = { NOH_CHANNEL_BLINK_LEFT, NOH_CHANNEL_BLINK_RIGHT };
        status = add_channels(p, m, links, count, lids, "blink");
    }
    for (uint32_t v = 1; v < NOH_VISEME_COUNT && !status; v++) {
        const uint32_t channels[2] = { NOH_CHANNEL_VISEMES + v, NOH_CHANNEL_VISEMES + v };
        status = add_channels(p, m, links, count, channels, noh_face_channel_name(channels[0]));
    }
    free(links);
    return status;
}

/* ---- the user's own ---- */

#define TEXT_BYTES_MAX (1u << 22)

static int add_own(view_presets *p)
{
    char *text = NULL;
    int status = text_file_read(p->path, 1, TEXT_BYTES_MAX, &text), begun = 0;
    weights_reader reader = { text, 0 };
    weights_item item;
    weights_kind kind;
    while (text && !status && (kind = weights_next(&reader, &item)) != WEIGHTS_END) {
        if (kind == WEIGHTS_PRESET) {
            status = add_preset(p, item.name, 1);
            begun = 1;
        } else if (kind == WEIGHTS_VALUE && begun) {
            status = add_weight(p, item.name, (float)item.value);
        } else {
            status = tool_fail(p->path, "line %u: '%.80s' is neither [NAME] nor TARGET = WEIGHT below a [NAME]",
                               item.line, item.name);
        }
    }
    free(text);
    return status;
}

int view_presets_read(view_presets *p, const view_model *m, const char *path)
{
    int status;
    view_presets_free(p);
    snprintf(p->path, sizeof p->path, path ? "%s" : "%s.presets", path ? path : m->path);
    status = add_recipes(p, m);
    return status ? status : add_own(p);
}

void view_presets_free(view_presets *p)
{
    free(p->weights);
    memset(p, 0, sizeof *p);
}

static int write_own(const view_presets *p)
{
    const size_t line = NOH_NAME_BYTES_MAX + 40u, room = (p->weight_count + 2u * p->count + 1u) * line;
    char *text = malloc(room);
    size_t bytes = 0;
    noh_error error;
    int status = 0;
    if (!text) return tool_fail("presets", "out of memory");
    for (uint32_t i = 0; i < p->count; i++) {
        const view_preset *preset = &p->list[i];
        if (!preset->own) continue;
        bytes += (size_t)snprintf(text + bytes, line, "%s[%s]\n", bytes ? "\n" : "", preset->name);
        for (uint32_t w = 0; w < preset->count; w++) {
            const view_preset_weight *weight = &p->weights[preset->first + w];
            bytes += weights_line(text + bytes, line, weight->name, weight->value);
        }
    }
    if (noh_file_write(p->path, text, bytes, &error)) status = tool_fail(p->path, "cannot be written: %s", error.what);
    free(text);
    return status;
}

int view_presets_keep(view_presets *p, const view_model *m, const char *name)
{
    int status = 0, any = 0;
    if (!name[0] || strpbrk(name, "[]\n")) return tool_fail("presets", "a preset needs a name without brackets");
    for (uint32_t t = 0; t < m->target_count; t++) any |= m->targets[t].held;
    if (!any) return tool_fail("presets", "no slider was moved: there is nothing to save");
    for (uint32_t i = 0; i < p->count; i++) {
        if (p->list[i].own && strcmp(p->list[i].name, name) == 0) p->list[i--] = p->list[--p->count];
    }
    status = add_preset(p, name, 1);
    for (uint32_t t = 0; t < m->target_count && !status; t++) {
        if (m->targets[t].held) status = add_weight(p, m->targets[t].name, m->targets[t].value);
    }
    return status ? status : write_own(p);
}

int view_presets_drop(view_presets *p, uint32_t index)
{
    memmove(&p->list[index], &p->list[index + 1u], (p->count - index - 1u) * sizeof p->list[0]);
    p->count--;
    return write_own(p);
}

void view_presets_use(const view_presets *p, uint32_t index, view_model *m)
{
    const view_preset *preset = &p->list[index];
    let_go_of_all(m);
    for (uint32_t w = 0; w < preset->count; w++) {
        view_target *target = find_target(m, p->weights[preset->first + w].name);
        if (target) view_target_hold(target, p->weights[preset->first + w].value);
    }
}
