#include "bmp_file.h"

#include <stdint.h>

#include "convert/base/byte_buffer.h"

#define BMP_HEADER 54u /* of the file and of a picture of the second version */

int bmp_begins(const unsigned char *bytes, size_t count)
{
    return count > BMP_HEADER && bytes[0] == 'B' && bytes[1] == 'M' && byte_word(bytes + 14) <= 124u;
}

/* Whether a pixel has a number behind the last colour of the palette, which stb_image takes from memory that is not
 * set. bits: 1, 4 or 8 */
static int leaves_palette(const unsigned char *rows, uint64_t row, uint64_t width, uint64_t height, unsigned bits,
                          uint64_t colours)
{
    const unsigned mask = (1u << bits) - 1u;
    for (uint64_t y = 0; colours <= mask && y < height; y++) {
        for (uint64_t x = 0; x < width; x++) {
            const unsigned shift = 8u - bits - (unsigned)(x * bits % 8u);
            if ((rows[y * row + x * bits / 8u] >> shift & mask) >= colours) return 1;
        }
    }
    return 0;
}

/* The first version has sides of 16 bits, and no packing. A negative height: the top row first. */
int bmp_is_refused(const unsigned char *bytes, size_t count, model_error *error)
{
    const int first = byte_word(bytes + 14) == 12u;
    const uint32_t side = byte_word(bytes + 18), tall = byte_word(bytes + 22),
                   packing = first ? 0 : byte_word(bytes + 30);
    const uint64_t width = first ? side & 0xffffu : side, bits = first ? bytes[24] : bytes[28];
    const uint64_t height = first ? side >> 16 : tall >> 31 ? 0u - tall : tall, begin = byte_word(bytes + 10);
    const uint64_t row = (width * bits + 31u) / 32u * 4u, header = 14u + byte_word(bytes + 14);
    if (packing != 0 && packing != 3u) {
        return model_fail(error, "", "it is a BMP picture with packed pixels, which is not read: save it as PNG");
    }
    /* a row is at most 2^38 bytes, and a file less than 2^31 */
    if (begin < header || begin > count || (height && row > (count - begin) / height)) {
        return model_fail(error, "",
                          "the BMP file ends at byte %zu, before its last pixel: it was cut off; save or copy it again",
                          count);
    }
    if (first && bits < 16u) { /* stb_image takes its palette for four colours shorter */
        return model_fail(error, "", "it is a BMP picture of OS/2 with a palette, which is not read: save it as PNG");
    }
    if (width && (bits == 1u || bits == 4u || bits == 8u) &&
        leaves_palette(bytes + begin, row, width, height, (unsigned)bits, (begin - header) / 4u)) {
        return model_fail(error, "", "pixels of the BMP picture have colours that its palette lacks: save it as PNG");
    }
    return 0;
}
