#define _POSIX_C_SOURCE 200809L /* fork, mkdtemp */
#include "texture_astc.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/pack/pack_internal.h"
#include "noh/format.h"

#define PROGRAM "astcenc"
#define QUALITY "-medium" /* -thorough takes four times as long, for 0.2 dB */
#define ASTC_HEAD_BYTES 16u
#define PATH_BYTES 1024u

/* ---- the program ---- */

/* Its status, without what it prints; -1: it cannot be started. */
static int run(const char *const *arguments)
{
    int status = 0;
    fflush(NULL);
    const pid_t child = fork();
    if (child == 0) {
        const int nowhere = open("/dev/null", O_WRONLY);
        if (nowhere >= 0 && dup2(nowhere, STDOUT_FILENO) >= 0 && dup2(nowhere, STDERR_FILENO) >= 0) {
            execvp(arguments[0], (char *const *)(uintptr_t)arguments);
        }
        _exit(127);
    }
    if (child < 0 || waitpid(child, &status, 0) != child || !WIFEXITED(status)) return -1;
    return WEXITSTATUS(status) == 127 ? -1 : WEXITSTATUS(status);
}

int texture_astc_find(model_error *error)
{
    const char *const arguments[] = { PROGRAM, "-version", NULL };
    return run(arguments) == 0 ? 0
                               : model_fail(error, "",
                                            "--textures astc needs the program " PROGRAM
                                            ", which cannot be run: apt-get install " PROGRAM);
}

/* A temporary folder, and the files in it. */
typedef struct folder {
    char path[PATH_BYTES], picture[PATH_BYTES + 16u], blocks[PATH_BYTES + 16u];
} folder;

static int folder_make(folder *f)
{
    const char *where = getenv("TMPDIR");
    const int length = snprintf(f->path, sizeof f->path, "%s/noh-astc-XXXXXX", where && *where ? where : "/tmp");
    if (length < 0 || (size_t)length >= sizeof f->path || !mkdtemp(f->path)) return 1;
    snprintf(f->picture, sizeof f->picture, "%s/picture.ktx", f->path);
    snprintf(f->blocks, sizeof f->blocks, "%s/blocks.astc", f->path);
    return 0;
}

static void folder_remove(const folder *f)
{
    (void)remove(f->picture);
    (void)remove(f->blocks);
    (void)rmdir(f->path);
}

static int write_file(const char *path, const void *head, size_t head_bytes, const void *rest, size_t rest_bytes)
{
    FILE *file = fopen(path, "wb");
    int failed = !file || fwrite(head, 1, head_bytes, file) != head_bytes ||
                 fwrite(rest, 1, rest_bytes, file) != rest_bytes;
    if (file) failed = fclose(file) != 0 || failed;
    return failed;
}

static int read_file(const char *path, void *head, size_t head_bytes, void *rest, size_t rest_bytes)
{
    FILE *file = fopen(path, "rb");
    const int failed = !file || fread(head, 1, head_bytes, file) != head_bytes ||
                       fread(rest, 1, rest_bytes, file) != rest_bytes;
    if (file) fclose(file);
    return failed;
}

/* ---- files ---- */

/* The head of a KTX file of one level, in the byte order of this machine, and the bytes of the level. */
typedef struct ktx_head {
    uint8_t identifier[12];
    uint32_t endianness, type, type_size, format, internal_format, base_format, width, height, depth;
    uint32_t elements, faces, levels, key_bytes, image_bytes;
} ktx_head;

#define KTX_L 0x1909u
#define KTX_RGBA 0x1908u

static ktx_head ktx_of(const texture_image *level)
{
    ktx_head h = { { 0xab, 'K', 'T', 'X', ' ', '1', '1', 0xbb, '\r', '\n', 0x1a, '\n' }, .endianness = 0x04030201u };
    h.type = 0x1401u; /* GL_UNSIGNED_BYTE */
    h.type_size = 1;
    h.format = h.base_format = KTX_RGBA;
    h.internal_format = 0x8058u; /* GL_RGBA8 */
    h.width = level->width;
    h.height = level->height;
    h.faces = h.levels = 1;
    h.image_bytes = level->width * level->height * 4u;
    return h;
}

/* A picture of the fewest channels: grey, grey and alpha, RGB or RGBA. Rows may be padded. */
static int read_picture(const char *path, const texture_image *level, uint8_t *rgba)
{
    static const uint8_t from[5][4] = { { 0 }, { 0, 0, 0, 9 }, { 0, 0, 0, 1 }, { 0, 1, 2, 9 }, { 0, 1, 2, 3 } };
    const size_t room = ((size_t)level->width * 4u) * level->height;
    uint8_t *bytes = malloc(room);
    ktx_head h;
    int failed = !bytes || read_file(path, &h, sizeof h, bytes, 0) || h.image_bytes > room;
    failed = failed || read_file(path, &h, sizeof h, bytes, h.image_bytes);
    const uint32_t channels = failed                ? 4u
                              : h.format == KTX_L   ? 1u
                              : h.format > KTX_L    ? 2u
                              : h.format < KTX_RGBA ? 3u
                                                    : 4u;
    const size_t row = failed ? 0 : h.image_bytes / level->height;
    failed = failed || row < (size_t)level->width * channels;
    for (size_t i = 0; !failed && i < (size_t)level->width * level->height; i++) {
        const uint8_t *texel = bytes + i / level->width * row + i % level->width * channels;
        for (int c = 0; c < 4; c++) rgba[4u * i + (size_t)c] = from[channels][c] == 9 ? 255 : texel[from[channels][c]];
    }
    free(bytes);
    return failed;
}

/* ---- levels ---- */

/* Bytes of unit vectors. */
static int write_picture(const char *path, const texture_image *level)
{
    const size_t count = (size_t)level->width * level->height;
    const ktx_head h = ktx_of(level);
    uint8_t *unit;
    if (level->use != MODEL_TEXTURE_NORMAL) return write_file(path, &h, sizeof h, level->rgba, 4u * count);
    unit = malloc(4u * count);
    for (size_t i = 0; unit && i < count; i++) texture_unit_bytes(level->rgba + 4u * i, unit + 4u * i);
    const int failed = !unit || write_file(path, &h, sizeof h, unit, 4u * count);
    free(unit);
    return failed;
}

int texture_astc_encode(const texture_image *level, uint32_t format, byte_buffer *out)
{
    const uint32_t side = noh_texture_block_side(format),
                   bytes = noh_texture_bytes(format, level->width, level->height);
    uint8_t head[ASTC_HEAD_BYTES];
    char size[8];
    folder f;
    snprintf(size, sizeof size, "%ux%u", side & 15u, side & 15u);
    void *to = buffer_append(out, NULL, bytes);
    if (!to || folder_make(&f)) return 1;
    const char *const arguments[] = {
        PROGRAM,   level->use == MODEL_TEXTURE_COLOR ? "-cs" : "-cl",
        f.picture, f.blocks,
        size,      QUALITY,
        "-esw",    level->use == MODEL_TEXTURE_NORMAL ? "rg01" : level->keeps_alpha ? "rgba" : "rgb1",
        NULL
    };
    const int failed = write_picture(f.picture, level) || run(arguments) != 0 ||
                       read_file(f.blocks, head, sizeof head, to, bytes);
    folder_remove(&f);
    return failed;
}

int texture_astc_decode(const texture_image *level, uint32_t format, const uint8_t *blocks, uint8_t *rgba)
{
    const uint8_t side = (uint8_t)noh_texture_block_side(format);
    const uint8_t head[ASTC_HEAD_BYTES] = { 0x13,
                                            0xab,
                                            0xa1,
                                            0x5c,
                                            side,
                                            side,
                                            1,
                                            level->width & 255u,
                                            level->width >> 8 & 255u,
                                            0,
                                            level->height & 255u,
                                            level->height >> 8 & 255u,
                                            0,
                                            1,
                                            0,
                                            0 };
    const size_t bytes = noh_texture_bytes(format, level->width, level->height);
    folder f;
    if (folder_make(&f)) return 1;
    const char *const arguments[] = { PROGRAM, level->use == MODEL_TEXTURE_COLOR ? "-ds" : "-dl", f.blocks, f.picture,
                                      NULL };
    const int failed = write_file(f.blocks, head, sizeof head, blocks, bytes) || run(arguments) != 0 ||
                       read_picture(f.picture, level, rgba);
    folder_remove(&f);
    return failed;
}
