/* report.c: what `noh build` prints of meshes, LOD levels and skins. The bytes of other engines' layouts are computed
 * from their bytes per vertex and target, or per pair. */
#include "convert.h"
#include "convert/texture/texture_blocks.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/pack.h"

static double ratio(double a, double b)
{
    return b > 0.0 ? a / b : 0.0;
}

static void report_peers(FILE *out, const model_mesh *m, const morph_encoding *e, double ours)
{
    double dense = (double)m->vertex_count * m->target_count, pairs = e->source_pairs;
    const struct {
        const char *name;
        double bytes;
    } peers[] = { { "three.js, RGBA32F position and normal of every vertex", dense * 32.0 },
                  { "Filament, RGBA32F position and RGBA16I frame of every vertex", dense * 24.0 },
                  { "PlayCanvas, RGBA16F of every touched vertex", (double)e->touched_count * m->target_count * 16.0 },
                  { "Unity, index and nine floats per pair", pairs * 40.0 },
                  { "one rectangle per target in the asset's order, 24 bytes", (double)e->texels_one_rect * 24.0 } };
    for (size_t i = 0; i < sizeof peers / sizeof peers[0]; i++) {
        fprintf(out, "    %10.0f bytes, %5.1f x  %s\n", peers[i].bytes, ratio(peers[i].bytes, ours), peers[i].name);
    }
}

/* The target whose certified error is the largest: where --error-um was hardest to keep. */
static const morph_target *worst_target(const morph_encoding *e, uint32_t *index)
{
    const morph_target *worst = &e->targets[0];
    *index = 0;
    for (uint32_t t = 1; t < e->target_count; t++) {
        if (e->targets[t].position_error > worst->position_error) {
            worst = &e->targets[t];
            *index = t;
        }
    }
    return worst;
}

/* The motion of texture coordinates by targets. */
static void report_uvs(FILE *out, const model_mesh *m, const morph_encoding *e, float error)
{
    uint32_t count = 0;
    for (uint32_t v = 0; e->uv_texel && v < m->vertex_count; v++) count += e->uv_texel[v] != MODEL_NONE;
    if (!e->uv_texel) return;
    fprintf(out, "  texture coordinates of %u vertices move, off by at most %.2g: %.2f texels of %u\n", count,
            (double)(error * e->uv_per_unit), (double)(error * e->uv_per_unit) * NOH_TEXTURE_SIZE_MAX,
            NOH_TEXTURE_SIZE_MAX);
}

void convert_report_mesh(FILE *out, const model_mesh *m, const morph_encoding *e, float scale, float error_um)
{
    double bytes = 12.0 * e->texel_count + sizeof(noh_rect) * (double)e->rect_count +
                   sizeof(noh_target) * (double)e->target_count;
    uint32_t index = 0;
    const morph_target *worst;
    fprintf(out, "mesh '%s': %u vertices, %u triangles, %u submeshes, %u targets\n", m->name, m->vertex_count,
            m->index_count / 3, m->submesh_count, m->target_count);
    if (!m->target_count) {
        return;
    }
    worst = worst_target(e, &index);
    fprintf(out, "  %u of %u vertices touched, in %u x %u texels\n", e->touched_count, m->vertex_count,
            1u << e->width_log2, e->height);
    fprintf(out,
            "  %u pairs (%u in the source) in %u rectangles of %u texels: %.3f texels blended per vertex touched\n",
            e->pair_count, e->source_pairs, e->rect_count, e->texel_count, ratio(e->texel_count, e->pair_count));
    fprintf(out, "  %.0f bytes, %.2f per pair; largest position error %.2f um in '%s' (%u bits, %.1f um requested)\n",
            bytes, ratio(bytes, e->pair_count), 1e6 * (double)(scale * worst->position_error), m->targets[index].name,
            worst->position_bits, (double)error_um);
    report_uvs(out, m, e, worst->position_error);
    report_peers(out, m, e, bytes);
}

void convert_report_lods(FILE *out, const model_mesh *mesh, const mesh_levels *levels, float scale)
{
    for (uint32_t k = 1; k < levels->count; k++) {
        const lod_errors *e = &levels->errors[k];
        const uint32_t triangles = levels->built->levels[levels->which[k]].index_count / 3;
        fprintf(
            out,
            "  level %u: %u triangles (%.1f %%), off by at most %.2f mm at rest (99 %%: %.2f), %.2f with one target, "
            "%.2f with left and right",
            k, triangles, 300.0 * triangles / (double)mesh->index_count, 1e3 * (double)(scale * e->rest),
            1e3 * (double)(scale * e->rest_p99), 1e3 * (double)(scale * e->targets), 1e3 * (double)(scale * e->pairs));
        if (e->clip > 0.0f) {
            fprintf(out, ", %.2f in motion", 1e3 * (double)(scale * e->clip));
        }
        if (levels->joints.level && k >= levels->joints.level) {
            fprintf(out, ", by %u virtual joints", levels->joints.fit.joint_count);
        }
        fputc('\n', out);
    }
    if (levels->joints.level) {
        fprintf(out, "  virtual joints: normals off by at most %.1f degrees (99 %%: %.1f) with one target, %u bytes\n",
                57.29578 * (double)levels->joints.normal_most, 57.29578 * (double)levels->joints.normal_p99,
                levels->joints.fit.joint_count * (20u + 8u * levels->joints.fit.target_count));
    }
    if (levels->count == 1 && levels->built) {
        fprintf(out, "  no coarser levels: %u of %u points may not move (seams without a partner, borders that touch, ",
                levels->built->stuck, levels->built->points);
        fprintf(out, "folds); the rest saves less than a twentieth at the requested errors\n");
    }
}

void convert_report_skins(FILE *out, const noh_pack *pack)
{
    noh_mesh mesh;
    for (uint32_t i = 0; noh_pack_mesh_at(pack, i, &mesh, NULL) == NOH_OK; i++) {
        const noh_mesh_header *h = mesh.header;
        uint32_t doubled = 0, followed = 0;
        noh_skin skin;
        if (noh_pack_skin_at(pack, h->skin, &skin, NULL)) {
            continue;
        }
        for (uint32_t v = 0; v < h->vertex_count; v++) {
            doubled += noh_mesh_accumulation_texel(&mesh, v) != v;
        }
        for (uint32_t j = 0; j < skin.header->joint_count; j++) {
            followed += mesh.joint_boxes[6 * j] <= mesh.joint_boxes[6 * j + 3];
        }
        fprintf(out, "mesh '%s' follows %u joints of skin '%s', %u a vertex, by %s: %u palette%s", mesh.name, followed,
                skin.name, h->influence_count, h->flags & NOH_MESH_DUAL_QUATERNION ? "dual quaternions" : "matrices",
                h->palette_count, h->palette_count == 1 ? "" : "s");
        if (h->palette_count > 1) {
            fprintf(out, ": split into %u parts", h->submesh_count);
            if (h->level_count == 1) {
                fprintf(out, ", %u vertices doubled", doubled);
            }
        }
        fputc('\n', out);
    }
}

void convert_report_textures(FILE *out, const noh_pack *pack)
{
    noh_texture t;
    for (uint32_t i = 0; noh_pack_texture_at(pack, i, &t, NULL) == NOH_OK; i++) {
        const double quality = texture_quality_db(t.header);
        if (t.header->format && quality < TEXTURE_QUALITY_DB) {
            fprintf(out, "texture '%s' has %.1f dB as %s, below %.0f: --textures raw keeps it exact\n", t.name, quality,
                    texture_format_name(t.header->format), TEXTURE_QUALITY_DB);
        }
    }
}
