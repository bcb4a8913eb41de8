#define _POSIX_C_SOURCE 200809L
#include "film_file.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cli/message.h"
#include "png_file.h"

static const char *ending_of(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot ? dot : "";
}

/* ---- ffmpeg ---- */

/* How an ending is encoded: a filter, and the encoder's own words. A GIF has one palette of 255 colours for all its
 * pictures, the best that they have together. */
static const char *const *words_of(const char *ending)
{
    static const char *const gif[] = { "-filter_complex",
                                       "split[a][b];[a]palettegen=stats_mode=full[p];[b][p]paletteuse",
                                       "-loop",
                                       "0",
                                       "-f",
                                       "gif",
                                       NULL };
    static const char *const mp4[] = {
        "-vf", "crop=trunc(iw/2)*2:trunc(ih/2)*2", "-c:v", "libx264", "-crf", "16", "-pix_fmt", "yuv420p", "-f", "mp4",
        NULL
    };
    static const char *const webm[] = {
        "-vf", "crop=trunc(iw/2)*2:trunc(ih/2)*2", "-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-f", "webm", NULL
    };
    static const char *const apng[] = { "-plays", "0", "-f", "apng", NULL };
    return strcmp(ending, ".gif") == 0    ? gif
           : strcmp(ending, ".mp4") == 0  ? mp4
           : strcmp(ending, ".webm") == 0 ? webm
           : strcmp(ending, ".apng") == 0 ? apng
                                          : NULL;
}

static void run_ffmpeg(const film *f, int from, const char *const *words)
{
    char size[32], rate[16];
    const char *arguments[32] = { "ffmpeg", "-nostdin", "-loglevel", "error", "-y", "-f", "rawvideo", "-pix_fmt",
                                  "rgba",   "-s",       size,        "-r",    rate, "-i", "pipe:0",   NULL };
    int count = 15;
    snprintf(size, sizeof size, "%ux%u", f->width, f->height);
    snprintf(rate, sizeof rate, "%u", f->rate_hz);
    while (*words && count < 30) arguments[count++] = *words++;
    arguments[count++] = f->path;
    arguments[count] = NULL;
    if (dup2(from, STDIN_FILENO) >= 0) execvp(arguments[0], (char *const *)(uintptr_t)arguments);
    _exit(errno == ENOENT ? 127 : 126);
}

static int start_ffmpeg(film *f, const char *const *words)
{
    int ends[2];
    if (pipe(ends)) return tool_fail(f->path, "cannot open a pipe to ffmpeg: %s", strerror(errno));
    (void)fcntl(ends[0], F_SETFD, FD_CLOEXEC);
    (void)fcntl(ends[1], F_SETFD, FD_CLOEXEC);
    fflush(NULL);
    f->process = fork();
    if (f->process < 0) {
        close(ends[0]);
        close(ends[1]);
        f->process = 0;
        return tool_fail(f->path, "cannot start ffmpeg: %s", strerror(errno));
    }
    if (!f->process) run_ffmpeg(f, ends[0], words);
    close(ends[0]);
    f->pipe = ends[1];
    return 0;
}

static int wait_for(film *f)
{
    int status = 0;
    while (waitpid(f->process, &status, 0) < 0) {
        if (errno != EINTR) break;
    }
    f->process = 0;
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return 0;
    if (WIFEXITED(status) && WEXITSTATUS(status) == 127)
        return tool_fail(
            f->path,
            "%s files need ffmpeg, which is not installed (apt-get install ffmpeg); a name that ends in .png gives "
            "numbered pictures without it",
            ending_of(f->path));
    return tool_fail(f->path, "ffmpeg failed; its message is above");
}

/* ---- a film ---- */

int film_open(film *f, const char *path, uint32_t width, uint32_t height, uint32_t rate_hz)
{
    const char *const *words = words_of(ending_of(path));
    memset(f, 0, sizeof *f);
    f->pipe = -1;
    f->width = width;
    f->height = height;
    f->rate_hz = rate_hz;
    if (strlen(path) >= sizeof f->path - 16u) return tool_fail(path, "the path is too long");
    strcpy(f->path, path);
    if (words) return start_ffmpeg(f, words);
    return strcmp(ending_of(path), ".png") == 0
               ? 0
               : tool_fail(
                     path,
                     "the name of a film must end in .gif, .mp4, .webm or .apng, or in .png for numbered pictures");
}

/* "walk.png" to "walk_0007.png". */
static void numbered(const film *f, uint32_t n, char path[1040])
{
    const int stem = (int)strlen(f->path) - 4;
    snprintf(path, 1040, "%.*s_%04u.png", stem, f->path, n);
}

static int write_all(film *f, const uint8_t *bytes, size_t count)
{
    struct sigaction ignore, before;
    memset(&ignore, 0, sizeof ignore);
    ignore.sa_handler = SIG_IGN; /* wait_for reports a broken pipe */
    sigaction(SIGPIPE, &ignore, &before);
    while (count) {
        const ssize_t written = write(f->pipe, bytes, count);
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) break;
        bytes += written;
        count -= (size_t)written;
    }
    sigaction(SIGPIPE, &before, NULL);
    return count ? EXIT_FAILED : 0;
}

int film_add(film *f, const uint8_t *rgba)
{
    char path[1040];
    if (f->pipe >= 0) {
        const int status = write_all(f, rgba, (size_t)f->width * f->height * 4u);
        f->count += !status;
        return status;
    }
    numbered(f, f->count, path);
    f->count++;
    return tool_write_png(path, f->width, f->height, rgba);
}

int film_close(film *f, int keep)
{
    char path[1040];
    int status = 0;
    if (f->pipe >= 0) {
        if (!keep && f->process) kill(f->process, SIGKILL);
        close(f->pipe);
        f->pipe = -1;
        if (keep) {
            status = wait_for(f);
        } else {
            while (waitpid(f->process, NULL, 0) < 0 && errno == EINTR) {}
        }
        if (status || !keep) (void)remove(f->path);
        return status;
    }
    for (uint32_t n = 0; !keep && n < f->count; n++) {
        numbered(f, n, path);
        (void)remove(path);
    }
    return 0;
}
