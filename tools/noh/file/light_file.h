/* light_file.h: a panorama: environment light as a picture, x the azimuth, y the height (equirectangular). A
 * Radiance .hdr file is linear; a PNG, JPEG or TGA is sRGB, and its white is radiance 1. The middle of the picture is
 * towards -z: in front of a viewer in front of a character. */
#ifndef NOH_NOH_FILE_LIGHT_FILE_H
#define NOH_NOH_FILE_LIGHT_FILE_H

#include "noh/light.h"

typedef struct light_file {
    uint32_t width, height;
    float *rgb; /* [height][width][3], the top row first */
} light_file;

/* Prints an error and returns an exit code; 0 on success. */
int light_file_open(light_file *file, const char *path);
void light_file_close(light_file *file);

/* A noh_radiance: user is a const light_file *. Between texels it interpolates. */
void light_file_radiance(const void *user, const float direction[3], float rgb[3]);

/* Its spherical harmonics: the sum over all texels. */
void light_file_project(const light_file *file, uint32_t order, noh_light *light);

#endif
