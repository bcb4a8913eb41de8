#include "image_whole.h"

#include <stdint.h>
#include <string.h>

static int is_cut(const char *format, size_t count, const char *what, size_t at, model_error *error)
{
    return model_fail(error, "",
                      "the %s file ends at byte %zu, in %s at byte %zu: it was cut off; save or copy it again", format,
                      count, what, at);
}

/* ---- PNG ---- */

static int png_is_cut(const unsigned char *bytes, size_t count, model_error *error)
{
    size_t at = 8;
    int pixels = 0;
    for (;;) {
        const unsigned char *c = bytes + at;
        if (count - at < 12) return is_cut("PNG", count, "the chunk", at, error);
        const uint32_t length = (uint32_t)c[0] << 24 | (uint32_t)c[1] << 16 | (uint32_t)c[2] << 8 | c[3];
        if (count - at - 12 < length) {
            return is_cut("PNG", count, memcmp(c + 4, "IDAT", 4) == 0 ? "the pixels" : "the chunk", at, error);
        }
        if (memcmp(c + 4, "IEND", 4) == 0) break;
        pixels |= memcmp(c + 4, "IDAT", 4) == 0;
        at += 12u + length;
    }
    return pixels ? 0 : model_fail(error, "", "the PNG file has no pixels, only a header: save or copy it again");
}

/* ---- JPEG ---- */

/* Where a scan's coded data ends: at the next marker but stuffed bytes and restarts. `count`: it does not. */
static size_t end_of_scan(const unsigned char *bytes, size_t count, size_t at)
{
    for (; at + 1 < count; at++) {
        if (bytes[at] == 0xff && bytes[at + 1] && bytes[at + 1] != 0xff && (bytes[at + 1] & 0xf8u) != 0xd0u) return at;
    }
    return count;
}

static int jpeg_is_cut(const unsigned char *bytes, size_t count, model_error *error)
{
    size_t at = 2;
    int scans = 0, frames = 0;
    for (;;) {
        while (at > 2 && at < count && bytes[at] != 0xff && !frames) at++;         /* padding */
        while (at + 1 < count && bytes[at] == 0xff && bytes[at + 1] == 0xff) at++; /* fill bytes */
        if (count - at < 2) return is_cut("JPEG", count, "the segment", at, error);
        if (bytes[at] != 0xff)
            return model_fail(error, "", "the JPEG file is damaged at byte %zu, where no segment begins: save it again",
                              at);
        if (bytes[at + 1] == 0xd9) break;
        if (count - at < 4) return is_cut("JPEG", count, "the segment", at, error);
        const size_t begin = at, length = (size_t)bytes[at + 2] << 8 | bytes[at + 3];
        if (count - at - 2 < length || length < 2) return is_cut("JPEG", count, "the segment", at, error);
        at += 2 + length;
        frames |= (bytes[begin + 1] & 0xfcu) == 0xc0u;
        if (bytes[begin + 1] != 0xda) continue;
        if (at == count) return is_cut("JPEG", count, "the pixels", begin, error);
        scans = 1;
        at = end_of_scan(bytes, count, at);
        if (at == count) {
            (void)model_fail(error, "",
                             "the JPEG file ends at byte %zu, in the pixels at byte %zu, and has no end marker: "
                             "if some of the picture is grey, it was cut off; save or copy it again",
                             count, begin);
            return IMAGE_NO_END;
        }
    }
    return scans ? 0 : model_fail(error, "", "the JPEG file has no pixels, only a header: save or copy it again");
}

int image_is_cut(const unsigned char *bytes, size_t count, model_error *error)
{
    return bytes[0] == 0x89 ? png_is_cut(bytes, count, error) : jpeg_is_cut(bytes, count, error);
}
