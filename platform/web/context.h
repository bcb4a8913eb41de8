/* context.h: the platform "web": a canvas's WebGL 2 context, which is OpenGL ES 3.0. */
#ifndef NOH_PLATFORM_WEB_CONTEXT_H
#define NOH_PLATFORM_WEB_CONTEXT_H

#include "platform.h"

extern const noh_platform noh_platform_web;

/* Ask for the extensions again: a context that was lost and restored has none. */
void noh_web_enable_extensions(noh_platform_context *context);

#endif
