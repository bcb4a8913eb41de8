#version 300 es
/* terrain.vert: a block of a height field, one triangle strip per row: see noh_terrain_lod_block. */
precision highp float;
precision highp int;

uniform highp usampler2D u_heights;
uniform ivec4 u_block;   /* its first height: column and row; cells per side, heights per cell */
uniform ivec4 u_edges;   /* at -x, +x, -z, +z: use every n-th vertex */
uniform vec4 u_origin;   /* world; w: spacing */
uniform vec4 u_scale;     /* x: scale of a height */
uniform mat4 u_view_projection;

out vec3 v_position;
out vec3 v_normal;

float height_at(ivec2 at)
{
    return u_scale.x * float(texelFetch(u_heights, clamp(at, ivec2(0), textureSize(u_heights, 0) - 1), 0).x);
}

void main()
{
    ivec2 own = ivec2(gl_VertexID >> 1, gl_InstanceID + (gl_VertexID & 1)), at = own;
    if (own.x == 0) at.y -= own.y % u_edges.x;
    if (own.x == u_block.z) at.y -= own.y % u_edges.y;
    if (own.y == 0) at.x -= own.x % u_edges.z;
    if (own.y == u_block.z) at.x -= own.x % u_edges.w;
    at = min(u_block.xy + at * u_block.w, textureSize(u_heights, 0) - 1);
    v_position = u_origin.xyz + vec3(float(at.x) * u_origin.w, height_at(at), float(at.y) * u_origin.w);
    vec2 rise = vec2(height_at(at - ivec2(1, 0)) - height_at(at + ivec2(1, 0)), height_at(at - ivec2(0, 1)) - height_at(at + ivec2(0, 1)));
    v_normal = normalize(vec3(rise.x, 2.0 * u_origin.w, rise.y));
    gl_Position = u_view_projection * vec4(v_position, 1.0);
}
