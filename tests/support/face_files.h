/* face_files.h: one face with its targets as the files that exporters write.
 *
 * The face is cut down to what all of them can say: positions, UVs, normals where asked for, triangles by material,
 * targets that move positions. A corner is a place among the positions, one among the UVs and one among the normals;
 * the same corner twice is one vertex. */
#ifndef NOH_TESTS_SUPPORT_FACE_FILES_H
#define NOH_TESTS_SUPPORT_FACE_FILES_H

#include "convert/model/model.h"

typedef struct face_corner {
    uint32_t position, uv, normal;
} face_corner;

typedef struct face_part {
    uint32_t first, count; /* of the corners; triangles */
    char name[64];         /* of the material */
    float color[3];
} face_part;

typedef struct face_files {
    uint32_t position_count, uv_count, normal_count, corner_count, part_count, target_count;
    float *positions;    /* [position_count][3] */
    float *uvs;          /* [uv_count][2]; NULL: none */
    float *normals;      /* [normal_count][3]; NULL: none */
    float **moved;       /* [target_count][position_count][3] where each target brings them */
    char (*targets)[64]; /* [target_count] names */
    face_corner *corners;
    face_part *parts;
} face_files;

/* The first mesh of a model, with at most `target_max` of its targets, in order of their names. */
face_files *face_files_new(const model *m, uint32_t target_max, int with_normals);
void face_files_free(face_files *f);

/* face.obj, face.mtl and a file for each target, in a folder that is there. */
void face_files_obj(const face_files *f, const char *folder);
/* Removes them and the folder. */
void face_files_obj_remove(const face_files *f, const char *folder);

typedef enum face_form {
    FACE_DENSE,  /* each primitive has accessors of its own, all vertices in each target */
    FACE_SPARSE, /* targets are sparse accessors of the vertices that they move */
    FACE_SHARED  /* all primitives have the same accessors, whose vertices parts share */
} face_form;

/* The same as a .glb file. */
void face_files_glb(const face_files *f, face_form form, const char *path);

#endif
