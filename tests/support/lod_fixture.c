#include "lod_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/clips/model_clips.h"
#include "convert/model/model_build.h"
#include "convert/pack/pack_clips.h"

#define PI 3.14159265358979
#define RADIUS 0.1
#define EYE_COLUMNS 12u
#define EYE_ROWS 8u
#define GUARD 64u

/* ---- a face ---- */

const uint32_t lod_face_pairs[LOD_FACE_PAIRS][2] = { { 0, 1 }, { 2, 3 }, { 4, 5 }, { 7, 8 }, { 9, 10 } };

/* A target's bump: its place, radius and height, in radii of the sphere. */
typedef struct face_target {
    const char *name;
    double at[3], reach, height;
} face_target;

/* clang-format off */
static const face_target face_targets[LOD_FACE_TARGETS] = {
    { "smileLeft", { 0.5, -0.3, 0.8 }, 0.6, 0.2 },   { "smileRight", { -0.5, -0.3, 0.8 }, 0.6, 0.2 },
    { "blink.l", { 0.4, 0.3, 0.85 }, 0.35, -0.1 },   { "blink.r", { -0.4, 0.3, 0.85 }, 0.35, -0.1 },
    { "brow-left-up", { 0.4, 0.6, 0.7 }, 0.4, 0.12 },  { "brow-right-up", { -0.4, 0.6, 0.7 }, 0.4, 0.12 },
    { "jawOpen", { 0.0, -0.7, 0.7 }, 0.8, 0.3 },     { "cheekPuffLeft", { 0.7, -0.1, 0.7 }, 0.5, 0.25 },
    { "cheekPuffRight", { -0.7, -0.1, 0.7 }, 0.5, 0.25 }, { "sneerL", { 0.2, 0.1, 0.97 }, 0.3, 0.1 },
    { "sneerR", { -0.2, 0.1, 0.97 }, 0.3, 0.1 },     { "pucker", { 0.0, -0.3, 0.95 }, 0.45, 0.15 }
};
/* clang-format on */

static void allocate_face(model_mesh *mesh, const lod_face *face)
{
    const uint32_t eye = face->eye ? (EYE_COLUMNS + 1u) * (EYE_ROWS + 1u) : 0u;
    mesh->name = model_string("face");
    mesh->vertex_count = (face->columns + 1u) * (face->rows + 1u) + eye;
    mesh->target_count = face->targets;
    mesh->submesh_count = face->eye ? 2u : 1u;
    mesh->position = test_zeros(12u * (size_t)mesh->vertex_count);
    mesh->normal = test_zeros(12u * (size_t)mesh->vertex_count);
    mesh->tangent = test_zeros(16u * (size_t)mesh->vertex_count);
    mesh->uv = test_zeros(8u * (size_t)mesh->vertex_count);
    mesh->indices = test_zeros(24u * (face->columns * (size_t)face->rows + EYE_COLUMNS * EYE_ROWS));
    mesh->submeshes = test_zeros(sizeof *mesh->submeshes * 3u);
    mesh->targets = test_zeros(sizeof *mesh->targets * (face->targets + 1u));
    mesh->weights = test_zeros(sizeof *mesh->weights * (face->targets + 1u));
}

/* A ball's vertices from `first` on: rings from pole to pole, the seam and the poles doubled for their uv. */
static void add_ball(model_mesh *mesh, uint32_t first, uint32_t columns, uint32_t rows, double radius, double bumps)
{
    for (uint32_t i = 0; i < (columns + 1u) * (rows + 1u); i++) {
        const uint32_t x = i % (columns + 1u), y = i / (columns + 1u), v = first + i;
        const double turn = 2.0 * PI * (x % columns) / columns, fall = PI * y / rows,
                     around = y % rows ? sin(fall) : 0.0;
        const double n[3] = { around * sin(turn), cos(fall), around * cos(turn) };
        const double grown = radius * (1.0 + bumps * sin(7.0 * n[0] + 1.0) * sin(6.0 * n[1]) * cos(5.0 * n[2]));
        for (uint32_t c = 0; c < 3u; c++) {
            mesh->position[3u * v + c] = (float)(grown * n[c]);
            mesh->normal[3u * v + c] = (float)n[c];
        }
        mesh->tangent[4u * v] = (float)cos(turn);
        mesh->tangent[4u * v + 2u] = (float)-sin(turn);
        mesh->tangent[4u * v + 3u] = 1.0f;
        mesh->uv[2u * v] = (float)x / (float)columns;
        mesh->uv[2u * v + 1u] = (float)y / (float)rows + (first ? 2.0f : 0.0f);
    }
}

static void add_triangle(model_mesh *mesh, uint32_t a, uint32_t b, uint32_t c)
{
    uint32_t *to = mesh->indices + mesh->index_count;
    to[0] = a;
    to[1] = b;
    to[2] = c;
    mesh->index_count += 3u;
}

/* A ball's triangles, as the n-th submesh. */
static void add_ball_triangles(model_mesh *mesh, uint32_t n, uint32_t first, uint32_t columns, uint32_t rows)
{
    model_submesh *sub = &mesh->submeshes[n];
    sub->first_index = mesh->index_count;
    sub->material = n;
    sub->first_vertex = first;
    sub->vertex_count = (columns + 1u) * (rows + 1u);
    for (uint32_t i = 0; i < columns * rows; i++) {
        const uint32_t a = first + i / columns * (columns + 1u) + i % columns, below = a + columns + 1u;
        if (i / columns) {
            add_triangle(mesh, a, below, a + 1u);
        }
        if (i / columns + 1u < rows) {
            add_triangle(mesh, a + 1u, below, below + 1u);
        }
    }
    sub->index_count = mesh->index_count - sub->first_index;
}

/* How much a target moves a place: 1 at its centre, falling to 0 or, where it moves every vertex, to nearly 0. */
static double share_of(const face_target *t, const float *position, int everywhere)
{
    double squared = 0.0, rest;
    for (int c = 0; c < 3; c++) {
        const double d = position[c] / RADIUS - t->at[c];
        squared += d * d;
    }
    rest = 1.0 - squared / (t->reach * t->reach);
    return (rest > 0.0 ? rest * rest : 0.0) + (everywhere ? 0.1 : 0.0);
}

static void fill_face_target(model_mesh *mesh, uint32_t index, uint32_t moved_count, int everywhere)
{
    const face_target *from = &face_targets[index];
    model_target *to = &mesh->targets[index];
    to->name = model_string(from->name);
    to->position = test_zeros(12u * (size_t)mesh->vertex_count);
    to->normal = test_zeros(12u * (size_t)mesh->vertex_count);
    to->tangent = test_zeros(12u * (size_t)mesh->vertex_count);
    to->has_position = to->has_normal = to->has_tangent = 1;
    for (uint32_t v = 0; v < moved_count; v++) {
        const double share = share_of(from, mesh->position + 3u * v, everywhere);
        for (uint32_t c = 0; c < 3u; c++) {
            const double along = mesh->normal[3u * v + c] + (c == 1u ? 0.5 : 0.0); /* outwards and up */
            to->position[3u * v + c] = (float)(RADIUS * from->height * share * along);
            to->normal[3u * v + c] = (float)(c == 1u ? -0.4 * share : 0.1 * share);
            to->tangent[3u * v + c] = (float)(c == 1u ? 0.3 * share : 0.0);
        }
    }
}

static void add_face_materials(model *m)
{
    m->material_count = 2;
    m->materials = test_zeros(sizeof *m->materials * 2u);
    for (uint32_t i = 0; i < 2u; i++) {
        m->materials[i] = model_material_default();
        m->materials[i].name = model_string(i ? "cornea" : "skin");
        m->materials[i].base_color_texture = MODEL_NONE;
        m->materials[i].base_color[3] = 1.0f;
        m->materials[i].alpha = i ? MODEL_ALPHA_BLEND : MODEL_ALPHA_OPAQUE;
    }
}

model *lod_face_model(const lod_face *face)
{
    const uint32_t skin = (face->columns + 1u) * (face->rows + 1u);
    model *m = model_new();
    model_mesh *mesh;
    assert_non_null(m);
    m->mesh_count = 1;
    mesh = m->meshes = test_zeros(sizeof *m->meshes);
    allocate_face(mesh, face);
    add_face_materials(m);
    add_ball(mesh, 0, face->columns, face->rows, RADIUS, 0.06);
    add_ball_triangles(mesh, 0, 0, face->columns, face->rows);
    if (face->eye) {
        add_ball(mesh, skin, EYE_COLUMNS, EYE_ROWS, 0.3 * RADIUS, 0.0);
        add_ball_triangles(mesh, 1, skin, EYE_COLUMNS, EYE_ROWS);
    }
    for (uint32_t t = 0; t < face->targets; t++) {
        fill_face_target(mesh, t, face->everywhere ? mesh->vertex_count : skin, face->everywhere);
    }
    return m;
}

model *lod_drawn_face_model(const lod_face *face)
{
    model *m = lod_face_model(face);
    m->node_count = 1;
    m->nodes = test_zeros(sizeof *m->nodes);
    m->nodes[0].name = model_string("head");
    m->nodes[0].parent = m->nodes[0].skin = MODEL_NONE;
    m->nodes[0].rotation[3] = 1.0f;
    for (uint32_t i = 0; i < 3u; i++) m->nodes[0].scale[i] = 1.0f;
    for (uint32_t i = 0; i < 4u; i++) m->nodes[0].world[5u * i] = 1.0;
    return m;
}

/* ---- a tube ---- */

double lod_tube_half_angle(uint32_t joint, uint32_t frame)
{
    return 0.12 * sin(0.9 * frame + 1.3 * joint) * (frame ? 1.0 : 0.0);
}

static void bend(model_channel *c, uint32_t joint)
{
    c->node = joint;
    c->path = MODEL_PATH_ROTATION;
    c->interpolation = MODEL_LINEAR;
    c->key_count = LOD_TUBE_KEYS;
    c->width = 4;
    c->times = test_zeros(4u * LOD_TUBE_KEYS);
    c->values = test_zeros(16u * LOD_TUBE_KEYS);
    for (uint32_t k = 0; k < LOD_TUBE_KEYS; k++) {
        c->times[k] = (float)(k / LOD_TUBE_HZ);
        c->values[4u * k] = (float)sin(lod_tube_half_angle(joint, k));
        c->values[4u * k + 3u] = (float)cos(lod_tube_half_angle(joint, k));
    }
}

model *lod_tube_model(const skin_cylinder *tube)
{
    model *m = skin_cylinder_model(tube);
    model_clip *clip = m->clips = test_zeros(sizeof *m->clips);
    m->clip_count = 1;
    clip->name = model_string("bend");
    clip->channel_count = tube->joints;
    clip->channels = test_zeros(sizeof *clip->channels * tube->joints);
    clip->duration_s = (float)((LOD_TUBE_KEYS - 1u) / LOD_TUBE_HZ);
    for (uint32_t j = 0; j < tube->joints; j++) {
        bend(&clip->channels[j], j);
    }
    return m;
}

/* ---- packs ---- */

static void encode(model *m, const lod_settings *settings, mesh_levels *levels, morph_encoding **encodings)
{
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        morph_options options = { 0 };
        model_error error = { "", "" };
        if (mesh_levels_make(m, i, settings, &levels[i], &error)) {
            fail_msg("%s (%s)", error.what, error.where);
        }
        options.rank = levels[i].rank;
        options.level_count = levels[i].count;
        assert_int_equal(morph_encode(&m->meshes[i], &options, &encodings[i], &error), 0);
    }
}

void lod_pack_make(model *m, const lod_settings *settings, uint32_t palette, lod_pack *p)
{
    const skin_options skin = { .palette = palette };
    lod_pack_make_skinned(m, settings, &skin, p);
}

void lod_pack_make_skinned(model *m, const lod_settings *settings, const skin_options *skin, lod_pack *p)
{
    sample_options rate = { 0.0 };
    clips_settings clip_of;
    model_clips *made;
    encoded_clips encoded;
    morph_encoding **encodings;
    byte_buffer out = { NULL, 0, 0, 0 };
    model_error error = { "", "" };
    memset(p, 0, sizeof *p);
    memset(&clip_of, 0, sizeof clip_of);
    clip_of.skeletons_only = 1;
    if ((skin->rigid_faces && skins_of_faces(m)) || clips_from_model(m, &rate, &made, &error) ||
        skins_bind(m, made, skin, &error) || clips_encode(made->sets, made->set_count, &clip_of, &encoded, &error)) {
        fail_msg("%s (%s)", error.what, error.where);
    }
    p->mesh_count = m->mesh_count;
    p->levels = test_zeros(sizeof *p->levels * m->mesh_count);
    encodings = test_zeros(sizeof *encodings * m->mesh_count);
    encode(m, settings, p->levels, encodings);
    if (pack_write(m, p->levels, encodings, &encoded, &out, &error)) {
        fail_msg("%s (%s)", error.what, error.where);
    }
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        morph_encoding_free(encodings[i]);
    }
    free(encodings);
    clips_free(&encoded);
    model_clips_free(made);
    p->byte_count = out.count;
    p->bytes = test_aligned(out.bytes, out.count);
    buffer_free(&out);
    p->pack = test_open(p->bytes, p->byte_count);
    p->mesh = test_mesh(&p->pack, 0);
    p->from = &m->meshes[0];
}

void lod_pack_free(lod_pack *p)
{
    for (uint32_t i = 0; i < p->mesh_count; i++) {
        mesh_levels_free(&p->levels[i]);
    }
    free(p->levels);
    free(p->bytes);
    memset(p, 0, sizeof *p);
}

static int is_same_vertex(const model_mesh *from, uint32_t old, const noh_vertex *vertex)
{
    const float *uv = from->uv ? from->uv + 2u * (size_t)old : vertex->uv;
    return !memcmp(from->position + 3u * (size_t)old, vertex->position, sizeof vertex->position) &&
           fabsf(uv[0] - vertex->uv[0]) < 1e-3f && fabsf(uv[1] - vertex->uv[1]) < 1e-3f;
}

uint32_t *lod_pack_sources(const lod_pack *p)
{
    uint32_t *sources = test_zeros(sizeof *sources * p->mesh.header->vertex_count);
    for (uint32_t v = 0; v < p->mesh.header->vertex_count; v++) {
        noh_vertex vertex;
        noh_mesh_vertex(&p->mesh, v, &vertex);
        while (sources[v] < p->from->vertex_count && !is_same_vertex(p->from, sources[v], &vertex)) {
            sources[v]++;
        }
        assert_true(sources[v] < p->from->vertex_count);
    }
    return sources;
}

/* ---- layers ---- */

lod_layers lod_layers_make(const noh_mesh *mesh)
{
    lod_layers l = { { NULL, NULL, NULL }, NULL, noh_morph_layers_size(mesh) };
    l.block = test_aligned(NULL, l.bytes + 2u * GUARD);
    memset(l.block, 0xa5, l.bytes + 2u * GUARD);
    assert_int_equal(noh_morph_layers_init(l.block + GUARD, l.bytes, mesh, &l.layers, NULL), NOH_OK);
    return l;
}

void lod_layers_free(lod_layers *l)
{
    for (uint32_t i = 0; i < GUARD; i++) {
        assert_int_equal(l->block[i], 0xa5);
        assert_int_equal(l->block[GUARD + l->bytes + i], 0xa5);
    }
    free(l->block);
}
