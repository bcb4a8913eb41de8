#define _POSIX_C_SOURCE 200809L /* rmdir */

#include "face_files.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "support.h"

/* ---- equal things as one ---- */

/* Places of things by their bytes. */
typedef struct unique {
    uint8_t *items; /* [count][size] */
    uint32_t *slots;
    size_t size;
    uint32_t count, slot_count;
} unique;

static unique unique_new(size_t size, uint32_t count_max)
{
    unique u = { NULL, NULL, size, 0, 16 };
    while (u.slot_count < count_max * 2u) u.slot_count *= 2u;
    u.items = test_zeros(count_max * size);
    u.slots = test_zeros(u.slot_count * sizeof *u.slots);
    memset(u.slots, 0xff, u.slot_count * sizeof *u.slots);
    return u;
}

static void unique_free(unique *u)
{
    free(u->items);
    free(u->slots);
}

static uint32_t unique_place(unique *u, const void *item)
{
    const uint8_t *b = item;
    uint32_t slot = 2166136261u;
    for (size_t i = 0; i < u->size; i++) slot = (slot ^ b[i]) * 16777619u;
    for (slot ^= slot >> 15;; slot++) {
        const uint32_t at = u->slots[slot &= u->slot_count - 1u];
        if (at == MODEL_NONE) break;
        if (memcmp(u->items + at * u->size, item, u->size) == 0) return at;
    }
    u->slots[slot] = u->count;
    memcpy(u->items + u->count * u->size, item, u->size);
    return u->count++;
}

/* ---- the face ---- */

static int by_name(const void *a, const void *b)
{
    const model_target *p = *(const model_target *const *)a, *q = *(const model_target *const *)b;
    return strcmp(p->name, q->name);
}

/* The first targets, in the order in which a folder of files is read. */
static const model_target **sorted_targets(const model_mesh *mesh, uint32_t count)
{
    const model_target **sorted = test_zeros((count + 1u) * sizeof(const model_target *));
    for (uint32_t t = 0; t < count; t++) sorted[t] = &mesh->targets[t];
    qsort(sorted, count, sizeof *sorted, by_name);
    return sorted;
}

/* Positions that every target brings to the same places are one. */
static uint32_t *find_positions(const model_mesh *mesh, const model_target *const *targets, face_files *f)
{
    const size_t floats = 3u * (1u + (size_t)f->target_count);
    unique u = unique_new(floats * sizeof(float), mesh->vertex_count);
    uint32_t *place = test_zeros(mesh->vertex_count * sizeof *place);
    float *all = test_zeros(floats * sizeof *all);
    for (size_t v = 0; v < mesh->vertex_count; v++) {
        for (size_t k = 0; k < 3; k++) {
            const float base = all[k] = mesh->position[v * 3 + k] + 0.0f; /* no -0 */
            for (uint32_t t = 0; t < f->target_count; t++) {
                all[3u * (1u + t) + k] = base + targets[t]->position[v * 3 + k] + 0.0f;
            }
        }
        place[v] = unique_place(&u, all);
    }
    f->position_count = u.count;
    f->positions = test_zeros((size_t)u.count * 12u);
    for (uint32_t t = 0; t < f->target_count; t++) f->moved[t] = test_zeros((size_t)u.count * 12u);
    for (size_t p = 0; p < u.count; p++) {
        const float *from = (const float *)(const void *)(u.items + p * u.size);
        memcpy(f->positions + p * 3, from, 12);
        for (uint32_t t = 0; t < f->target_count; t++) memcpy(f->moved[t] + p * 3, from + 3u * (1u + t), 12);
    }
    free(all);
    unique_free(&u);
    return place;
}

/* Rows of floats as those that differ, *out; the place of each. */
static uint32_t *find_rows(const float *rows, uint32_t count, size_t width, float **out, uint32_t *out_count)
{
    unique u = unique_new(width * sizeof(float), count);
    uint32_t *place = test_zeros(count * sizeof *place);
    for (size_t v = 0; v < count; v++) place[v] = unique_place(&u, rows + v * width);
    *out = (float *)(void *)u.items;
    *out_count = u.count;
    free(u.slots);
    return place;
}

static void find_corners(const model_mesh *mesh, uint32_t *position, int with_normals, face_files *f)
{
    uint32_t *uv = NULL, *normal = NULL;
    if (mesh->uv) uv = find_rows(mesh->uv, mesh->vertex_count, 2, &f->uvs, &f->uv_count);
    if (with_normals) normal = find_rows(mesh->normal, mesh->vertex_count, 3, &f->normals, &f->normal_count);
    f->corner_count = mesh->index_count;
    f->corners = test_zeros(mesh->index_count * sizeof *f->corners);
    for (uint32_t i = 0; i < mesh->index_count; i++) {
        const uint32_t v = mesh->indices[i];
        f->corners[i] = (face_corner){ position[v], uv ? uv[v] : 0u, normal ? normal[v] : 0u };
    }
    free(uv);
    free(normal);
}

/* The largest part becomes two, whose border has vertices of both. */
static void cut_largest(face_files *f)
{
    face_part *largest = &f->parts[0], *rest = &f->parts[f->part_count++];
    for (uint32_t i = 1; i + 1 < f->part_count; i++)
        largest = f->parts[i].count > largest->count ? &f->parts[i] : largest;
    *rest = *largest;
    largest->count = largest->count / 6u * 3u;
    rest->first += largest->count;
    rest->count -= largest->count;
    (void)snprintf(rest->name, sizeof rest->name, "neck");
}

static void find_parts(const model *m, const model_mesh *mesh, face_files *f)
{
    f->part_count = mesh->submesh_count;
    f->parts = test_zeros((mesh->submesh_count + 1u) * sizeof *f->parts);
    for (uint32_t i = 0; i < mesh->submesh_count; i++) {
        face_part *p = &f->parts[i];
        const model_material *material = &m->materials[mesh->submeshes[i].material];
        p->first = mesh->submeshes[i].first_index;
        p->count = mesh->submeshes[i].index_count;
        (void)snprintf(p->name, sizeof p->name, "%s", material->name);
        memcpy(p->color, material->base_color, sizeof p->color);
    }
    cut_largest(f);
}

face_files *face_files_new(const model *m, uint32_t target_max, int with_normals)
{
    const model_mesh *mesh = &m->meshes[0];
    const model_target **sorted;
    uint32_t *position;
    face_files *f = test_zeros(sizeof *f);
    f->target_count = mesh->target_count < target_max ? mesh->target_count : target_max;
    f->moved = test_zeros((f->target_count + 1u) * sizeof *f->moved);
    f->targets = test_zeros((f->target_count + 1u) * sizeof *f->targets);
    sorted = sorted_targets(mesh, f->target_count);
    for (uint32_t t = 0; t < f->target_count; t++) {
        (void)snprintf(f->targets[t], sizeof *f->targets, "%s", sorted[t]->name);
    }
    position = find_positions(mesh, sorted, f);
    find_corners(mesh, position, with_normals, f);
    find_parts(m, mesh, f);
    free(position);
    free(sorted);
    return f;
}

void face_files_free(face_files *f)
{
    for (uint32_t t = 0; t < f->target_count; t++) free(f->moved[t]);
    free(f->moved);
    free(f->targets);
    free(f->positions);
    free(f->uvs);
    free(f->normals);
    free(f->corners);
    free(f->parts);
    free(f);
}

/* ---- .obj ---- */

static const char *path_of(const char *folder, const char *name, const char *end)
{
    static char path[4096];
    (void)snprintf(path, sizeof path, "%s/%s%s", folder, name, end);
    return path;
}

static FILE *create(const char *folder, const char *name, const char *end)
{
    FILE *file = fopen(path_of(folder, name, end), "wb");
    assert_non_null(file);
    return file;
}

/* Nine digits give each float back. */
static void print_rows(FILE *file, const char *word, const float *rows, uint32_t count)
{
    for (size_t i = 0; i < count; i++) {
        fprintf(file, "%s %.9g %.9g %.9g\n", word, (double)rows[i * 3], (double)rows[i * 3 + 1],
                (double)rows[i * 3 + 2]);
    }
}

static void print_corner(FILE *file, const face_files *f, const face_corner *c)
{
    fprintf(file, " %u/", c->position + 1u);
    if (f->uvs) fprintf(file, "%u", c->uv + 1u);
    if (f->normals) fprintf(file, "/%u", c->normal + 1u);
}

static int same_corner(const face_corner *a, const face_corner *b)
{
    return memcmp(a, b, sizeof *a) == 0;
}

static void normal_of(const face_files *f, const face_corner *c, double normal[3])
{
    const float *p = f->positions + 3 * (size_t)c[0].position, *q = f->positions + 3 * (size_t)c[1].position,
                *r = f->positions + 3 * (size_t)c[2].position;
    for (int k = 0; k < 3; k++) {
        const int m = (k + 1) % 3, n = (k + 2) % 3;
        normal[k] = ((double)q[m] - (double)p[m]) * ((double)r[n] - (double)p[n]) -
                    ((double)q[n] - (double)p[n]) * ((double)r[m] - (double)p[m]);
    }
}

/* Whether four corners lie nearly in a plane: of a folded face it is a matter of taste which diagonal cuts it. */
static int is_flat(const face_files *f, const face_corner *c)
{
    double a[3], b[3];
    normal_of(f, c, a);
    normal_of(f, c + 3, b);
    const double dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    const double lengths = (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]) * (b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);
    return dot > 0.0 && dot * dot > 0.8 * lengths;
}

/* Two triangles that a fan of four corners gives are written as one face, as modellers keep them. */
static void print_part(FILE *file, const face_files *f, const face_part *p)
{
    for (uint32_t i = 0; i < p->count; i += 3) {
        const face_corner *c = f->corners + p->first + i;
        const int is_quad = i + 3 < p->count && same_corner(&c[3], &c[0]) && same_corner(&c[4], &c[2]) && is_flat(f, c);
        fputc('f', file);
        for (uint32_t k = 0; k < 3; k++) print_corner(file, f, &c[k]);
        if (is_quad) print_corner(file, f, &c[5]);
        fputc('\n', file);
        i += is_quad ? 3u : 0u;
    }
}

static void print_target(const face_files *f, uint32_t target, const char *folder)
{
    FILE *file = create(folder, f->targets[target], ".obj");
    print_rows(file, "v", f->moved[target], f->position_count);
    assert_int_equal(fclose(file), 0);
}

void face_files_obj(const face_files *f, const char *folder)
{
    FILE *file = create(folder, "face", ".mtl");
    for (uint32_t i = 0; i < f->part_count; i++) {
        const float *c = f->parts[i].color;
        fprintf(file, "newmtl %s\nKd %.9g %.9g %.9g\n", f->parts[i].name, (double)c[0], (double)c[1], (double)c[2]);
    }
    assert_int_equal(fclose(file), 0);
    file = create(folder, "face", ".obj");
    fprintf(file, "mtllib face.mtl\n");
    print_rows(file, "v", f->positions, f->position_count);
    for (size_t i = 0; i < f->uv_count; i++) {
        fprintf(file, "vt %.9g %.17g\n", (double)f->uvs[i * 2], 1.0 - (double)f->uvs[i * 2 + 1]);
    }
    print_rows(file, "vn", f->normals, f->normal_count);
    for (uint32_t i = 0; i < f->part_count; i++) {
        fprintf(file, "usemtl %s\n", f->parts[i].name);
        print_part(file, f, &f->parts[i]);
    }
    assert_int_equal(fclose(file), 0);
    for (uint32_t t = 0; t < f->target_count; t++) print_target(f, t, folder);
}

void face_files_obj_remove(const face_files *f, const char *folder)
{
    for (uint32_t t = 0; t < f->target_count; t++) assert_int_equal(remove(path_of(folder, f->targets[t], ".obj")), 0);
    assert_int_equal(remove(path_of(folder, "face", ".obj")), 0);
    assert_int_equal(remove(path_of(folder, "face", ".mtl")), 0);
    assert_int_equal(rmdir(folder), 0);
}

/* ---- .glb ---- */

typedef struct glb {
    byte_buffer bin, views, accessors, primitives;
    uint32_t view_count, accessor_count;
} glb;

static uint32_t add_view(glb *g, const void *bytes, size_t count)
{
    buffer_print(&g->views, "%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}", g->view_count ? "," : "",
                 g->bin.count, count);
    buffer_append(&g->bin, bytes, count);
    buffer_align(&g->bin, 4);
    return g->view_count++;
}

static uint32_t add_accessor(glb *g, const void *bytes, size_t count, uint32_t width)
{
    static const char *const types[] = { "", "SCALAR", "VEC2", "VEC3" };
    const uint32_t view = add_view(g, bytes, count * width * 4u);
    buffer_print(&g->accessors, "%s{\"bufferView\":%u,\"componentType\":%u,\"count\":%zu,\"type\":\"%s\"}",
                 g->accessor_count ? "," : "", view, width == 1 ? 5125u : 5126u, count, types[width]);
    return g->accessor_count++;
}

static uint32_t add_sparse(glb *g, const float *deltas, uint32_t count)
{
    byte_buffer places = { NULL, 0, 0, 0 }, values = { NULL, 0, 0, 0 };
    const float none[3] = { 0.0f, 0.0f, 0.0f };
    uint32_t moved = 0;
    for (uint32_t v = 0; v < count; v++) {
        if (memcmp(deltas + (size_t)v * 3, none, sizeof none) == 0) continue;
        buffer_append(&places, &v, sizeof v);
        buffer_append(&values, deltas + (size_t)v * 3, sizeof none);
        moved++;
    }
    buffer_print(&g->accessors, "%s{\"componentType\":5126,\"count\":%u,\"type\":\"VEC3\"",
                 g->accessor_count ? "," : "", count);
    if (moved) {
        const uint32_t at = add_view(g, places.bytes, places.count), what = add_view(g, values.bytes, values.count);
        buffer_print(&g->accessors,
                     ",\"sparse\":{\"count\":%u,\"indices\":{\"bufferView\":%u,\"componentType\":5125},"
                     "\"values\":{\"bufferView\":%u}}",
                     moved, at, what);
    }
    buffer_print(&g->accessors, "}");
    buffer_free(&places);
    buffer_free(&values);
    return g->accessor_count++;
}

/* One row of each vertex out of the rows that its corner has a place in. */
static float *gather(const unique *vertices, const float *rows, uint32_t width, size_t which)
{
    float *out = test_zeros((size_t)vertices->count * width * sizeof *out);
    for (size_t v = 0; v < vertices->count; v++) {
        uint32_t place;
        memcpy(&place, vertices->items + v * vertices->size + which, sizeof place);
        memcpy(out + v * width, rows + (size_t)place * width, width * sizeof *out);
    }
    return out;
}

static void add_attribute(glb *g, byte_buffer *to, const unique *vertices, const char *name, const float *rows,
                          uint32_t width, size_t which)
{
    float *gathered;
    if (!rows) return;
    gathered = gather(vertices, rows, width, which);
    buffer_print(to, "%s\"%s\":%u", to->count > 1 ? "," : "", name, add_accessor(g, gathered, vertices->count, width));
    free(gathered);
}

static uint32_t add_target(glb *g, const face_files *f, const unique *vertices, uint32_t target, int sparse)
{
    float *from = gather(vertices, f->positions, 3, 0), *to = gather(vertices, f->moved[target], 3, 0);
    uint32_t accessor;
    for (size_t i = 0; i < (size_t)vertices->count * 3; i++) to[i] = (float)((double)to[i] - (double)from[i]);
    accessor = sparse ? add_sparse(g, to, vertices->count) : add_accessor(g, to, vertices->count, 3);
    free(from);
    free(to);
    return accessor;
}

/* The attributes and targets of a primitive as text. */
static byte_buffer add_vertices(glb *g, const face_files *f, const unique *vertices, int sparse)
{
    byte_buffer text = { NULL, 0, 0, 0 };
    buffer_print(&text, "{");
    add_attribute(g, &text, vertices, "POSITION", f->positions, 3, offsetof(face_corner, position));
    add_attribute(g, &text, vertices, "TEXCOORD_0", f->uvs, 2, offsetof(face_corner, uv));
    add_attribute(g, &text, vertices, "NORMAL", f->normals, 3, offsetof(face_corner, normal));
    buffer_print(&text, "},\"targets\":[");
    for (uint32_t t = 0; t < f->target_count; t++) {
        buffer_print(&text, "%s{\"POSITION\":%u}", t ? "," : "", add_target(g, f, vertices, t, sparse));
    }
    buffer_print(&text, "]");
    return text;
}

static void add_primitive(glb *g, uint32_t part, const byte_buffer *vertices, const uint32_t *indices, uint32_t count)
{
    buffer_print(&g->primitives, "%s{\"attributes\":", part ? "," : "");
    buffer_append(&g->primitives, vertices->bytes, vertices->count);
    buffer_print(&g->primitives, ",\"indices\":%u,\"material\":%u}", add_accessor(g, indices, count, 1), part);
}

static void add_own(glb *g, const face_files *f, int sparse)
{
    for (uint32_t i = 0; i < f->part_count; i++) {
        const face_part *p = &f->parts[i];
        unique vertices = unique_new(sizeof(face_corner), p->count);
        uint32_t *indices = test_zeros(p->count * sizeof *indices);
        byte_buffer text;
        for (uint32_t k = 0; k < p->count; k++) indices[k] = unique_place(&vertices, &f->corners[p->first + k]);
        text = add_vertices(g, f, &vertices, sparse);
        add_primitive(g, i, &text, indices, p->count);
        buffer_free(&text);
        free(indices);
        unique_free(&vertices);
    }
}

static void add_shared(glb *g, const face_files *f)
{
    unique vertices = unique_new(sizeof(face_corner), f->corner_count);
    uint32_t *indices = test_zeros(f->corner_count * sizeof *indices);
    byte_buffer text;
    for (uint32_t k = 0; k < f->corner_count; k++) indices[k] = unique_place(&vertices, &f->corners[k]);
    text = add_vertices(g, f, &vertices, 0);
    for (uint32_t i = 0; i < f->part_count; i++) {
        add_primitive(g, i, &text, indices + f->parts[i].first, f->parts[i].count);
    }
    buffer_free(&text);
    free(indices);
    unique_free(&vertices);
}

static byte_buffer glb_text(const face_files *f, const glb *g)
{
    byte_buffer text = { NULL, 0, 0, 0 };
    buffer_print(&text, "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[0]}],\"scene\":0,"
                        "\"nodes\":[{\"name\":\"face\",\"mesh\":0}],\"materials\":[");
    for (uint32_t i = 0; i < f->part_count; i++) {
        const float *c = f->parts[i].color;
        buffer_print(&text,
                     "%s{\"name\":\"%s\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[%.9g,%.9g,%.9g,1],"
                     "\"metallicFactor\":0,\"roughnessFactor\":0.8}}",
                     i ? "," : "", f->parts[i].name, (double)c[0], (double)c[1], (double)c[2]);
    }
    buffer_print(&text, "],\"meshes\":[{\"name\":\"face\",\"extras\":{\"targetNames\":[");
    for (uint32_t t = 0; t < f->target_count; t++) buffer_print(&text, "%s\"%s\"", t ? "," : "", f->targets[t]);
    buffer_print(&text, "]},\"primitives\":[");
    buffer_append(&text, g->primitives.bytes, g->primitives.count);
    buffer_print(&text, "]}],\"accessors\":[");
    buffer_append(&text, g->accessors.bytes, g->accessors.count);
    buffer_print(&text, "],\"bufferViews\":[");
    buffer_append(&text, g->views.bytes, g->views.count);
    buffer_print(&text, "],\"buffers\":[{\"byteLength\":%zu}]}", g->bin.count);
    while (text.count % 4) buffer_print(&text, " ");
    return text;
}

static void append_word(byte_buffer *b, size_t word)
{
    const uint32_t narrow = (uint32_t)word;
    buffer_append(b, &narrow, sizeof narrow);
}

void face_files_glb(const face_files *f, face_form form, const char *path)
{
    glb g = { .view_count = 0 };
    byte_buffer out = { NULL, 0, 0, 0 }, text;
    if (form == FACE_SHARED)
        add_shared(&g, f);
    else
        add_own(&g, f, form == FACE_SPARSE);
    text = glb_text(f, &g);
    buffer_print(&out, "glTF");
    append_word(&out, 2);
    append_word(&out, 28u + text.count + g.bin.count);
    append_word(&out, text.count);
    buffer_print(&out, "JSON");
    buffer_append(&out, text.bytes, text.count);
    append_word(&out, g.bin.count);
    buffer_append(&out, "BIN", 4);
    buffer_append(&out, g.bin.bytes, g.bin.count);
    assert_false(out.failed);
    test_write_file(path, out.bytes, out.count);
    buffer_free(&text);
    buffer_free(&out);
    buffer_free(&g.bin);
    buffer_free(&g.views);
    buffer_free(&g.accessors);
    buffer_free(&g.primitives);
}
