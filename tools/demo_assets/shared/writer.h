/* The parts of a glTF binary: views of its bytes, accessors, and the container. */
#ifndef MASK_WRITER_H
#define MASK_WRITER_H

#include "buffer.h"
#include "maths.h"

/* Component types and view targets, with glTF's numbers. */
enum { TYPE_U8 = 5121, TYPE_U16 = 5123, TYPE_FLOAT = 5126 };
enum { TARGET_NONE = 0, TARGET_ARRAY = 34962, TARGET_ELEMENTS = 34963 };

typedef struct {
    Buffer views, accessors, data;
    int view_count, accessor_count;
} Writer;

/* As the file holds it. */
typedef struct {
    float x, y, z;
} F3;

F3 f3(V3 v);
void put_f3(Buffer *data, F3 f);

/* Views: each begins on a multiple of four bytes and covers what is written between open and
 * close, which returns its number. */
int view_open(Writer *w);
int view_close(Writer *w, int start, int target);

/* Accessors: what is printed into w->accessors between these two calls belongs to the new one, whose number the second
 * returns. */
void accessor_begin(Writer *w, int component, int count, const char *type);
int accessor_end(Writer *w);
void print_range(Writer *w, const F3 *values, int count, F3 low, F3 high);

/* Whole accessors; all return their number. */
int write_vectors(Writer *w, const V3 *values, int count, int with_range);
int write_floats(Writer *w, const double *values, int count, const char *type, int width, int target);
int write_scalars(Writer *w, const double *values, int count, int with_range); /* ascending, if with a range */
int write_joints(Writer *w, const int *joints, int count);        /* four for each of `count` vertices, below 256 */
int write_indices(Writer *w, const uint32_t *indices, int count); /* below 65536 */

/* Prints a material object, white and not metallic; the first has no comma before it. tint: whether an instance's
 * tint colours it. */
void material_write(Buffer *json, int is_first, const char *name, double roughness, int tint);

/* Appends accessors, views and buffer to a glTF object that is open and ends with a comma, closes
 * it, and appends the finished file. Frees what the writer holds. */
void writer_finish(Writer *w, Buffer *json, Buffer *file);

#endif
