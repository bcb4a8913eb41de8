/* view_watch.h: detects that a file has changed on disk: its new time or size must be equal twice, so that a file that
 * is still being written is left alone. */
#ifndef NOH_NOH_VIEW_VIEW_WATCH_H
#define NOH_NOH_VIEW_VIEW_WATCH_H

#include <stdint.h>

typedef struct view_watch {
    int64_t shown[3], seen[3]; /* seconds, nanoseconds, bytes */
} view_watch;

/* Start: the present file is the one shown. */
void view_watch_begin(view_watch *w, const char *path);
/* 1 once for each change. A deleted file has not changed. */
int view_watch_changed(view_watch *w, const char *path);

#endif
