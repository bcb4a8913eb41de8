/* wire.c: takes a file in pieces, collects it by blocks, and hands them to the filters once their checksum is right. */
#include "core/base/assert_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/pack.h"

#include <string.h>

#include "core/wire/wire_internal.h"

typedef enum wire_phase { WIRE_HEAD, WIRE_BLOCK, WIRE_PAYLOAD, WIRE_WHOLE, WIRE_FAILED } wire_phase;

struct noh_wire {
    noh_wire_filter filter;
    noh_wire_desc desc;
    noh_wire_head head;
    noh_pack pack;
    uint32_t pack_count; /* that are there */
    uint32_t image;
    wire_phase phase;
    uint32_t section_open; /* the filter waits for a block */
    uint32_t crc;
    uint32_t taken;
    uint32_t have, want; /* bytes of the piece that is collected */
    uint8_t block_head[NOH_WIRE_BLOCK_HEAD_BYTES];
    uint8_t input[NOH_WIRE_BLOCK_BYTES_MAX];
};

/* ---- the header ---- */

static uint64_t aligned(uint64_t bytes)
{
    return (bytes + NOH_PACK_ALIGN - 1u) & ~(uint64_t)(NOH_PACK_ALIGN - 1u);
}

static uint32_t whole_bytes(const noh_wire_head *h)
{
    return h->image_bytes[h->image_count - 1u];
}

static uint64_t block_bytes(const noh_wire_head *h)
{
    return aligned(whole_bytes(h)) + (h->image_count > 1u ? aligned(h->image_bytes[0]) : 0u) + h->scratch_bytes;
}

static noh_result check_head(const noh_wire_head *h, noh_error *error)
{
    if (h->magic != NOH_WIRE_MAGIC) {
        return noh_fail(error, NOH_ERR_DATA, "not the wire form of a pack: it does not begin with NOHZ", 0, 0);
    }
    if (!h->version || h->version > NOH_WIRE_VERSION) {
        return noh_fail(error, NOH_ERR_VERSION, "the wire form is of a version that is not known here: pack it again",
                        4, NOH_WIRE_VERSION);
    }
    if (noh_crc32c(0, h, offsetof(noh_wire_head, crc)) != h->crc) {
        return noh_fail(error, NOH_ERR_DATA, "checksum of the wire form's header is wrong: the file is damaged",
                        offsetof(noh_wire_head, crc), 0);
    }
    if (h->image_count < 1u || h->image_count > NOH_WIRE_IMAGES_MAX || block_bytes(h) > NOH_PACK_BYTES_MAX ||
        h->file_bytes < sizeof *h) {
        return noh_fail(error, NOH_ERR_DATA, "the wire form's header holds counts that no pack has", 0, 0);
    }
    for (uint32_t i = 0; i < h->image_count; i++) {
        if (h->image_bytes[i] < sizeof(noh_pack_header)) {
            return noh_fail(error, NOH_ERR_DATA, "the wire form's header tells of a pack of no bytes",
                            offsetof(noh_wire_head, image_bytes), 0);
        }
    }
    return NOH_OK;
}

noh_result noh_wire_info_read(const void *bytes, size_t byte_count, noh_wire_info *info, noh_error *error)
{
    noh_wire_head h;
    noh_result result;
    if (!bytes || !info) return noh_fail(error, NOH_ERR_ARG, "bytes or info is NULL", 0, 0);
    if (byte_count < sizeof h) {
        return noh_fail(error, NOH_ERR_DATA, "the wire form is shorter than its header", byte_count, sizeof h);
    }
    memcpy(&h, bytes, sizeof h);
    result = check_head(&h, error);
    if (result) return result;
    info->file_bytes = h.file_bytes;
    info->block_bytes = (uint32_t)block_bytes(&h);
    info->pack_bytes = whole_bytes(&h);
    info->coarse_bytes = h.image_count > 1u ? h.image_bytes[0] : 0u;
    return NOH_OK;
}

/* ---- memory ---- */

size_t noh_wire_size(void)
{
    return sizeof(noh_wire);
}

noh_result noh_wire_init(void *memory, size_t bytes, const noh_wire_desc *desc, noh_wire **wire, noh_error *error)
{
    noh_wire *w = memory;
    if (!memory || !desc || !wire || !desc->block) {
        return noh_fail(error, NOH_ERR_ARG, "memory, desc, its block or wire is NULL", 0, sizeof *w);
    }
    if ((uintptr_t)memory % NOH_MEMORY_ALIGN || (uintptr_t)desc->block % NOH_MEMORY_ALIGN) {
        return noh_fail(error, NOH_ERR_ARG, "memory or block is not aligned to NOH_MEMORY_ALIGN", 0, sizeof *w);
    }
    if (bytes < sizeof *w) {
        return noh_fail(error, NOH_ERR_MEMORY, "memory is too small for a noh_wire", 0, sizeof *w);
    }
    memset(w, 0, sizeof *w);
    w->desc = *desc;
    w->want = NOH_WIRE_HEAD_BYTES;
    *wire = w;
    return NOH_OK;
}

/* ---- images ---- */

static uint32_t image_at(const noh_wire *w, uint32_t image)
{
    return image + 1u == w->head.image_count ? 0u : (uint32_t)aligned(whole_bytes(&w->head));
}

static void begin_image(noh_wire *w)
{
    noh_wire_filter *f = &w->filter;
    uint8_t *block = w->desc.block;
    f->before = w->image ? block + image_at(w, w->image - 1u) : NULL;
    f->before_bytes = w->image ? w->head.image_bytes[w->image - 1u] : 0u;
    f->image = block + image_at(w, w->image);
    f->image_bytes = w->head.image_bytes[w->image];
    f->mesh.chunk = 0;
    memset(f->image, 0, f->image_bytes);
}

static noh_result begin_file(noh_wire *w, noh_error *error)
{
    noh_result result;
    memcpy(&w->head, w->input, sizeof w->head);
    result = check_head(&w->head, error);
    if (result) return result;
    if (w->desc.block_bytes < block_bytes(&w->head)) {
        return noh_fail(error, NOH_ERR_MEMORY, "the block is too small for what the wire form unpacks to", 0,
                        block_bytes(&w->head));
    }
    w->crc = w->head.crc;
    w->filter.scratch = (uint8_t *)w->desc.block + (block_bytes(&w->head) - w->head.scratch_bytes);
    w->filter.scratch_bytes = w->head.scratch_bytes;
    begin_image(w);
    return NOH_OK;
}

static noh_result end_image(noh_wire *w, noh_error *error)
{
    const noh_result result = noh_pack_open(w->filter.image, w->filter.image_bytes, &w->pack, error);
    if (result) return result;
    w->pack_count++;
    w->image++;
    if (w->image < w->head.image_count) begin_image(w);
    return NOH_OK;
}

/* ---- blocks ---- */

static noh_result fail_here(const noh_wire *w, const char *what, noh_error *error)
{
    return noh_fail(error, NOH_ERR_DATA, what, w->taken, 0);
}

static noh_result begin_section(noh_wire *w, uint32_t bytes, noh_error *error)
{
    noh_wire_section section;
    int done;
    if (bytes != NOH_WIRE_SECTION_BYTES || w->section_open || w->image == w->head.image_count) {
        return fail_here(w, "a section of the wire form begins where none can", error);
    }
    noh_wire_section_read(&section, w->input);
    if (section.kind == NOH_WIRE_END) return end_image(w, error);
    done = noh_wire_begin(&w->filter, &section);
    if (done < 0) return fail_here(w, w->filter.wrong, error);
    w->section_open = !done;
    return NOH_OK;
}

static noh_result run_block(noh_wire *w, uint32_t bytes, uint32_t items, noh_error *error)
{
    int done;
    if (!w->section_open) return fail_here(w, "a block of the wire form belongs to no section", error);
    noh_wire_coder_begin(&w->filter.coder, w->input, bytes, items);
    done = noh_wire_run(&w->filter);
    if (done < 0) return fail_here(w, w->filter.wrong, error);
    if (!noh_wire_coder_ended(&w->filter.coder)) {
        return fail_here(w, "a block of the wire form does not end where its section has it", error);
    }
    w->section_open = !done;
    return NOH_OK;
}

static uint32_t block_word(const noh_wire *w, uint32_t at)
{
    const uint8_t *b = w->block_head + at;
    return (uint32_t)b[0] | (uint32_t)b[1] << 8;
}

/* A piece is complete: what it is decides what comes next. */
static noh_result take_block(noh_wire *w, noh_error *error)
{
    const uint32_t size = block_word(w, 2), bytes = size & (NOH_WIRE_BLOCK_SECTION - 1u);
    const uint32_t crc = noh_crc32c(noh_crc32c(w->crc, w->block_head, 4), w->input, bytes);
    noh_result result;
    if (crc != (block_word(w, 4) | block_word(w, 6) << 16)) {
        return fail_here(w, "checksum of a block of the wire form is wrong: the file is damaged", error);
    }
    w->crc = crc;
    result = size & NOH_WIRE_BLOCK_SECTION ? begin_section(w, bytes, error)
                                           : run_block(w, bytes, block_word(w, 0), error);
    if (result) return result;
    w->phase = WIRE_BLOCK;
    w->want = NOH_WIRE_BLOCK_HEAD_BYTES;
    if (w->taken == w->head.file_bytes) {
        if (w->image < w->head.image_count) return fail_here(w, "the wire form ends before its pack does", error);
        w->phase = WIRE_WHOLE;
    }
    return NOH_OK;
}

static noh_result take_piece(noh_wire *w, noh_error *error)
{
    noh_result result = NOH_OK;
    if (w->phase == WIRE_HEAD) {
        result = begin_file(w, error);
        w->phase = WIRE_BLOCK;
        w->want = NOH_WIRE_BLOCK_HEAD_BYTES;
    } else if (w->phase == WIRE_BLOCK) {
        w->want = block_word(w, 2) & (NOH_WIRE_BLOCK_SECTION - 1u);
        w->phase = WIRE_PAYLOAD;
        if (w->want > NOH_WIRE_BLOCK_BYTES_MAX) result = fail_here(w, "a block of the wire form is too long", error);
        if (!w->want) result = fail_here(w, "a block of the wire form is empty", error);
    } else {
        result = take_block(w, error);
    }
    w->have = 0;
    return result;
}

noh_result noh_wire_push(noh_wire *w, const void *bytes, size_t byte_count, noh_error *error)
{
    const uint8_t *from = bytes;
    NOH_ASSERT(w);
    if (!bytes && byte_count) return noh_fail(error, NOH_ERR_ARG, "bytes is NULL", 0, 0);
    while (byte_count) {
        uint8_t *to = w->phase == WIRE_BLOCK ? w->block_head : w->input;
        const uint32_t left = w->want - w->have, now = byte_count < left ? (uint32_t)byte_count : left;
        noh_result result;
        if (w->phase == WIRE_FAILED) return fail_here(w, "the wire form was refused before", error);
        if (w->phase == WIRE_WHOLE) {
            w->phase = WIRE_FAILED;
            return fail_here(w, "bytes follow the end of the wire form", error);
        }
        memcpy(to + w->have, from, now);
        from += now;
        byte_count -= now;
        w->have += now;
        w->taken += now;
        if (w->have < w->want) return NOH_OK;
        result = take_piece(w, error);
        if (result) {
            w->phase = WIRE_FAILED;
            return result;
        }
    }
    return NOH_OK;
}

noh_result noh_wire_pack(const noh_wire *w, noh_pack *pack, noh_error *error)
{
    NOH_ASSERT(w && pack);
    if (!w->pack_count)
        return noh_fail(error, NOH_ERR_NOT_FOUND, "no pack is complete yet: pass more bytes", w->taken,
                        w->head.file_bytes);
    *pack = w->pack;
    return NOH_OK;
}

int noh_wire_is_complete(const noh_wire *w)
{
    NOH_ASSERT(w);
    return w->phase == WIRE_WHOLE;
}

uint32_t noh_wire_bytes_read(const noh_wire *w)
{
    NOH_ASSERT(w);
    return w->taken;
}
