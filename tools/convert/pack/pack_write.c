#include "pack_write.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "convert/model/tint.h"
#include "pack_clips.h"
#include "pack_graph.h"
#include "pack_mesh.h"
#include "pack_skin.h"
#include "texture_levels.h"

typedef struct writer {
    const model *m;
    const mesh_levels *levels;  /* or NULL */
    const encoded_clips *clips; /* or NULL */
    byte_buffer out;            /* header and table first, then the chunks */
    string_table strings;
    noh_pack_chunk *chunks;
    uint32_t chunk_count;
    uint32_t *skin_chunks; /* [skin_count] the n-th skin chunk, or NOH_NONE where no mesh is bound to it */
    mesh_extra *extras;    /* [mesh_count] */
    model_error *error;
    int refused; /* a mesh cannot be packed; the error has the reason */
} writer;

static void name_of(string_table *strings, const char *text, uint32_t *name, uint32_t *hash)
{
    *name = string_offset(strings, text ? text : "");
    *hash = noh_hash_name((const char *)strings->bytes.bytes + *name);
}

static void begin_chunk(writer *w, uint32_t type, const char *name)
{
    noh_pack_chunk *c = &w->chunks[w->chunk_count];
    buffer_align(&w->out, NOH_PACK_ALIGN);
    memset(c, 0, sizeof *c);
    c->type = type;
    name_of(&w->strings, name, &c->name, &c->name_hash);
    c->offset = (uint32_t)w->out.count;
}

static void end_chunk(writer *w)
{
    noh_pack_chunk *c = &w->chunks[w->chunk_count++];
    c->bytes = (uint32_t)(w->out.count - c->offset);
    c->crc = w->out.failed ? 0 : noh_crc32c(0, w->out.bytes + c->offset, c->bytes);
}

static uint32_t wrap_mode(uint32_t gltf)
{
    return gltf == 33071 ? NOH_WRAP_CLAMP : gltf == 33648 ? NOH_WRAP_MIRROR : NOH_WRAP_REPEAT;
}

static void write_texture(writer *w, const model_texture *t)
{
    noh_texture_header h;
    size_t base;
    begin_chunk(w, NOH_CHUNK_TEXTURE, t->name);
    memset(&h, 0, sizeof h);
    h.wrap_s = wrap_mode(t->wrap_s);
    h.wrap_t = wrap_mode(t->wrap_t);
    h.nearest = t->mag_filter == 9728;
    h.flags = t->use == MODEL_TEXTURE_COLOR ? 0u : NOH_TEXTURE_LINEAR;
    h.pixels_offset = sizeof h;
    base = w->out.count;
    buffer_append(&w->out, &h, sizeof h);
    if (texture_levels_write(t, &h, &w->out)) {
        w->out.failed = 1;
    } else {
        memcpy(w->out.bytes + base, &h, sizeof h);
    }
    end_chunk(w);
}

static uint32_t material_flags(const model_material *m)
{
    return (m->alpha == MODEL_ALPHA_BLEND ? NOH_MATERIAL_BLEND : 0u) |
           (m->alpha == MODEL_ALPHA_MASK ? NOH_MATERIAL_MASK : 0u) |
           (m->double_sided ? NOH_MATERIAL_DOUBLE_SIDED : 0u) | (m->unlit ? NOH_MATERIAL_UNLIT : 0u) |
           (m->specular_texture == MODEL_NONE ? 0u
            : m->specular_roughness           ? NOH_MATERIAL_SPECULAR_ROUGHNESS
                                              : NOH_MATERIAL_SPECULAR_WEIGHT) |
           (tint_is_taken(m) ? 0u : NOH_MATERIAL_UNTINTED) | (m->wrinkle_codes ? NOH_MATERIAL_WRINKLE_CODES : 0u);
}

static void write_maps(const model_material *from, noh_material *to)
{
    to->normal_scale = from->normal_scale;
    to->occlusion_strength = from->occlusion_strength;
    memcpy(to->emissive, from->emissive, sizeof to->emissive);
    memcpy(to->f0, from->f0, sizeof to->f0);
    to->normal_texture = from->normal_texture;
    to->surface_texture = from->surface_texture;
    to->emissive_texture = from->emissive_texture;
    to->wrinkle_texture = from->wrinkle_texture;
    to->specular_texture = from->specular_texture == MODEL_NONE ? 0u : from->specular_texture;
    to->f90_loss = from->f90_loss;
    to->wrinkle_models = (uint16_t)from->wrinkle_models;
    memcpy(to->wrinkle_weights, from->wrinkle_weights, sizeof to->wrinkle_weights);
    to->surface = from->surface;
    memcpy(to->surface_values, from->surface_values, sizeof to->surface_values);
    memcpy(to->surface_more, from->surface_more, sizeof to->surface_more);
}

static void write_materials(writer *w)
{
    begin_chunk(w, NOH_CHUNK_MATERIALS, "");
    for (uint32_t i = 0; i < w->m->material_count; i++) {
        const model_material *from = &w->m->materials[i];
        noh_material to;
        memset(&to, 0, sizeof to);
        name_of(&w->strings, from->name, &to.name, &to.name_hash);
        to.flags = material_flags(from);
        to.base_color_texture = from->base_color_texture;
        memcpy(to.base_color, from->base_color, sizeof to.base_color);
        to.metallic = from->metallic;
        to.roughness = from->roughness;
        to.alpha_cutoff = from->alpha_cutoff;
        to.priority = from->priority;
        write_maps(from, &to);
        buffer_append(&w->out, &to, sizeof to);
    }
    end_chunk(w);
}

static void write_mesh(writer *w, uint32_t index, const morph_encoding *e)
{
    static const mesh_levels alone = { .count = 1 };
    const model_mesh *mesh = &w->m->meshes[index];
    uint8_t blends[NOH_SUBMESHES_MAX];
    const mesh_input from = { mesh,
                              w->levels ? &w->levels[index] : &alone,
                              e,
                              blends,
                              model_mesh_scale(w->m, index),
                              mesh->bound ? w->skin_chunks[mesh->skin] : NOH_NONE,
                              mesh->bound ? w->m->skins[mesh->skin].joint_count : 0 };
    for (uint32_t s = 0; s < mesh->submesh_count; s++) {
        uint32_t material = mesh->submeshes[s].material;
        blends[s] = material != MODEL_NONE && w->m->materials[material].alpha == MODEL_ALPHA_BLEND;
    }
    w->extras[index].index = index;
    begin_chunk(w, NOH_CHUNK_MESH, mesh->name);
    w->refused = w->refused || pack_mesh(&from, &w->strings, &w->out, &w->extras[index], w->error);
    end_chunk(w);
}

/* A skinned mesh is placed by its joints, whose model space is the world. */
static void set_world(const writer *w, const model_node *from, noh_node *to)
{
    int skinned = from->mesh != MODEL_NONE && w->m->meshes[from->mesh].bound;
    for (int i = 0; i < 12; i++) {
        to->world[i] = skinned ? (i % 5 == 0 ? 1.0f : 0.0f) : (float)from->world[4 * (i % 4) + i / 4];
    }
}

static void write_node(writer *w, const model_node *from, uint32_t *weight_count)
{
    noh_node to;
    memset(&to, 0, sizeof to);
    name_of(&w->strings, from->name, &to.name, &to.name_hash);
    to.parent = from->parent;
    to.mesh = from->mesh;
    memcpy(to.translation, from->translation, sizeof to.translation);
    memcpy(to.rotation, from->rotation, sizeof to.rotation);
    memcpy(to.scale, from->scale, sizeof to.scale);
    set_world(w, from, &to);
    to.first_weight = NOH_NONE;
    if (from->mesh != MODEL_NONE && from->weights) {
        to.first_weight = *weight_count;
        *weight_count += w->m->meshes[from->mesh].target_count;
    }
    buffer_append(&w->out, &to, sizeof to);
}

static void write_nodes(writer *w)
{
    noh_nodes_header h = { w->m->node_count, 0, sizeof h, 0 };
    size_t base;
    begin_chunk(w, NOH_CHUNK_NODES, "");
    base = w->out.count;
    buffer_append(&w->out, &h, sizeof h);
    for (uint32_t i = 0; i < w->m->node_count; i++) {
        write_node(w, &w->m->nodes[i], &h.weight_count);
    }
    buffer_align(&w->out, 16);
    h.weights_offset = (uint32_t)(w->out.count - base);
    for (uint32_t i = 0; i < w->m->node_count; i++) {
        const model_node *n = &w->m->nodes[i];
        if (n->mesh != MODEL_NONE && n->weights) {
            buffer_append(&w->out, n->weights, 4u * (size_t)w->m->meshes[n->mesh].target_count);
        }
    }
    if (!w->out.failed) {
        memcpy(w->out.bytes + base, &h, sizeof h);
    }
    end_chunk(w);
}

/* The n-th skeleton chunk of a set; sets without joints have none. */
static uint32_t skeleton_chunk(const encoded_clips *made, uint32_t set)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < set; i++) {
        n += made->sets[i]->skeleton.joint_count > 0;
    }
    return n;
}

static void write_skeletons(writer *w)
{
    for (uint32_t i = 0; i < w->clips->set_count; i++) {
        if (!w->clips->sets[i]->skeleton.joint_count) {
            continue; /* clips of weights alone */
        }
        begin_chunk(w, NOH_CHUNK_SKELETON, w->clips->sets[i]->skeleton.name);
        pack_skeleton(&w->clips->sets[i]->skeleton, &w->strings, &w->out);
        end_chunk(w);
    }
}

/* Only skins that move a mesh. */
static void write_skins(writer *w)
{
    uint32_t count = 0;
    for (uint32_t s = 0; s < w->m->skin_count; s++) {
        int used = 0;
        for (uint32_t i = 0; i < w->m->mesh_count; i++) {
            used |= w->m->meshes[i].bound && w->m->meshes[i].skin == s;
        }
        w->skin_chunks[s] = used ? count++ : NOH_NONE;
        if (used) {
            begin_chunk(w, NOH_CHUNK_SKIN, w->m->skins[s].name);
            pack_skin(&w->m->skins[s], skeleton_chunk(w->clips, w->m->skins[s].set), &w->out);
            end_chunk(w);
        }
    }
}

static void write_influences(writer *w, uint32_t index)
{
    const byte_buffer *list = &w->extras[index].influences;
    w->out.failed |= list->failed;
    if (!list->count) return;
    begin_chunk(w, NOH_CHUNK_INFLUENCES, w->m->meshes[index].name);
    buffer_append(&w->out, list->bytes, list->count);
    end_chunk(w);
}

static void write_wrinkles(writer *w, uint32_t index)
{
    const model_mesh *mesh = &w->m->meshes[index];
    noh_wrinkles_header h;
    memset(&h, 0, sizeof h);
    h.mesh = index;
    h.target_count = mesh->target_count;
    h.matrix_offset = sizeof h;
    begin_chunk(w, NOH_CHUNK_WRINKLES, mesh->name);
    buffer_append(&w->out, &h, sizeof h);
    buffer_append(&w->out, mesh->wrinkles, (size_t)mesh->target_count * NOH_WRINKLE_REGIONS);
    end_chunk(w);
}

static void write_content(writer *w, morph_encoding *const *encodings)
{
    for (uint32_t i = 0; i < w->m->texture_count; i++) {
        write_texture(w, &w->m->textures[i]);
    }
    if (w->m->material_count) {
        write_materials(w);
    }
    if (w->clips) {
        write_skeletons(w);
        write_skins(w);
    }
    for (uint32_t i = 0; i < w->m->mesh_count; i++) {
        write_mesh(w, i, encodings[i]);
    }
    for (uint32_t i = 0; i < w->m->mesh_count; i++) {
        write_influences(w, i);
    }
    for (uint32_t i = 0; i < w->m->mesh_count; i++) {
        if (w->m->meshes[i].wrinkles) write_wrinkles(w, i);
    }
    if (w->m->node_count) {
        write_nodes(w);
    }
}

static void write_clips(writer *w)
{
    for (uint32_t i = 0; i < w->clips->clip_count; i++) {
        begin_chunk(w, NOH_CHUNK_CLIP, w->clips->clips[i].raw->name);
        pack_clip(w->clips, &w->clips->clips[i], &w->strings, &w->out);
        end_chunk(w);
    }
}

static void write_graphs(writer *w)
{
    for (uint32_t i = 0; w->clips->extras.graphs && i < w->clips->extras.graphs->count; i++) {
        begin_chunk(w, NOH_CHUNK_GRAPH, w->clips->extras.graphs->graphs[i]->name);
        pack_graph(w->clips->extras.graphs->graphs[i], &w->strings, &w->out);
        end_chunk(w);
    }
}

static void write_recipe(writer *w)
{
    const recipe_text *recipe = w->clips->extras.recipe;
    noh_recipe_header h;
    if (!recipe || !recipe->count) return;
    memset(&h, 0, sizeof h);
    h.row_count = recipe->count;
    h.rows_offset = sizeof h;
    begin_chunk(w, NOH_CHUNK_RECIPE, "");
    buffer_append(&w->out, &h, sizeof h);
    for (uint32_t i = 0; i < recipe->count; i++) {
        noh_recipe_row row;
        memset(&row, 0, sizeof row);
        row.target = string_offset(&w->strings, recipe->rows[i].target);
        row.target_hash = noh_hash_name(recipe->rows[i].target);
        row.channel = string_offset(&w->strings, recipe->rows[i].channel);
        row.channel_hash = noh_hash_name(recipe->rows[i].channel);
        row.weight = recipe->rows[i].weight;
        buffer_append(&w->out, &row, sizeof row);
    }
    end_chunk(w);
}

static void write_ragdoll(writer *w)
{
    const ragdoll_text *ragdoll = w->clips->extras.ragdoll;
    noh_pack_ragdoll_header h;
    if (!ragdoll) return;
    memset(&h, 0, sizeof h);
    h.row_count = ragdoll->count;
    h.rows_offset = sizeof h;
    begin_chunk(w, NOH_CHUNK_RAGDOLL, "");
    buffer_append(&w->out, &h, sizeof h);
    for (uint32_t i = 0; i < ragdoll->count; i++) {
        const ragdoll_line *from = &ragdoll->rows[i];
        noh_pack_ragdoll_row row;
        memset(&row, 0, sizeof row);
        name_of(&w->strings, from->joint, &row.joint, &row.joint_hash);
        row.hinge = from->hinge;
        row.toward = from->toward;
        row.bend_min = from->bend_min;
        row.bend_max = from->bend_max;
        row.side = from->side;
        row.twist = from->twist;
        row.friction = from->friction;
        buffer_append(&w->out, &row, sizeof row);
    }
    end_chunk(w);
}

static void write_springs(writer *w)
{
    for (uint32_t i = 0; w->clips->extras.springs && i < w->clips->set_count; i++) {
        const set_springs *s = &w->clips->extras.springs[i];
        noh_springs_header h;
        if (!s->row_count) continue;
        memset(&h, 0, sizeof h);
        h.skeleton = i;
        h.joint_count = w->clips->sets[i]->skeleton.joint_count;
        h.row_count = s->row_count;
        h.rows_offset = sizeof h;
        h.chain_count = s->chain_count;
        h.chains_offset = (h.rows_offset + h.row_count * (uint32_t)sizeof *s->rows + 15u) & ~15u;
        h.collider_count = s->collider_count;
        h.colliders_offset = (h.chains_offset + h.chain_count * (uint32_t)sizeof *s->chains + 15u) & ~15u;
        begin_chunk(w, NOH_CHUNK_SPRINGS, w->clips->sets[i]->skeleton.name);
        buffer_append(&w->out, &h, sizeof h);
        buffer_append(&w->out, s->rows, s->row_count * sizeof *s->rows);
        buffer_align(&w->out, 16);
        buffer_append(&w->out, s->chains, s->chain_count * sizeof *s->chains);
        buffer_align(&w->out, 16);
        buffer_append(&w->out, s->colliders, s->collider_count * sizeof *s->colliders);
        end_chunk(w);
    }
}

/* sRGB to linear. */
static float linear(float c)
{
    return c <= 0.04045f ? c / 12.92f : powf((c + 0.055f) / 1.055f, 2.4f);
}

/* All but the name and the offsets. */
static void hair_header(const hair_text *t, const hair_grown *g, noh_pack_hair_header *h)
{
    memset(h, 0, sizeof *h);
    h->hair_count = g->hair_count;
    h->point_count = g->point_count;
    h->patch_count = g->patch_count;
    h->sphere_count = g->sphere_count;
    h->strip_count = (uint32_t)t->strips;
    h->segment_count = (uint32_t)t->segments;
    h->seed = (uint32_t)t->seed;
    h->pull = t->pull[0];
    h->pull_at_tip = t->pull[1];
    h->damping = t->damping;
    h->gravity = t->gravity;
    h->width_root = t->width[0];
    h->width_tip = t->width[1];
    h->curl_radius = t->curl[0] < 1.0f ? t->curl[0] : 1.0f;
    h->curl_turns = t->curl[1];
    h->scatter = t->scatter;
    h->gloss = t->gloss;
    memcpy(h->middle, t->skull, sizeof h->middle);
    for (int i = 0; i < 3; i++) {
        h->color_root[i] = linear(t->root[i]);
        h->color_tip[i] = linear(t->tip[i]);
    }
}

static void write_hair(writer *w)
{
    const hair_text *t = w->clips->extras.hair;
    const hair_grown *g = w->clips->extras.grown;
    noh_pack_hair_header h;
    if (!t) return;
    hair_header(t, g, &h);
    h.metres = w->clips->set_count ? (float)(w->clips->sets[0]->skeleton.unit_cm / 100.0) : 1.0f;
    name_of(&w->strings, t->joint ? t->joint : "", &h.joint, &h.joint_hash);
    begin_chunk(w, NOH_CHUNK_HAIR, "");
    const size_t start = w->out.count;
    buffer_append(&w->out, &h, sizeof h);
    h.points_offset = (uint32_t)(w->out.count - start);
    buffer_append(&w->out, g->points, (size_t)g->hair_count * g->point_count * 12u);
    buffer_align(&w->out, 16);
    h.patches_offset = (uint32_t)(w->out.count - start);
    buffer_append(&w->out, g->patches, (size_t)g->patch_count * sizeof *g->patches);
    h.spheres_offset = (uint32_t)(w->out.count - start);
    buffer_append(&w->out, g->spheres, (size_t)g->sphere_count * sizeof *g->spheres);
    if (!w->out.failed) memcpy(w->out.bytes + start, &h, sizeof h);
    end_chunk(w);
}

static void write_terrain(writer *w)
{
    const terrain *t = w->clips->extras.ground;
    noh_pack_terrain_header h;
    if (!t) return;
    memset(&h, 0, sizeof h);
    h.width = t->width;
    h.depth = t->depth;
    memcpy(h.origin, t->origin, sizeof h.origin);
    h.spacing = t->spacing;
    h.scale = t->scale;
    h.heights_offset = sizeof h;
    begin_chunk(w, NOH_CHUNK_TERRAIN, "");
    buffer_append(&w->out, &h, sizeof h);
    buffer_append(&w->out, t->heights, sizeof *t->heights * t->width * t->depth);
    end_chunk(w);
}

/* The strings are complete only now, but their chunk is the first: put it between the table and the other chunks. */
static int assemble(writer *w, byte_buffer *out)
{
    noh_pack_header h;
    size_t table = sizeof h + sizeof *w->chunks * w->chunk_count, content;
    noh_pack_chunk *s = &w->chunks[0];
    memset(&h, 0, sizeof h);
    buffer_append(out, &h, sizeof h);
    buffer_append(out, w->chunks, sizeof *w->chunks * w->chunk_count);
    buffer_align(out, NOH_PACK_ALIGN);
    s->offset = (uint32_t)out->count;
    s->bytes = (uint32_t)w->strings.bytes.count;
    s->crc = noh_crc32c(0, w->strings.bytes.bytes, w->strings.bytes.count);
    buffer_append(out, w->strings.bytes.bytes, w->strings.bytes.count);
    buffer_align(out, NOH_PACK_ALIGN);
    content = out->count;
    for (uint32_t i = 1; i < w->chunk_count; i++) {
        w->chunks[i].offset += (uint32_t)content;
    }
    buffer_append(out, w->out.bytes ? w->out.bytes : (const uint8_t *)"", w->out.count);
    buffer_align(out, NOH_PACK_ALIGN);
    if (out->failed || out->count > NOH_PACK_BYTES_MAX) {
        return 1;
    }
    h.magic = NOH_PACK_MAGIC;
    h.version = NOH_PACK_VERSION;
    h.library_version = noh_version_number();
    h.byte_count = (uint32_t)out->count;
    h.chunk_count = w->chunk_count;
    memcpy(out->bytes + sizeof h, w->chunks, table - sizeof h);
    h.crc = noh_crc32c(noh_crc32c(0, &h, sizeof h), w->chunks, table - sizeof h);
    memcpy(out->bytes, &h, sizeof h);
    return 0;
}

static size_t chunk_capacity(const model *m, const encoded_clips *made)
{
    size_t lists = 0;
    for (uint32_t i = 0; i < m->mesh_count; i++) lists += m->meshes[i].influence_max > NOH_INFLUENCES_MAX;
    return lists + 2 * (size_t)m->mesh_count + m->texture_count + m->skin_count + 7 +
           (made ? 2 * (size_t)made->set_count + made->clip_count +
                       (made->extras.graphs ? made->extras.graphs->count : 0)
                 : 0);
}

int pack_write(const model *m, const mesh_levels *levels, morph_encoding *const *encodings, const encoded_clips *made,
               byte_buffer *out, model_error *error)
{
    writer w;
    int failed;
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        if (pack_check_encoding(&m->meshes[i], encodings[i], error)) {
            return 1;
        }
    }
    if (chunk_capacity(m, made) > NOH_PACK_CHUNKS_MAX) {
        snprintf(error->what, sizeof error->what,
                 "more than %u meshes, textures, skeletons, clips and graphs: split them into several packs",
                 NOH_PACK_CHUNKS_MAX);
        error->where[0] = 0;
        return 1;
    }
    memset(&w, 0, sizeof w);
    w.m = m;
    w.levels = levels;
    w.clips = made;
    w.error = error;
    w.chunks = calloc(chunk_capacity(m, made), sizeof *w.chunks);
    w.skin_chunks = calloc(m->skin_count + 1u, sizeof *w.skin_chunks);
    w.extras = calloc(m->mesh_count + 1u, sizeof *w.extras);
    string_offset(&w.strings, "");
    if (w.chunks && w.skin_chunks && w.extras) {
        begin_chunk(&w, NOH_CHUNK_STRINGS, "");
        w.chunk_count = 1; /* the strings, filled in by assemble */
        write_content(&w, encodings);
        if (made) {
            write_clips(&w);
            write_graphs(&w);
            write_recipe(&w);
            write_ragdoll(&w);
            write_springs(&w);
            write_hair(&w);
            write_terrain(&w);
        }
    }
    failed = w.refused || !w.chunks || !w.skin_chunks || !w.extras || w.out.failed || w.strings.bytes.failed ||
             assemble(&w, out);
    if (failed && !w.refused) {
        snprintf(error->what, sizeof error->what, "out of memory, or the pack would be over %u bytes",
                 NOH_PACK_BYTES_MAX);
        error->where[0] = 0;
        buffer_free(out);
    }
    buffer_free(&w.out);
    buffer_free(&w.strings.bytes);
    free(w.chunks);
    free(w.skin_chunks);
    for (uint32_t i = 0; w.extras && i < m->mesh_count; i++) buffer_free(&w.extras[i].influences);
    free(w.extras);
    return failed;
}
