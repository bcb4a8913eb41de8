#include "noh/base.h"
#include "noh/gl_device.h"

#include <string.h>

#include "core/base/assert_internal.h"
#include "core/base/compiler_internal.h"
#include "gl/device/gl_api_internal.h"

noh_result noh_gl_open(noh_gl *gl, noh_gl_get_proc get, void *user, noh_error *error)
{
    noh_result result;
    NOH_ASSERT(gl && get);
    gl->log[0] = 0;
    result = noh_gl_api_load(&gl->api, get, user, error);
    if (!result) result = noh_gl_caps_probe(&gl->api, &gl->caps, error);
    if (result) return result;
    memset(&gl->ledger, 0, sizeof gl->ledger);
    gl->device.api = &gl->api;
    gl->device.caps = &gl->caps;
    gl->device.ledger = &gl->ledger;
    gl->device.log = gl->log;
    gl->device.log_bytes = sizeof gl->log;
    return NOH_OK;
}

noh_result noh_gl_device_check(const noh_gl_device *device, int needs_caps, noh_error *error)
{
    if (NOH_PAGE || (device && device->api && device->ledger && (device->caps || !needs_caps))) return NOH_OK;
    return noh_fail(error, NOH_ERR_ARG, "the device is empty: call noh_gl_open first", 0, 0);
}
