/* bench_wire.c: rows wire/: a pack's wire form unpacked, against copying the pack, and against zstd, where its library
 * is on this machine. It is loaded when it is asked for, so that nobody needs it to build. */
#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>

#include "bench_job.h"
#include "cli/message.h"
#include "convert/pack/pack_wire.h"
#include "noh/pack.h"

#define SAMPLE_NS 2e7
#define ZSTD_LEVEL 19

typedef struct zstd {
    void *library; /* NULL: there is none */
    size_t (*bound)(size_t bytes);
    size_t (*compress)(void *to, size_t room, const void *from, size_t bytes, int level);
    size_t (*decompress)(void *to, size_t room, const void *from, size_t bytes);
    unsigned (*is_error)(size_t code);
} zstd;

typedef struct wire_bench {
    const noh_pack *pack;
    byte_buffer wired;
    noh_wire_info info;
    void *state, *block;
    zstd z;
    uint8_t *packed; /* by zstd */
    size_t packed_bytes;
    int failed;
} wire_bench;

static void load_zstd(zstd *z)
{
    z->library = dlopen("libzstd.so.1", RTLD_NOW | RTLD_LOCAL);
    if (!z->library) return;
    *(void **)&z->bound = dlsym(z->library, "ZSTD_compressBound");
    *(void **)&z->compress = dlsym(z->library, "ZSTD_compress");
    *(void **)&z->decompress = dlsym(z->library, "ZSTD_decompress");
    *(void **)&z->is_error = dlsym(z->library, "ZSTD_isError");
    if (z->bound && z->compress && z->decompress && z->is_error) return;
    dlclose(z->library);
    z->library = NULL;
}

/* ---- timed code ---- */

static void run_unpack(void *self, uint32_t frame)
{
    wire_bench *b = self;
    const noh_wire_desc desc = { b->block, b->info.block_bytes };
    noh_wire *wire;
    (void)frame;
    b->failed |= noh_wire_init(b->state, noh_wire_size(), &desc, &wire, NULL) ||
                 noh_wire_push(wire, b->wired.bytes, b->wired.count, NULL) || !noh_wire_is_complete(wire);
}

static void run_copy(void *self, uint32_t frame)
{
    wire_bench *b = self;
    (void)frame;
    memcpy(b->block, b->pack->bytes, b->pack->byte_count);
}

static void run_zstd(void *self, uint32_t frame)
{
    wire_bench *b = self;
    (void)frame;
    b->failed |= b->z.decompress(b->block, b->info.block_bytes, b->packed, b->packed_bytes) != b->pack->byte_count;
}

/* ---- the rows ---- */

static int make_wire(wire_bench *b, const char *subject)
{
    const wire_steps steps = { NULL, 32767u, 65535u, 0 };
    wire_report report;
    model_error error;
    if (pack_wire(b->pack, 1, &steps, &b->wired, &report, &error)) return tool_fail(subject, "%s", error.what);
    (void)noh_wire_info_read(b->wired.bytes, b->wired.count, &b->info, NULL);
    b->state = malloc(noh_wire_size());
    b->block = malloc(b->info.block_bytes);
    return b->state && b->block ? 0 : tool_fail(subject, "out of memory");
}

static int make_zstd(wire_bench *b, const char *subject)
{
    load_zstd(&b->z);
    if (!b->z.library) return 0;
    b->packed = malloc(b->z.bound(b->pack->byte_count));
    if (!b->packed) return tool_fail(subject, "out of memory");
    b->packed_bytes = b->z.compress(b->packed, b->z.bound(b->pack->byte_count), b->pack->bytes, b->pack->byte_count,
                                    ZSTD_LEVEL);
    return b->z.is_error(b->packed_bytes) ? tool_fail(subject, "zstd cannot compress the pack") : 0;
}

static int measure(bench_job *job, wire_bench *b)
{
    const double kilobytes = 1e-3 * (double)b->pack->byte_count;
    bench_cells cells;
    int status;
    memset(&cells, 0, sizeof cells);
    bench_add_cell(&cells, run_unpack, b);
    bench_add_cell(&cells, run_copy, b);
    if (b->z.library) bench_add_cell(&cells, run_zstd, b);
    status = bench_run_cells(&cells, &job->cpu_clock, job->rounds, SAMPLE_NS, "wire");
    if (!status && b->failed) status = tool_fail(job->files[0].path, "its wire form does not unpack");
    if (!status) {
        const double ours = bench_median(&cells, 0) / kilobytes;
        bench_add_row(&job->rows, "wire/unpack", "memcpy", bench_median(&cells, 1) / kilobytes, ours, "ns/KB",
                      cells.rounds);
        if (b->z.library) {
            bench_add_row(&job->rows, "wire/unpack", "zstd-19", bench_median(&cells, 2) / kilobytes, ours, "ns/KB",
                          cells.rounds);
            bench_add_row(&job->rows, "wire/size", "zstd-19", 1e-3 * (double)b->packed_bytes,
                          1e-3 * (double)b->wired.count, "KB", 1);
        }
    }
    bench_free_cells(&cells);
    return status;
}

int bench_wire(bench_job *job)
{
    wire_bench b;
    const char *subject = job->files[0].path;
    int status;
    memset(&b, 0, sizeof b);
    b.pack = &job->files[0].pack;
    status = make_wire(&b, subject);
    if (!status) status = make_zstd(&b, subject);
    if (!status) status = measure(job, &b);
    if (b.z.library) dlclose(b.z.library);
    free(b.packed);
    free(b.block);
    free(b.state);
    buffer_free(&b.wired);
    return status;
}
