/* view_watch.h: whether a file has changed on disk: seen with another time or size twice alike, so one that is still
 * being written is left alone. */
#ifndef NOH_NOH_VIEW_VIEW_WATCH_H
#define NOH_NOH_VIEW_VIEW_WATCH_H

#include <stdint.h>

typedef struct view_watch {
    int64_t shown[3], seen[3]; /* seconds, nanoseconds, bytes */
} view_watch;

/* From now on: what is there now is what is shown. */
void view_watch_begin(view_watch *w, const char *path);
/* 1 once for each change. A file that is gone has not changed. */
int view_watch_changed(view_watch *w, const char *path);

#endif
