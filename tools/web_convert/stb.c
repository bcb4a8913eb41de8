/* stb.c: Debian's libstb is for this machine's processor alone; its header is the source. */
#define STB_IMAGE_IMPLEMENTATION
#include <stb/stb_image.h>
