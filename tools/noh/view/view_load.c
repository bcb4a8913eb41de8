#define _POSIX_C_SOURCE 200809L
#include "view/view_load.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cli/message.h"
#include "convert/base/file_kind.h"
#include "file/model_pack.h"

int view_is_model(const char *path)
{
    return file_kind_is_built(file_kind_of(path));
}

/* ---- the process that converts ---- */

static int write_all(int file, const uint8_t *bytes, size_t count)
{
    while (count) {
        const ssize_t written = write(file, bytes, count);
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return 0;
        bytes += written;
        count -= (size_t)written;
    }
    return 1;
}

/* Ends with 0 where the pack is whole; else its last words are the reason. */
static void convert(const view_load *l, const char *levels, int words)
{
    const char *options[] = { "--lod", levels, "--lod-fast" }; /* quick */
    model_pack_desc desc = { .path = l->path, .options = options, .option_count = levels ? 3 : 0, .draft = 1 };
    byte_buffer pack;
    convert_failure failure;
    desc.progress = fdopen(words, "w");
    if (!desc.progress) _exit(EXIT_FAILED);
    fprintf(desc.progress, "\rreading");
    fflush(desc.progress);
    if (model_pack_make(&desc, &pack, &failure)) {
        fprintf(desc.progress, "\r!%s%s%s%s", failure.error.what, failure.error.where[0] ? " (" : "",
                failure.error.where, failure.error.where[0] ? ")" : "");
        fflush(desc.progress);
        _exit(EXIT_FAILED);
    }
    if (!write_all(l->bytes, pack.bytes, pack.count)) {
        fprintf(desc.progress, "\r!cannot write the converted file: no space left");
        fflush(desc.progress);
        _exit(EXIT_FAILED);
    }
    fflush(NULL);
    _exit(0);
}

/* ---- the viewer ---- */

static void close_files(view_load *l)
{
    if (l->words > 0) close(l->words);
    if (l->bytes > 0) close(l->bytes);
    l->words = l->bytes = 0;
}

/* A file without a name. */
static int open_nameless(void)
{
    FILE *stream = tmpfile();
    const int file = stream ? dup(fileno(stream)) : -1;
    if (stream) fclose(stream);
    return file;
}

int view_load_start(view_load *l, const char *path, const char *levels)
{
    int ends[2];
    view_load_cancel(l);
    if (strlen(path) >= sizeof l->path) return tool_fail(path, "the path is too long");
    if (l->path != path) strcpy(l->path, path);
    strcpy(l->does, "starting");
    l->bytes = open_nameless();
    if (l->bytes < 0 || pipe(ends)) {
        close_files(l);
        return tool_fail(path, "cannot make a temporary file or pipe: %s", strerror(errno));
    }
    fflush(NULL); /* or the other process writes it again */
    l->process = fork();
    if (l->process == 0) {
        close(ends[0]);
        convert(l, levels, ends[1]);
    }
    close(ends[1]);
    l->words = ends[0];
    if (l->process < 0) {
        l->process = 0;
        close_files(l);
        return tool_fail(path, "cannot start a process to convert it: %s", strerror(errno));
    }
    (void)fcntl(l->words, F_SETFL, O_NONBLOCK);
    l->started_ns = noh_clock_ns();
    l->state = VIEW_LOAD_RUNS;
    return 0;
}

/* Keep what follows the last carriage return, without a terminal's signs. */
static void hear(view_load *l)
{
    char heard[1024];
    ssize_t count;
    while ((count = read(l->words, heard, sizeof heard)) > 0 || (count < 0 && errno == EINTR)) {
        size_t length = strlen(l->does);
        for (ssize_t i = 0; i < count; i++) {
            if (heard[i] == '\r') length = 0;
            if (heard[i] == '\033' && i + 2 < count)
                i += 2;
            else if (heard[i] >= ' ' && length + 1u < sizeof l->does)
                l->does[length++] = heard[i];
        }
        if (length || !l->does[0]) l->does[length] = 0;
    }
}

view_load_state view_load_poll(view_load *l)
{
    int status = 0;
    pid_t ended;
    if (l->state != VIEW_LOAD_RUNS) return l->state;
    hear(l);
    ended = waitpid(l->process, &status, WNOHANG);
    if (ended == 0 || (ended < 0 && errno == EINTR)) return l->state;
    hear(l);
    l->process = 0;
    if (ended > 0 && WIFEXITED(status) && WEXITSTATUS(status) == 0) {
        l->state = VIEW_LOAD_DONE;
        return l->state;
    }
    if (l->does[0] == '!') {
        tool_fail(l->path, "%s", l->does + 1);
    } else {
        tool_fail(l->path, "the conversion crashed while %s", l->does);
    }
    close_files(l);
    l->state = VIEW_LOAD_FAILED;
    return l->state;
}

int view_load_take(view_load *l, byte_buffer *out)
{
    const off_t end = l->state == VIEW_LOAD_DONE ? lseek(l->bytes, 0, SEEK_END) : -1;
    int status = 0;
    memset(out, 0, sizeof *out);
    if (end <= 0 || lseek(l->bytes, 0, SEEK_SET) || !buffer_append(out, NULL, (size_t)end)) {
        status = tool_fail(l->path, "the converted file cannot be read back");
    }
    for (size_t at = 0; !status && at < out->count;) {
        const ssize_t count = read(l->bytes, out->bytes + at, out->count - at);
        if (count > 0)
            at += (size_t)count;
        else if (count == 0 || errno != EINTR)
            status = tool_fail(l->path, "the converted file cannot be read back");
    }
    close_files(l);
    l->state = VIEW_LOAD_NONE;
    if (status) buffer_free(out);
    return status;
}

void view_load_cancel(view_load *l)
{
    if (l->process > 0) {
        kill(l->process, SIGKILL);
        while (waitpid(l->process, NULL, 0) < 0 && errno == EINTR) {}
    }
    l->process = 0;
    close_files(l);
    l->state = VIEW_LOAD_NONE;
}

double view_load_seconds(const view_load *l)
{
    return (double)(noh_clock_ns() - l->started_ns) * 1e-9;
}
