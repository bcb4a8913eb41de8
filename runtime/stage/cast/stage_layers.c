/* stage_layers.c: layers out of a desc, and their masks out of names. */
#include <string.h>

#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/noh.h"
#include "noh/pack.h"
#include "stage/cast/stage_internal.h"

typedef noh_stage_word word;

int noh_stage_next_word(const char **list, word *w)
{
    const char *at = *list;
    memset(w, 0, sizeof *w);
    while (*at == ' ') at++;
    if (!*at) return 0;
    if (*at == '-') {
        w->takes_out = 1;
        at++;
    }
    w->text = at;
    while (*at && *at != ' ') at++;
    w->length = (size_t)(at - w->text);
    if (w->length && w->text[w->length - 1u] == '*') {
        w->any_rest = 1;
        w->length--;
    }
    *list = at;
    return 1;
}

int noh_stage_word_matches(const word *w, const char *name)
{
    size_t i = 0;
    while (i < w->length && name[i] == w->text[i] && name[i]) i++;
    return i == w->length && (w->any_rest || !name[i]);
}

/* ---- joints ---- */

static int mask_joints(const noh_stage_kind *k, const word *w, uint8_t *mask)
{
    int found = 0;
    for (uint32_t j = 0; j < k->skeleton.joint_count; j++) {
        if (noh_stage_word_matches(w, noh_pack_joint_name(k->desc->mesh, k->desc->skeleton, j))) {
            noh_mask_subtree(mask, &k->skeleton, j, w->takes_out ? 0 : 255);
            found = 1;
        }
    }
    return found;
}

/* ---- floats ---- */

/* The mesh of the node that a group of floats belongs to; 0: none. */
static int group_mesh(const noh_stage_kind *k, const noh_clip_group *group, noh_mesh *mesh)
{
    return group->node != NOH_NONE &&
           noh_pack_mesh_at(k->desc->mesh, k->desc->mesh->nodes[group->node].mesh, mesh, NULL) == NOH_OK;
}

/* A named float of clips has a hash alone, so no '*' matches it. */
static int matches_hash(const word *w, uint32_t hash)
{
    char name[NOH_NAME_BYTES_MAX];
    if (w->any_rest || w->length >= sizeof name) return w->any_rest && w->length == 0;
    memcpy(name, w->text, w->length);
    name[w->length] = 0;
    return noh_hash_name(name) == hash;
}

static int mask_floats(const noh_stage_kind *k, const word *w, uint8_t *mask)
{
    int found = 0;
    for (uint32_t g = 0; k->bank && g < k->bank->group_count; g++) {
        const noh_clip_group *group = &k->bank->groups[g];
        noh_mesh mesh;
        const int has_mesh = group_mesh(k, group, &mesh);
        for (uint32_t i = 0; i < group->width; i++) {
            if (has_mesh ? noh_stage_word_matches(w, noh_pack_string(mesh.pack, mesh.targets[i].name))
                         : matches_hash(w, group->name_hash)) {
                mask[group->first + i] = w->takes_out ? 0 : 255;
                found = 1;
            }
        }
    }
    return found;
}

/* ---- masks ---- */

typedef int (*mask_fn)(const noh_stage_kind *k, const word *w, uint8_t *mask);

/* NULL takes all, "" none; a list that begins by taking out begins with all. */
static noh_result fill_mask(const noh_stage_kind *k, const char *list, mask_fn fn, uint8_t *mask, uint32_t count,
                            uint64_t where, const char *what, noh_error *error)
{
    const char *at = list;
    word w;
    noh_mask_fill(mask, count, !list ? 255 : 0);
    for (int first = 1; list && noh_stage_next_word(&at, &w); first = 0) {
        if (first && w.takes_out) noh_mask_fill(mask, count, 255);
        if (!fn(k, &w, mask)) {
            return noh_fail(error, NOH_ERR_NOT_FOUND, what, where, (uint64_t)(w.text - list));
        }
    }
    return NOH_OK;
}

static int any(const uint8_t *mask, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        if (mask[i]) return 1;
    }
    return 0;
}

static noh_result open_mask(noh_stage_kind *k, const noh_layer_desc *d, noh_stage_layer *layer, uint64_t where,
                            noh_error *error)
{
    const uint32_t joints = k->set.joint_count, floats = k->set.float_count;
    uint8_t *mask = k->masks + k->set.mask_count * (joints + floats);
    noh_result result = fill_mask(k, d->joints, mask_joints, mask, joints, where,
                                  "joints of a layer: the skeleton has no joint of this name: noh info lists them",
                                  error);
    if (result == NOH_OK && k->bank) {
        result = fill_mask(k, d->floats, mask_floats, mask + joints, floats, where,
                           "floats of a layer: no target of the meshes and no float of the clips has this name: "
                           "noh info lists them",
                           error);
    } else if (!k->bank) {
        noh_mask_fill(mask + joints, floats, 0);
    }
    layer->moves_joints = any(mask, joints);
    layer->mask = ++k->set.mask_count;
    return result;
}

noh_result noh_stage_open_layers(noh_stage_kind *k, uint32_t kind, noh_error *error)
{
    noh_result result = NOH_OK;
    uint32_t tracks = 0;
    k->layer_count = k->desc->layer_count;
    k->set.mask_count = 0;
    k->set.masks = k->masks;
    for (uint32_t i = 0; i < k->layer_count && result == NOH_OK; i++) {
        const noh_layer_desc *d = &k->desc->layers[i];
        noh_stage_layer *layer = &k->layers[i];
        memset(layer, 0, sizeof *layer);
        layer->name = d->name;
        layer->mode = (uint32_t)d->mode;
        layer->first_track = tracks;
        layer->track_count = noh_stage_layer_tracks(d);
        layer->moves_joints = k->set.joint_count > 0;
        tracks += layer->track_count;
        if (d->joints || d->floats) result = open_mask(k, d, layer, kind | (uint64_t)i << 32, error);
    }
    return result;
}
