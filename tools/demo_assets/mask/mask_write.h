/* The mask's mesh and materials within a glTF file. */
#ifndef MASK_MASK_WRITE_H
#define MASK_MASK_WRITE_H

#include "figure.h"
#include "shared/writer.h"

/* How the mask is worn: its origin is at `origin`, and two joints of a skin move it. */
typedef struct {
    V3 origin;
    int head, jaw;
} MaskWearer;

/* Prints a mesh object with all targets. Its primitives use the materials 0 to PART_COUNT - 1.
 * wearer: NULL for a mask alone, without a skin. */
void mask_mesh_write(Writer *w, Buffer *json, const Figure *mask, const MaskWearer *wearer);

/* Prints material objects, with commas between them. */
void materials_write(Buffer *json, const FigureMaterial *materials, int count);

#endif
