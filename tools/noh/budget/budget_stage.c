/* budget_stage.c: makes a stage from the options of `noh budget`. */
#include <stdlib.h>
#include <string.h>

#include "budget_args.h"
#include "crowd/place_people.h"
#include "draw/drawn_hair.h"
#include "file/ground_file.h"
#include "stage_budget.h"
#include "stage_desc_file.h"
#include "cli/message.h"
#include "convert/base/input_file.h"

#define BYTES_MAX 9007199254740992.0 /* whole numbers up to here are exact as doubles */

static int check_counts(budget_args *a)
{
    static const struct {
        const char *name;
        double least, most;
    } rows[COUNT_OPTIONS] = {
        { "--actors", 1.0, NOH_STAGE_ACTORS_MAX },
        { "--near", 0.0, NOH_STAGE_ACTORS_MAX },
        { "--middle", 0.0, NOH_STAGE_ACTORS_MAX },
        { "--finest", 0.0, NOH_LOD_LEVELS_MAX - 1u },
        { "--bytes", 1.0, BYTES_MAX },
        { "--cpu-bytes", 1.0, BYTES_MAX },
        { "--gpu-bytes", 1.0, BYTES_MAX },
        { "--height", 1.0, 65536.0 },
        { "--jobs", 1.0, NOH_STAGE_JOBS_MAX },
        { "--ragdolls", 1.0, NOH_RAGDOLLS_MAX },
    };
    for (int i = 0; i < COUNT_OPTIONS; i++) {
        double value;
        if (!a->texts[i]) continue;
        if (tool_number(a->texts[i], &value) || !(value >= rows[i].least && value <= rows[i].most) ||
            value > (double)(uint64_t)value) {
            return tool_usage("%s must be a whole number from %.0f to %.0f, not '%s'", rows[i].name, rows[i].least,
                              rows[i].most, a->texts[i]);
        }
        a->counts[i] = (uint64_t)value;
    }
    return 0;
}

static int check_pixels(budget_args *a)
{
    if (a->pixels_text && (tool_number(a->pixels_text, &a->pixels) || !(a->pixels > 0.0 && a->pixels <= 1e6))) {
        return tool_usage("--pixels must be a number above 0 and at most 1000000, not '%s'", a->pixels_text);
    }
    return 0;
}

int stage_args_check(budget_args *a)
{
    const int status = check_counts(a);
    return status ? status : check_pixels(a);
}

/* Options override the text. */
static void apply_options(const budget_args *a, noh_stage_desc *desc)
{
    const uint64_t *counts = a->counts;
    if (counts[BYTES]) desc->bytes_max = counts[BYTES];
    if (counts[CPU_BYTES]) desc->cpu_bytes_max = counts[CPU_BYTES];
    if (counts[GPU_BYTES]) desc->gpu_bytes_max = counts[GPU_BYTES];
    if (counts[HEIGHT]) desc->height_px = (uint32_t)counts[HEIGHT];
    if (counts[JOBS]) desc->job_count = (uint32_t)counts[JOBS];
    if (a->pixels_text) desc->lod.pixels = (float)a->pixels;
    if (a->halves) desc->halves = 1;
    desc->gpu = a->without_gpu ? NULL : &noh_stage_on_gl;
    desc->morph_path = (uint32_t)a->figure.path;
}

/* Why a crowd has no size. */
static int fail_crowd(const char *subject, const noh_crowd_desc *desc)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_crowd *crowd;
    (void)noh_crowd_init(NULL, 0, desc, &crowd, &error);
    return tool_fail_error(subject, &error);
}

/* The parts of a place in addition to its stage: agents, flow fields, smart objects and walkers. */
static int add_place(stage_budget *b, const place_file *place, const place_people *people)
{
    noh_crowd_desc crowd;
    noh_smart_desc smart;
    place_crowd_desc(place, people->kind.actor_count, &crowd);
    place_smart_desc(place, people->kind.actor_count, &smart);
    const size_t whole = noh_crowd_size(&crowd);
    crowd.field_count = 0;
    const size_t agents = noh_crowd_size(&crowd);
    if (!whole) return fail_crowd(b->subject, &crowd);
    int status = stage_budget_add(b, "crowd", agents, 0);
    if (!status && whole != agents) status = stage_budget_add(b, "flow fields", whole - agents, 0);
    if (!status && smart.object_count) status = stage_budget_add(b, "smart objects", noh_smart_size(&smart), 0);
    if (!status) status = stage_budget_add(b, "walkers", noh_walkers_size(&people->walkers), 0);
    if (status || !place->ground || !b->caps) return status;
    return stage_budget_add(b, "terrain", noh_stage_terrain_size(place->ground),
                            noh_stage_terrain_bytes(place->ground));
}

/* Of a pack's characters, as `noh crowd` draws it. */
static int add_hair(stage_budget *b, const pack_file *file, const noh_kind_desc *kind)
{
    drawn_hair hair;
    uint64_t cpu_bytes, gpu_bytes;
    noh_error error = { NOH_OK, "", 0, 0 };
    if (drawn_hair_plan(&hair, &file->pack, 0, kind->skeleton, kind->actor_count, &error)) {
        return tool_fail_error(file->path, &error);
    }
    drawn_hair_bytes(&hair, &cpu_bytes, &gpu_bytes);
    return hair.is_there ? stage_budget_add(b, "hair", cpu_bytes, gpu_bytes) : 0;
}

/* place and people, file NULL: none */
static int budget_of_stage(const budget_args *a, const char *subject, noh_stage_desc *desc, const place_file *place,
                           const place_people *people, const pack_file *file)
{
    noh_gl_caps caps;
    stage_budget b;
    int status = 0;
    apply_options(a, desc);
    if (desc->gpu) status = budget_caps(a, 1, &caps);
    if (!status) status = stage_budget_make(&b, subject, desc, desc->gpu ? &caps : NULL);
    if (status) return status;
    if (place && people) status = add_place(&b, place, people);
    if (!status && file && desc->gpu) status = add_hair(&b, file, &desc->kinds[0]);
    if (!status && a->as_json) status = stage_budget_json(&b);
    if (!status && !a->as_json) stage_budget_print(&b);
    if (!status && a->strict && b.plan.concession_count) {
        status = tool_fail(subject,
                           "the stage meets its limit only by giving up %u feature%s: raise the limit, or ask for less",
                           b.plan.concession_count, b.plan.concession_count == 1u ? "" : "s");
    }
    stage_budget_free(&b);
    return status;
}

/* Peers first, for the plan of a stage reads theirs. */
static int plan_peers(const budget_args *a, stage_desc_file *file, const noh_gl_caps *caps)
{
    int status = 0;
    for (uint32_t i = 0; i < file->share.peer_count && !status; i++) {
        noh_stage_desc *desc = &file->peer_files[i]->desc;
        noh_error error;
        status = plan_peers(a, file->peer_files[i], caps);
        desc->gpu = a->without_gpu ? NULL : &noh_stage_on_gl;
        desc->morph_path = (uint32_t)a->figure.path;
        if (!status && noh_stage_plan_make(desc, desc->gpu ? caps : NULL, &file->peer_plans[i], &error)) {
            status = tool_fail_error(a->desc, &error);
        }
    }
    return status;
}

int budget_of_desc(const budget_args *a)
{
    stage_desc_file *file;
    int status = stage_desc_file_read(a->desc, &file);
    if (!status) {
        noh_gl_caps caps;
        if (file->share.peer_count && !a->without_gpu) status = budget_caps(a, 1, &caps);
        if (!status) status = plan_peers(a, file, &caps);
        if (!status) status = budget_of_stage(a, a->desc, &file->desc, NULL, NULL, NULL);
        stage_desc_file_free(file);
    }
    return status;
}

/* One kind: the pack's characters, in a place if there is one. */
static int budget_of_kind(const budget_args *a, const pack_file *file, const noh_pack *const *clips)
{
    static place_people people;
    const noh_kind_ragdoll ragdoll = { .count = (uint32_t)a->counts[RAGDOLLS] };
    noh_kind_desc kind;
    noh_stage_desc desc;
    place_file *place = NULL;
    ground_file ground;
    char *name = input_stem(a->pack);
    int status = a->place ? place_read(a->place, &place) : 0;
    memset(&ground, 0, sizeof ground);
    memset(&kind, 0, sizeof kind);
    memset(&desc, 0, sizeof desc);
    if (!status && a->ground) status = ground_file_open(&ground, a->ground);
    if (!status && place) {
        place->ground = a->ground ? &ground.field : NULL;
        status = place_people_make(&people, file, place, (uint32_t)a->counts[ACTORS], ragdoll.count);
        kind = people.kind;
    }
    kind.name = name ? name : a->pack;
    kind.springs = noh_springs_module(NULL);
    kind.mesh = &file->pack;
    kind.clip_packs = a->clips.count ? clips : NULL;
    kind.clip_pack_count = (uint32_t)a->clips.count;
    kind.actor_count = (uint32_t)a->counts[ACTORS];
    kind.near_count = (uint32_t)a->counts[NEAR];
    kind.middle_count = (uint32_t)a->counts[MIDDLE];
    kind.finest_level = (uint32_t)a->counts[FINEST];
    if (ragdoll.count && !place) kind.ragdoll = noh_ragdoll_module(&ragdoll);
    desc.kinds = &kind;
    desc.kind_count = 1;
    if (!status) status = budget_of_stage(a, a->pack, &desc, place, &people, file);
    ground_file_close(&ground);
    place_free(place);
    free(name);
    return status;
}

int budget_of_actors(const budget_args *a)
{
    const noh_pack *packs[STAGE_DESC_CLIPS_MAX];
    pack_file file, clips[STAGE_DESC_CLIPS_MAX];
    int open = 0, status;
    if (a->clips.count > (int)STAGE_DESC_CLIPS_MAX) {
        return tool_usage("--clips may be given at most %u times", STAGE_DESC_CLIPS_MAX);
    }
    status = pack_file_open(&file, a->pack);
    for (; open < a->clips.count && !status; open++) {
        status = pack_file_open(&clips[open], a->clips.items[open]);
        packs[open] = &clips[open].pack;
    }
    if (!status) status = budget_of_kind(a, &file, packs);
    while (open) {
        pack_file_close(&clips[--open]);
    }
    pack_file_close(&file);
    return status;
}
