/* files.c: readers of files that need a library without a package for other processors, or C++. Every call fails. Tests
 * that need one of them are left out (tests/cross_tests.sh); the converter's table of chunks links them into others. */
#define STBI_NO_STDIO
#include <stb/stb_image.h>

#include "convert/base/webp_file.h"
#include "convert/fbx/fbx_read.h"
#include "convert/model/model.h"

int stbi_info_from_memory(stbi_uc const *bytes, int count, int *width, int *height, int *channels)
{
    (void)bytes, (void)count, (void)width, (void)height, (void)channels;
    return 0;
}

int stbi_is_16_bit_from_memory(stbi_uc const *bytes, int count)
{
    (void)bytes, (void)count;
    return 0;
}

stbi_uc *stbi_load_from_memory(stbi_uc const *bytes, int count, int *width, int *height, int *channels, int wanted)
{
    (void)bytes, (void)count, (void)width, (void)height, (void)channels, (void)wanted;
    return NULL;
}

stbi_us *stbi_load_16_from_memory(stbi_uc const *bytes, int count, int *width, int *height, int *channels, int wanted)
{
    (void)bytes, (void)count, (void)width, (void)height, (void)channels, (void)wanted;
    return NULL;
}

const char *stbi_failure_reason(void)
{
    return "no decoder";
}

int webp_begins(const unsigned char *bytes, size_t count)
{
    (void)bytes, (void)count;
    return 0;
}

int webp_read(const unsigned char *bytes, size_t count, uint64_t pixels_max, uint32_t *width, uint32_t *height,
              unsigned char **rgba, model_error *error)
{
    (void)bytes, (void)count, (void)pixels_max, (void)width, (void)height, (void)rgba;
    return model_fail(error, "", "WebP is not read here");
}

int model_read_gltf_with(const char *path, const extra_list *extras, model **out, model_error *error)
{
    (void)extras, (void)out;
    return model_fail(error, path, "glTF is not read here");
}

int model_read_gltf(const char *path, model **out, model_error *error)
{
    return model_read_gltf_with(path, NULL, out, error);
}

int fbx_read(const char *path, const fbx_options *options, model **out, model_error *error)
{
    (void)options, (void)out;
    return model_fail(error, path, "FBX is not read here");
}
