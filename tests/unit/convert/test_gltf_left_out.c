/* test_gltf_left_out.c: what a glTF file has and a pack does not is said, once for each kind, with the first name and
 * a count; and nothing is said of a file that is read whole. */
#define _POSIX_C_SOURCE 200809L /* open_memstream */

#include "support/support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/convert.h"

#define PIXEL \
    "\"data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mP8z8DwHwAFAAH/e+m+7wAAAABJRU5ErkJggg==\""

/* A triangle with UVs (accessor 1), which may be read as any attribute of two floats; `primitive` and `rest` are JSON
 * from their comma on. */
static const char *save(const char *attributes, const char *primitive, const char *rest)
{
    static char json[8192];
    const float data[15] = { 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1 };
    int used = snprintf(
        json, sizeof json,
        "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"uri\":\"left_out.bin\",\"byteLength\":60}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},{\"buffer\":0,\"byteOffset\":36,\"byteLength\":24}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"
        "{\"bufferView\":1,\"componentType\":5126,\"count\":3,\"type\":\"VEC2\"}],"
        "\"meshes\":[{\"name\":\"m\",\"primitives\":[{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1%s}%s}]}]%s}",
        attributes, primitive, rest);
    assert_true(used > 0 && (size_t)used < sizeof json);
    test_write_file(test_path("left_out.bin"), data, sizeof data);
    test_write_file(test_path("left_out.gltf"), json, (size_t)used);
    test_keep_glb_seed(json, data, sizeof data);
    return test_path("left_out.gltf");
}

static model *load(const char *attributes, const char *primitive, const char *rest)
{
    model *m = NULL;
    model_error error = { "", "" };
    if (model_read_gltf(save(attributes, primitive, rest), &m, &error)) {
        fail_msg("refused: %s (%s)", error.what, error.where);
    }
    return m;
}

/* These warnings and no others, in any order. */
static void expect(const char *attributes, const char *primitive, const char *rest, const char *const *warnings,
                   uint32_t count)
{
    model *m = load(attributes, primitive, rest);
    for (uint32_t i = 0; i < count; i++) {
        int found = 0;
        for (uint32_t k = 0; k < m->warning_count; k++) {
            found += strcmp(m->warnings[k], warnings[i]) == 0;
        }
        if (found != 1) {
            fail_msg("'%s' was said %d times; the first of %u warnings is '%s'", warnings[i], found, m->warning_count,
                     m->warning_count ? m->warnings[0] : "");
        }
    }
    assert_int_equal(m->warning_count, count);
    model_free(m);
}
#define EXPECT(attributes, primitive, rest, ...)                                             \
    do {                                                                                     \
        static const char *const warnings[] = { __VA_ARGS__ };                               \
        expect(attributes, primitive, rest, warnings, sizeof warnings / sizeof warnings[0]); \
    } while (0)

#define ONE_TEXTURE ",\"textures\":[{\"source\":0}],\"images\":[{\"uri\":" PIXEL "}]"

static void a_file_that_is_read_whole_is_silent(void **state)
{
    (void)state;
    expect(
        "", ",\"material\":0",
        ",\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}},\"extensions\":{\"KHR_materials_unlit\":{}},"
        "\"emissiveFactor\":[0,0,0]}],\"extensionsUsed\":[\"KHR_materials_unlit\"],"
        "\"nodes\":[{\"mesh\":0}],\"scenes\":[{\"nodes\":[0]}]" ONE_TEXTURE,
        NULL, 0);
}

static void textures_of_a_material(void **state)
{
    (void)state;
    /* all share one set of texture coordinates, with one transform */
    expect(
        "", ",\"material\":1",
        ",\"materials\":[{\"name\":\"skin\",\"normalTexture\":{\"index\":0},\"occlusionTexture\":{\"index\":0},"
        "\"emissiveTexture\":{\"index\":0},\"emissiveFactor\":[1,1,1],"
        "\"pbrMetallicRoughness\":{\"metallicRoughnessTexture\":{\"index\":0}}},"
        "{\"name\":\"cloth\",\"normalTexture\":{\"index\":0}},{\"normalTexture\":{\"index\":0},\"emissiveFactor\":[0,0.5,0]}]" ONE_TEXTURE,
        NULL, 0);
    EXPECT("", ",\"material\":0",
           ",\"materials\":[{\"name\":\"skin\",\"normalTexture\":{\"index\":0,\"texCoord\":1},"
           "\"occlusionTexture\":{\"index\":0,\"extensions\":{\"KHR_texture_transform\":{\"scale\":[2,2]}}},"
           "\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}},"
           "\"extensions\":{\"KHR_materials_specular\":{\"specularFactor\":0.5,\"specularTexture\":{\"index\":0,"
           "\"texCoord\":1}}}}],"
           "\"extensionsUsed\":[\"KHR_texture_transform\"]" ONE_TEXTURE,
           "material 'skin': the normal texture was left out: its texture coordinates or their transform differ "
           "from the material's other textures",
           "material 'skin': the occlusion texture was left out: its texture coordinates or their transform differ "
           "from the material's other textures",
           "material 'skin': the specular texture was left out: its texture coordinates or their transform differ "
           "from the material's other textures");
}

/* An extension is named once, with what carries it first, whether "extensionsUsed" lists it or not. */
static void extensions(void **state)
{
    (void)state;
    EXPECT(
        "", "",
        ",\"materials\":[{\"name\":\"glass\",\"extensions\":{\"KHR_materials_transmission\":{},\"KHR_materials_sheen\":{}}},"
        "{\"name\":\"ice\",\"extensions\":{\"KHR_materials_sheen\":{\"extensions\":{\"IGNORED\":{}}}}}],"
        "\"nodes\":[{\"mesh\":0},{\"name\":\"sun\",\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}},"
        "\"extras\":{\"extensions\":{\"NOT_ONE\":{}}}}],\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"point\"}]}},"
        "\"extensionsUsed\":[\"KHR_materials_sheen\",\"KHR_lights_punctual\",\"EXT_nowhere\"]",
        "material 'glass': the extension KHR_materials_transmission is not supported and was ignored",
        "material 'glass': the extension KHR_materials_sheen is not supported and was ignored (and 1 more like it)",
        "node 'sun': the extension KHR_lights_punctual is not supported and was ignored",
        "the extension EXT_nowhere is not supported and was ignored");
}

static void further_uvs_and_colours(void **state)
{
    (void)state;
    EXPECT(",\"TEXCOORD_1\":1,\"COLOR_1\":0,\"_HEAT\":0", "", "",
           "mesh 'm' primitive 0: the attribute TEXCOORD_1 was left out; --attributes keeps it",
           "mesh 'm' primitive 0: the attribute COLOR_1 was left out",
           "mesh 'm' primitive 0: the attribute _HEAT was left out; --attributes keeps it");
    EXPECT(
        "", ",\"targets\":[{\"POSITION\":0,\"COLOR_0\":0},{\"POSITION\":0,\"_HEAT\":0}]", "",
        "mesh 'm' primitive 0 target 0: the deltas of COLOR_0 were ignored: noh build --color-map makes colours that "
        "fade in",
        "mesh 'm' primitive 0 target 1: the deltas of _HEAT were ignored which cannot be morphed");
    /* the set that the texture uses is the one that is kept */
    EXPECT(
        ",\"TEXCOORD_1\":1", ",\"material\":0",
        ",\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0,\"texCoord\":1}}}]" ONE_TEXTURE,
        "mesh 'm' primitive 0: the attribute TEXCOORD_0 was left out; --attributes keeps it");
    EXPECT(
        "", ",\"material\":0",
        ",\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0,\"texCoord\":3}}}]" ONE_TEXTURE,
        "mesh 'm' primitive 0: it lacks the UV set that its texture uses; TEXCOORD_0 was used");
}

static void samplers(void **state)
{
    (void)state;
    const char *rest = ",\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}}],"
                       "\"textures\":[{\"source\":0,\"sampler\":0}],\"images\":[{\"uri\":" PIXEL
                       "}],\"samplers\":[{%s}]";
    char json[1024];
    snprintf(json, sizeof json, rest, "\"magFilter\":9729,\"minFilter\":9728");
    EXPECT("", ",\"material\":0", json, "sampler 0: 'minFilter' was ignored: a pack filters as 'magFilter' says");
    snprintf(json, sizeof json, rest, "\"magFilter\":9728,\"minFilter\":9728,\"wrapS\":33071,\"wrapT\":33648");
    expect("", ",\"material\":0", json, NULL, 0);
}

static void cameras_and_other_scenes(void **state)
{
    (void)state;
    EXPECT("", "",
           ",\"cameras\":[{\"name\":\"close\",\"type\":\"perspective\",\"perspective\":{\"yfov\":1,\"znear\":1}},"
           "{\"type\":\"perspective\",\"perspective\":{\"yfov\":1,\"znear\":1}}],"
           "\"nodes\":[{\"mesh\":0,\"camera\":0},{\"name\":\"table\",\"mesh\":0},{\"mesh\":0}],"
           "\"scenes\":[{\"nodes\":[0]},{\"nodes\":[1,2]}]",
           "camera 'close': cameras are not kept (and 1 more like it)",
           "node 'table' was left out: it is not in the default scene (and 1 more like it)");
}

/* A hundred nodes with lights are one warning, and do not hide the camera's warning. */
static void many_are_one(void **state)
{
    (void)state;
    char json[4096];
    size_t used = 0;
    used += (size_t)snprintf(
        json, sizeof json,
        ",\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":1,\"znear\":1}}],\"nodes\":[{\"mesh\":0}");
    for (int i = 0; i < 100; i++) {
        used += (size_t)snprintf(json + used, sizeof json - used, ",{\"extensions\":{\"X\":{}}}");
    }
    snprintf(json + used, sizeof json - used, "]");
    EXPECT("", "", json, "node 1: the extension X is not supported and was ignored (and 99 more like it)",
           "camera 'camera_0': cameras are not kept");
}

/* Warnings are part of the report: a quiet build prints none, and both build the same pack. */
static void warnings_go_to_the_report(void **state)
{
    (void)state;
    char *said = NULL;
    size_t length = 0;
    byte_buffer packs[2];
    const char *path = save(
        "", ",\"material\":0",
        ",\"materials\":[{\"name\":\"skin\",\"extensions\":{\"KHR_materials_sheen\":{}}}]" ONE_TEXTURE);
    for (int quiet = 0; quiet < 2; quiet++) {
        convert_options options;
        convert_failure failure;
        memset(&options, 0, sizeof options);
        memset(&packs[quiet], 0, sizeof packs[quiet]);
        options.morph.error_um = 10.0f;
        options.source.unit_cm = 1.0;
        options.clip.clip.error_cm = 0.01;
        options.clip.clip.shell_cm = 3.0;
        options.source.skin.influences = 8;
        options.source.skin.palette = 256;
        options.report = quiet ? NULL : open_memstream(&said, &length);
        if (convert_files(&path, 1, &options, &packs[quiet], &failure)) {
            fail_msg("%s (%s)", failure.error.what, failure.error.where);
        }
        if (options.report) {
            fclose(options.report);
        }
    }
    assert_non_null(
        strstr(said, "warning: material 'skin': the extension KHR_materials_sheen is not supported and was ignored\n"));
    assert_true(packs[0].count == packs[1].count && memcmp(packs[0].bytes, packs[1].bytes, packs[0].count) == 0);
    buffer_free(&packs[0]);
    buffer_free(&packs[1]);
    free(said);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_file_that_is_read_whole_is_silent),
    cmocka_unit_test(textures_of_a_material),
    cmocka_unit_test(extensions),
    cmocka_unit_test(further_uvs_and_colours),
    cmocka_unit_test(samplers),
    cmocka_unit_test(cameras_and_other_scenes),
    cmocka_unit_test(many_are_one),
    cmocka_unit_test(warnings_go_to_the_report),
};

TEST_MAIN(tests, NULL, NULL)
