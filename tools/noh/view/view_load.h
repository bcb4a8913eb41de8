/* view_load.h: converts a model in a separate process while the window runs: it can be cancelled at any time, and a
 * file that crashes the converter does not crash the viewer.
 *
 *   view_is_model                  whether a file has to be converted
 *   view_load_start, view_load_poll, view_load_cancel
 *   view_load_take                 the pack, once it is there */
#ifndef NOH_NOH_VIEW_VIEW_LOAD_H
#define NOH_NOH_VIEW_VIEW_LOAD_H

#include "convert/base/byte_buffer.h"
#include "platform.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum view_load_state { VIEW_LOAD_NONE, VIEW_LOAD_RUNS, VIEW_LOAD_DONE, VIEW_LOAD_FAILED } view_load_state;

typedef struct view_load {
    view_load_state state;
    char path[1024];
    char does[256];   /* its present step, in words */
    int process;      /* 0: none */
    int words, bytes; /* files: its messages, and the pack */
    uint64_t started_ns;
} view_load;

int view_is_model(const char *path);

/* levels: as noh build --lod; NULL: the full mesh only. One at a time: a running conversion is cancelled. Prints an
 * error and returns an exit code; 0 on success. */
int view_load_start(view_load *l, const char *path, const char *levels);
/* Read its messages. VIEW_LOAD_FAILED: after an error was printed. */
view_load_state view_load_poll(view_load *l);
int view_load_take(view_load *l, byte_buffer *out);
void view_load_cancel(view_load *l);
double view_load_seconds(const view_load *l);

#ifdef __cplusplus
}
#endif
#endif
