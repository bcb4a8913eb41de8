#include "info_transfer.h"

#include <stdio.h>
#include "noh/light.h"

static uint32_t record_bytes(const noh_transfer *t)
{
    return NOH_TRANSFER_RECORD_BYTES(t->header->order, t->header->flags);
}

static uint64_t delta_bytes(const noh_transfer *t)
{
    return t->header->texel_count + 4ull * t->header->target_count;
}

void info_print_transfer(const noh_mesh *mesh)
{
    noh_transfer t;
    if (noh_transfer_of(mesh, &t, NULL) == NOH_OK) {
        printf(
            "  transfer of order %u about %s, %u bytes a vertex, %llu bytes of occlusion by targets; %u rays a vertex%s\n",
            t.header->order, t.header->flags & NOH_TRANSFER_ON_NORMAL ? "the normal" : "an axis of its own",
            record_bytes(&t), (unsigned long long)delta_bytes(&t), t.header->ray_count,
            t.header->bounce ? ", one reflection" : "");
    }
}

void info_json_transfer(json *j, const noh_mesh *mesh)
{
    noh_transfer t;
    if (noh_transfer_of(mesh, &t, NULL)) {
        json_null(j, "transfer");
        return;
    }
    json_open(j, "transfer", '{');
    json_integer(j, "order", t.header->order);
    json_bool(j, "on_normal", (t.header->flags & NOH_TRANSFER_ON_NORMAL) != 0);
    json_integer(j, "bytes_per_vertex", record_bytes(&t));
    json_integer(j, "bytes", record_bytes(&t) * (uint64_t)t.header->vertex_count + delta_bytes(&t));
    json_integer(j, "rays", t.header->ray_count);
    json_integer(j, "bounce", t.header->bounce);
    json_close(j, '}');
}
