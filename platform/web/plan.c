/* plan.c: plans the memory of a pack's page. It runs under node when the page is built, because pointers have another
 * size there.
 *
 *   plan PACK ACTORS [WIRE]
 *
 * Prints the bytes of the stage for each path, plain and lit, with and without faces; the number of held floats, the
 * kinds with a face (a bit each), whether the first kind can fall, the bytes of hair (per actor, CPU, GPU), the eyes of
 * the first face; the bytes of the page's block, and of the block to unpack the wire form. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cast.h"
#include "platform.h"
#include "noh/base.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/modules.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"

/* A device with the capabilities for every path, and with software rendering, as in the tests. The browser's device is
 * probed at run time. */
static noh_gl_caps browser_device(void)
{
    noh_gl_caps caps;
    memset(&caps, 0, sizeof caps);
    memcpy(caps.renderer, "SwiftShader", sizeof "SwiftShader");
    caps.version = 320;
    caps.is_es = 1;
    caps.texture_size_max = 2048;
    caps.array_layers_max = 256;
    caps.draw_buffers_max = caps.color_attachments_max = 4;
    caps.uniform_block_bytes_max = 16384;
    caps.vertex_textures_max = caps.vertex_attributes_max = 16;
    caps.mrt3 = caps.render_f32 = caps.render_f16 = caps.render_u32 = 1;
    caps.blend_f32 = caps.blend_f16 = caps.blend_f32_exact = caps.layered = caps.etc2 = caps.astc = caps.block_points =
        1;
    return caps;
}

/* Print one line; *most: the largest block. */
static int plan(const noh_pack *pack, const web_wants *wants, size_t *most, noh_error *error)
{
    static web_cast cast;
    const noh_gl_caps caps = browser_device();
    const size_t bytes = web_cast_scratch(pack);
    void *scratch = malloc(bytes + 1u);
    const int failed = !scratch || web_cast_plan(&cast, pack, wants, scratch, bytes, &caps, error);
    free(scratch);
    if (failed) return 1;
    printf("%s %s %s %llu %llu\n", noh_morph_path_name(wants->path), wants->lit ? "lit" : "plain",
           wants->alive ? "alive" : "still", (unsigned long long)cast.cpu_bytes, (unsigned long long)cast.gpu_bytes);
    if (cast.bytes > *most) *most = cast.bytes;
    if (wants->alive && wants->lit && wants->path == NOH_MORPH_CPU) {
        printf("floats %u\nfaces %u\n", cast.plan.kinds[0].float_count, cast.faces_found);
        if (!cast.cannot_fall.result) printf("falls\n");
        if (cast.has_hair) {
            printf("hair %u %zu %llu\n", cast.hair_part->state_bytes,
                   noh_actor_hair_size(&cast.hair) + noh_stage_hair_size(&cast.hair),
                   (unsigned long long)noh_stage_hair_bytes(&cast.hair));
        }
        for (int i = 0; i < 6; i++) printf("%s%.9g", i ? " " : "eyes ", (double)cast.faces[0].face.eyes[i / 3][i % 3]);
        printf("\n");
    }
    return 0;
}

static int plan_all(const noh_pack *pack, uint32_t actors, noh_error *error)
{
    static const noh_morph_path paths[] = { NOH_MORPH_CPU, NOH_MORPH_GATHER, NOH_MORPH_MRT, NOH_MORPH_PER_LAYER,
                                            NOH_MORPH_DIRECT };
    size_t most = 0;
    for (uint32_t i = 0; i < 4u * sizeof paths / sizeof *paths; i++) {
        const web_wants wants = { actors, paths[i / 4u], i & 1u, (i & 2u) != 0, 0, 0, 0, NOH_SHADING_FULL };
        if (plan(pack, &wants, &most, error)) return 1;
    }
    printf("block %llu\n", (unsigned long long)most);
    return 0;
}

static int plan_wire(const char *path, noh_error *error)
{
    noh_wire_info info;
    noh_file file;
    if (noh_file_map(path, &file, error) || noh_wire_info_read(file.data, file.bytes, &info, error)) return 1;
    printf("wire %u\n", info.block_bytes);
    return 0;
}

/* Open the pack, plain or unpacked from its wire form as on the page. */
static int open_pack(const char *path, noh_pack *pack, noh_error *error)
{
    static uint8_t state[NOH_WIRE_STATE_BYTES] __attribute__((aligned(16)));
    noh_wire_desc desc = { NULL, 0 };
    noh_wire_info info;
    noh_wire *wire;
    noh_file file;
    if (noh_file_map(path, &file, error)) return 1;
    if (noh_wire_info_read(file.data, file.bytes, &info, NULL))
        return noh_pack_open(file.data, file.bytes, pack, error);
    desc.block_bytes = (info.block_bytes + 63u) / 64u * 64u;
    desc.block = aligned_alloc(64, desc.block_bytes); /* not freed: contains the pack */
    return !desc.block || noh_wire_init(state, sizeof state, &desc, &wire, error) ||
           noh_wire_push(wire, file.data, file.bytes, error) || noh_wire_pack(wire, pack, error);
}

int main(int argc, char **argv)
{
    noh_error error = { NOH_OK, "usage: plan PACK ACTORS [WIRE]", 0, 0 };
    noh_pack pack;
    if (argc < 3 || open_pack(argv[1], &pack, &error) ||
        plan_all(&pack, (uint32_t)strtoul(argv[2], NULL, 10), &error) || (argc > 3 && plan_wire(argv[3], &error))) {
        (void)fprintf(stderr, "plan: %s\n", error.what);
        return 1;
    }
    return 0;
}
