#include "png_file.h"

#include <stdlib.h>
#include <string.h>

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#include <stb/stb_image_write.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

#include "cli/message.h"
#include "platform.h"

typedef struct png_bytes {
    uint8_t *bytes;
    size_t count;
    int failed;
} png_bytes;

static void png_append(void *context, void *data, int size)
{
    png_bytes *png = (png_bytes *)context;
    uint8_t *grown = realloc(png->bytes, png->count + (size_t)size);
    if (!grown) {
        png->failed = 1;
        return;
    }
    memcpy(grown + png->count, data, (size_t)size);
    png->bytes = grown;
    png->count += (size_t)size;
}

int tool_write_png(const char *path, uint32_t width, uint32_t height, const uint8_t *rgba)
{
    png_bytes png = { NULL, 0, 0 };
    noh_error error = { NOH_OK, "", 0, 0 };
    int written = stbi_write_png_to_func(png_append, &png, (int)width, (int)height, 4, rgba, (int)width * 4);
    int status = 0;
    if (!written || png.failed) {
        status = tool_fail(path, "out of memory while compressing the picture");
    } else if (noh_file_write(path, png.bytes, png.count, &error)) {
        status = tool_fail(path, "cannot write: %s", error.what);
    }
    free(png.bytes);
    return status;
}
