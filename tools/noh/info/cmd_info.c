/* cmd_info.c: lists the contents of a pack. */
#include <stdio.h>
#include <string.h>

#include "info_chunks.h"
#include "info_graph.h"
#include "info_hair.h"
#include "info_joints.h"
#include "info_match.h"
#include "info_materials.h"
#include "info_terrain.h"
#include "info_extras.h"
#include "info_transfer.h"
#include "cli/args.h"
#include "core/mesh/mesh_internal.h"
#include "cli/message.h"
#include "file/pack_file.h"
#include "verify/half_bound.h"
#include "cli/options.h"
#include "cli/verbs.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/deform.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"
#include "noh/pack.h"

static uint64_t target_bytes(const noh_mesh_header *h)
{
    return 12ull * h->texel_count + sizeof(noh_rect) * (uint64_t)h->rect_count +
           sizeof(noh_target) * (uint64_t)h->target_count;
}

static void print_target(const noh_pack *pack, const noh_target *t, double scale)
{
    printf("    %-24s %6u pairs %4u rects %6u texels  %2u/%2u/%2u bits  moves %.3f mm, error %.2f um\n",
           noh_pack_string(pack, t->name), t->pair_count, t->rect_count, t->texel_count, t->position_bits,
           t->normal_bits, t->tangent_bits, 1e3 * scale * (double)t->radius, 1e6 * scale * (double)t->position_error);
}

static const char *method_of(const noh_mesh_header *h)
{
    return h->flags & NOH_MESH_DUAL_QUATERNION ? "dual quaternions" : "matrices";
}

static void print_skin(const noh_pack *pack, uint32_t mesh, const noh_mesh_header *h)
{
    noh_skin skin;
    noh_skin_list list;
    if (noh_pack_skin_at(pack, h->skin, &skin, NULL) == NOH_OK) {
        printf("  skin '%s': %u joints, %u influence%s per vertex, %u palette%s, with %s\n", skin.name,
               skin.header->joint_count, h->influence_count, plural(h->influence_count), h->palette_count,
               plural(h->palette_count), method_of(h));
    }
    if (noh_pack_skin_list(pack, mesh, &list, NULL) == NOH_OK) {
        printf("  all joints of %u vertices, up to %u each, are listed for the CPU\n", list.header->vertex_count,
               list.header->most);
    }
}

/* A length in mesh units as millimetres in the world. */
static double millimetres(const noh_mesh_header *h, float length)
{
    return 1e3 * (double)h->world_scale * (double)length;
}

static void print_levels(const noh_mesh *m)
{
    if (m->header->influence_errors[2] > 0.0f) {
        printf("  with only the 4, 2, 1 heaviest joints of a vertex: off by at most %.3f, %.3f, %.3f mm in clips\n",
               millimetres(m->header, m->header->influence_errors[0]),
               millimetres(m->header, m->header->influence_errors[1]),
               millimetres(m->header, m->header->influence_errors[2]));
    }
    if (m->header->level_first) {
        printf("  levels finer than %u were left out; source %08x\n", m->header->level_first, noh_mesh_source(m));
    }
    for (uint32_t k = m->header->level_first; k < m->header->level_count && m->header->level_count > 1; k++) {
        const noh_mesh level = noh_mesh_at_lod(m, k);
        const noh_mesh_header *h = level.header;
        printf("  level %u: %6u vertices, %6u triangles, %6u texels, %7u pairs in %5u rectangles", k, h->vertex_count,
               h->index_count / 3, h->touched_count, h->pair_count, h->rect_count);
        if (k) {
            printf(
                "; off by at most, mm: %.3f at rest (99 %%: %.3f), %.3f with one target, %.3f with left and right, %.3f in clips",
                millimetres(h, h->level_error_rest), millimetres(h, h->level_error_rest_p99),
                millimetres(h, h->level_error_targets), millimetres(h, h->level_error_pairs),
                millimetres(h, h->level_error_clip));
        }
        if (h->level_skipped > 0.0f) {
            printf("; targets left out move at most %.3f together", millimetres(h, h->level_skipped));
        }
        putchar('\n');
    }
}

/* Vertices whose texture coordinates targets move. */
static uint32_t count_sliding(const noh_mesh *m)
{
    uint32_t count = 0;
    for (uint32_t v = 0; v < m->header->vertex_count; v++) {
        count += noh_mesh_uv_texel(m, v) < m->header->touched_count;
    }
    return count;
}

/* Of all weights from 0 to 1, micrometres. */
static double half_bound_um(const noh_mesh *m)
{
    float low[NOH_TARGETS_MAX], high[NOH_TARGETS_MAX];
    for (uint32_t t = 0; t < m->header->target_count; t++) {
        low[t] = 0.0f;
        high[t] = 1.0f;
    }
    return 1e6 * (double)m->header->world_scale * half_bound(m, &(half_range){ low, high, 0, NOH_HALF_RTZ });
}

static void print_mesh(const noh_pack *pack, uint32_t index, const noh_mesh *m)
{
    const noh_mesh_header *h = m->header;
    printf("mesh '%s': %u vertices, %u indices, %u submeshes%s%s%s\n", m->name, h->vertex_count, h->index_count,
           h->submesh_count, (h->flags & NOH_MESH_TANGENTS) ? ", tangents" : "",
           (h->flags & NOH_MESH_UVS) ? ", uvs" : "", (h->flags & NOH_MESH_COLORS) ? ", colours" : "");
    print_skin(pack, index, h);
    if (h->target_count) {
        printf("  %u targets, %u pairs in %u rectangles of %u texels (%.3f per pair), %llu bytes (%.2f per pair)\n",
               h->target_count, h->pair_count, h->rect_count, h->texel_count,
               h->pair_count ? (double)h->texel_count / h->pair_count : 0.0, (unsigned long long)target_bytes(h),
               h->pair_count ? (double)target_bytes(h) / h->pair_count : 0.0);
        printf("  %u vertices touched, in %u x %u texels; ", h->touched_count, 1u << h->morph_width_log2,
               h->morph_height);
        if (h->f16_position_bound < NOH_NUMBER_MAX) {
            printf("f16 accumulation within %.0f um (weights 0..1; %.0f: -2..2)\n", half_bound_um(m),
                   1e6 * (double)h->world_scale * (double)h->f16_position_bound);
        } else {
            printf("no f16 accumulation: sums are beyond 65504\n");
        }
    }
    if (h->flags & NOH_MESH_UV_TARGETS) {
        printf("  texture coordinates of %u vertices move\n", count_sliding(m));
    }
    info_print_extras(m);
    info_print_transfer(m);
    print_levels(m);
    for (uint32_t t = 0; t < h->target_count; t++) {
        print_target(pack, &m->targets[t], (double)h->world_scale);
    }
}

static int print_clip(const pack_file *file, uint32_t index)
{
    noh_pack_clip clip;
    noh_clip_info info;
    int status = tool_clip_info(file, index, &clip, &info);
    if (!status) {
        printf("clip '%s': %.3f s, %u joints, %u floats, %u bytes, %u callback key%s, %u sync marker%s%s\n", clip.name,
               tool_clip_seconds(&info), info.joint_count, info.float_count, clip.header->clip_bytes,
               clip.header->event_count, plural(clip.header->event_count), clip.header->marker_count,
               plural(clip.header->marker_count), info.flags & NOH_CLIP_FLAG_LOOP ? ", a loop" : ", plays once");
        info_print_keys(&file->pack, &clip);
        info_print_errors(&file->pack, &clip);
    }
    return status;
}

#define VERSION_BYTES 24

/* The version of the noh that wrote the pack; "?" if the pack has none. */
static void write_version(const noh_pack *pack, char text[VERSION_BYTES])
{
    const uint32_t v = pack->library_version;
    if (v) {
        snprintf(text, VERSION_BYTES, "%u.%u.%u", v >> 24, v >> 12 & 0xfffu, v & 0xfffu);
    } else {
        snprintf(text, VERSION_BYTES, "?");
    }
}

static int print_info(const pack_file *file)
{
    const noh_pack *p = &file->pack;
    int status = 0;
    char writer[VERSION_BYTES];
    write_version(p, writer);
    printf(
        "%s: format %u, written by noh %s, %u bytes, %u chunks; %u mesh%s, %u node%s, %u skeleton%s, %u clip%s, %u material%s, %u texture%s\n",
        file->path, NOH_PACK_VERSION, writer, p->byte_count, p->chunk_count, p->runs[NOH_CHUNK_MESH].count,
        p->runs[NOH_CHUNK_MESH].count == 1 ? "" : "es", p->node_count, plural(p->node_count),
        p->runs[NOH_CHUNK_SKELETON].count, plural(p->runs[NOH_CHUNK_SKELETON].count), p->runs[NOH_CHUNK_CLIP].count,
        plural(p->runs[NOH_CHUNK_CLIP].count), p->material_count, plural(p->material_count),
        p->runs[NOH_CHUNK_TEXTURE].count, plural(p->runs[NOH_CHUNK_TEXTURE].count));
    info_print_chunks(p);
    for (uint32_t i = 0; i < p->runs[NOH_CHUNK_MESH].count; i++) {
        noh_mesh mesh;
        noh_pack_mesh_at(p, i, &mesh, NULL);
        print_mesh(p, i, &mesh);
    }
    for (uint32_t i = 0; i < p->runs[NOH_CHUNK_SKELETON].count; i++) {
        noh_skeleton skeleton;
        noh_pack_skeleton_at(p, i, &skeleton, NULL, NULL);
        printf("skeleton '%s': %u joints", noh_pack_chunk_name(p, p->runs[NOH_CHUNK_SKELETON].first + i),
               skeleton.joint_count);
        info_print_levels(p, i);
        printf("\n");
        info_print_joints(p, i);
        info_print_springs(p, i);
    }
    for (uint32_t i = 0; i < p->runs[NOH_CHUNK_CLIP].count && !status; i++) {
        status = print_clip(file, i);
    }
    info_print_hair(p);
    info_print_terrain(p);
    info_print_match(p);
    for (uint32_t i = 0; i < p->runs[NOH_CHUNK_GRAPH].count && !status; i++) {
        status = info_print_graph(file, i);
    }
    info_print_materials(p);
    info_print_textures(p);
    return status;
}

static void json_target(json *j, const noh_pack *pack, const noh_target *t, double scale)
{
    json_open(j, NULL, '{');
    json_text(j, "name", noh_pack_string(pack, t->name));
    json_integer(j, "pairs", t->pair_count);
    json_integer(j, "rects", t->rect_count);
    json_integer(j, "texels", t->texel_count);
    json_integer(j, "position_bits", t->position_bits);
    json_integer(j, "normal_bits", t->normal_bits);
    json_integer(j, "tangent_bits", t->tangent_bits);
    json_number(j, "max_displacement_um", 1e6 * scale * (double)t->radius);
    json_number(j, "position_error_um", 1e6 * scale * (double)t->position_error);
    json_number(j, "normal_error", (double)t->normal_error);
    json_number(j, "tangent_error", (double)t->tangent_error);
    json_close(j, '}');
}

/* Null for a rigid mesh. */
static void json_skin(json *j, const noh_pack *pack, uint32_t mesh, const noh_mesh_header *h)
{
    noh_skin skin;
    noh_skin_list list;
    const int listed = noh_pack_skin_list(pack, mesh, &list, NULL) == NOH_OK;
    if (noh_pack_skin_at(pack, h->skin, &skin, NULL) != NOH_OK) {
        json_null(j, "skin");
        return;
    }
    json_open(j, "skin", '{');
    json_text(j, "name", skin.name);
    json_integer(j, "joints", skin.header->joint_count);
    json_integer(j, "influences", h->influence_count);
    json_integer(j, "listed_vertices", listed ? list.header->vertex_count : 0);
    json_integer(j, "listed_influences", listed ? list.header->most : 0);
    json_integer(j, "palettes", h->palette_count);
    json_bool(j, "dual_quaternion", (h->flags & NOH_MESH_DUAL_QUATERNION) != 0);
    json_close(j, '}');
}

static void json_levels(json *j, const noh_mesh *m)
{
    json_open(j, "lods", '[');
    for (uint32_t k = m->header->level_first; k < m->header->level_count; k++) {
        const noh_mesh level = noh_mesh_at_lod(m, k);
        const noh_mesh_header *h = level.header;
        json_open(j, NULL, '{');
        json_integer(j, "level", k);
        json_integer(j, "vertices", h->vertex_count);
        json_integer(j, "triangles", h->index_count / 3);
        json_integer(j, "touched", h->touched_count);
        json_integer(j, "pairs", h->pair_count);
        json_integer(j, "rects", h->rect_count);
        json_integer(j, "texels", h->texel_count);
        json_number(j, "error_rest_um", 1e3 * millimetres(h, h->level_error_rest));
        json_number(j, "error_rest_p99_um", 1e3 * millimetres(h, h->level_error_rest_p99));
        json_number(j, "error_targets_um", 1e3 * millimetres(h, h->level_error_targets));
        json_number(j, "error_pairs_um", 1e3 * millimetres(h, h->level_error_pairs));
        json_number(j, "error_motion_um", 1e3 * millimetres(h, h->level_error_clip));
        json_number(j, "skipped_um", 1e3 * millimetres(h, h->level_skipped));
        json_close(j, '}');
    }
    json_close(j, ']');
}

static void json_mesh(json *j, const noh_pack *pack, uint32_t index, const noh_mesh *m)
{
    const noh_mesh_header *h = m->header;
    json_open(j, NULL, '{');
    json_text(j, "name", m->name);
    json_integer(j, "vertices", h->vertex_count);
    json_integer(j, "indices", h->index_count);
    json_integer(j, "submeshes", h->submesh_count);
    json_integer(j, "targets", h->target_count);
    json_integer(j, "touched", h->touched_count);
    json_integer(j, "sliding", count_sliding(m));
    json_integer(j, "pairs", h->pair_count);
    json_integer(j, "source_pairs", h->source_pair_count);
    json_integer(j, "rects", h->rect_count);
    json_integer(j, "texels", h->texel_count);
    json_integer(j, "target_bytes", target_bytes(h));
    json_number(j, "f16_bound_0_to_1_um", half_bound_um(m));
    json_number(j, "f16_bound_um", 1e6 * (double)h->world_scale * (double)h->f16_position_bound);
    json_skin(j, pack, index, h);
    info_json_extras(j, m);
    info_json_transfer(j, m);
    json_integer(j, "level_first", h->level_first);
    json_integer(j, "source", noh_mesh_source(m));
    json_levels(j, m);
    json_open(j, "target_list", '[');
    for (uint32_t t = 0; t < h->target_count; t++) {
        json_target(j, pack, &m->targets[t], (double)h->world_scale);
    }
    json_close(j, ']');
    json_close(j, '}');
}

static void json_skeleton(json *j, const noh_pack *pack, uint32_t index)
{
    noh_skeleton skeleton;
    const noh_skeleton_header *h;
    noh_pack_skeleton_at(pack, index, &skeleton, &h, NULL);
    json_open(j, NULL, '{');
    json_text(j, "name", noh_pack_chunk_name(pack, pack->runs[NOH_CHUNK_SKELETON].first + index));
    json_integer(j, "joints", h->joint_count);
    json_integer(j, "hash", h->hash);
    json_number(j, "unit_cm", (double)h->unit_cm);
    info_json_joints(j, pack, index);
    info_json_levels(j, pack, index);
    info_json_springs(j, pack, index);
    json_close(j, '}');
}

static int json_clip(json *j, const pack_file *file, uint32_t index)
{
    noh_pack_clip clip;
    noh_clip_info info;
    int status = tool_clip_info(file, index, &clip, &info);
    if (!status) {
        json_open(j, NULL, '{');
        json_text(j, "name", clip.name);
        json_number(j, "seconds", tool_clip_seconds(&info));
        json_integer(j, "joints", info.joint_count);
        json_integer(j, "floats", info.float_count);
        json_bool(j, "loop", (info.flags & NOH_CLIP_FLAG_LOOP) != 0);
        json_integer(j, "bytes", clip.header->clip_bytes);
        json_integer(j, "events", clip.header->event_count);
        json_integer(j, "markers", clip.header->marker_count);
        info_json_keys(j, &file->pack, &clip);
        info_json_errors(j, &file->pack, &clip);
        json_close(j, '}');
    }
    return status;
}

static uint64_t count_events(const noh_pack *pack)
{
    uint64_t count = 0;
    for (uint32_t i = 0; i < pack->runs[NOH_CHUNK_CLIP].count; i++) {
        noh_pack_clip clip;
        noh_pack_clip_at(pack, i, &clip, NULL);
        count += clip.header->event_count;
    }
    return count;
}

static int json_info(const pack_file *file)
{
    const noh_pack *p = &file->pack;
    int status = 0;
    json j = json_begin();
    char writer[VERSION_BYTES];
    write_version(p, writer);
    json_integer(&j, "version", NOH_PACK_VERSION);
    json_text(&j, "writer", writer);
    json_integer(&j, "bytes", p->byte_count);
    info_json_chunks(&j, p);
    json_open(&j, "meshes", '[');
    for (uint32_t i = 0; i < p->runs[NOH_CHUNK_MESH].count; i++) {
        noh_mesh mesh;
        noh_pack_mesh_at(p, i, &mesh, NULL);
        json_mesh(&j, p, i, &mesh);
    }
    json_close(&j, ']');
    json_open(&j, "skeletons", '[');
    for (uint32_t i = 0; i < p->runs[NOH_CHUNK_SKELETON].count; i++) {
        json_skeleton(&j, p, i);
    }
    json_close(&j, ']');
    json_open(&j, "clips", '[');
    for (uint32_t i = 0; i < p->runs[NOH_CHUNK_CLIP].count && !status; i++) {
        status = json_clip(&j, file, i);
    }
    json_close(&j, ']');
    info_json_hair(&j, p);
    info_json_terrain(&j, p);
    json_open(&j, "graphs", '[');
    for (uint32_t i = 0; i < p->runs[NOH_CHUNK_GRAPH].count && !status; i++) {
        status = info_json_graph(&j, file, i);
    }
    json_close(&j, ']');
    json_integer(&j, "events", count_events(p));
    json_integer(&j, "nodes", p->node_count);
    json_integer(&j, "materials", p->material_count);
    json_integer(&j, "textures", p->runs[NOH_CHUNK_TEXTURE].count);
    info_json_materials(&j, p);
    info_json_textures(&j, p);
    if (status) {
        json_drop(&j);
    }
    return status ? status : json_end(&j);
}

typedef struct info_args {
    const char *pack;
    int as_json;
} info_args;

static int run(void *args)
{
    const info_args *a = args;
    pack_file file;
    int status = pack_file_open(&file, a->pack);
    if (!status) {
        status = a->as_json ? json_info(&file) : print_info(&file);
        pack_file_close(&file);
    }
    return status;
}

static info_args arguments;

static const option options[] = { OPTION_JSON(info_args, as_json) };

const verb verb_info = {
    .name = "info",
    .files = "PACK|MODEL",
    .what =
        "list the contents of a pack: counts, names, joints, callback keys and markers with their times, bytes, and errors certified at build",
    .example = "face.noh\nface.noh --json",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .file_max = 1,
    .files_at = offsetof(info_args, pack),
    .args = &arguments,
    .run = run,
};
