#define _POSIX_C_SOURCE 200809L
#include "view/view_watch.h"

#include <string.h>
#include <sys/stat.h>

static int look(const char *path, int64_t at[3])
{
    struct stat file;
    if (stat(path, &file) || file.st_size <= 0) return 0;
    at[0] = (int64_t)file.st_mtim.tv_sec;
    at[1] = (int64_t)file.st_mtim.tv_nsec;
    at[2] = (int64_t)file.st_size;
    return 1;
}

void view_watch_begin(view_watch *w, const char *path)
{
    memset(w, 0, sizeof *w);
    (void)look(path, w->shown);
    memcpy(w->seen, w->shown, sizeof w->seen);
}

int view_watch_changed(view_watch *w, const char *path)
{
    int64_t now[3];
    int settled;
    if (!look(path, now)) return 0;
    settled = memcmp(now, w->seen, sizeof now) == 0 && memcmp(now, w->shown, sizeof now) != 0;
    memcpy(w->seen, now, sizeof now);
    if (settled) memcpy(w->shown, now, sizeof now);
    return settled;
}
