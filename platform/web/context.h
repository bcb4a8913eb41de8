/* context.h: the platform "web": the WebGL 2 context of a canvas, which is OpenGL ES 3.0. */
#ifndef NOH_PLATFORM_WEB_CONTEXT_H
#define NOH_PLATFORM_WEB_CONTEXT_H

#include "platform.h"

extern const noh_platform noh_platform_web;

/* Enable the extensions again: a restored context has none enabled. */
void noh_web_enable_extensions(noh_platform_context *context);

#endif
