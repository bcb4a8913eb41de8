#include "pack_skin.h"

#include <float.h>
#include <string.h>

#include "convert/skin/influence_pack.h"

void pack_grow_box(float box[6], const float point[3])
{
    for (int c = 0; c < 3; c++) {
        box[c] = point[c] < box[c] ? point[c] : box[c];
        box[3 + c] = point[c] > box[3 + c] ? point[c] : box[3 + c];
    }
}

void pack_skin(const model_skin *skin, uint32_t skeleton, byte_buffer *out)
{
    size_t base = out->count;
    noh_skin_header h = { skin->joint_count, skeleton, 0, 0 };
    buffer_append(out, &h, sizeof h);
    h.joints_offset = (uint32_t)(out->count - base);
    for (uint32_t j = 0; j < h.joint_count; j++) {
        uint16_t joint = (uint16_t)skin->skeleton_joints[j];
        buffer_append(out, &joint, sizeof joint);
    }
    buffer_align(out, 16);
    h.inverse_bind_offset = (uint32_t)(out->count - base);
    for (uint32_t i = 0; i < h.joint_count * 12u; i++) {
        const float *columns = skin->inverse_bind + 16 * (size_t)(i / 12u);
        buffer_append(out, columns + i % 4u * 4u + i % 12u / 4u, sizeof *columns);
    }
    if (!out->failed) {
        memcpy(out->bytes + base, &h, sizeof h);
    }
}

static uint32_t round_up_16(uint32_t bytes)
{
    return (bytes + 15u) & ~15u;
}

static uint32_t place_of(const mesh_layout *l, uint32_t palette, uint32_t joint)
{
    const uint16_t *joints = l->palette_joints + l->palettes[palette].first_joint;
    uint32_t low = 0, high = l->palettes[palette].joint_count;
    while (high - low > 1) {
        uint32_t middle = (low + high) / 2;
        low = joints[middle] <= joint ? middle : low;
        high = joints[middle] <= joint ? high : middle;
    }
    return low;
}

void pack_influences(const model_mesh *m, const mesh_layout *l, noh_mesh_header *h, size_t base, byte_buffer *out)
{
    buffer_align(out, 16);
    h->influences_offset = (uint32_t)(out->count - base);
    for (uint32_t v = 0; h->influence_count && v < l->vertex_count; v++) {
        uint32_t places[NOH_INFLUENCES_MAX], words[7];
        influence_list list;
        influence_quantise(m, l->source[v], &list);
        for (uint32_t i = 0; i < list.count; i++) {
            places[i] = place_of(l, l->palette[v], list.joints[i]);
        }
        buffer_append(out, words, 4u * influence_record(&list, places, h->influence_count, words));
    }
    buffer_align(out, 16);
    h->palettes_offset = (uint32_t)(out->count - base);
    buffer_append(out, l->palettes, sizeof *l->palettes * l->palette_count);
    buffer_align(out, 16);
    h->palette_joints_offset = (uint32_t)(out->count - base);
    buffer_append(out, l->palette_joints, sizeof *l->palette_joints * l->palette_joint_count);
}

/* The vertices of a layout that more joints move than the mesh has room for. */
static uint32_t long_vertices(const model_mesh *m, const mesh_layout *l, noh_influences_header *h)
{
    for (uint32_t v = 0; v < l->vertex_count; v++) {
        const uint32_t count = influence_count(m, l->source[v]);
        if (count <= NOH_INFLUENCES_MAX) continue;
        h->vertex_count++;
        h->influence_count += count;
        h->most = count > h->most ? count : h->most;
    }
    return h->vertex_count;
}

void pack_influence_list(const model_mesh *m, const mesh_layout *l, uint32_t mesh, byte_buffer *out)
{
    noh_influences_header h;
    uint32_t *vertices, *firsts, at = 0, n = 0;
    float *weights;
    uint16_t *joints;
    memset(&h, 0, sizeof h);
    h.mesh = mesh;
    if (!m->bound || m->dual_quaternion || m->influence_max <= NOH_INFLUENCES_MAX || !long_vertices(m, l, &h)) return;
    h.vertices_offset = sizeof h;
    h.firsts_offset = round_up_16(h.vertices_offset + 4u * h.vertex_count);
    h.weights_offset = round_up_16(h.firsts_offset + 4u * (h.vertex_count + 1u));
    h.joints_offset = round_up_16(h.weights_offset + 4u * h.influence_count);
    if (!buffer_append(out, NULL, h.joints_offset + 2u * (size_t)h.influence_count)) return;
    memcpy(out->bytes, &h, sizeof h);
    vertices = (uint32_t *)(void *)(out->bytes + h.vertices_offset);
    firsts = (uint32_t *)(void *)(out->bytes + h.firsts_offset);
    weights = (float *)(void *)(out->bytes + h.weights_offset);
    joints = (uint16_t *)(void *)(out->bytes + h.joints_offset);
    for (uint32_t v = 0; v < l->vertex_count; v++) {
        const size_t row = (size_t)l->source[v] * MODEL_INFLUENCES_MAX;
        const uint32_t count = influence_count(m, l->source[v]);
        if (count <= NOH_INFLUENCES_MAX) continue;
        vertices[n] = v;
        firsts[n++] = at;
        memcpy(weights + at, m->joint_weights + row, count * sizeof *weights);
        memcpy(joints + at, m->joints + row, count * sizeof *joints);
        at += count;
    }
    firsts[n] = at;
}

void pack_joint_boxes(const model_mesh *m, uint32_t joint_count, noh_mesh_header *h, size_t base, byte_buffer *out)
{
    float *boxes;
    buffer_align(out, 16);
    h->joint_boxes_offset = (uint32_t)(out->count - base);
    boxes = buffer_append(out, NULL, (size_t)joint_count * 24u);
    for (uint32_t i = 0; boxes && i < joint_count * 6u; i++) {
        boxes[i] = i % 6 < 3 ? FLT_MAX : -FLT_MAX;
    }
    for (uint32_t v = 0; boxes && joint_count && v < m->vertex_count; v++) {
        influence_list list;
        influence_quantise(m, v, &list);
        for (uint32_t i = 0; i < list.count; i++) {
            pack_grow_box(boxes + 6 * (size_t)list.joints[i], m->position + 3 * (size_t)v);
        }
        for (uint32_t i = NOH_INFLUENCES_MAX; i < influence_count(m, v); i++) {
            pack_grow_box(boxes + 6 * (size_t)m->joints[(size_t)v * MODEL_INFLUENCES_MAX + i],
                          m->position + 3 * (size_t)v);
        }
    }
}
