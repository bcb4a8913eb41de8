/* obj_internal.h: an OBJ file before it is a model.
 *
 *   obj_text.c      the text: positions, normals, UVs, faces
 *   obj_material.c  .mtl files
 *   obj_targets.c   the folder of targets
 *   obj_read.c      all of it as a model */
#ifndef NOH_CONVERT_OBJ_OBJ_INTERNAL_H
#define NOH_CONVERT_OBJ_OBJ_INTERNAL_H

#include "convert/base/byte_buffer.h"
#include "convert/base/text_scan.h"
#include "convert/obj/obj_read.h"

/* A corner of a face: places among the file's positions, UVs and normals, MODEL_NONE where it has none. */
typedef struct obj_corner {
    uint32_t position, uv, normal;
} obj_corner;

/* Corners of triangles of one material. */
typedef struct obj_part {
    char *material;      /* the name; NULL: none */
    byte_buffer corners; /* of obj_corner, three a triangle */
} obj_part;

typedef struct obj_text {
    byte_buffer positions, uvs,
        normals;          /* of float: 3, 2, 3 each; v from the top of the picture. NaN: the line was left
                                          * out, and no corner refers to it */
    byte_buffer colors;   /* of float, 3 a position: white where a line has none */
    int has_colors;       /* any line has */
    byte_buffer parts;    /* of obj_part */
    char *library;        /* the .mtl file's name; NULL: none */
    const char *left_out; /* the first keyword that was skipped; NULL: none */
    uint32_t left_out_line, left_out_count;
    model_error bad_line; /* why the first line of bad_line_count was left out */
    uint32_t bad_line_count;
} obj_text;

uint32_t obj_position_count(const obj_text *o);
uint32_t obj_part_count(const obj_text *o);
const obj_part *obj_part_at(const obj_text *o, uint32_t i);

/* Reads a file. positions_only: nothing else is kept or checked. Free in both cases. */
int obj_text_read(const char *path, int positions_only, obj_text *out, model_error *error);
void obj_text_free(obj_text *o);

/* Fills in the model's materials and textures: one for each part that names one, in the order of parts. What cannot be
 * read becomes a warning. Returns 1 when out of memory. */
int obj_materials_read(const char *obj_path, const obj_text *o, model *m);

/* Adds a target for each other .obj file of the folder, in the order of their names. source [vertex_count]: the
 * position from which each vertex of mesh 0 is made. scale: metres per unit. */
int obj_targets_read(const char *folder, const char *obj_path, const obj_text *o, const uint32_t *source, double scale,
                     model *m, model_error *error);

#endif
