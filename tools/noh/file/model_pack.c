#define _POSIX_C_SOURCE 200809L /* open_memstream */

#include "model_pack.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#include "build/build_options.h"
#include "cli/message.h"
#include "file/pack_cache.h"

#define OPTIONS_MAX 8

/* This program, the options, and the model; not whether it is a draft. */
static int hash_model(const model_pack_desc *desc, content_hash *h)
{
    const char *slash = strrchr(desc->path, '/');
    struct stat program;
    memset(h, 0, sizeof *h);
    content_hash_add_text(h, NOH_VERSION);
    if (stat("/proc/self/exe", &program) == 0) {
        const int64_t stamp[3] = { (int64_t)program.st_size, (int64_t)program.st_mtim.tv_sec,
                                   (int64_t)program.st_mtim.tv_nsec };
        content_hash_add(h, stamp, sizeof stamp);
    }
    for (int i = 0; i < desc->option_count; i++) content_hash_add_text(h, desc->options[i]);
    content_hash_add_text(h, slash ? slash + 1 : desc->path); /* clips take the file's name */
    return content_hash_add_file(h, desc->path);
}

static int read_options(const model_pack_desc *desc, convert_options *o)
{
    char *argv[OPTIONS_MAX + 5] = { (char *)desc->path, (char *)"-o", (char *)"", (char *)"--effort", (char *)"1" };
    const int own = desc->draft ? 5 : 3;
    for (int i = 0; i < desc->option_count; i++) argv[own + i] = (char *)desc->options[i];
    return build_options_read(own + desc->option_count, argv, o);
}

/* The lines of the build's warnings, each with the model's name. */
static void print_warnings(const char *path, char *lines)
{
    for (char *line = strtok(lines, "\n"); line; line = strtok(NULL, "\n"))
        fprintf(stderr, "noh: %s: %s\n", path, line);
}

static int build(const model_pack_desc *desc, input_list *inputs, byte_buffer *pack, convert_failure *failure)
{
    convert_options o;
    char *warnings = NULL;
    size_t size = 0;
    int failed;
    failure->file = desc->path;
    if (read_options(desc, &o)) return model_fail(&failure->error, "", "wrong options");
    o.warnings = open_memstream(&warnings, &size);
    o.progress = desc->progress;
    o.inputs = inputs;
    failed = o.warnings ? convert_files(&desc->path, 1, &o, pack, failure) : model_fail_memory(&failure->error);
    if (o.warnings) fclose(o.warnings);
    if (warnings) print_warnings(desc->path, warnings);
    free(warnings);
    return failed;
}

int model_pack_make(const model_pack_desc *desc, byte_buffer *pack, convert_failure *failure)
{
    struct timespec now;
    content_hash begun;
    input_list inputs;
    int failed, is_there = hash_model(desc, &begun);
    memset(pack, 0, sizeof *pack);
    memset(failure, 0, sizeof *failure);
    memset(&inputs, 0, sizeof inputs);
    if (is_there && pack_cache_find(desc->path, begun, pack)) return 0;
    if (desc->draft) {
        content_hash_add_text(&begun, "draft");
        if (is_there && pack_cache_find(desc->path, begun, pack)) return 0;
    }
    (void)clock_gettime(CLOCK_REALTIME, &now);
    failed = build(desc, &inputs, pack, failure);
    if (!failed) {
        const int64_t start_ns = (int64_t)now.tv_sec * 1000000000 + (int64_t)now.tv_nsec;
        pack_cache_keep(desc->path, begun, &inputs, start_ns, pack);
    }
    inputs_free(&inputs);
    return failed;
}
