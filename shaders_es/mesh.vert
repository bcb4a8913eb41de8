#version 300 es
/* mesh.vert: the vertices of the plain renderer, morphed, skinned, and placed in the world. common_skin.glsl and
 * common_layers.glsl name the defines. */
precision highp float;
precision highp int;
#include "common_layers.glsl"
#include "common_attributes.glsl"
#include "common_skin.glsl"

uniform mat4 u_view_projection;
uniform vec4 u_world[3];        /* rows of 3 x 4 */
uniform vec4 u_normal[3];       /* rows of the inverse transpose of its 3 x 3 part, up to a positive factor */
uniform vec4 u_uv;              /* offset, scale */

#ifdef CROWD
#define WORLD(i) crowd_row(i)
#define NORMAL_BY(i, a, b) cross(a.xyz, b.xyz) /* row i of the cofactors; no instance of a crowd is mirrored */
#define TILE ivec4(crowd_row(3))
#else
#define WORLD(i) u_world[i]
#define NORMAL_BY(i, a, b) u_normal[i].xyz
#define TILE u_morph
#endif

layout(location = 0) in vec3 a_position;
layout(location = 1) in ivec2 a_normal;
layout(location = 2) in ivec2 a_tangent;
layout(location = 3) in vec2 a_uv;
layout(location = 4) in vec4 a_color;

out vec3 v_world;
out vec3 v_normal;
out vec4 v_tangent;
out vec2 v_uv;
out vec4 v_color;
out vec3 v_model;

void main()
{
    vec4 tangent = tangent_of_pair(a_tangent), wx = WORLD(0), wy = WORLD(1), wz = WORLD(2), p;
    vec3 position = a_position, normal = direction_of_pair(a_normal);
    if (morph_fetch_tile(TILE, morph_vertex(), position, normal, tangent.xyz)) {
        morph_frame(normal, tangent.xyz);
    }
    skin(position, normal, tangent);
    p = vec4(position, 1.0);
    v_world = vec3(dot(wx, p), dot(wy, p), dot(wz, p));
    v_normal = vec3(dot(NORMAL_BY(0, wy, wz), normal), dot(NORMAL_BY(1, wz, wx), normal), dot(NORMAL_BY(2, wx, wy), normal));
    v_tangent = vec4(dot(wx.xyz, tangent.xyz), dot(wy.xyz, tangent.xyz), dot(wz.xyz, tangent.xyz), tangent.w);
    v_uv = u_uv.xy + u_uv.zw * a_uv;
    v_color = vec4(a_color.rgb * a_color.rgb, a_color.a);
    v_model = position;
    gl_Position = u_view_projection * vec4(v_world, 1.0);
}
