/* report.c: the figures of the levels, ours beside meshoptimizer's. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compare.h"

#define SEEN_PIXEL 0.0002f /* 0.2 mm, a pixel of the z-buffer that measures visible areas */

static void raise_to(float *to, float value)
{
    *to = value > *to ? value : *to;
}

static uint32_t main_submesh(const model_mesh *mesh)
{
    uint32_t best = 0;
    for (uint32_t s = 1; s < mesh->submesh_count; s++) {
        best = mesh->submeshes[s].index_count > mesh->submeshes[best].index_count ? s : best;
    }
    return best;
}

static void measure(const model_mesh *mesh, const lod_level *level, const shapes *unseen, figures *out)
{
    uint32_t poses = unseen->mix_count + unseen->frame_count, first_mix = 1u + mesh->target_count,
             row = first_mix + poses;
    uint32_t largest = main_submesh(mesh);
    lod_distance *d = compare_zeros((size_t)mesh->submesh_count * row, sizeof *d);
    model_error error = { "", "" };
    if (lod_certify(mesh, level, (const float *const *)unseen->poses, poses, d, &error)) {
        fprintf(stderr, "lod_compare: %s\n", error.what);
        exit(1);
    }
    for (uint32_t i = 0; i < mesh->submesh_count * row; i++) {
        uint32_t pose = i % row;
        float mm = d[i].max * 1000.0f;
        raise_to(i / row != largest                     ? &out->others
                 : pose < first_mix                     ? &out->targets
                 : pose < first_mix + unseen->mix_count ? &out->mixes
                                                        : &out->frames,
                 mm);
    }
    out->rest_p99 = d[(size_t)largest * row].p99 * 1000.0f;
    free(d);
}

/* Square millimetres of two submeshes that the camera sees; -1 if the mesh lacks the first. */
static float seen(const model *m, const model_mesh *mesh, const lod_level *level, const char *name, const char *other,
                  const float *weights)
{
    uint32_t s = find_submesh(m, mesh, name), t = find_submesh(m, mesh, other), count;
    float *position, box[4];
    canvas c;
    if (s == MODEL_NONE) {
        return -1.0f;
    }
    position = compare_zeros((size_t)mesh->vertex_count * 3u, sizeof *position);
    shapes_mixed(mesh, weights, position, NULL);
    box_of(mesh, s, position, 0.01f, box);
    c = canvas_new(box[0], box[1], box[2], box[3], SEEN_PIXEL);
    canvas_draw(&c, m, mesh, level, position, mesh->normal);
    count = canvas_count(&c, s) + (t != MODEL_NONE ? canvas_count(&c, t) : 0u);
    canvas_free(&c);
    free(position);
    return (float)count * SEEN_PIXEL * SEEN_PIXEL * 1e6f;
}

/* The level's largest submesh with all others in full. */
static lod_level with_full_parts(const model_mesh *mesh, const lod_level *level)
{
    uint32_t n = mesh->submesh_count, skin = main_submesh(mesh);
    lod_level mixed = *level;
    mixed.indices = compare_zeros((size_t)mesh->index_count + level->index_count, sizeof *mixed.indices);
    mixed.submesh_first = compare_zeros((size_t)n * 2u, sizeof *mixed.submesh_first);
    mixed.submesh_count = mixed.submesh_first + n;
    memcpy(mixed.indices, mesh->indices, mesh->index_count * sizeof *mixed.indices);
    memcpy(mixed.indices + mesh->index_count, level->indices, level->index_count * sizeof *mixed.indices);
    for (uint32_t s = 0; s < n; s++) {
        mixed.submesh_first[s] = s == skin ? mesh->index_count + level->submesh_first[s]
                                           : mesh->submeshes[s].first_index;
        mixed.submesh_count[s] = s == skin ? level->submesh_count[s] : mesh->submeshes[s].index_count;
    }
    return mixed;
}

static void look(const model *m, const model_mesh *mesh, const lod_level *level, figures *out)
{
    float *weights = compare_zeros(mesh->target_count, sizeof *weights);
    lod_level mixed = with_full_parts(mesh, level);
    out->eyes_open = seen(m, mesh, level, "eyes", "", weights);
    out->eyes_shut = shapes_eyes_shut(mesh, weights) ? seen(m, mesh, level, "eyes", "", weights) : -1.0f;
    out->teeth = out->teeth_skin = -1.0f;
    if (shapes_mouth_open(mesh, weights)) {
        out->teeth = seen(m, mesh, level, "teeth", "tongue", weights);
        out->teeth_skin = seen(m, mesh, &mixed, "teeth", "tongue", weights);
    }
    free(mixed.indices);
    free(mixed.submesh_first);
    free(weights);
}

void figures_of(const model *m, const model_mesh *mesh, const lod_level *level, const shapes *unseen, figures *out)
{
    memset(out, 0, sizeof *out);
    out->triangles = level->index_count / 3u;
    out->main_triangles = level->submesh_count[main_submesh(mesh)] / 3u;
    measure(mesh, level, unseen, out);
    look(m, mesh, level, out);
    faults_of(mesh, level->indices, level->index_count, &out->faults);
}

/* ---- the table ---- */

static float larger(float a, float b)
{
    return a > b ? a : b;
}

float figures_skin(const model_mesh *mesh, const lod_level *level, const shapes *unseen)
{
    figures f = { 0 };
    measure(mesh, level, unseen, &f);
    return larger(f.targets, f.mixes);
}

static float both(const figures *f)
{
    return larger(f->targets, f->mixes);
}

static void print_values(const char *name, const char *unit, float ours, float peer, float npm)
{
    printf("  %-34s %-4s %9.3f %9.3f", name, unit, (double)ours, (double)peer);
    if (npm >= 0.0f) {
        printf(" %9.3f", (double)npm);
    }
}

static void print_lengths(const char *name, float ours, float peer, float npm)
{
    print_values(name, "mm", ours, peer, npm);
    if (ours > 0.0f) {
        printf("   %5.2f", (double)(peer / ours));
        if (npm >= 0.0f) {
            printf(" %5.2f", (double)(npm / ours));
        }
        printf(" times");
    }
    putchar('\n');
}

static void print_areas(const char *name, float ours, float peer, float npm, float full)
{
    if (full >= 0.0f) {
        print_values(name, "mm2", ours, peer, npm);
        printf("   full mesh %.1f\n", (double)full);
    }
}

static void print_faults(const char *name, const figures *f)
{
    printf("  %s: UV flips %u, non-manifold edges %u\n", name, f->faults.uv_flips, f->faults.non_manifold);
}

static void print_level(const figures *a, const figures *b, const figures *c, const figures *full)
{
#define OF_NPM(field) (c ? c->field : -1.0f)
    print_lengths("skin, targets", a->targets, b->targets, OF_NPM(targets));
    print_lengths("skin, unseen mixes", a->mixes, b->mixes, OF_NPM(mixes));
    print_lengths("skin, targets and mixes", both(a), both(b), c ? both(c) : -1.0f);
    if (b->frames > 0.0f) {
        print_lengths("skin, unseen frames", a->frames, b->frames, OF_NPM(frames));
    }
    print_lengths("skin at rest, 99 % of the area", a->rest_p99, b->rest_p99, OF_NPM(rest_p99));
    print_lengths("other parts, any of these poses", a->others, b->others, OF_NPM(others));
    print_areas("eyes seen open", a->eyes_open, b->eyes_open, OF_NPM(eyes_open), full->eyes_open);
    print_areas("eyes seen shut", a->eyes_shut, b->eyes_shut, OF_NPM(eyes_shut), full->eyes_shut);
    print_areas("teeth and tongue, mouth open", a->teeth, b->teeth, OF_NPM(teeth), full->teeth);
    print_areas("the same, only the skin simplified", a->teeth_skin, b->teeth_skin, OF_NPM(teeth_skin),
                full->teeth_skin);
#undef OF_NPM
    print_faults("full mesh", full);
    print_faults("ours", a);
    print_faults("meshoptimizer, Debian's", b);
    if (c) {
        print_faults("meshoptimizer, npm's", c);
    }
}

void figures_print(const lod *l, const figures *ours, const figures *peer, const figures *npm, const float *weights)
{
    for (uint32_t i = 1; i < l->level_count; i++) {
        printf(" level %u: %u triangles, of the skin %u; %u vertices; meshoptimizer: Debian's %u (%u)", i,
               ours[i].triangles, ours[i].main_triangles, l->levels[i].vertex_count, peer[i].triangles,
               peer[i].main_triangles);
        if (npm) {
            printf(", npm's %u (%u) with weight %g", npm[i].triangles, npm[i].main_triangles, (double)weights[i]);
        }
        printf("\n  %-34s %-4s %9s %9s%s   over ours\n", "", "", "ours", "Debian's", npm ? "     npm's" : "");
        print_level(&ours[i], &peer[i], npm ? &npm[i] : NULL, &ours[0]);
    }
}
