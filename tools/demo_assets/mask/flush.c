#include "flush.h"

#include "face.h"
#include "shared/maths.h"

#include <math.h>

enum { SIDE = 64, ROW = 1 + 3 * SIDE, BYTES = SIDE * ROW };

static void put_big(Buffer *out, uint32_t value)
{
    for (int i = 24; i >= 0; i -= 8) {
        buffer_u8(out, value >> i & 255u);
    }
}

/* PNG, annex D, a bit at a time. */
static uint32_t crc_of(const unsigned char *bytes, int count)
{
    uint32_t crc = 0xffffffffu;
    for (int i = 0; i < 8 * count; i++) {
        uint32_t bit = (crc ^ (uint32_t)bytes[i / 8] >> i % 8) & 1u;
        crc = crc >> 1 ^ (bit ? 0xedb88320u : 0u);
    }
    return ~crc;
}

static void put_chunk(Buffer *png, const char *type, const Buffer *data)
{
    Buffer chunk = { 0 };
    buffer_print(&chunk, "%s", type);
    buffer_append(&chunk, data);
    put_big(png, (uint32_t)data->count);
    buffer_append(png, &chunk);
    put_big(png, crc_of(chunk.bytes, chunk.count));
    buffer_free(&chunk);
}

/* As seed_texture lays the mask out: a plain view from the front. */
static void put_pixel(Buffer *rows, int i, int j)
{
    double x = 0.24 * ((i + 0.5) / SIDE - 0.5), y = 0.24 * (0.5 - (j + 0.5) / SIDE), side = fabs(x);
    double blush = 1.2 * bump2(side - 0.036, y + 0.020, 0.040, 0.034) + 0.6 * bump2(x, y + 0.022, 0.024, 0.018);
    double face = smooth(1.15, 0.75,
                         sqrt(x * x / (FACE_HALF_WIDTH * FACE_HALF_WIDTH) +
                              y * y / (FACE_HALF_HEIGHT * FACE_HALF_HEIGHT))) *
                  smooth(0.084, 0.062, y + 8 * x * x);
    double brow = bump2(x, y - 0.050, 0.070, 0.050) + 0.7 * bump2(x, y - 0.012, 0.022, 0.030);
    const double all[3] = { blush, face, brow };
    for (int c = 0; c < 3; c++) {
        buffer_u8(rows, (uint32_t)(255 * clamp(all[c], 0, 1) + 0.5));
    }
}

/* A zlib stream of one stored block. */
static void put_stored(Buffer *data, const Buffer *rows)
{
    uint32_t a = 1, b = 0;
    for (int i = 0; i < rows->count; i++) {
        a = (a + rows->bytes[i]) % 65521u;
        b = (b + a) % 65521u;
    }
    buffer_u16(data, 0x0178);
    buffer_u8(data, 1);
    buffer_u16(data, BYTES);
    buffer_u16(data, 0xffffu ^ BYTES);
    buffer_append(data, rows);
    put_big(data, b << 16 | a);
}

void flush_write(Buffer *png)
{
    static const unsigned char head[8] = { 137, 'P', 'N', 'G', 13, 10, 26, 10 };
    Buffer shape = { 0 }, rows = { 0 }, data = { 0 }, none = { 0 };
    put_big(&shape, SIDE);
    put_big(&shape, SIDE);
    for (int i = 0; i < 5; i++) {
        buffer_u8(&shape, i == 0 ? 8 : i == 1 ? 2 : 0); /* 8 bits, colour */
    }
    for (int j = 0; j < SIDE; j++) {
        buffer_u8(&rows, 0); /* no filter */
        for (int i = 0; i < SIDE; i++) {
            put_pixel(&rows, i, j);
        }
    }
    put_stored(&data, &rows);
    for (int i = 0; i < 8; i++) {
        buffer_u8(png, head[i]);
    }
    put_chunk(png, "IHDR", &shape);
    put_chunk(png, "IDAT", &data);
    put_chunk(png, "IEND", &none);
    buffer_free(&shape);
    buffer_free(&rows);
    buffer_free(&data);
}
