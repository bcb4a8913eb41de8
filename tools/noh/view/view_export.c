#include "view/view_export.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/message.h"

int view_export_start(view_export *e, const canvas *c, const char *path, uint32_t rate_hz, double seconds, int turns)
{
    int status;
    view_export_stop(e);
    e->frames = (uint32_t)fmax(floor(seconds * rate_hz + 0.5), 1.0);
    e->turns = turns;
    e->rgba = malloc((size_t)c->width * c->height * 4u);
    status = e->rgba ? film_open(&e->film, path, c->width, c->height, rate_hz) : tool_fail(path, "out of memory");
    e->is_on = !status;
    if (status) free(e->rgba);
    if (status) e->rgba = NULL;
    return status;
}

static int end(view_export *e, int keep)
{
    const int status = film_close(&e->film, keep);
    free(e->rgba);
    e->rgba = NULL;
    e->is_on = 0;
    return status;
}

void view_export_stop(view_export *e)
{
    if (e->is_on) (void)end(e, 0);
}

int view_export_step(const view_export *e, double *seconds, double *radians)
{
    if (!e->is_on) return 0;
    *seconds = 1.0 / e->film.rate_hz;
    *radians = e->turns ? 6.283185307179586 / e->frames : 0.0;
    return 1;
}

int view_export_frame(view_export *e, canvas *c)
{
    int status = 0;
    if (!e->is_on) return 0;
    if (c->width != e->film.width || c->height != e->film.height) {
        status = tool_fail(e->film.path, "the picture changed its size during the export: start again");
        view_export_stop(e);
        return status;
    }
    status = canvas_read(c, e->rgba);
    if (!status) status = film_add(&e->film, e->rgba);
    if (!status && e->film.count < e->frames) return 0;
    if (!status) {
        const uint32_t frames = e->film.count;
        status = end(e, 1);
        if (!status) printf("%s: %u frames\n", e->film.path, frames);
        fflush(stdout);
        return status;
    }
    /* A broken pipe: closing reports the reason. */
    return end(e, 1) ? EXIT_FAILED : status;
}
