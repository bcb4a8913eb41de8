/* gl_timer.h: how long the GPU took.
 *
 *   noh_gl_timer_init / noh_gl_timer_delete
 *   noh_gl_timer_begin / noh_gl_timer_end   around the calls to time
 *   noh_gl_timer_poll                       the oldest finished measurement, never waits
 *
 * Results come some frames late, so several measurements are in flight. Without
 * timer queries, and while all are in flight, begin and end do nothing. One timer
 * at a time may be open: GL does not nest time queries.
 *
 * Threads: the context's own thread, for every function. */
#ifndef NOH_GL_GL_TIMER_H
#define NOH_GL_GL_TIMER_H

#include "gl/gl_api.h"
#include "gl/gl_caps.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_GL_TIMER_FLIGHT 4u

typedef struct noh_gl_timer {
    GLuint queries[NOH_GL_TIMER_FLIGHT];
    uint32_t oldest; /* index into queries of the oldest in flight */
    uint32_t flying; /* ended and not polled */
    int available;   /* 0: the context cannot time */
    int open;        /* between begin and end */
} noh_gl_timer;

/* Never fails. `available` is 0 without timer queries, and where the driver refuses to make them: the timer then
 * measures nothing. */
void noh_gl_timer_init(noh_gl_timer *timer, const noh_gl_api *api, const noh_gl_caps *caps);
void noh_gl_timer_delete(noh_gl_timer *timer, const noh_gl_api *api);

void noh_gl_timer_begin(noh_gl_timer *timer, const noh_gl_api *api);
void noh_gl_timer_end(noh_gl_timer *timer, const noh_gl_api *api);

/* units   nanoseconds
 * errors  NOH_ERR_NOT_FOUND none has finished yet; NOH_ERR_UNSUPPORTED no timer queries;
 *         NOH_ERR_GL the GPU's clock was disjoint (a frequency change, for instance): all in flight are dropped */
noh_result noh_gl_timer_poll(noh_gl_timer *timer, const noh_gl_api *api, uint64_t *elapsed_ns);

#ifdef __cplusplus
}
#endif

#endif
