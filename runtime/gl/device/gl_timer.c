/* gl_timer.c: a ring of queries. `oldest` is the next query to read, `flying` queries from there on are in flight, and
 * the query after them is the next to begin. A disjoint clock invalidates all of them. */
#include "gl/device/gl_names_internal.h"
#include "core/base/assert_internal.h"
#include "gl/device/gl_api_internal.h"
#include "gl/device/gl_timer_internal.h"
#include "noh/base.h"
#include "noh/gl_device.h"

#include <string.h>

void noh_gl_timer_init(noh_gl_timer *timer, const noh_gl_api *api, const noh_gl_caps *caps)
{
    NOH_ASSERT(timer && api && caps);
    memset(timer, 0, sizeof *timer);
    timer->available = caps->timer_query;
    if (!timer->available) return;
    noh_gl_error_take(api);
    api->TimeGenQueries(NOH_GL_TIMER_FLIGHT, timer->queries);
    /* reading the flag clears it */
    GLint disjoint = 0;
    if (api->is_es) api->GetIntegerv(GL_GPU_DISJOINT_EXT, &disjoint);
    if (noh_gl_error_take(api) != GL_NO_ERROR) {
        api->TimeDeleteQueries(NOH_GL_TIMER_FLIGHT, timer->queries);
        memset(timer, 0, sizeof *timer);
    }
}

void noh_gl_timer_delete(noh_gl_timer *timer, const noh_gl_api *api)
{
    NOH_ASSERT(timer && api);
    noh_gl_timer_end(timer, api);
    if (timer->available) api->TimeDeleteQueries(NOH_GL_TIMER_FLIGHT, timer->queries);
    memset(timer, 0, sizeof *timer);
}

void noh_gl_timer_begin(noh_gl_timer *timer, const noh_gl_api *api)
{
    NOH_ASSERT(timer && api);
    if (!timer->available || timer->open || timer->flying == NOH_GL_TIMER_FLIGHT) return;
    uint32_t next = (timer->oldest + timer->flying) % NOH_GL_TIMER_FLIGHT;
    api->TimeBeginQuery(GL_TIME_ELAPSED_EXT, timer->queries[next]);
    timer->open = 1;
}

void noh_gl_timer_end(noh_gl_timer *timer, const noh_gl_api *api)
{
    NOH_ASSERT(timer && api && timer->flying <= NOH_GL_TIMER_FLIGHT);
    if (!timer->open) return;
    NOH_ASSERT(timer->available && timer->flying < NOH_GL_TIMER_FLIGHT);
    api->TimeEndQuery(GL_TIME_ELAPSED_EXT);
    timer->open = 0;
    timer->flying++;
}

noh_result noh_gl_timer_poll(noh_gl_timer *timer, const noh_gl_api *api, uint64_t *elapsed_ns)
{
    NOH_ASSERT(timer && api && elapsed_ns && timer->flying <= NOH_GL_TIMER_FLIGHT &&
               timer->oldest < NOH_GL_TIMER_FLIGHT);
    if (!timer->available) return NOH_ERR_UNSUPPORTED;
    if (timer->flying == 0) return NOH_ERR_NOT_FOUND;
    GLuint query = timer->queries[timer->oldest];
    GLuint ready = 0;
    api->TimeGetQueryObjectuiv(query, GL_QUERY_RESULT_AVAILABLE_EXT, &ready);
    if (!ready) return NOH_ERR_NOT_FOUND;
    GLint disjoint = 0;
    if (api->is_es) api->GetIntegerv(GL_GPU_DISJOINT_EXT, &disjoint);
    if (disjoint) {
        timer->oldest = (timer->oldest + timer->flying) % NOH_GL_TIMER_FLIGHT;
        timer->flying = 0;
        return NOH_ERR_GL;
    }
    GLuint64 elapsed = 0;
    api->TimeGetQueryObjectui64v(query, GL_QUERY_RESULT_EXT, &elapsed);
    timer->oldest = (timer->oldest + 1) % NOH_GL_TIMER_FLIGHT;
    timer->flying--;
    *elapsed_ns = elapsed;
    return NOH_OK;
}
