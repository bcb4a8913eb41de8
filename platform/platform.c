#include "platform.h"

#include "platforms.h"

#include <string.h>

static const noh_platform *const platforms[] = { &noh_platform_egl, &noh_platform_angle, &noh_platform_osmesa,
                                                 &noh_platform_glfw, &noh_platform_null };

const noh_platform *noh_platform_find(const char *name)
{
    for (size_t i = 0; i < sizeof platforms / sizeof *platforms; i++) {
        if (strcmp(platforms[i]->name, name) == 0) return platforms[i];
    }
    return NULL;
}

const char *noh_platform_names(void)
{
    return "egl, angle, osmesa, glfw, null";
}
