/* platforms.h (private to platform/): all platforms, and shared functions. */
#ifndef NOH_PLATFORM_PLATFORMS_H
#define NOH_PLATFORM_PLATFORMS_H

#include "platform.h"
#include "noh/gl_device.h"

extern const noh_platform noh_platform_egl;
extern const noh_platform noh_platform_angle;
extern const noh_platform noh_platform_osmesa;
extern const noh_platform noh_platform_glfw;
extern const noh_platform noh_platform_null;

/* Open a shared library; its symbols stay private. NULL on failure, with the reason appended to message. */
void *noh_library_open(const char *path, char *message, size_t message_bytes);

/* A function of an open library; NULL: not found. */
noh_gl_proc noh_library_proc(void *library, const char *name);

/* Append a formatted text to a string, cut at its end. */
void noh_message_add(char *message, size_t message_bytes, const char *format, ...);

#endif
