/* gl_timer_internal.h: the GPU's time of a few calls. */
#ifndef NOH_DEVICE_GL_TIMER_INTERNAL_H
#define NOH_DEVICE_GL_TIMER_INTERNAL_H

#include "noh/gl_device.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ======== GPU time ========
 * GPU time.
 *
 *   noh_gl_timer_init / noh_gl_timer_delete
 *   noh_gl_timer_begin / noh_gl_timer_end   around the calls to time
 *   noh_gl_timer_poll                       the oldest finished measurement; never waits
 *
 * Results arrive some frames later, so up to NOH_GL_TIMER_FLIGHT measurements are in flight at once. If all are in
 * flight, or without timer queries, begin and end do nothing. Only one timer may be open at a time: GL does not nest
 * time queries.
 *
 * Threads: the context's own thread, for every function. */

#define NOH_GL_TIMER_FLIGHT 4u

typedef struct noh_gl_timer {
    unsigned queries[NOH_GL_TIMER_FLIGHT];
    uint32_t oldest; /* index into queries of the oldest in flight */
    uint32_t flying; /* ended but not polled */
    int available;   /* 0: the context cannot time */
    int open;        /* between begin and end */
} noh_gl_timer;

/* Make a timer. Never fails: without timer queries, or if the driver refuses them, `available` is 0 and nothing is
 * measured. */
void noh_gl_timer_init(noh_gl_timer *timer, const noh_gl_api *api, const noh_gl_caps *caps);
void noh_gl_timer_delete(noh_gl_timer *timer, const noh_gl_api *api);

void noh_gl_timer_begin(noh_gl_timer *timer, const noh_gl_api *api);
void noh_gl_timer_end(noh_gl_timer *timer, const noh_gl_api *api);

/* Take the oldest finished measurement, in nanoseconds. Never waits for the GPU.
 * errors  NOT_FOUND none has finished yet; UNSUPPORTED no timer queries; GL the GPU's clock was disjoint, such as after
 *         a change of frequency: all measurements in flight are dropped */
noh_result noh_gl_timer_poll(noh_gl_timer *timer, const noh_gl_api *api, uint64_t *elapsed_ns);

#ifdef __cplusplus
}
#endif

#endif
