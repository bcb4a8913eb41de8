/* gl_skin.c: palettes in memory, and their GL object.
 *
 * All palettes of all instances lie in one array of rows, in the layout of the GL object. Setting matrices writes only
 * rows that differ to this array, and widens one span of rows to send. An update sends the span in one call: a few
 * unchanged rows in between are cheaper to send than more calls. */
#include "core/base/assert_internal.h"
#include "gl/device/gl_api_internal.h"
#include "gl/draw/gl_skin_internal.h"
#include "noh/base.h"
#include "noh/deform.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"

#include <string.h>

#include "gl/device/gl_state_internal.h"
#include "gl/device/gl_debug_internal.h"
#include "deform/skin/skin_internal.h"

static const float identity[12] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0 };

/* ---- setting ---- */

static const noh_gl_skin_mesh *mesh_of(const noh_gl_skin *skin, uint32_t instance)
{
    uint32_t i = 0;
    NOH_ASSERT(instance < skin->plan.instance_count);
    while (instance - skin->meshes[i].first_instance >= skin->meshes[i].instance_count) {
        i++;
    }
    return &skin->meshes[i];
}

static uint32_t first_row(const noh_gl_skin_mesh *m, uint32_t instance)
{
    return m->first_row + (instance - m->first_instance) * m->stride;
}

/* Rows first to end - 1; empty if first >= end. */
typedef struct span {
    uint32_t first, end;
} span;

static void widen(span *s, uint32_t row, uint32_t count)
{
    s->first = row < s->first ? row : s->first;
    s->end = row + count > s->end ? row + count : s->end;
}

/* Widen the range of rows that the next update sends. */
static void send(noh_gl_skin *skin, const span *changed)
{
    span all = { skin->dirty_first, skin->dirty_end };
    if (changed->first < changed->end) {
        widen(&all, changed->first, changed->end - changed->first);
        skin->dirty_first = all.first;
        skin->dirty_end = all.end;
    }
}

/* Write rows that have changed. */
static void put_rows(const noh_gl_skin *skin, uint32_t row, const float *values, uint32_t count, span *changed)
{
    NOH_ASSERT((uint64_t)row + count <= skin->plan.texel_count);
    float *own = skin->rows + 4u * (size_t)row;
    if (memcmp(own, values, 16u * (size_t)count) != 0) {
        memcpy(own, values, 16u * (size_t)count);
        widen(changed, row, count);
    }
}

/* Write a joint of a mesh with NOH_MESH_DUAL_QUATERNION as the rows of common_skin.glsl: rotation, dual part, and the
 * stretch, a symmetric matrix, as xx yy zz xy, xz yz 0 0. */
static void dual_rows(const float matrix[12], float rows[16])
{
    noh_dual_quaternion q;
    const float *h = q.stretch;
    noh_dual_quaternion_from_matrix(matrix, &q);
    memcpy(rows, q.real, sizeof q.real);
    memcpy(rows + 4, q.dual, sizeof q.dual);
    rows[8] = h[0];
    rows[9] = h[4];
    rows[10] = h[8];
    rows[11] = h[1];
    rows[12] = h[2];
    rows[13] = h[5];
    rows[14] = rows[15] = 0.0f;
}

/* Write the joints of a palette. stride: floats from a joint's matrix to the next; 0: one matrix for all. */
static void put_palette(const noh_gl_skin *skin, const noh_mesh *mesh, const noh_palette *palette, uint32_t row,
                        const float *matrices, uint32_t stride, span *changed)
{
    const uint16_t *joints = mesh->palette_joints + palette->first_joint;
    uint32_t joint_rows = noh_gl_joint_rows(mesh);
    for (uint32_t i = 0; i < palette->joint_count; i++) {
        const float *matrix = matrices + (size_t)joints[i] * stride;
        float rows[16];
        if (joint_rows == 4u) {
            dual_rows(matrix, rows);
            matrix = rows;
        }
        put_rows(skin, row + joint_rows * i, matrix, joint_rows, changed);
    }
}

static span put_palettes(const noh_gl_skin *skin, uint32_t instance, const float *matrices, uint32_t stride)
{
    span changed = { UINT32_MAX, 0 };
    const noh_gl_skin_mesh *m = mesh_of(skin, instance);
    noh_gl_skin_binding binding = noh_gl_skin_binding_of(skin, instance);
    for (uint32_t i = 0; i < m->mesh.header->palette_count; i++) {
        put_palette(skin, &m->mesh, &m->mesh.palettes[i], binding.first + noh_gl_palette_row(&binding, &m->mesh, i),
                    matrices, stride, &changed);
    }
    return changed;
}

void noh_gl_skin_set_matrices(noh_gl_skin *skin, uint32_t instance, const float *matrices)
{
    span changed;
    NOH_ASSERT(skin && matrices && instance < skin->plan.instance_count);
    changed = put_palettes(skin, instance, matrices, 12);
    send(skin, &changed);
}

int noh_gl_skin_write_matrices(noh_gl_skin *skin, uint32_t instance, const float *matrices)
{
    span changed;
    NOH_ASSERT(skin && matrices && instance < skin->plan.instance_count);
    changed = put_palettes(skin, instance, matrices, 12);
    return changed.first < changed.end;
}

/* The kept rows of an instance. */
static float *kept_of(const noh_gl_skin *skin, const noh_gl_skin_mesh *m, uint32_t instance)
{
    const uint32_t row = m->first_kept + (instance - m->first_instance) * m->before_row;
    NOH_ASSERT(row + m->before_row <= skin->plan.kept_count);
    return skin->kept + 4u * (size_t)row;
}

void noh_gl_skin_keep(noh_gl_skin *skin)
{
    NOH_ASSERT(skin && skin->kept);
    for (uint32_t i = 0; i < skin->plan.instance_count; i++) {
        const noh_gl_skin_mesh *m = mesh_of(skin, i);
        memcpy(kept_of(skin, m, i), skin->rows + 4u * (size_t)first_row(m, i), 16u * (size_t)m->before_row);
    }
}

int noh_gl_skin_write_before(noh_gl_skin *skin, uint32_t instance, uint32_t was)
{
    const noh_gl_skin_mesh *m = mesh_of(skin, instance);
    const uint32_t palettes = noh_gl_crowd_rows(&m->mesh), to = first_row(m, instance) + palettes;
    const float *from = was == NOH_NONE ? skin->rows + 4u * (size_t)to : kept_of(skin, m, was) + 4u * palettes;
    span changed = { UINT32_MAX, 0 };
    NOH_ASSERT(skin->kept && (was == NOH_NONE || mesh_of(skin, was) == m));
    put_rows(skin, to + m->before_row, from, m->before_row - palettes, &changed);
    return changed.first < changed.end;
}

void noh_gl_skin_put_before(noh_gl_skin *skin, uint32_t instance, const float world[12],
                            const noh_gl_morph_binding *morph)
{
    const noh_gl_skin_mesh *m = mesh_of(skin, instance);
    const uint32_t row = first_row(m, instance) + m->before_row;
    float tile[4] = { 0.0f, 0.0f, 0.0f, 0.0f };
    span changed = { UINT32_MAX, 0 };
    NOH_ASSERT(m->before_row && world);
    if (morph) noh_gl_tile_floats(morph, tile);
    put_rows(skin, row, world, 3, &changed);
    put_rows(skin, row + 3u, tile, 1, &changed);
    send(skin, &changed);
}

void noh_gl_skin_touch(noh_gl_skin *skin, uint32_t instance)
{
    const noh_gl_skin_mesh *m = mesh_of(skin, instance);
    const span all = { first_row(m, instance), first_row(m, instance) + m->stride };
    send(skin, &all);
}

/* Row i of the cofactors is the cross product of the two rows after it; the determinant is any row times its cofactors.
 */
float noh_gl_normal_rows(const float w[12], float rows[12])
{
    float determinant;
    for (int i = 0; i < 3; i++) {
        const float *a = w + 4 * ((i + 1) % 3), *b = w + 4 * ((i + 2) % 3);
        rows[4 * i + 0] = a[1] * b[2] - a[2] * b[1];
        rows[4 * i + 1] = a[2] * b[0] - a[0] * b[2];
        rows[4 * i + 2] = a[0] * b[1] - a[1] * b[0];
        rows[4 * i + 3] = 0.0f;
    }
    determinant = w[0] * rows[0] + w[1] * rows[1] + w[2] * rows[2];
    for (int i = 0; determinant < 0.0f && i < 12; i++) {
        rows[i] = -rows[i];
    }
    return determinant;
}

static noh_result no_crowds(uint32_t instance, noh_error *error)
{
    return noh_fail(error, NOH_ERR_UNSUPPORTED, "palettes are in a uniform buffer: crowds need NOH_PALETTE_TEXTURE",
                    instance, 0);
}

/* Write the row of a tile with its tint, as floats: its whole numbers are below 2^24 and so exact. Stored as integer
 * bits they would be denormal floats, which GPUs may flush to zero. last: the touched vertices, and half of how far the
 * lips are open, below 0.75. That is exact up to 65,535 vertices; of more it is rounded, and never to a further
 * vertex */
static void put_tile(noh_gl_skin *skin, uint32_t row, const uint32_t tile[3], float last, const uint32_t tint[3])
{
    float values[4];
    span changed = { UINT32_MAX, 0 };
    for (int i = 0; i < 3; i++) values[i] = (float)(tile[i] | tint[i]);
    values[3] = last;
    put_rows(skin, row, values, 1, &changed);
    send(skin, &changed);
}

/* The tile bits of a row's value, or its tint bits (of_tint). */
static uint32_t tile_bits(const float *row, int i, int of_tint)
{
    const uint32_t mask = i < 2 ? NOH_TILE_XY_MASK : NOH_TILE_LOG2_MASK;
    return (uint32_t)row[i] & (of_tint ? ~mask : mask);
}

noh_result noh_gl_skin_set_tint(noh_gl_skin *skin, uint32_t instance, const uint8_t tint[4], noh_error *error)
{
    const uint32_t row = first_row(mesh_of(skin, instance), instance) + 3u;
    const float *own = skin->rows + 4u * (size_t)row;
    uint32_t tile[3], bits[3], apart = 0;
    if (skin->plan.mode != NOH_PALETTE_TEXTURE) {
        return no_crowds(instance, error);
    }
    noh_gl_tint_bits(tint, bits);
    for (int i = 0; i < 3; i++) apart |= tile_bits(own, i, 1) ^ bits[i];
    if (apart) {
        for (int i = 0; i < 3; i++) tile[i] = tile_bits(own, i, 0);
        put_tile(skin, row, tile, own[3], bits);
    }
    return NOH_OK;
}

noh_result noh_gl_skin_set_place(noh_gl_skin *skin, uint32_t instance, const float world[12],
                                 const noh_gl_morph_binding *morph, noh_error *error)
{
    uint32_t row = first_row(mesh_of(skin, instance), instance);
    const float *own = skin->rows + 4u * (size_t)(row + 3u);
    uint32_t tile[3] = { 0, 0, 0 }, tint[3];
    float normal[12];
    span changed = { UINT32_MAX, 0 };
    NOH_ASSERT(world);
    if (skin->plan.mode != NOH_PALETTE_TEXTURE) {
        return no_crowds(instance, error);
    }
    if (noh_gl_normal_rows(world, normal) < 0.0f) {
        return noh_fail(error, NOH_ERR_ARG, "an instance of a crowd is mirrored: draw it alone", instance, 0);
    }
    if (morph) {
        tile[0] = (uint32_t)morph->tile_x;
        tile[1] = (uint32_t)morph->tile_y;
        tile[2] = (uint32_t)morph->width_log2;
    }
    for (int i = 0; i < 3; i++) tint[i] = tile_bits(own, i, 1);
    put_rows(skin, row, world, 3, &changed);
    send(skin, &changed);
    put_tile(skin, row + 3u, tile, morph ? (float)morph->touched + 0.5f * morph->lips : 0.0f, tint);
    return NOH_OK;
}

noh_result noh_gl_skin_set_wrinkles(noh_gl_skin *skin, uint32_t instance, const float *regions, noh_error *error)
{
    const noh_gl_skin_mesh *m = mesh_of(skin, instance);
    const uint32_t rows = noh_gl_crowd_rows(&m->mesh);
    float values[2][4] = { { 0.0f } };
    span changed = { UINT32_MAX, 0 };
    if (skin->plan.mode != NOH_PALETTE_TEXTURE) {
        return no_crowds(instance, error);
    }
    if (rows == NOH_CROWD_ROWS) {
        return noh_fail(error, NOH_ERR_NOT_FOUND, "the instance's mesh has no wrinkles", instance, 0);
    }
    for (uint32_t i = 0; i < NOH_WRINKLE_REGIONS && regions; i++) { /* three bytes each, exact as floats */
        const uint32_t byte = (uint32_t)(regions[i] * 255.0f + 0.5f);
        if (i < NOH_WRINKLE_FOLDS) values[0][i / 3u] += (float)(byte << 8u * (i % 3u));
        if (i >= NOH_WRINKLE_FOLDS) values[1][i - NOH_WRINKLE_FOLDS] = (float)byte / 255.0f;
    }
    put_rows(skin, first_row(m, instance) + NOH_CROWD_REGIONS, values[0], rows - NOH_CROWD_REGIONS, &changed);
    send(skin, &changed);
    return NOH_OK;
}

noh_result noh_gl_skin_set_user(noh_gl_skin *skin, uint32_t instance, const float values[4], noh_error *error)
{
    const noh_gl_skin_mesh *m = mesh_of(skin, instance);
    span changed = { UINT32_MAX, 0 };
    NOH_ASSERT(values);
    if (!skin->user_rows) {
        return skin->plan.mode != NOH_PALETTE_TEXTURE
                   ? no_crowds(instance, error)
                   : noh_fail(error, NOH_ERR_UNSUPPORTED, "skin desc: user_values is 0", instance, 0);
    }
    put_rows(skin, first_row(m, instance) + m->stride - 1u, values, 1, &changed);
    send(skin, &changed);
    return NOH_OK;
}

/* ---- making ---- */

static noh_result create_buffer(noh_gl_skin *skin, noh_error *error)
{
    noh_result result = noh_gl_buffer_create(skin->gl, skin->ledger, GL_UNIFORM_BUFFER, skin->plan.gpu_bytes, NULL,
                                             GL_DYNAMIC_DRAW, &skin->buffer, error);
    if (!result) {
        noh_gl_label(skin->gl, GL_BUFFER, skin->buffer.name, "palettes", NULL);
    }
    return result;
}

static noh_result create_texture(noh_gl_skin *skin, noh_error *error)
{
    noh_gl_texture_desc desc = { GL_RGBA32F, 0, 0, 0, 0, 0, 0 };
    noh_result result;
    desc.width = skin->plan.width;
    desc.height = skin->plan.height;
    result = noh_gl_texture_create(skin->gl, skin->ledger, &desc, &skin->texture, error);
    if (!result) {
        skin->gl->BindTexture(GL_TEXTURE_2D, skin->texture.name);
        noh_gl_label(skin->gl, GL_TEXTURE, skin->texture.name, "palettes", NULL);
        skin->gl->BindTexture(GL_TEXTURE_2D, 0);
    }
    return result;
}

/* Deletes its objects on error. */
static noh_result create_object(noh_gl_skin *skin, noh_error *error)
{
    noh_result result = NOH_OK;
    skin->dirty_first = 0; /* the content of a new object is undefined: the first update sends everything */
    skin->dirty_end = skin->plan.texel_count;
    if (skin->plan.mode == NOH_PALETTE_TEXTURE) {
        result = create_texture(skin, error);
    } else if (skin->plan.gpu_bytes) {
        result = create_buffer(skin, error);
    } else {
        return NOH_OK;
    }
    if (!result) {
        result = noh_gl_error_check(skin->gl, "the driver refused the palettes", skin->plan.gpu_bytes, error);
    }
    if (result) {
        noh_gl_skin_delete(skin);
    }
    return result;
}

static void set_bind_pose(noh_gl_skin *skin)
{
    static const float none[4] = { 0.0f, 0.0f, 0.0f, 0.0f };
    for (uint32_t i = 0; i < skin->plan.instance_count; i++) {
        (void)put_palettes(skin, i, identity, 0);
        if (skin->plan.mode == NOH_PALETTE_TEXTURE) {
            noh_gl_skin_set_place(skin, i, identity, NULL, NULL);
            if (skin->user_rows) (void)noh_gl_skin_set_user(skin, i, none, NULL);
        }
    }
}

noh_result noh_gl_skin_init(void *memory, size_t bytes, const noh_gl_device *device, const noh_gl_skin_desc *desc,
                            noh_gl_skin **skin, noh_error *error)
{
    noh_gl_skin_plan plan;
    noh_gl_skin *s;
    noh_arena arena;
    noh_result result;
    NOH_ASSERT(desc && skin);
    result = noh_gl_device_check(device, 1, error);
    if (!result) result = noh_gl_skin_plan_make(desc, device->caps, &plan, error);
    if (!result && plan.cpu_bytes > SIZE_MAX) {
        result = noh_fail(error, NOH_ERR_LIMIT, "the palettes need more memory than this processor can address", 0,
                          plan.cpu_bytes);
    }
    if (!result) result = noh_arena_open(&arena, memory, bytes, (size_t)plan.cpu_bytes, error);
    if (result) {
        return result;
    }
    memset(memory, 0, (size_t)plan.cpu_bytes);
    s = (noh_gl_skin *)noh_arena_carve(&arena, sizeof *s, 16);
    s->gl = device->api;
    s->ledger = device->ledger;
    s->plan = plan;
    s->mesh_count = desc->mesh_count;
    s->align = noh_gl_skin_align(&plan, device->caps);
    while (plan.width >> s->width_log2 > 1u) {
        s->width_log2++;
    }
    noh_gl_skin_carve(&arena, desc->mesh_count, &plan, s);
    noh_gl_skin_layout(desc, plan.mode, s->align, s->meshes);
    s->user_rows = desc->user_values && plan.mode == NOH_PALETTE_TEXTURE;
    set_bind_pose(s);
    result = create_object(s, error);
    if (!result) {
        *skin = s;
    }
    return result;
}

void noh_gl_skin_delete(noh_gl_skin *skin)
{
    NOH_ASSERT(skin && skin->gl && skin->ledger);
    noh_gl_buffer_delete(skin->gl, skin->ledger, &skin->buffer);
    noh_gl_texture_delete(skin->gl, skin->ledger, &skin->texture);
}

void noh_gl_skin_forget(noh_gl_skin *skin)
{
    const noh_gl_api *gl;
    NOH_ASSERT(skin && skin->gl && skin->ledger);
    gl = skin->gl;
    skin->gl = noh_gl_lost_api();
    noh_gl_skin_delete(skin);
    skin->gl = gl;
}

noh_result noh_gl_skin_restore(noh_gl_skin *skin, noh_error *error)
{
    noh_gl_skin_forget(skin);
    return create_object(skin, error);
}

/* ---- asking ---- */

uint32_t noh_gl_skin_instance(const noh_gl_skin *skin, uint32_t mesh, uint32_t i)
{
    NOH_ASSERT(skin && mesh < skin->mesh_count && i < skin->meshes[mesh].instance_count);
    return skin->meshes[mesh].first_instance + i;
}

noh_gl_skin_binding noh_gl_skin_binding_of(const noh_gl_skin *skin, uint32_t instance)
{
    const noh_gl_skin_mesh *m = mesh_of(skin, instance);
    noh_gl_skin_binding binding = { .mode = NOH_PALETTE_AUTO };
    binding.mode = skin->plan.mode;
    binding.name = skin->plan.mode == NOH_PALETTE_TEXTURE ? skin->texture.name : skin->buffer.name;
    binding.first = first_row(m, instance);
    binding.stride = m->stride;
    binding.user_row = skin->user_rows ? m->stride - 1u : 0;
    binding.before_row = m->before_row;
    binding.width_log2 = skin->width_log2;
    binding.align = skin->align;
    return binding;
}

/* ---- sending ---- */

/* A buffer is updated with the span itself, a texture with all texel rows that the span touches, as one rectangle. */
void noh_gl_skin_update(noh_gl_skin *skin)
{
    const noh_gl_api *gl = skin->gl;
    uint32_t first = skin->dirty_first, end = skin->dirty_end;
    NOH_ASSERT(first >= end || end <= skin->plan.texel_count);
    if (first >= end) {
        return;
    }
    if (skin->plan.mode == NOH_PALETTE_UNIFORM) {
        gl->BindBuffer(GL_UNIFORM_BUFFER, skin->buffer.name);
        gl->BufferSubData(GL_UNIFORM_BUFFER, (GLintptr)first * 16, (GLsizeiptr)(end - first) * 16,
                          skin->rows + 4u * (size_t)first);
        gl->BindBuffer(GL_UNIFORM_BUFFER, 0);
    } else {
        uint32_t y = first >> skin->width_log2, height = ((end - 1u) >> skin->width_log2) + 1u - y;
        noh_gl_pixels kept;
        gl->ActiveTexture(GL_TEXTURE0);
        gl->BindTexture(GL_TEXTURE_2D, skin->texture.name);
        noh_gl_unpack_begin(gl, &kept);
        gl->TexSubImage2D(GL_TEXTURE_2D, 0, 0, (GLint)y, (GLsizei)skin->plan.width, (GLsizei)height, GL_RGBA, GL_FLOAT,
                          skin->rows + ((size_t)y << skin->width_log2) * 4u);
        noh_gl_unpack_end(gl, &kept);
        gl->BindTexture(GL_TEXTURE_2D, 0);
    }
    skin->dirty_first = UINT32_MAX;
    skin->dirty_end = 0;
}
