/* fuzz_import.c: any bytes as the files that noh build reads: glTF, VRM, FBX, OBJ with targets, BVH, facial capture,
 * markers, raw clips, pictures, and text files; and what other verbs read: places, sound, packets of a capture. What
 * is read is converted, and the pack used in full.
 *
 * The kind follows from the first bytes, so that seeds are files as they are. A .glb is tried as it is, then with the
 * lengths of its chunks made right. An .obj file is also its own target. */
#define _XOPEN_SOURCE 700

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "capture/vmc.h"
#include "cli/message.h"
#include "convert/base/hair_read.h"
#include "convert/base/image_file.h"
#include "convert/base/ragdoll_read.h"
#include "convert/base/recipe_read.h"
#include "convert/choices.h"
#include "convert/clips/events_read.h"
#include "convert/convert.h"
#include "convert/graph/graph_text.h"
#include "convert/springs/springs_read.h"
#include "crowd/place_file.h"
#include "noh/base.h"
#include "noh/pack.h"
#include "speak/sound.h"
#include "support/fuzz_replay.h"
#include "support/pack_walk.h"
#include "support/wild_bytes.h"
#include "support/wild_text.h"

#define WILD_S 5         /* of the processor, of one file of at most 64 KB */
#define WILD_KB 2000000L /* of memory, at most, of all before it, too */

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t count);

static char folder[64], target_folder[80];
static int converted; /* the last input, for the replay */

static void remove_folders(void)
{
    char path[128];
    static const char *const names[] = { "in.glb", "in.gltf", "in.fbx", "in.obj", "in.bvh",       "in.rcl",
                                         "in.csv", "in.trc",  "in.c3d", "in.txt", "targets/a.obj" };
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        (void)snprintf(path, sizeof path, "%s/%s", folder, names[i]);
        (void)remove(path);
    }
    (void)rmdir(target_folder);
    (void)rmdir(folder);
}

static void make_folders(void)
{
    const char *root = access("/dev/shm", W_OK) ? "/tmp" : "/dev/shm";
    (void)snprintf(folder, sizeof folder, "%s/noh_fuzz_XXXXXX", root);
    if (!mkdtemp(folder)) abort();
    (void)snprintf(target_folder, sizeof target_folder, "%s/targets", folder);
    if (mkdir(target_folder, 0700)) abort();
    (void)atexit(remove_folders);
}

static void write_to(const char *path, const uint8_t *bytes, size_t count)
{
    FILE *f = fopen(path, "wb");
    if (!f || fwrite(bytes, 1, count, f) != count || fclose(f)) abort();
}

/* Defaults of noh build, but two levels of detail where `more` says so, and clips as they come. */
static convert_options options_of(int more, int split_eyes)
{
    convert_options o;
    memset(&o, 0, sizeof o);
    o.clip.clip.error_cm = 0.01;
    o.clip.clip.shell_cm = 3.0;
    o.clip.clip.effort = 1;
    o.source.skin.influences = 4;
    o.source.skin.palette = more ? 8 : NOH_PALETTE_JOINTS_MAX;
    o.lod.mode = LOD_FAST;
    o.lod.level_count = more ? 2 : 0;
    o.source.clean = more ? ~0u : 0u;
    o.source.split_eyes = split_eyes;
    o.source.choices = more ? CHOICE_EYES | CHOICE_LIPS : 0u;
    o.choose_levels = more;
    o.blocks = MODEL_BLOCKS_ETC2;
    o.texture_max = 256;
    return o;
}

static void must_say(const model_error *e)
{
    if (e->what[0] && !strchr(e->what, '\n') && !strchr(e->where, '\n')) return;
    fprintf(stderr, "an error without a what, or in lines: '%s' (%s)\n", e->what, e->where);
    abort();
}

static void convert(const char *path, const char *targets, int more, int split_eyes)
{
    const char *inputs[] = { path };
    convert_options o = options_of(more, split_eyes);
    convert_failure failure;
    byte_buffer out = { NULL, 0, 0, 0 };
    noh_pack pack;
    noh_error error;
    void *aligned;
    memset(&failure, 0, sizeof failure);
    o.source.targets = targets;
    if (convert_files(inputs, 1, &o, &out, &failure)) {
        must_say(&failure.error);
        return;
    }
    if (posix_memalign(&aligned, 64, out.count)) abort();
    memcpy(aligned, out.bytes, out.count);
    if (noh_pack_open(aligned, out.count, &pack, &error) != NOH_OK) {
        fprintf(stderr, "the pack does not open: %s\n", error.what);
        abort();
    }
    pack_walk(&pack, 1);
    converted = 1;
    free(aligned);
    buffer_free(&out);
}

static void try_as(const char *ending, const uint8_t *bytes, size_t count)
{
    char path[96], target[128];
    const int is_obj = strcmp(ending, "obj") == 0;
    (void)snprintf(path, sizeof path, "%s/in.%s", folder, ending);
    write_to(path, bytes, count);
    (void)snprintf(target, sizeof target, "%s/a.obj", target_folder);
    if (is_obj) write_to(target, bytes, count);
    convert(path, is_obj ? target_folder : NULL, count % 2u != 0, count % 8u == 3u);
}

/* ---- .glb: the lengths made right ---- */

static void put_word(uint8_t *to, size_t word)
{
    const uint32_t narrow = (uint32_t)word;
    memcpy(to, &narrow, sizeof narrow);
}

/* The second chunk begins where its name is; what is before it is text, padded to four bytes. */
static void try_repaired(const uint8_t *bytes, size_t count)
{
    size_t bin = 20, text, rest;
    uint8_t *copy;
    while (bin + 8 <= count && memcmp(bytes + bin + 4, "BIN", 4) != 0) bin++;
    text = ((bin + 8 <= count ? bin : count) - 20 + 3) / 4 * 4;
    rest = bin + 8 <= count ? (count - bin - 8 + 3) / 4 * 4 : 0;
    copy = malloc(28 + text + rest);
    if (!copy) abort();
    memset(copy, 0, 28 + text + rest);
    memcpy(copy, bytes, 20);
    memset(copy + 20, ' ', text);
    memcpy(copy + 20, bytes + 20, (bin + 8 <= count ? bin : count) - 20);
    put_word(copy + 8, 28 + text + rest);
    put_word(copy + 12, text);
    memcpy(copy + 16, "JSON", 4);
    put_word(copy + 20 + text, rest);
    memcpy(copy + 24 + text, "BIN", 4);
    if (bin + 8 <= count) memcpy(copy + 28 + text, bytes + bin + 8, count - bin - 8);
    try_as("glb", copy, 28 + text + rest);
    free(copy);
}

/* ---- what is no model ---- */

static void try_picture(const uint8_t *bytes, size_t count)
{
    image_file image;
    model_error error = { "", "" };
    uint32_t width, height;
    uint16_t *grey;
    char path[96];
    (void)snprintf(path, sizeof path, "%s/in.txt", folder);
    write_to(path, bytes, count);
    if (image_read(path, &image, &error)) must_say(&error);
    free(image.rgba);
    if (image_read_grey(path, &width, &height, &grey, &error)) must_say(&error);
    free(grey);
}

static void try_texts(const uint8_t *bytes, size_t count)
{
    char path[96];
    uint32_t line = 0;
    model_error error = { "", "" };
    hair_text *hair = NULL;
    ragdoll_text *ragdoll = NULL;
    recipe_text *recipe = NULL;
    event_list *events = NULL;
    graph_file *graph = NULL;
    springs_text *springs = springs_text_new();
    place_file *place = NULL;
    (void)snprintf(path, sizeof path, "%s/in.txt", folder);
    write_to(path, bytes, count);
    if (hair_read(path, &hair, &line, &error)) must_say(&error);
    if (ragdoll_read(path, &ragdoll, &line, &error)) must_say(&error);
    if (recipe_read(path, &recipe, &line, &error)) must_say(&error);
    if (events_read(path, &events, &error)) must_say(&error);
    if (graph_text_read(path, &graph, &line, &error)) must_say(&error);
    if (springs && springs_text_read(springs, path, &line, &error)) must_say(&error);
    if (place_parse((const char *)bytes, count, &place, &line, &error)) must_say(&error);
    hair_free(hair);
    ragdoll_free(ragdoll);
    recipe_free(recipe);
    events_free(events);
    graph_text_free(graph);
    springs_text_free(springs);
    place_free(place);
}

/* As `noh speak` reads it. */
static void try_sound(const uint8_t *bytes, size_t count)
{
    sound whole, resampled;
    char path[96];
    (void)snprintf(path, sizeof path, "%s/in.txt", folder);
    write_to(path, bytes, count);
    tool_errors_quiet();
    if (sound_read(path, &whole)) return;
    if (!whole.count || sound_resample(&whole, 16000, &resampled)) abort();
    for (size_t i = 0; i < resampled.count; i++) {
        if (!(resampled.samples[i] > -2e6f && resampled.samples[i] < 2e6f)) abort();
    }
    sound_free(&resampled);
    sound_free(&whole);
    converted = 1;
}

static void try_packet(const uint8_t *bytes, size_t count)
{
    static vmc v;
    memset(&v, 0, sizeof v);
    vmc_take(&v, bytes, count);
    if (v.messages + v.bad > count || v.value_count > VMC_VALUES_MAX) abort();
    converted = v.messages > 0 && v.bad == 0;
}

static int begins(const uint8_t *bytes, size_t count, const char *with)
{
    return count >= strlen(with) && memcmp(bytes, with, strlen(with)) == 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t count)
{
    if (!folder[0]) make_folders();
    converted = 0;
    if (begins(data, count, "glTF")) {
        try_as("glb", data, count);
        if (!converted && count >= 28) try_repaired(data, count);
    } else if (begins(data, count, "{")) {
        try_as("gltf", data, count);
    } else if (begins(data, count, "Kaydara FBX") || begins(data, count, "; FBX") || begins(data, count, "FBXHeader")) {
        try_as("fbx", data, count);
    } else if (begins(data, count, "HIER")) {
        try_as("bvh", data, count);
    } else if (begins(data, count, "Time")) {
        try_as("csv", data, count);
    } else if (begins(data, count, "PathFile")) {
        try_as("trc", data, count);
    } else if (count > 1 && data[1] == 0x50 && data[0] < 8) {
        try_as("c3d", data, count);
    } else if (begins(data, count, "RCL")) {
        try_as("rcl", data, count);
    } else if (begins(data, count, "RIFF") && count > 8 && begins(data + 8, count - 8, "WAVE")) {
        try_sound(data, count);
    } else if (begins(data, count, "#bundle") || begins(data, count, "/VMC")) {
        try_packet(data, count);
    } else if (begins(data, count, "\x89PNG") || begins(data, count, "\xff\xd8") || begins(data, count, "RIFF")) {
        try_picture(data, count);
    } else if (begins(data, count, "text")) {
        try_texts(data + 4, count - 4);
    } else {
        try_as("obj", data, count);
    }
    return 0;
}

#ifndef NOH_LIBFUZZER

static int try_input(const uint8_t *bytes, size_t count)
{
    LLVMFuzzerTestOneInput(bytes, count);
    return converted;
}

/* A valid text, or a file of bytes, into to[TEXT_ROOM]; *name: its format. Returns its length. */
static size_t seed_of(size_t which, uint8_t *to, const char **name)
{
    if (which >= wild_seed_count) {
        *name = wild_bytes_names[which - wild_seed_count];
        return wild_bytes_seed((int)(which - wild_seed_count), to);
    }
    *name = wild_seeds[which].name;
    memcpy(to, wild_seeds[which].text, strlen(wild_seeds[which].text));
    return strlen(wild_seeds[which].text);
}

/* Every kind of text with grammatical edits, and of bytes with edits of fields, cases first to first + count - 1. What
 * a case takes is limited: a file of a few kilobytes is refused or converted in seconds. The file as it is has to be
 * read. A case that fails leaves its file in the folder that is printed. */
static int run_wild(uint32_t first, uint32_t count)
{
    static uint8_t bytes[1u << 16];
    const size_t kinds = wild_seed_count + WILD_BYTES_COUNT;
    for (size_t s = 0; s < kinds; s++) {
        const char *name;
        size_t whole = seed_of(s, bytes, &name);
        unsigned passed = 0;
        clock_t longest = 0;
        uint32_t slowest = 0;
        const int is_read = s < wild_seed_count || try_input(bytes, whole);
        struct rusage used;
        if (!is_read && strncmp(name, "wav", 3) == 0 && !dlopen("libsndfile.so.1", RTLD_NOW)) {
            printf("ok %u - %s # SKIP libsndfile is not here\n", (unsigned)s + 1u, name);
            continue;
        }
        for (uint32_t i = first; i < first + count; i++) {
            const clock_t begin = clock();
            clock_t taken;
            whole = seed_of(s, bytes, &name);
            whole = s < wild_seed_count ? wild_text((char *)bytes, whole, sizeof bytes, i)
                                        : wild_bytes(bytes, whole, WILD_BYTES_ROOM, i);
            passed += (unsigned)try_input(bytes, whole);
            taken = clock() - begin;
            if (taken > longest) longest = taken, slowest = i;
        }
        (void)getrusage(RUSAGE_SELF, &used);
        printf("%s %u - %s: %u wild files, %u converted; the slowest, %u, took %ld ms; %ld MB until here%s\n",
               is_read && longest < WILD_S * CLOCKS_PER_SEC && used.ru_maxrss < WILD_KB ? "ok" : "not ok",
               (unsigned)s + 1u, name, count, passed, slowest, (long)(longest * 1000 / CLOCKS_PER_SEC),
               used.ru_maxrss / 1024, is_read ? "" : "; the valid file was refused");
        fflush(stdout);
    }
    printf("1..%u\n", (unsigned)kinds);
    return 0;
}

/* The valid files, for libFuzzer. */
static int write_seeds(const char *to)
{
    static uint8_t bytes[1u << 16];
    for (size_t s = 0; s < wild_seed_count + WILD_BYTES_COUNT; s++) {
        char path[512];
        const char *name;
        const size_t count = seed_of(s, bytes, &name);
        (void)snprintf(path, sizeof path, "%s/%s", to, name);
        write_to(path, bytes, count);
    }
    return 0;
}

/* fuzz_import FILE|FOLDER...          replay
 * fuzz_import --wild FIRST COUNT      edits of valid files
 * fuzz_import --seeds FOLDER          write those */
int main(int argument_count, char **arguments)
{
    if (argument_count == 4 && !strcmp(arguments[1], "--wild"))
        return run_wild((uint32_t)atoi(arguments[2]), (uint32_t)atoi(arguments[3]));
    if (argument_count == 3 && !strcmp(arguments[1], "--seeds")) return write_seeds(arguments[2]);
    return fuzz_replay(argument_count, arguments, try_input);
}

#else

/* Half of libFuzzer's edits are its own, half keep the grammar. */
size_t LLVMFuzzerMutate(uint8_t *data, size_t count, size_t room);
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t count, size_t room, unsigned seed);
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t count, size_t room, unsigned seed)
{
    const int is_text = count && !memchr(data, 0, count);
    if (seed % 2u || !count) return LLVMFuzzerMutate(data, count, room);
    return is_text ? wild_text((char *)data, count, room, seed) : wild_bytes(data, count, room, seed);
}

#endif
