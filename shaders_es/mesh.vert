#version 300 es
/* mesh.vert: the vertices of the plain renderer. After #version: noh_gl_shader_prefix, as for a game's own shader. */
out vec3 v_world;
out vec3 v_normal;
out vec4 v_tangent;
out vec2 v_uv;
centroid out vec4 v_color;
out vec3 v_model;

void main()
{
    noh_vertex v = noh_fetch();
    v_world = v.position;
    v_normal = v.normal;
    v_tangent = v.tangent;
    v_uv = v.uv;
    v_color = v.color * v.tint;
    v_model = v.model;
    gl_Position = noh_view_projection * vec4(v.position, 1.0);
}
