/* ground_file.h: a height field out of a file: a pack with a terrain, or what noh build --terrain takes. */
#ifndef NOH_NOH_FILE_GROUND_FILE_H
#define NOH_NOH_FILE_GROUND_FILE_H

#include "convert/terrain/terrain_read.h"
#include "pack_file.h"
#include "noh/body.h"

typedef struct ground_file {
    noh_field field; /* metres; points into the rest */
    pack_file pack;
    terrain land;
} ground_file;

/* Prints an error and returns an exit code; 0 on success. Closed in any case, zeros too. */
int ground_file_open(ground_file *file, const char *path);
void ground_file_close(ground_file *file);

#endif
