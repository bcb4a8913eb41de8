#version 300 es
/* bench_mesh.vert: one mesh, morphed in the ways that `noh bench` compares; without a
 * BENCH_* define, not at all: the floor. All give the same outputs.
 *
 *   BENCH_LAYERS    ours: three accumulated layers, fetched by texel, or summed here from lists
 *   BENCH_DENSE     every target's position and normal for every vertex, summed here;
 *                   with BENCH_HOISTED the texels' place is found once, not for every target;
 *                   with BENCH_ACTIVE it is, too, and the loop is over the active targets alone
 *   BENCH_FILAMENT  the same with the normal as a packed frame
 *   BENCH_QUADS     layers of all vertices, by vertex index
 *
 * Tangents are morphed by the accumulating ways only, and no shader here asks for them. */
precision highp float;
precision highp int;
precision highp sampler2DArray;
precision highp isampler2DArray;
#include "../../../shaders_es/common_attributes.glsl"
#if defined(BENCH_LAYERS)
#include "../../../shaders_es/common_delta.glsl"
#include "../../../shaders_es/common_walk.glsl"
#include "../../../shaders_es/common_layers.glsl"
#endif

uniform mat4 u_view_projection;
uniform vec4 u_world[3];
uniform vec4 u_normal[3];
uniform vec4 u_uv;

layout(location = 0) in vec3 a_position;
layout(location = 1) in ivec2 a_normal;
layout(location = 3) in vec2 a_uv;
layout(location = 4) in vec4 a_color;

out vec3 v_world;
out vec3 v_normal;
out vec4 v_tangent;
out vec2 v_uv;
out vec4 v_color;
out vec3 v_model;

#if defined(BENCH_DENSE)
uniform sampler2DArray u_targets; /* layer: target; two texels for each vertex, position and normal */
uniform int u_targets_width;
#if defined(BENCH_ACTIVE)
uniform vec4 u_weights[(TARGETS + 1) / 2]; /* layer and weight of two active targets */
uniform int u_count;
#else
uniform float u_weights[TARGETS];
#endif

ivec2 place_of(int offset)
{
    int i = gl_VertexID * 2 + offset;
    int y = i / u_targets_width;
    return ivec2(i - y * u_targets_width, y);
}

#if defined(BENCH_HOISTED)
#define PLACE(offset) (offset == 0 ? place0 : place1)
#else
#define PLACE(offset) place_of(offset)
#endif

#if defined(BENCH_ACTIVE)
void morph(inout vec3 position, inout vec3 normal)
{
    ivec2 place0 = place_of(0), place1 = place_of(1);
    for (int i = 0; i < u_count; i++) {
        vec4 two = u_weights[i >> 1];
        vec2 one = (i & 1) == 0 ? two.xy : two.zw;
        int layer = int(one.x);
        position += texelFetch(u_targets, ivec3(place0, layer), 0).xyz * one.y;
        normal += texelFetch(u_targets, ivec3(place1, layer), 0).xyz * one.y;
    }
    normal = normalize(normal);
}
#else
void morph(inout vec3 position, inout vec3 normal)
{
#if defined(BENCH_HOISTED)
    ivec2 place0 = place_of(0), place1 = place_of(1);
#endif
    for (int i = 0; i < TARGETS; i++) {
        if (u_weights[i] != 0.0) {
            position += texelFetch(u_targets, ivec3(PLACE(0), i), 0).xyz * u_weights[i];
        }
    }
    for (int i = 0; i < TARGETS; i++) {
        if (u_weights[i] != 0.0) {
            normal += texelFetch(u_targets, ivec3(PLACE(1), i), 0).xyz * u_weights[i];
        }
    }
    normal = normalize(normal);
}
#endif
#elif defined(BENCH_FILAMENT)
uniform sampler2DArray u_positions; /* layer: target; a texel for each vertex */
uniform isampler2DArray u_frames;   /* the frame of the morphed vertex as a quaternion, times 32767 */
uniform int u_targets;
layout(std140) uniform weights_block {
    vec4 weights[256];
};

vec3 normal_of_frame(vec4 q)
{
    return vec3(2.0 * (q.x * q.z + q.w * q.y), 2.0 * (q.y * q.z - q.w * q.x), 1.0 - 2.0 * (q.x * q.x + q.y * q.y));
}

void morph(inout vec3 position, inout vec3 normal)
{
    ivec2 texel = ivec2(gl_VertexID & 2047, gl_VertexID >> 11);
    vec3 rest = normal;
    for (int i = 0; i < u_targets; i++) {
        float w = weights[i].x;
        if (w != 0.0) {
            position += texelFetch(u_positions, ivec3(texel, i), 0).xyz * w;
        }
    }
    for (int i = 0; i < u_targets; i++) {
        float w = weights[i].x;
        if (w != 0.0) {
            ivec4 q = texelFetch(u_frames, ivec3(texel, i), 0);
            normal += (normal_of_frame(vec4(q) * (1.0 / 32767.0)) - rest) * w;
        }
    }
    normal = normalize(normal);
}
#elif defined(BENCH_QUADS)
uniform sampler2DArray u_sums;
uniform int u_width;

void morph(inout vec3 position, inout vec3 normal)
{
    int y = gl_VertexID / u_width;
    ivec2 texel = ivec2(gl_VertexID - y * u_width, y);
    position += texelFetch(u_sums, ivec3(texel, 0), 0).xyz;
    normal = normalize(normal + texelFetch(u_sums, ivec3(texel, 1), 0).xyz);
}
#elif defined(BENCH_LAYERS)
void morph(inout vec3 position, inout vec3 normal)
{
    vec3 tangent = vec3(0.0);
    if (noh_morph_fetch(gl_VertexID, position, normal, tangent)) normal = normalize(normal);
}
#else
void morph(inout vec3 position, inout vec3 normal)
{
}
#endif

void main()
{
    vec3 position = a_position, normal = noh_direction_of_pair(a_normal);
    morph(position, normal);
    vec4 p = vec4(position, 1.0);
    v_world = vec3(dot(u_world[0], p), dot(u_world[1], p), dot(u_world[2], p));
    v_normal = vec3(dot(u_normal[0].xyz, normal), dot(u_normal[1].xyz, normal), dot(u_normal[2].xyz, normal));
    v_tangent = vec4(0.0);
    v_uv = u_uv.xy + u_uv.zw * a_uv;
    v_color = vec4(a_color.rgb * a_color.rgb, a_color.a);
    v_model = position;
    gl_Position = u_view_projection * vec4(v_world, 1.0);
}
