/* cmd_light.c: compares a pack's precomputed light transfer with brute force. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/json.h"
#include "cli/message.h"
#include "cli/options.h"
#include "cli/verbs.h"
#include "file/pack_file.h"
#include "light_measure.h"
#include "light_pose.h"
#include "draw/figure.h"

#define RAYS_MIN 64.0
#define RAYS_MAX 65536.0

typedef struct light_args {
    const char *pack;
    option_list weights;
    double rays;
    int as_json;
} light_args;

/* Bytes of a vertex's record: of the meshes together, all have the same. */
static uint32_t bytes_per_vertex(const noh_pack *pack)
{
    const noh_pack_chunk *chunk = &pack->chunks[pack->runs[NOH_CHUNK_TRANSFER].first];
    const noh_transfer_header *h = (const noh_transfer_header *)(const void *)(pack->bytes + chunk->offset);
    return NOH_TRANSFER_RECORD_BYTES(h->order, h->flags);
}

static void json_rms(json *j, const light_measure *m)
{
    static const struct {
        const char *key;
        int posed;
        light_method method;
        uint32_t kind;
    } rows[] = { { "rms_soft", 0, LIGHT_STORED, 0 },
                 { "rms_lamps", 0, LIGHT_STORED, 1 },
                 { "rms_morphed_soft", 1, LIGHT_STORED, 0 },
                 { "rms_morphed_lamps", 1, LIGHT_STORED, 1 },
                 { "seed_rms_soft", 0, LIGHT_SEED, 0 },
                 { "seed_rms_lamps", 0, LIGHT_SEED, 1 },
                 { "seed_rms_morphed_soft", 1, LIGHT_SEED, 0 },
                 { "seed_rms_morphed_lamps", 1, LIGHT_SEED, 1 } };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        json_number(j, rows[i].key, light_measure_rms(m, rows[i].posed, rows[i].method, rows[i].kind));
    }
}

static void json_pose(json *j, const light_args *a, const noh_pack *pack)
{
    noh_mesh mesh;
    json_open(j, "pose", '{');
    for (uint32_t i = 0; noh_pack_mesh_at(pack, i, &mesh, NULL) == NOH_OK; i++) {
        float *weights = malloc((mesh.header->target_count + 1u) * sizeof *weights);
        if (!weights) {
            break;
        }
        light_pose(&mesh, &a->weights, weights);
        for (uint32_t t = 0; t < mesh.header->target_count; t++) {
            if (weights[t] != 0.0f) {
                json_number(j, noh_pack_string(pack, mesh.targets[t].name), (double)weights[t]);
            }
        }
        free(weights);
    }
    json_close(j, '}');
}

static int print_json(const light_args *a, const noh_pack *pack, const light_measure *m)
{
    json j = json_begin();
    json_integer(&j, "vertices", m->vertices);
    json_integer(&j, "bytes_per_vertex", bytes_per_vertex(pack));
    json_rms(&j, m);
    json_integer(&j, "vertices_all", m->vertices_all);
    json_integer(&j, "rays", m->rays.count);
    json_pose(&j, a, pack);
    return json_end(&j);
}

static void print_row(const light_measure *m, const char *name, int posed)
{
    printf("%-12s %12.4f %12.4f %18.4f %12.4f\n", name, light_measure_rms(m, posed, LIGHT_STORED, 0),
           light_measure_rms(m, posed, LIGHT_STORED, 1), light_measure_rms(m, posed, LIGHT_SEED, 0),
           light_measure_rms(m, posed, LIGHT_SEED, 1));
}

static int print_table(const light_args *a, const noh_pack *pack, const light_measure *m)
{
    printf("%s: %u of %u vertices, %u bytes each; relative RMS against %u rays a vertex\n", a->pack, m->vertices,
           m->vertices_all, bytes_per_vertex(pack), m->rays.count);
    printf("%-12s %12s %12s %18s %12s\n", "", "soft", "lamps", "about normal: soft", "lamps");
    print_row(m, "bind pose", 0);
    print_row(m, "posed", 1);
    return 0;
}

static int measure_mesh(light_measure *m, const light_args *a, const noh_pack *pack, uint32_t index)
{
    noh_transfer transfer;
    model_error error;
    noh_mesh mesh;
    float *weights;
    int failed;
    (void)noh_pack_mesh_at(pack, index, &mesh, NULL);
    if (noh_transfer_of(&mesh, &transfer, NULL)) {
        return 0;
    }
    weights = malloc((mesh.header->target_count + 1u) * sizeof *weights);
    if (!weights) {
        return tool_fail(a->pack, "out of memory");
    }
    light_pose(&mesh, &a->weights, weights);
    failed = light_measure_mesh(m, pack, index, weights, &error);
    free(weights);
    return failed ? tool_fail(a->pack, "%s", error.what) : 0;
}

/* Every --weight is NAME=V of a target that some mesh has. */
static int check_weights(const light_args *a, const pack_file *file)
{
    const figure_desc desc = { .file = file, .held_float_count = (uint32_t)a->weights.count };
    figure f;
    int status = figure_open(&f, &desc, NULL);
    if (!status) {
        status = figure_hold_options(&f, &a->weights);
        figure_close(&f);
    }
    return status;
}

static int measure(const light_args *a, const pack_file *file)
{
    light_measure m;
    int status;
    if (!file->pack.runs[NOH_CHUNK_TRANSFER].count) {
        return tool_fail(a->pack, "the pack has no light transfer: build it with --transfer 4 or 6");
    }
    status = check_weights(a, file);
    if (status) {
        return status;
    }
    status = light_measure_open(&m, (uint32_t)a->rays) ? tool_fail(a->pack, "out of memory") : 0;
    for (uint32_t i = 0; i < file->pack.runs[NOH_CHUNK_MESH].count && !status; i++) {
        status = measure_mesh(&m, a, &file->pack, i);
    }
    if (!status) status = a->as_json ? print_json(a, &file->pack, &m) : print_table(a, &file->pack, &m);
    light_measure_close(&m);
    return status;
}

static int run(void *args)
{
    const light_args *a = args;
    pack_file file;
    int status;
    if (!(a->rays >= RAYS_MIN && a->rays <= RAYS_MAX) || a->rays != (double)(uint32_t)a->rays) {
        return tool_usage("--rays must be a whole number from %.0f to %.0f", RAYS_MIN, RAYS_MAX);
    }
    status = pack_file_open(&file, a->pack);
    if (!status) {
        status = measure(a, &file);
        pack_file_close(&file);
    }
    return status;
}

static light_args arguments;

static const option options[] = {
    OPTION_WEIGHT(light_args, weights, .needs = NULL),
    { .name = "--rays",
      .kind = OPTION_NUMBER,
      .at = offsetof(light_args, rays),
      .value = "N",
      .initial = "4096",
      .what = "rays per vertex of the brute force, over the whole sphere, 64 to 65536",
      .example = "1024" },
    OPTION_JSON(light_args, as_json),
};

const verb verb_light = {
    .name = "lab light",
    .files = "PACK|MODEL",
    .what = "compare precomputed light (noh build --transfer) with brute force",
    .more =
        "Prints the relative root mean square error of the light reflected by white matte vertices, against rays from every vertex, over 12 random lights of each kind: soft lights, and lamps of about 25 degrees; and the same for the method of the SparseMorphTargets sample, lobes about the normal. Vertices that see less than 15 % of the sphere are left out. Without --weight the pose is an open mouth, brows down and mouth corners pulled, by the targets' names, or else the four targets that move the farthest.",
    .example = "head.noh\nhead.noh --json --weight jawOpen=1",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .file_max = 1,
    .files_at = offsetof(light_args, pack),
    .args = &arguments,
    .run = run,
};
