#include "convert/chunks/chunk_maker.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "convert/model/tint.h"
#include "pack_clips.h"
#include "pack_mesh.h"
#include "pack_skin.h"
#include "texture_levels.h"

const chunk_maker *chunk_maker_of(noh_chunk_type type)
{
#define MAKER(NAME, name, tag, many) &chunk_##name,
    static const chunk_maker *const makers[NOH_CHUNK_TYPES] = { NOH_CHUNKS(MAKER) };
#undef MAKER
    return makers[type];
}

void chunk_name(pack_writer *w, const char *text, uint32_t *name, uint32_t *hash)
{
    *name = string_offset(&w->strings, text ? text : "");
    *hash = string_hash(text ? text : "");
}

void chunk_begin(pack_writer *w, noh_chunk_type type, const char *name)
{
#define TAG(NAME, lower, tag, many) NOH_TAG_##NAME,
    static const uint32_t tags[NOH_CHUNK_TYPES] = { NOH_CHUNKS(TAG) };
#undef TAG
    if (w->chunk_count == NOH_PACK_CHUNKS_MAX) {
        w->refused = model_fail(w->error, "",
                                "more than %u meshes, textures, skeletons, clips and graphs: split them into several "
                                "packs",
                                NOH_PACK_CHUNKS_MAX);
        w->chunk_count--;
    }
    noh_pack_chunk *c = &w->chunks[w->chunk_count];
    buffer_align(&w->out, NOH_PACK_ALIGN);
    memset(c, 0, sizeof *c);
    c->type = tags[type];
    chunk_name(w, name, &c->name, &c->name_hash);
    c->offset = (uint32_t)w->out.count;
}

void chunk_end(pack_writer *w)
{
    noh_pack_chunk *c = &w->chunks[w->chunk_count++];
    c->bytes = (uint32_t)(w->out.count - c->offset);
    c->crc = w->out.failed ? 0 : noh_crc32c(0, w->out.bytes + c->offset, c->bytes);
}

/* Filled in by assemble. */
static void write_strings(pack_writer *w, const void *made)
{
    (void)made;
    chunk_begin(w, NOH_CHUNK_STRINGS, "");
    w->chunk_count++;
}

const chunk_maker chunk_strings = { .write = write_strings };

static uint32_t wrap_mode(uint32_t gltf)
{
    return gltf == 33071 ? NOH_WRAP_CLAMP : gltf == 33648 ? NOH_WRAP_MIRROR : NOH_WRAP_REPEAT;
}

static void write_texture(pack_writer *w, const model_texture *t)
{
    noh_texture_header h;
    size_t base;
    chunk_begin(w, NOH_CHUNK_TEXTURE, t->name);
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
        if (t->blocks == MODEL_BLOCKS_ASTC && !w->refused) {
            w->refused = model_fail(
                w->error, t->name,
                "astcenc failed, or memory ran out: make room in the temporary folder ($TMPDIR), or "
                "build with --textures etc2");
        }
    } else {
        memcpy(w->out.bytes + base, &h, sizeof h);
    }
    chunk_end(w);
}

static void write_textures(pack_writer *w, const void *made)
{
    (void)made;
    for (uint32_t i = 0; i < w->m->texture_count; i++) write_texture(w, &w->m->textures[i]);
}

const chunk_maker chunk_texture = { .write = write_textures };

static uint32_t material_flags(const model_material *m)
{
    return (m->alpha == MODEL_ALPHA_BLEND ? NOH_MATERIAL_BLEND : 0u) |
           (m->alpha == MODEL_ALPHA_MASK ? NOH_MATERIAL_MASK : 0u) |
           (m->double_sided ? NOH_MATERIAL_DOUBLE_SIDED : 0u) | (m->unlit ? NOH_MATERIAL_UNLIT : 0u) |
           (m->specular_texture == MODEL_NONE ? 0u
            : m->specular_roughness           ? NOH_MATERIAL_SPECULAR_ROUGHNESS
                                              : NOH_MATERIAL_SPECULAR_WEIGHT) |
           (tint_is_taken(m) ? 0u : NOH_MATERIAL_UNTINTED) | (m->wrinkle_codes ? NOH_MATERIAL_WRINKLE_CODES : 0u) |
           (m->surface == NOH_SURFACE_TOON && m->toon_shade ? NOH_MATERIAL_TOON_SHADE : 0u) |
           (m->surface == NOH_SURFACE_TOON && m->outline_lit ? NOH_MATERIAL_OUTLINE_LIT : 0u) |
           (m->surface == NOH_SURFACE_TOON && m->toon_masks ? NOH_MATERIAL_TOON_MASKS : 0u);
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
    memcpy(to->more_textures, from->more_textures, sizeof to->more_textures);
    to->surface = from->surface;
    memcpy(to->surface_values, from->surface_values, sizeof to->surface_values);
    memcpy(to->surface_more, from->surface_more, sizeof to->surface_more);
}

static void write_materials(pack_writer *w, const void *made)
{
    (void)made;
    if (!w->m->material_count) return;
    chunk_begin(w, NOH_CHUNK_MATERIALS, "");
    for (uint32_t i = 0; i < w->m->material_count; i++) {
        const model_material *from = &w->m->materials[i];
        noh_material to;
        memset(&to, 0, sizeof to);
        chunk_name(w, from->name, &to.name, &to.name_hash);
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
    chunk_end(w);
}

const chunk_maker chunk_materials = { .write = write_materials };

static void write_mesh(pack_writer *w, uint32_t index, const morph_encoding *e)
{
    static const mesh_levels alone = { .count = 1 };
    const model_mesh *mesh = &w->m->meshes[index];
    uint8_t blends[NOH_SUBMESHES_MAX];
    extra_plan extras;
    const mesh_input from = { mesh,
                              w->levels ? &w->levels[index] : &alone,
                              e,
                              blends,
                              model_mesh_scale(w->m, index),
                              mesh->bound ? w->skin_chunks[mesh->skin] : NOH_NONE,
                              mesh->bound ? w->m->skins[mesh->skin].joint_count : 0,
                              &extras };
    extras_plan(w->m, mesh, &extras);
    for (uint32_t s = 0; s < mesh->submesh_count; s++) {
        uint32_t material = mesh->submeshes[s].material;
        blends[s] = material != MODEL_NONE && w->m->materials[material].alpha == MODEL_ALPHA_BLEND;
    }
    w->extras[index].index = index;
    chunk_begin(w, NOH_CHUNK_MESH, mesh->name);
    w->refused = w->refused || pack_mesh(&from, &w->strings, &w->out, &w->extras[index], w->error);
    chunk_end(w);
}

static void write_meshes(pack_writer *w, const void *made)
{
    (void)made;
    for (uint32_t i = 0; i < w->m->mesh_count; i++) write_mesh(w, i, w->encodings[i]);
}

const chunk_maker chunk_mesh = { .write = write_meshes };

/* Added to the finished pack: light/pack_transfer.c. */
const chunk_maker chunk_transfer = { .write = NULL };

/* A skinned mesh is placed by its joints, whose model space is the world. */
static void set_world(const pack_writer *w, const model_node *from, noh_node *to)
{
    int skinned = from->mesh != MODEL_NONE && w->m->meshes[from->mesh].bound;
    for (int i = 0; i < 12; i++) {
        to->world[i] = skinned ? (i % 5 == 0 ? 1.0f : 0.0f) : (float)from->world[4 * (i % 4) + i / 4];
    }
}

static void write_node(pack_writer *w, const model_node *from, uint32_t *weight_count)
{
    noh_node to;
    memset(&to, 0, sizeof to);
    chunk_name(w, from->name, &to.name, &to.name_hash);
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

static void write_nodes(pack_writer *w, const void *made)
{
    (void)made;
    if (!w->m->node_count) return;
    noh_nodes_header h = { w->m->node_count, 0, sizeof h, 0 };
    size_t base;
    chunk_begin(w, NOH_CHUNK_NODES, "");
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
    chunk_end(w);
}

const chunk_maker chunk_nodes = { .write = write_nodes };

/* The n-th skeleton chunk of a set; sets without joints have none. */
static uint32_t skeleton_chunk(const encoded_clips *made, uint32_t set)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < set; i++) {
        n += made->sets[i]->skeleton.joint_count > 0;
    }
    return n;
}

static void write_skeletons(pack_writer *w, const void *made)
{
    (void)made;
    for (uint32_t i = 0; w->clips && i < w->clips->set_count; i++) {
        if (!w->clips->sets[i]->skeleton.joint_count) {
            continue; /* clips of weights alone */
        }
        chunk_begin(w, NOH_CHUNK_SKELETON, w->clips->sets[i]->skeleton.name);
        pack_skeleton(&w->clips->sets[i]->skeleton, &w->strings, &w->out);
        chunk_end(w);
    }
}

const chunk_maker chunk_skeleton = { .write = write_skeletons };

/* Only skins that move a mesh. */
static void write_skins(pack_writer *w, const void *made)
{
    (void)made;
    if (!w->clips) return;
    uint32_t count = 0;
    for (uint32_t s = 0; s < w->m->skin_count; s++) {
        int used = 0;
        for (uint32_t i = 0; i < w->m->mesh_count; i++) {
            used |= w->m->meshes[i].bound && w->m->meshes[i].skin == s;
        }
        w->skin_chunks[s] = used ? count++ : NOH_NONE;
        if (used) {
            chunk_begin(w, NOH_CHUNK_SKIN, w->m->skins[s].name);
            pack_skin(&w->m->skins[s], skeleton_chunk(w->clips, w->m->skins[s].set), &w->out);
            chunk_end(w);
        }
    }
}

const chunk_maker chunk_skin = { .write = write_skins };

static void write_list(pack_writer *w, uint32_t index)
{
    const byte_buffer *list = &w->extras[index].influences;
    w->out.failed |= list->failed;
    if (!list->count) return;
    chunk_begin(w, NOH_CHUNK_INFLUENCES, w->m->meshes[index].name);
    buffer_append(&w->out, list->bytes, list->count);
    chunk_end(w);
}

static void write_regions(pack_writer *w, uint32_t index)
{
    const model_mesh *mesh = &w->m->meshes[index];
    const size_t matrix_bytes = (size_t)mesh->target_count * NOH_WRINKLE_FOLDS;
    noh_wrinkles_header h;
    memset(&h, 0, sizeof h);
    h.mesh = index;
    h.target_count = mesh->target_count;
    h.matrix_offset = sizeof h;
    if (mesh->colors) {
        h.colors_offset = (uint32_t)(sizeof h + (matrix_bytes + 15u) / 16u * 16u);
        h.color_material = mesh->color_material;
        h.color_texture = w->m->materials[mesh->color_material].color_texture;
    }
    chunk_begin(w, NOH_CHUNK_WRINKLES, mesh->name);
    buffer_append(&w->out, &h, sizeof h);
    buffer_append(&w->out, mesh->wrinkles, matrix_bytes); /* NULL: zeros */
    if (mesh->colors) {
        buffer_align(&w->out, 16);
        buffer_append(&w->out, mesh->colors, 4u * (NOH_WRINKLE_COLORS + (size_t)mesh->target_count));
    }
    chunk_end(w);
}

static void write_influences(pack_writer *w, const void *made)
{
    (void)made;
    for (uint32_t i = 0; i < w->m->mesh_count; i++) write_list(w, i);
}

const chunk_maker chunk_influences = { .write = write_influences };

static uint32_t motion_word(const int16_t *motion)
{
    uint32_t word = 0;
    for (uint32_t k = 0; k < 3u; k++) word |= ((uint32_t)motion[k] & 0x3ffu) << 10u * k;
    return word;
}

static void write_joints_of(pack_writer *w, uint32_t index, const lod_joints *joints)
{
    const joint_fit *f = &joints->fit;
    noh_far_joints_header h;
    size_t base;
    memset(&h, 0, sizeof h);
    h.mesh = index;
    h.level = joints->level;
    h.joint_count = f->joint_count;
    h.target_count = f->target_count;
    h.first_joint = joints->first_joint;
    h.normal_error = joints->normal_most;
    h.normal_error_p99 = joints->normal_p99;
    h.centres_offset = sizeof h;
    chunk_begin(w, NOH_CHUNK_FAR_JOINTS, w->m->meshes[index].name);
    base = w->out.count;
    buffer_append(&w->out, &h, sizeof h);
    buffer_append(&w->out, f->centre, 12u * (size_t)f->joint_count);
    buffer_align(&w->out, 16);
    h.scales_offset = (uint32_t)(w->out.count - base);
    buffer_append(&w->out, f->scale, 8u * (size_t)f->joint_count);
    buffer_align(&w->out, 16);
    h.motions_offset = (uint32_t)(w->out.count - base);
    for (size_t i = 0; i < f->joint_count * (size_t)f->target_count; i++) {
        const size_t at = 6u * (i % f->joint_count * f->target_count + i / f->joint_count);
        const uint32_t words[2] = { motion_word(f->motion + at), motion_word(f->motion + at + 3u) };
        buffer_append(&w->out, words, sizeof words);
    }
    if (!w->out.failed) memcpy(w->out.bytes + base, &h, sizeof h);
    chunk_end(w);
}

static void write_far_joints(pack_writer *w, const void *made)
{
    (void)made;
    for (uint32_t i = 0; w->levels && i < w->m->mesh_count; i++) {
        if (w->levels[i].joints.level) write_joints_of(w, i, &w->levels[i].joints);
    }
}

const chunk_maker chunk_far_joints = { .write = write_far_joints };

static void write_wrinkles(pack_writer *w, const void *made)
{
    (void)made;
    for (uint32_t i = 0; i < w->m->mesh_count; i++) {
        if (w->m->meshes[i].wrinkles || w->m->meshes[i].colors) write_regions(w, i);
    }
}

const chunk_maker chunk_wrinkles = { .write = write_wrinkles };

static void write_clips(pack_writer *w, const void *made)
{
    (void)made;
    for (uint32_t i = 0; w->clips && i < w->clips->clip_count; i++) {
        chunk_begin(w, NOH_CHUNK_CLIP, w->clips->clips[i].raw->name);
        pack_clip(w->clips, &w->clips->clips[i], &w->strings, &w->out);
        chunk_end(w);
    }
}

const chunk_maker chunk_clip = { .write = write_clips };

/* The strings are complete only now, but their chunk is the first: put it between the table and the other chunks. */
static int assemble(pack_writer *w, byte_buffer *out)
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

/* Types in the order of the list. */
static void write_chunks(pack_writer *w)
{
    for (int type = 0; type < NOH_CHUNK_TYPES; type++) {
        const chunk_maker *maker = chunk_maker_of((noh_chunk_type)type);
        if (maker->write) maker->write(w, w->clips && w->clips->chunks ? w->clips->chunks[type] : NULL);
    }
}

int pack_fail_size(size_t bytes, model_error *error)
{
    if (bytes <= NOH_PACK_BYTES_MAX) return model_fail_memory(error);
    return model_fail(
        error, "",
        "the pack would be %zu bytes, and the limit is %u: build parts of it as packs of their own (--only), "
        "or use --texture-max",
        bytes, NOH_PACK_BYTES_MAX);
}

int pack_write(const model *m, const mesh_levels *levels, morph_encoding *const *encodings, const encoded_clips *made,
               byte_buffer *out, model_error *error)
{
    pack_writer w;
    int failed;
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        if (pack_check_encoding(&m->meshes[i], encodings[i], error)) {
            return 1;
        }
    }
    memset(&w, 0, sizeof w);
    w.m = m;
    w.levels = levels;
    w.encodings = encodings;
    w.clips = made;
    w.error = error;
    w.chunks = calloc(NOH_PACK_CHUNKS_MAX, sizeof *w.chunks);
    w.skin_chunks = calloc(m->skin_count + 1u, sizeof *w.skin_chunks);
    w.extras = calloc(m->mesh_count + 1u, sizeof *w.extras);
    string_offset(&w.strings, "");
    if (w.chunks && w.skin_chunks && w.extras) {
        write_chunks(&w);
    }
    failed = w.refused || !w.chunks || !w.skin_chunks || !w.extras || w.out.failed || w.strings.bytes.failed ||
             assemble(&w, out);
    if (failed && !w.refused) {
        (void)pack_fail_size(w.out.count > out->count ? w.out.count : out->count, error);
        buffer_free(out);
    }
    buffer_free(&w.out);
    string_table_free(&w.strings);
    free(w.chunks);
    free(w.skin_chunks);
    for (uint32_t i = 0; w.extras && i < m->mesh_count; i++) buffer_free(&w.extras[i].influences);
    free(w.extras);
    return failed;
}
