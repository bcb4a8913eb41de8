#define _POSIX_C_SOURCE 200809L /* opendir */

#include "obj_internal.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/base/input_file.h"
#include "convert/model/model_build.h"

/* ---- which files ---- */

static int is_obj(const char *name)
{
    const size_t length = strlen(name);
    return length > 4 && name[length - 4] == '.' && (name[length - 3] | 32) == 'o' && (name[length - 2] | 32) == 'b' &&
           (name[length - 1] | 32) == 'j';
}

/* By the names of the targets, which end before ".obj". */
static int by_name(const void *a, const void *b)
{
    const char *p = *(char *const *)a, *q = *(char *const *)b;
    const size_t p_size = strlen(p) - 4, q_size = strlen(q) - 4;
    const int order = memcmp(p, q, p_size < q_size ? p_size : q_size);
    return order ? order : p_size != q_size ? (p_size > q_size) - (p_size < q_size) : strcmp(p, q);
}

static const char *file_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

static void free_names(byte_buffer *names)
{
    for (size_t i = 0; i < names->count / sizeof(char *); i++) free(((char **)(void *)names->bytes)[i]);
    buffer_free(names);
}

static int add_name(const char *file, byte_buffer *names)
{
    char *name = model_string(file);
    const int failed = !name || !buffer_append(names, &name, sizeof(char *));
    if (failed) free(name);
    return failed;
}

/* All files but the one that has the name of the model: it is the model in most folders. */
static int list_names(const char *folder, const char *model_file, byte_buffer *names, model_error *error)
{
    DIR *open = inputs_are_held() ? NULL : opendir(folder);
    uint32_t at = 0;
    int failed = 0;
    if (!open && !inputs_are_held())
        return model_fail(error, "", "the folder %.120s cannot be read: %s", folder, strerror(errno));
    while (!failed) {
        const struct dirent *entry = open ? readdir(open) : NULL;
        const char *name = open ? (entry ? entry->d_name : NULL) : input_next_held(folder, &at);
        if (!name) break;
        if (is_obj(name) && strcmp(name, file_name(model_file)) != 0) failed = add_name(name, names);
    }
    if (open) (void)closedir(open);
    return failed ? model_fail_memory(error) : 0;
}

/* The targets of a folder, by name. */
static int list_folder(const char *folder, const char *model_file, byte_buffer *names, model_error *error)
{
    if (list_names(folder, model_file, names, error)) return 1;
    if (names->count == 0) return model_fail(error, "", "there is no other .obj file in the folder %.120s", folder);
    qsort(names->bytes, names->count / sizeof(char *), sizeof(char *), by_name);
    return 0;
}

/* ---- one target ---- */

static int fill_target(const obj_text *base, const obj_text *moved, const uint32_t *source, double scale,
                       const model_mesh *mesh, model_target *t)
{
    const float *from = (const float *)(const void *)base->positions.bytes;
    const float *to = (const float *)(const void *)moved->positions.bytes;
    const size_t floats = (size_t)mesh->vertex_count * 3;
    t->position = model_zeros(floats, sizeof(float));
    t->normal = model_zeros(floats, sizeof(float));
    t->tangent = mesh->tangent ? model_zeros(floats, sizeof(float)) : NULL;
    t->missing = model_zeros(mesh->submesh_count, 1);
    if (!t->position || !t->normal || !t->missing || (mesh->tangent && !t->tangent)) return 1;
    t->has_position = 1;
    memset(t->missing, MODEL_MISSING_NORMAL | (mesh->tangent ? MODEL_MISSING_TANGENT : 0), mesh->submesh_count);
    for (size_t i = 0; i < floats; i++) {
        const size_t at = (size_t)source[i / 3] * 3 + i % 3;
        t->position[i] = (float)(((double)to[at] - (double)from[at]) * scale);
    }
    return 0;
}

static int read_target(const char *path, const obj_text *base, const uint32_t *source, double scale,
                       const model_mesh *mesh, model_target *t, model_error *error)
{
    obj_text moved;
    int failed = obj_text_read(path, 1, &moved, error);
    if (!failed && obj_position_count(&moved) != obj_position_count(base)) {
        failed = model_fail(error, "", "it has %u positions, and the model has %u: a target needs the same number",
                            obj_position_count(&moved), obj_position_count(base));
    }
    if (!failed) {
        t->name = input_stem(path);
        failed = !t->name || fill_target(base, &moved, source, scale, mesh, t) ? model_fail_memory(error) : 0;
    }
    obj_text_free(&moved);
    return failed;
}

/* An error names the target, as the caller names only the model's file. */
static int name_target(const char *file, model_error *error)
{
    const model_error inner = *error;
    char where[128];
    (void)snprintf(where, sizeof where, "target %.60s%s%.40s", file, inner.where[0] ? ", " : "", inner.where);
    return model_fail(error, where, "%s", inner.what);
}

int obj_targets_read(const char *folder, const char *obj_path, const obj_text *o, const uint32_t *source, double scale,
                     model *m, model_error *error)
{
    model_mesh *mesh = &m->meshes[0];
    byte_buffer names = { NULL, 0, 0, 0 };
    char path[4096];
    int failed = list_folder(folder, obj_path, &names, error);
    const size_t count = names.count / sizeof(char *);
    mesh->targets = failed ? NULL : model_zeros(count, sizeof *mesh->targets);
    mesh->weights = failed ? NULL : model_zeros(count, sizeof *mesh->weights);
    if (!failed && (!mesh->targets || !mesh->weights)) failed = model_fail_memory(error);
    for (size_t i = 0; i < count && !failed; i++) {
        const char *name = ((char **)(void *)names.bytes)[i];
        const int length = snprintf(path, sizeof path, "%s/%s", folder, name);
        if (length < 0 || (size_t)length >= sizeof path) {
            failed = model_fail(error, "", "the path of the target %.60s is too long", name);
            break;
        }
        mesh->target_count++;
        failed = read_target(path, o, source, scale, mesh, &mesh->targets[i], error) ? name_target(name, error) : 0;
    }
    free_names(&names);
    return failed;
}
