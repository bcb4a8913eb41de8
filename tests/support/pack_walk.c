#include "pack_walk.h"

#include <stdlib.h>
#include <string.h>

#include "deform/morph/morph_internal.h"
#include "motion/graph/graph_internal.h"
#include "motion/graph/graph_pack_internal.h"
#include "motion/match/match_internal.h"
#include "stage/modules/springs_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/deform.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/graph.h"
#include "noh/light.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"
#include "noh/low_life.h"
#include "noh/low_motion.h"
#include "noh/low_stage.h"
#include "noh/modules.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"

#define NAMES_LOOKED_UP 64u /* looking up names takes targets squared: enough to see every kind */

noh_pack_chunk *pack_find(uint8_t *bytes, uint32_t tag)
{
    const noh_pack_header *header = (const noh_pack_header *)(const void *)bytes;
    noh_pack_chunk *chunks = (noh_pack_chunk *)(void *)(bytes + sizeof *header);
    for (uint32_t i = 0; i < header->chunk_count; i++) {
        if (chunks[i].type == tag) return &chunks[i];
    }
    return NULL;
}

void pack_repair(uint8_t *bytes, size_t count)
{
    noh_pack_header header;
    if (count < sizeof header) {
        return;
    }
    memcpy(&header, bytes, sizeof header);
    if (header.chunk_count > (count - sizeof header) / sizeof(noh_pack_chunk)) {
        return;
    }
    for (uint32_t i = 0; i < header.chunk_count; i++) {
        uint8_t *at = bytes + sizeof header + i * sizeof(noh_pack_chunk);
        noh_pack_chunk chunk;
        memcpy(&chunk, at, sizeof chunk);
        if (chunk.offset <= count && chunk.bytes <= count - chunk.offset) {
            chunk.crc = noh_crc32c(0, bytes + chunk.offset, chunk.bytes);
            memcpy(at, &chunk, sizeof chunk);
        }
    }
    header.crc = 0;
    header.crc = noh_crc32c(noh_crc32c(0, &header, sizeof header), bytes + sizeof header,
                            header.chunk_count * sizeof(noh_pack_chunk));
    memcpy(bytes, &header, sizeof header);
}

typedef struct walk {
    const noh_pack *pack;
    uint32_t random, hash;
} walk;

static void eat(walk *w, const void *bytes, size_t count)
{
    w->hash = noh_crc32c(w->hash, bytes, count);
}

static void eat_name(walk *w, const char *name)
{
    eat(w, name, strlen(name));
}

static float weight(walk *w)
{
    w->random = w->random * 1664525u + 1013904223u;
    return (w->random >> 30) == 0u ? 0.0f : (float)(w->random >> 8) / 4194304.0f - 1.5f;
}

static void *memory(size_t bytes)
{
    void *p = malloc(bytes ? bytes : 1);
    if (!p) {
        abort();
    }
    return p;
}

static void walk_names(walk *w)
{
    for (uint32_t i = 0; i < w->pack->chunk_count; i++) {
        eat_name(w, noh_pack_chunk_name(w->pack, i));
    }
    for (uint32_t i = 0; i < w->pack->string_bytes; i++) {
        eat_name(w, noh_pack_string(w->pack, i));
    }
    eat_name(w, noh_pack_string(w->pack, w->pack->string_bytes));
    eat_name(w, noh_pack_string(w->pack, 0xffffffffu));
}

static void walk_textures(walk *w)
{
    noh_texture t;
    for (uint32_t i = 0; noh_pack_texture_at(w->pack, i, &t, NULL) == NOH_OK; i++) {
        eat_name(w, t.name);
        for (uint32_t level = 0; level < t.header->level_count; level++) {
            const noh_texture_level at = noh_texture_level_at(&t, level);
            eat(w, at.pixels, at.bytes);
        }
    }
    for (uint32_t i = 0; i < w->pack->material_count; i++) {
        const noh_material *m = &w->pack->materials[i];
        const uint32_t textures[] = {
            m->base_color_texture, m->normal_texture,   m->surface_texture,
            m->emissive_texture,   m->wrinkle_texture,  m->more_textures[0],
            m->more_textures[1],   m->more_textures[2], m->flags & 192u ? m->specular_texture : NOH_NONE
        };
        eat_name(w, noh_pack_string(w->pack, m->name));
        for (int k = 0; k < 9; k++) {
            if (textures[k] != NOH_NONE && noh_pack_texture_at(w->pack, textures[k], &t, NULL) != NOH_OK) {
                abort(); /* the checker guarantees it */
            }
        }
    }
}

/* The stage may refuse what the checker lets through, such as bones too short for it; never more. */
static void walk_springs(walk *w)
{
    for (uint32_t i = 0; i < w->pack->runs[NOH_CHUNK_SKELETON].count; i++) {
        noh_springs_desc desc;
        noh_springs *springs;
        size_t state_bytes, scratch_bytes, bytes;
        void *block;
        if (!noh_springs_of_pack(w->pack, i, &desc)) continue;
        bytes = noh_springs_size(&desc);
        block = memory(bytes);
        noh_springs_measure(&desc, &state_bytes, &scratch_bytes);
        eat(w, &state_bytes, sizeof state_bytes);
        if (!bytes) abort(); /* counts are checked */
        if (noh_springs_init(block, bytes, &desc, &springs, NULL) == NOH_OK &&
            noh_springs_modifier(springs).state_bytes != state_bytes)
            abort();
        free(block);
    }
}

static void walk_nodes(walk *w)
{
    for (uint32_t i = 0; i < w->pack->node_count; i++) {
        const noh_node *n = &w->pack->nodes[i];
        noh_mesh mesh;
        uint32_t steps = 0;
        eat_name(w, noh_pack_string(w->pack, n->name));
        for (uint32_t p = n->parent; p != NOH_NONE && steps <= i; steps++) {
            p = w->pack->nodes[p].parent;
        }
        if (steps > i || (n->mesh != NOH_NONE && noh_pack_mesh_at(w->pack, n->mesh, &mesh, NULL) != NOH_OK)) {
            abort();
        }
        if (n->first_weight != NOH_NONE) {
            eat(w, w->pack->node_weights + n->first_weight, 4u * (size_t)mesh.header->target_count);
        }
    }
}

static void walk_vertices(walk *w, const noh_mesh *mesh)
{
    for (uint32_t v = 0; v < mesh->header->vertex_count; v++) {
        noh_vertex vertex;
        noh_mesh_vertex(mesh, v, &vertex);
        eat(w, &vertex, sizeof vertex);
    }
    for (uint32_t s = 0; s < mesh->header->submesh_count; s++) {
        const noh_submesh *sub = &mesh->submeshes[s];
        for (uint32_t i = 0; i < sub->index_count; i++) {
            uint32_t index = noh_mesh_index(mesh, sub->first_index + i);
            eat(w, mesh->positions + 3u * (size_t)index, 12);
        }
        if (sub->vertex_count) {
            eat(w, mesh->positions + 3u * ((size_t)sub->first_vertex + sub->vertex_count - 1u), 12);
        }
    }
    for (uint32_t i = 0; i < mesh->header->index_count; i++) {
        eat(w, mesh->positions + 3u * (size_t)noh_mesh_index(mesh, i), 12);
    }
}

static void walk_targets(walk *w, const noh_mesh *mesh)
{
    eat(w, mesh->texels, 12u * (size_t)mesh->header->texel_count);
    eat(w, mesh->target_boxes, 24u * (size_t)mesh->header->target_count);
    for (uint32_t t = 0; t < mesh->header->target_count; t++) {
        const char *name = noh_pack_string(mesh->pack, mesh->targets[t].name);
        eat(w, mesh->rects + mesh->targets[t].first_rect, sizeof(noh_rect) * mesh->targets[t].rect_count);
        if (t < NAMES_LOOKED_UP && noh_mesh_find_target(mesh, name) > t) {
            abort(); /* a target that has a name is found by it, or an earlier one of the same name */
        }
    }
}

static void walk_influences(walk *w, const noh_mesh *mesh)
{
    noh_skin skin;
    if (noh_pack_skin_at(mesh->pack, mesh->header->skin, &skin, NULL) != NOH_OK) {
        return;
    }
    eat(w, mesh->joint_boxes, 24u * (size_t)skin.header->joint_count);
    for (uint32_t v = 0; v < mesh->header->vertex_count; v++) {
        uint32_t joints[NOH_INFLUENCES_MAX], count;
        float weights[NOH_INFLUENCES_MAX];
        count = noh_mesh_influences(mesh, v, joints, weights);
        for (uint32_t i = 0; i < count; i++) {
            eat(w, skin.inverse_bind + 12u * (size_t)joints[i], 48);
            eat(w, &skin.joints[joints[i]], sizeof *skin.joints);
        }
        eat(w, weights, sizeof *weights * count);
    }
}

static void walk_far_joints(walk *w, const noh_mesh *mesh, const noh_skin *skin)
{
    const size_t bytes = 48u * (size_t)skin->header->joint_count;
    float *matrices = memory(bytes), *weights = memory(4u * (size_t)mesh->header->target_count);
    memcpy(matrices, skin->inverse_bind, bytes);
    for (uint32_t t = 0; t < mesh->header->target_count; t++) weights[t] = (float)(t % 3u) - 0.5f;
    noh_mesh_move_far_joints(mesh, weights, matrices);
    eat(w, matrices, bytes);
    free(matrices);
    free(weights);
}

/* Skinned by the inverse bind matrices: any matrices will do, and these are at hand. */
static void walk_skinned(walk *w, const noh_mesh *mesh)
{
    const uint32_t count = mesh->header->vertex_count;
    noh_skin skin;
    float *positions, *normals, *tangents;
    if (noh_pack_skin_at(mesh->pack, mesh->header->skin, &skin, NULL) != NOH_OK) {
        return;
    }
    if (mesh->far_joints) walk_far_joints(w, mesh, &skin);
    positions = memory(12u * (size_t)count);
    normals = memory(12u * (size_t)count);
    tangents = memory(16u * (size_t)count);
    noh_skin_vertices(mesh, skin.inverse_bind, NULL, 0, count, positions, normals, tangents);
    eat(w, positions, 12u * (size_t)count);
    eat(w, normals, 12u * (size_t)count);
    eat(w, tangents, 16u * (size_t)count);
    free(positions);
    free(normals);
    free(tangents);
}

typedef void (*accumulate_function)(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers);

static void accumulate_rne(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers)
{
    noh_morph_accumulate_f16(mesh, weights, NOH_HALF_RNE, layers);
}

static void accumulate_rtz(const noh_mesh *mesh, const float *weights, const noh_morph_layers *layers)
{
    noh_morph_accumulate_f16(mesh, weights, NOH_HALF_RTZ, layers);
    noh_morph_round_f16(mesh, NOH_HALF_RTZ, layers);
}

static void walk_morph(walk *w, const noh_mesh *mesh, accumulate_function accumulate)
{
    size_t bytes = noh_morph_layers_size(mesh);
    float *weights = memory(4u * (size_t)mesh->header->target_count);
    void *block = memory(bytes);
    noh_morph_layers layers;
    noh_morph_cost cost;
    for (uint32_t t = 0; t < mesh->header->target_count; t++) {
        weights[t] = weight(w);
    }
    if (noh_morph_layers_init(block, bytes, mesh, &layers, NULL) != NOH_OK) {
        abort();
    }
    accumulate(mesh, weights, &layers);
    eat(w, block, bytes);
    for (uint32_t v = 0; v < mesh->header->vertex_count; v++) {
        noh_vertex vertex;
        noh_morph_vertex(mesh, &layers, v, &vertex);
        eat(w, &vertex, sizeof vertex);
    }
    cost = noh_morph_cost_of(mesh, weights);
    eat(w, &cost, sizeof cost);
    free(block);
    free(weights);
}

/* A GPU that can do everything: the plan of every path and format. */
static void walk_plans(walk *w, const noh_mesh *meshes, uint32_t count)
{
    noh_gl_caps caps;
    noh_gl_morph_desc desc;
    memset(&caps, 0, sizeof caps);
    memset(&desc, 0, sizeof desc);
    caps.texture_size_max = 4096;
    caps.mrt3 = caps.render_f32 = caps.render_f16 = caps.render_u32 = caps.blend_f32 = caps.blend_f16 = caps.layered =
        1;
    desc.meshes = meshes;
    desc.mesh_count = count;
    for (int i = 0; i < NOH_MORPH_PATH_COUNT * 2; i++) {
        noh_gl_morph_plan plan;
        desc.path = (noh_morph_path)(i / 2);
        desc.accumulate = i % 2 ? NOH_ACCUMULATE_F16 : NOH_ACCUMULATE_F32;
        if (noh_gl_morph_plan_make(&desc, &caps, &plan, NULL) == NOH_OK) {
            eat(w, &plan.gpu_bytes, sizeof plan.gpu_bytes);
        }
    }
}

static void walk_level(walk *w, const noh_mesh *level)
{
    static const accumulate_function ways[] = { noh_morph_accumulate, noh_morph_accumulate_scalar, accumulate_rne,
                                                accumulate_rtz };
    walk_vertices(w, level);
    walk_targets(w, level);
    walk_influences(w, level);
    walk_skinned(w, level);
    for (size_t k = 0; k < sizeof ways / sizeof ways[0]; k++) {
        walk_morph(w, level, ways[k]);
    }
}

static void walk_transfer(walk *w, const noh_mesh *mesh)
{
    const size_t bytes = 4u * ((size_t)mesh->header->morph_height << mesh->header->morph_width_log2);
    float *weights, *layer;
    noh_transfer transfer;
    noh_light light;
    if (noh_transfer_of(mesh, &transfer, NULL)) {
        return;
    }
    weights = memory(4u * (size_t)mesh->header->target_count);
    layer = memory(bytes);
    for (uint32_t t = 0; t < mesh->header->target_count; t++) {
        weights[t] = weight(w);
    }
    memset(layer, 0, bytes);
    noh_transfer_accumulate(mesh, weights, layer);
    noh_light_from_environment(noh_environment_at(1), NOH_SH_ORDER_MAX, &light);
    for (uint32_t v = 0; v < mesh->header->vertex_count; v++) {
        noh_vertex vertex;
        float rgb[3];
        noh_mesh_vertex(mesh, v, &vertex);
        noh_transfer_shade(mesh, &transfer, v, vertex.normal, layer, &light, rgb);
        eat(w, rgb, sizeof rgb);
    }
    free(weights);
    free(layer);
}

static void walk_meshes(walk *w)
{
    noh_mesh *meshes = memory(sizeof *meshes * w->pack->runs[NOH_CHUNK_MESH].count);
    for (uint32_t i = 0; i < w->pack->runs[NOH_CHUNK_MESH].count; i++) {
        if (noh_pack_mesh_at(w->pack, i, &meshes[i], NULL) != NOH_OK) {
            abort();
        }
        eat_name(w, meshes[i].name);
        for (uint32_t k = 0; k < meshes[i].header->level_count; k++) {
            const noh_mesh level = noh_mesh_at_lod(&meshes[i], k);
            walk_level(w, &level);
            walk_transfer(w, &level);
        }
    }
    if (w->pack->runs[NOH_CHUNK_MESH].count) {
        walk_plans(w, meshes, w->pack->runs[NOH_CHUNK_MESH].count);
    }
    free(meshes);
}

/* Heights and normals all over it and beyond. */
static void walk_terrain(walk *w)
{
    noh_field field;
    if (noh_terrain_of(w->pack, &field, NULL)) return;
    for (uint32_t i = 0; i < 64u; i++) {
        const float x = field.origin[0] + weight(w) * field.spacing * (float)field.width;
        const float z = field.origin[2] + weight(w) * field.spacing * (float)field.depth;
        float at[4];
        if (noh_field_height(&field, x, z, &at[0], at + 1)) eat(w, at, sizeof at);
    }
}

/* Search the table of motion matching, down its tree and through all rows. */
static void walk_match(walk *w)
{
    noh_match_table table;
    if (!noh_match_table_of(w->pack, &table)) return;
    for (uint32_t i = 0; i < table.header->tag_count; i++) eat_name(w, noh_pack_string(w->pack, table.tags[i].name));
    for (uint32_t i = 0; i < 16u; i++) {
        noh_match_hit hit = { INT32_MAX, NOH_NONE, 0 }, all = hit;
        int16_t query[NOH_MATCH_FEATURES];
        for (uint32_t k = 0; k < NOH_MATCH_FEATURES; k++) query[k] = noh_match_number(&table, k, weight(w) * 100.0f);
        noh_match_search(&table, query, i % 3u, &hit);
        noh_match_search_all(&table, query, i % 3u, &all);
        if (hit.row != all.row || hit.cost != all.cost) abort();
        if (hit.row != NOH_NONE)
            eat_name(w, noh_pack_string(w->pack, table.clips[noh_match_clip_of(&table, hit.row)].name));
    }
}

/* Play every clip for a while, in every loop mode, forwards and backwards, at random times. */
static void walk_clip(walk *w, noh_clip_bank *set, noh_controller *c, noh_pose_scratch *scratch, uint32_t clip)
{
    noh_transform *pose = memory(sizeof *pose * set->clips.joint_count);
    float *floats = memory(sizeof *floats * set->clips.float_count);
    for (uint32_t i = 0; i < 6; i++) {
        noh_track_desc track;
        memset(&track, 0, sizeof track);
        w->random = w->random * 1664525u + 1013904223u;
        track.clip = clip;
        track.loop = (noh_loop)(i % 3u + 1u);
        track.speed = i < 3 ? 3 * NOH_SPEED_ONE : -3 * NOH_SPEED_ONE;
        track.position_ticks = (int64_t)(w->random >> 4) % ((int64_t)set->clips.clips[clip].duration_ticks + 1);
        if (noh_controller_start(c, &set->clips, 0, &track, NULL) != NOH_OK) {
            abort();
        }
        noh_clip_cache_begin_frame(set->cache);
        noh_controller_step(c, &set->clips, 700, NULL, NULL);
        noh_clip_bank_prefetch(set, c, 4000);
        noh_clip_cache_work(set->cache, 100);
        noh_controller_pose(c, &set->clips, scratch, pose, floats);
        eat(w, pose, sizeof *pose * set->clips.joint_count);
        eat(w, floats, sizeof *floats * set->clips.float_count);
    }
    free(floats);
    free(pose);
}

static void walk_playing(walk *w, noh_clip_bank *set)
{
    noh_controller_desc desc;
    noh_controller *c = NULL;
    noh_pose_scratch scratch;
    size_t bytes, scratch_bytes = noh_pose_scratch_size(&set->clips, 0);
    void *block, *scratch_block = memory(scratch_bytes);
    memset(&desc, 0, sizeof desc);
    desc.set = &set->clips;
    desc.track_count = 1;
    bytes = noh_controller_size(&desc);
    block = memory(bytes);
    if (noh_controller_init(block, bytes, &desc, &c, NULL) != NOH_OK ||
        noh_pose_scratch_init(scratch_block, scratch_bytes, &set->clips, 0, &scratch, NULL) != NOH_OK) {
        abort();
    }
    for (uint32_t m = 0; m < set->clips.clip_count; m++) {
        walk_clip(w, set, c, &scratch, m);
    }
    free(block);
    free(scratch_block);
}

/* Every parameter at random, for some steps. */
static void walk_instance(walk *w, const noh_graph_pack *made, noh_graph_state *state, noh_graph_scratch *scratch)
{
    noh_transform *pose = memory(sizeof *pose * made->clips.joint_count);
    float *floats = memory(sizeof *floats * made->clips.float_count);
    for (uint32_t i = 0; i < 6; i++) {
        for (uint32_t p = 0; p < made->graph.param_count; p++) {
            if (noh_graph_pack_set_param(made, state, p, 4.0f * weight(w)) != NOH_OK) {
                abort();
            }
        }
        noh_graph_step(state, &made->graph, &made->clips, 1500, NULL, NULL);
        noh_graph_pose(state, &made->graph, &made->clips, scratch, pose, floats);
        eat(w, pose, sizeof *pose * made->clips.joint_count);
        eat(w, floats, sizeof *floats * made->clips.float_count);
    }
    for (uint32_t m = 0; m < made->graph.machine_count; m++) {
        eat_name(w, noh_graph_pack_state_name(made, m, noh_graph_machine_state(state, m)));
    }
    free(floats);
    free(pose);
}

static void walk_graph(walk *w, const noh_graph_pack_desc *desc)
{
    const size_t bytes = noh_graph_pack_size(desc, NULL);
    void *block = memory(bytes);
    noh_graph_pack *made = NULL;
    if (bytes && noh_graph_pack_init(block, bytes, desc, &made, NULL) == NOH_OK) {
        const size_t state_bytes = noh_graph_state_size(&made->graph, &made->clips),
                     scratch_bytes = noh_graph_scratch_size(&made->graph, &made->clips);
        void *state_block = memory(state_bytes), *scratch_block = memory(scratch_bytes);
        noh_graph_state *state = NULL;
        noh_graph_scratch scratch;
        if (noh_graph_state_init(state_block, state_bytes, &made->graph, &made->clips, &state, NULL) != NOH_OK ||
            noh_graph_scratch_init(scratch_block, scratch_bytes, &made->graph, &made->clips, &scratch, NULL) !=
                NOH_OK) {
            abort(); /* noh_graph_pack_init has checked it */
        }
        walk_instance(w, made, state, &scratch);
        free(scratch_block);
        free(state_block);
    }
    free(block);
}

static void walk_graphs(walk *w, const noh_clip_bank *set, uint32_t skeleton)
{
    for (uint32_t i = 0; i < w->pack->runs[NOH_CHUNK_GRAPH].count; i++) {
        const noh_graph_pack_desc desc = { w->pack, i, &set->clips, NULL, skeleton };
        walk_graph(w, &desc);
    }
}

/* The errors of fewer joints and fewer updates. */
static void walk_lod(walk *w, const noh_clip_bank *set, const noh_clip_bank_desc *set_desc)
{
    noh_lod_pack_desc desc;
    noh_lod_pack lod;
    size_t bytes;
    void *block;
    memset(&desc, 0, sizeof desc);
    desc.set = set;
    desc.set_desc = set_desc;
    bytes = noh_lod_pack_size(&desc);
    block = memory(bytes);
    if (noh_lod_pack_init(block, bytes, &desc, &lod, NULL) != NOH_OK) {
        abort();
    }
    eat(w, block, bytes);
    free(block);
}

/* The ragdoll of one skeleton, by its table or by names. */
static void walk_ragdoll(walk *w, uint32_t skeleton)
{
    noh_ragdoll_source source = { .pack = w->pack, .skeleton = skeleton, .metres = 1.0f };
    noh_ragdoll_row rows[NOH_RAGDOLL_BODIES_MAX];
    noh_ragdoll_rig *rig = memory(sizeof *rig);
    uint32_t count;
    if (noh_pack_skeleton_at(w->pack, skeleton, &source.joints, NULL, NULL) == NOH_OK &&
        noh_ragdoll_find_rows(&source, rows, &count, NULL) == NOH_OK &&
        noh_ragdoll_rig_make(&source, rows, count, rig, NULL) == NOH_OK) {
        eat(w, rig->bodies, sizeof rig->bodies);
    }
    free(rig);
}

/* All clips of one skeleton, where the decoder accepts them. */
static void walk_set(walk *w, uint32_t skeleton)
{
    noh_clip_bank_desc desc;
    noh_clip_bank *set = NULL;
    size_t bytes;
    void *block;
    memset(&desc, 0, sizeof desc);
    desc.clips = w->pack;
    desc.skeleton = skeleton;
    desc.root_axes = NOH_ROOT_GROUND;
    desc.root_up = 1;
    bytes = noh_clip_bank_size(&desc, NULL);
    block = memory(bytes);
    if (bytes && noh_clip_bank_init(block, bytes, &desc, &set, NULL) == NOH_OK) {
        walk_playing(w, set);
        walk_graphs(w, set, skeleton);
        walk_lod(w, set, &desc);
    }
    free(block);
}

static void walk_covers(walk *w)
{
    for (uint32_t i = 0; i < w->pack->runs[NOH_CHUNK_COVER].count; i++) {
        const noh_pack_cover_header *h = noh_pack_chunk_at(w->pack, NOH_CHUNK_COVER, i);
        eat_name(w, noh_pack_string(w->pack, h->mesh));
        eat(w, (const uint8_t *)h + h->bits_offset, (h->triangle_count + 31u) / 32u * sizeof(uint32_t));
    }
}

static void walk_clips(walk *w)
{
    noh_pack_clip clip;
    for (uint32_t i = 0; noh_pack_clip_at(w->pack, i, &clip, NULL) == NOH_OK; i++) {
        eat_name(w, clip.name);
        for (uint32_t k = 0; k < clip.header->event_count; k++) {
            eat_name(w, noh_pack_string(w->pack, clip.events[k].name));
        }
        for (uint32_t k = 0; k < clip.header->marker_count; k++) {
            eat_name(w, noh_pack_string(w->pack, clip.markers[k].name));
        }
    }
    for (uint32_t i = 0; i < w->pack->runs[NOH_CHUNK_SKELETON].count; i++) {
        noh_skeleton skeleton;
        noh_pack_skeleton_at(w->pack, i, &skeleton, NULL, NULL);
        for (uint32_t j = 0; j < skeleton.joint_count; j++) {
            eat_name(w, noh_pack_joint_name(w->pack, i, j));
            eat(w, &skeleton.parents[j], sizeof skeleton.parents[j]);
        }
        walk_set(w, i);
        walk_ragdoll(w, i);
    }
    walk_set(w, NOH_NONE);
}

uint32_t pack_walk(const noh_pack *pack, uint32_t seed)
{
    walk w = { pack, seed, 0 };
    walk_names(&w);
    walk_textures(&w);
    walk_nodes(&w);
    walk_springs(&w);
    walk_meshes(&w);
    walk_terrain(&w);
    walk_match(&w);
    walk_covers(&w);
    walk_clips(&w);
    return w.hash;
}
