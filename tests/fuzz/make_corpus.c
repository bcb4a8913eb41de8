/* make_corpus.c: the fuzzers' seeds: small packs of every shape, small clips, and wire forms of some packs, each in a
 * folder. */
#include "support/support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "platform.h"

#include "convert/convert.h"
#include "convert/light/pack_transfer.h"
#include "convert/model/model_build.h"
#include "convert/model/model_extra.h"
#include "convert/pack/pack_strip.h"
#include "convert/pack/pack_wire.h"
#include "support/graph_fixture.h"
#include "support/lod_fixture.h"
#include "support/clip_bank_fixture.h"
#include "support/skin_asset.h"
#include "support/clip_fixture.h"
#include "support/springs_fixture.h"

static void write_pack(const char *folder, const char *name, const test_model_desc *desc)
{
    char path[4096];
    size_t count;
    uint8_t *bytes = test_pack(desc, &count);
    snprintf(path, sizeof path, "%s/%s.noh", folder, name);
    test_write_file(path, bytes, count);
    free(bytes);
}

/* A skeleton and a clip, from a .bvh; with a ragdoll of two bodies and a haircut, or without. */
static void write_clip_pack(const char *folder, const char *name, const char *ragdoll, const char *hair,
                            const char *match)
{
    static const char bvh[] =
        "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
        "JOINT b\n{\nOFFSET 0 -9 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{\nOFFSET 0 -9 0\n}\n}\n}\nMOTION\n"
        "Frames: 4\nFrame Time: 0.05\n0 20 0 0 0 0 0 0 0\n1 20 0 5 0 0 10 0 0\n2 21 0 10 0 0 25 0 0\n3 20 0 5 0 0 10 3 0\n";
    const char *input = test_path("clip.bvh");
    char path[4096];
    convert_options options;
    convert_failure failure;
    byte_buffer out = { NULL, 0, 0, 0 };
    memset(&options, 0, sizeof options);
    test_write_file(input, bvh, sizeof bvh - 1);
    if (ragdoll) {
        options.texts[NOH_CHUNK_RAGDOLL] = test_path("two.ragdoll");
        test_write_file(options.texts[NOH_CHUNK_RAGDOLL], ragdoll, strlen(ragdoll));
    }
    if (hair) {
        options.texts[NOH_CHUNK_HAIR] = test_path("short.hair");
        test_write_file(options.texts[NOH_CHUNK_HAIR], hair, strlen(hair));
    }
    if (match) {
        options.texts[NOH_CHUNK_MATCH] = test_path("all.match");
        test_write_file(options.texts[NOH_CHUNK_MATCH], match, strlen(match));
    }
    assert_int_equal(convert_files(&input, 1, &options, &out, &failure), 0);
    snprintf(path, sizeof path, "%s/%s.noh", folder, name);
    test_write_file(path, out.bytes, out.count);
    buffer_free(&out);
}

/* Springs: three chains, one of them attached to another, and a collider. */
static void write_springs(const char *in)
{
    size_t count = 0;
    uint8_t *bytes = springs_fixture_pack(&count);
    char path[4096];
    snprintf(path, sizeof path, "%s/springs.noh", in);
    test_write_file(path, bytes, count);
    free(bytes);
}

/* Textures of each format in blocks. */
static void write_blocks(const char *in)
{
    const test_model_desc desc = { 1, 2, 0, TEST_UVS, 8 };
    model *m = test_model(&desc);
    char path[4096];
    size_t count;
    m->textures = test_zeros(4 * sizeof *m->textures);
    m->texture_count = 4;
    for (uint32_t t = 0; t < 4; t++) {
        model_texture *to = &m->textures[t];
        to->name = model_string("blocks");
        to->width = 6;
        to->height = 5;
        to->rgba = test_zeros(6 * 5 * 4);
        for (uint32_t i = 0; i < 6 * 5 * 4; i++) to->rgba[i] = (uint8_t)(128u + (i * (t + 1u)) % 7u);
        to->use = t < 3 ? (model_texture_use)t : MODEL_TEXTURE_COLOR;
        to->blocks = MODEL_BLOCKS_ETC2;
        to->with_alpha = 1;
        if (t < 3) continue;
        to->cut_alone = 1;
        to->alpha_cutoff = 0.5f;
        for (uint32_t i = 0; i < 6 * 5; i++) to->rgba[4 * i + 3] = i % 6 < 3 ? 255 : 0;
    }
    uint8_t *bytes = test_pack_of(m, &count, NULL);
    snprintf(path, sizeof path, "%s/blocks.noh", in);
    test_write_file(path, bytes, count);
    free(bytes);
    model_free(m);
}

/* Weights, a joint, callback keys and sync markers. */
static void write_weights(const char *folder)
{
    model *m = clip_model(2);
    char path[4096];
    size_t count;
    uint8_t *bytes = test_pack_of(m, &count, NULL);
    snprintf(path, sizeof path, "%s/weights.noh", folder);
    test_write_file(path, bytes, count);
    free(bytes);
    model_free(m);
}

/* A skinned tube, whole or split into palettes. */
static void write_skin(const char *folder, const char *name, uint32_t palette)
{
    const skin_cylinder tube = { 3, 6, 9, 2, 1, 1, 1.0f, 0.5f };
    model *m = skin_cylinder_model(&tube);
    char path[4096];
    skin_options options;
    uint8_t *bytes;
    size_t count;
    memset(&options, 0, sizeof options);
    options.palette = palette;
    bytes = skin_pack_of(m, &options, 10.0f, &count, NULL);
    snprintf(path, sizeof path, "%s/%s.noh", folder, name);
    test_write_file(path, bytes, count);
    free(bytes);
    model_free(m);
}

/* Three LOD levels; the model is freed. */
static void write_levels(const char *folder, const char *name, model *m, uint32_t palette)
{
    const lod_settings three = { 3, 0, LOD_FAST, 0.0f, 0.0f, NULL, 0 };
    char path[4096];
    lod_pack p;
    lod_pack_make(m, &three, palette, &p);
    assert_int_equal(p.mesh.header->level_count, 3);
    snprintf(path, sizeof path, "%s/%s.noh", folder, name);
    test_write_file(path, p.bytes, p.byte_count);
    lod_pack_free(&p);
    model_free(m);
}

/* A face whose coarsest level has virtual joints. */
static void write_far_joints(const char *in)
{
    const lod_settings settings = { 3, 0, LOD_FAST, 0.0f, 0.0f, NULL, 2 };
    const skin_options skin = { .rigid_faces = 1 };
    const lod_face face = { 22, 16, 7, 0, 0 };
    model *m = lod_drawn_face_model(&face);
    char path[4096];
    lod_pack p;
    lod_pack_make_skinned(m, &settings, &skin, &p);
    assert_non_null(p.mesh.far_joints);
    snprintf(path, sizeof path, "%s/far_joints.noh", in);
    test_write_file(path, p.bytes, p.byte_count);
    lod_pack_free(&p);
    model_free(m);
}

/* Clips and an animation graph with every kind of node. */
static void write_graph(const char *folder)
{
    const set_fixture x = graph_fixture_pack(GRAPH_FIXTURE_TEXT);
    char path[4096];
    snprintf(path, sizeof path, "%s/graph.noh", folder);
    test_write_file(path, x.bytes, x.pack.byte_count);
    free(x.bytes);
}

/* LOD levels and a transfer. */
static void write_transfer(const char *folder)
{
    const lod_face face = { 12, 10, 2, 0, 0 };
    const lod_settings two = { 2, 0, LOD_FAST, 0.0f, 0.0f, NULL, 0 };
    const transfer_settings settings = { 4, 0, NULL, 0 };
    byte_buffer out = { NULL, 0, 0, 0 };
    model *m = lod_face_model(&face);
    model_error error;
    char path[4096];
    lod_pack p;
    lod_pack_make(m, &two, 0, &p);
    assert_int_equal(pack_transfer(&p.pack, &settings, &out, &error), 0);
    snprintf(path, sizeof path, "%s/transfer.noh", folder);
    test_write_file(path, out.bytes, out.count);
    buffer_free(&out);
    lod_pack_free(&p);
    model_free(m);
}

/* A face with levels, whose vertices have extra attributes in halves and bytes. */
static void write_extras(const char *folder)
{
    const lod_face face = { 8, 6, 2, 0, 0 };
    const lod_settings two = { .level_count = 2, .mode = LOD_FAST };
    model *m = lod_face_model(&face);
    model_mesh *mesh = &m->meshes[0];
    model_error error;
    char path[4096];
    lod_pack p;
    assert_int_equal(extras_parse("TEXCOORD_1,_MASK:8,_NONE", &m->extras, &error), 0);
    mesh->extra = test_zeros(sizeof *mesh->extra * 4u * NOH_EXTRAS_MAX * mesh->vertex_count);
    mesh->extras[0].width = 2;
    mesh->extras[1].width = 3;
    for (uint32_t i = 0; i < 4u * NOH_EXTRAS_MAX * mesh->vertex_count; i++) mesh->extra[i] = (float)(i % 97u) / 7.0f;
    lod_pack_make(m, &two, 0, &p);
    snprintf(path, sizeof path, "%s/extras.noh", folder);
    test_write_file(path, p.bytes, p.byte_count);
    lod_pack_free(&p);
    model_free(m);
}

/* A terrain of 3 x 2 heights, and nothing else. */
static void write_terrain(const char *in)
{
    static const uint8_t png[] = { 0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48,
                                   0x44, 0x52, 0x00, 0x00, 0x00, 0x03, 0x00, 0x00, 0x00, 0x02, 0x10, 0x00, 0x00, 0x00,
                                   0x00, 0xe8, 0x8f, 0xe5, 0x85, 0x00, 0x00, 0x00, 0x16, 0x49, 0x44, 0x41, 0x54, 0x78,
                                   0xda, 0x63, 0x60, 0x60, 0x28, 0x35, 0xf8, 0xff, 0x9f, 0x81, 0xf9, 0x05, 0xfb, 0x85,
                                   0x39, 0x0e, 0x00, 0x20, 0x82, 0x05, 0x42, 0xa0, 0xdf, 0x35, 0xa5, 0x00, 0x00, 0x00,
                                   0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82 };
    char path[4096];
    convert_options options;
    convert_failure failure;
    byte_buffer out = { NULL, 0, 0, 0 };
    memset(&options, 0, sizeof options);
    options.texts[NOH_CHUNK_TERRAIN] = test_path("hill.png");
    test_write_file(options.texts[NOH_CHUNK_TERRAIN], png, sizeof png);
    assert_int_equal(convert_files(NULL, 0, &options, &out, &failure), 0);
    snprintf(path, sizeof path, "%s/terrain.noh", in);
    test_write_file(path, out.bytes, out.count);
    buffer_free(&out);
}

/* A sleeve around a tube that was written before, and what it hides of the tube's levels. */
static void write_cover(const char *in, const char *wearer)
{
    const char *input = test_path("sleeve.obj");
    FILE *sleeve = fopen(input, "w");
    char path[4096], worn[4096];
    convert_options options;
    convert_failure failure;
    byte_buffer out = { NULL, 0, 0, 0 };
    noh_file file;
    noh_error error;
    noh_pack pack;
    noh_mesh mesh;
    assert_non_null(sleeve);
    snprintf(worn, sizeof worn, "%s/%s.noh", in, wearer);
    assert_int_equal(noh_file_map(worn, &file, &error), NOH_OK);
    pack = test_open(file.data, file.bytes);
    mesh = test_mesh(&pack, 0);
    for (uint32_t i = 0; i < mesh.header->vertex_count; i++) {
        noh_vertex v;
        noh_mesh_vertex(&mesh, i, &v);
        for (int k = 0; k < 3; k++) v.position[k] += 0.01f * v.normal[k];
        fprintf(sleeve, "v %f %f %f\n", v.position[0], v.position[1], v.position[2]);
    }
    for (uint32_t i = 0; i + 2u < mesh.header->index_count; i += 3)
        fprintf(sleeve, "f %u %u %u\n", 1u + noh_mesh_index(&mesh, i), 1u + noh_mesh_index(&mesh, i + 1u),
                1u + noh_mesh_index(&mesh, i + 2u));
    fclose(sleeve);
    noh_file_unmap(&file);
    memset(&options, 0, sizeof options);
    options.texts[NOH_CHUNK_COVER] = worn;
    assert_int_equal(convert_files(&input, 1, &options, &out, &failure), 0);
    pack = test_open(out.bytes, out.count);
    assert_int_equal(pack.runs[NOH_CHUNK_COVER].count, 1);
    snprintf(path, sizeof path, "%s/cover.noh", in);
    test_write_file(path, out.bytes, out.count);
    buffer_free(&out);
}

static const char *folder, *clip_folder, *wire_folder;

/* Encode a clip, take it, and write its bytes. */
static void write_clip(const char *name, raw_set *set, const clip_options *options)
{
    char path[4096];
    fixture x;
    const char *failed = fixture_build(&x, set, options, 2);
    if (failed) fail_msg("%s: %s", name, failed);
    snprintf(path, sizeof path, "%s/%s.clip", clip_folder, name);
    test_write_file(path, x.blob.bytes, x.blob.count);
    fixture_free(&x);
}

/* Spins too fast for components, which makes raw and wild tracks; and a scale that changes. */
static raw_set *spinning(void)
{
    raw_set *set = fixture_swing(4, 60, 1, 15.0f, 0.4, 0.5);
    for (uint32_t f = 0; f < 60u; f++) {
        fixture_axis_angle(fixture_rotation(&set->clips[0], f, 2), 0.2, 1.0, 0.3, 0.4 * (double)f);
        fixture_axis_angle(fixture_rotation(&set->clips[0], f, 3), 1.0, 0.1, 0.3, 3.1 * (double)f);
        fixture_scale(&set->clips[0], f, 1)[0] = (float)(1.0 + 0.3 * sin(0.2 * (double)f));
    }
    return set;
}

static raw_set *shaking(void)
{
    raw_set *set = fixture_swing(4, 70, 2, 10.0f, 0.1, 0.0);
    fixture_shake(&set->clips[0], 0.02);
    return set;
}

static raw_set *with_weights(void)
{
    raw_set *set = fixture_swing(2, 30, 1, 10.0f, 0.5, 0.5);
    raw_clip *c = &set->clips[0];
    c->floats = calloc(1, sizeof *c->floats);
    c->float_count = 1;
    assert_int_equal(raw_floats_alloc(&c->floats[0], 30, 5), 0);
    for (uint32_t i = 0; i < 150u; i++) c->floats[0].values[i] = (float)(0.5 + 0.5 * sin(0.07 * (double)i));
    return set;
}

static void clips(void **state)
{
    clip_options open, split;
    (void)state;
    memset(&open, 0, sizeof open);
    open.open_loop = 1;
    memset(&split, 0, sizeof split);
    split.split_hz = 1.0;
    write_clip("still", fixture_still(3, 4, 1, 10.0f, 30.0), NULL);
    write_clip("short", fixture_swing(3, 12, 1, 10.0f, 0.6, 0.5), NULL);
    write_clip("segments", fixture_swing(6, 100, 2, 10.0f, 0.6, 0.5), NULL);
    write_clip("split", shaking(), &split);
    write_clip("wide", fixture_swing(3, 20, 1, 3000.0f, 0.5, 10.0), NULL);
    write_clip("spinning", spinning(), NULL);
    write_clip("weights", with_weights(), NULL);
    write_clip("open", fixture_swing(4, 20, 1, 10.0f, 0.6, 0.5), &open);
}

/* The wire form of a seed, after a pack of its coarsest level where it has several. */
static void write_wire(const char *name)
{
    static const wire_steps exact = { NULL, 32767, 65535, 0 };
    const char *item = "7";
    const strip_levels levels = { &item, 1 };
    byte_buffer out = { NULL, 0, 0, 0 }, coarse = { NULL, 0, 0, 0 };
    uint32_t first[8] = { 0 }, count = 1;
    noh_file file;
    noh_error failed;
    noh_pack packs[2];
    wire_report report;
    model_error error;
    char path[4096];
    snprintf(path, sizeof path, "%s/%s.noh", folder, name);
    assert_int_equal(noh_file_map(path, &file, &failed), NOH_OK);
    packs[0] = test_open(file.data, file.bytes);
    if (test_mesh(&packs[0], 0).header->level_count > 1u) {
        packs[count++] = packs[0];
        assert_int_equal(strip_levels_of(&levels, &packs[1], first, &error), 0);
        assert_int_equal(pack_strip(&packs[1], first, &coarse, &error), 0);
        packs[0] = test_open(coarse.bytes, coarse.count);
    }
    assert_int_equal(pack_wire(packs, count, &exact, &out, &report, &error), 0);
    snprintf(path, sizeof path, "%s/%s.nohz", wire_folder, name);
    test_write_file(path, out.bytes, out.count);
    buffer_free(&out);
    buffer_free(&coarse);
    noh_file_unmap(&file);
}

static void wires(void **state)
{
    (void)state;
    write_wire("scene");
    write_wire("skin_split");
    write_wire("levels");
    write_wire("blocks");
}

static void corpus(void **state)
{
    static const struct {
        const char *name;
        test_model_desc desc;
    } seeds[] = { { "bare", { 1, 2, 0, 0, 1 } },
                  { "targets", { 1, 4, 3, 0, 2 } },
                  { "attributes", { 1, 4, 2, TEST_TANGENTS | TEST_UVS | TEST_COLORS, 3 } },
                  { "scene", { 1, 4, 3, TEST_TANGENTS | TEST_UVS | TEST_COLORS | TEST_SCENE, 4 } },
                  { "scene_without_targets", { 1, 3, 0, TEST_SCENE, 5 } },
                  { "two_meshes", { 2, 3, 2, TEST_SCENE, 6 } },
                  { "many_targets", { 1, 5, 20, TEST_COLORS, 7 } } };
    const lod_face face = { 12, 10, 2, 0, 0 }, all_touched = { 12, 10, 2, 0, 1 };
    const skin_cylinder tube = { 4, 12, 8, 2, 2, 0, 2.0f, 0.5f };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(seeds); i++) {
        write_pack(folder, seeds[i].name, &seeds[i].desc);
    }
    write_clip_pack(folder, "clip", NULL, NULL, NULL);
    write_clip_pack(folder, "ragdoll", "a\nb forward bend -20 95 side 40 twist 30 friction 5\n", NULL, NULL);
    write_clip_pack(folder, "hair", NULL,
                    "skull 0 0 0  0.1 0.12 0.1\naround 3\nrows 2\npoints 3\nstrips 20\nsegments 4\n", NULL);
    write_clip_pack(folder, "match", NULL, NULL, "rows 60\nfeet b a\nclip *\nclip clip low\n");
    write_springs(folder);
    write_weights(folder);
    write_blocks(folder);
    write_graph(folder);
    write_transfer(folder);
    write_extras(folder);
    write_terrain(folder);
    write_skin(folder, "skin", 0);
    write_skin(folder, "skin_split", 4);
    write_levels(folder, "levels", lod_face_model(&face), 0);
    write_levels(folder, "levels_all_touched", lod_face_model(&all_touched), 0);
    write_levels(folder, "levels_skin", lod_tube_model(&tube), 0);
    write_levels(folder, "levels_split", lod_tube_model(&tube), 6);
    write_far_joints(folder);
    write_cover(folder, "levels_skin");
}

int main(int argument_count, char **arguments)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(corpus), cmocka_unit_test(clips), cmocka_unit_test(wires) };
    if (argument_count != 4) {
        fprintf(stderr, "usage: make_corpus FOLDER FOLDER_OF_CLIPS FOLDER_OF_WIRE_FORMS\n");
        return 2;
    }
    folder = arguments[1];
    clip_folder = arguments[2];
    wire_folder = arguments[3];
    return cmocka_run_group_tests(tests, NULL, NULL);
}
