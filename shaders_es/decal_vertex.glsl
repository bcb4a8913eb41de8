/* decal_vertex.glsl: draws a mesh again, with the positions of its pixels in the bind pose, for decal_fragment.glsl.
 * After #version: noh_gl_shader_prefix. */
out vec3 v_world;
out vec3 v_normal;
out vec4 v_tangent;
out vec2 v_uv;
out vec4 v_color;
out highp vec3 v_rest;
out vec3 v_rest_normal;
flat out highp int v_corner; /* last corner of a triangle */
uniform highp vec4 u_towards; /* x: offset that moves depths towards the eye */

void main()
{
    noh_vertex v = noh_fetch();
    v_world = v.position;
    v_normal = v.normal;
    v_tangent = v.tangent;
    v_uv = v.uv;
    v_color = v.color * v.tint;
    v_rest = noh_a_rest;
    v_corner = gl_VertexID;
#ifdef NOH_DEPTH_ONLY
    v_rest_normal = vec3(0.0);
#else
    v_rest_normal = noh_direction_of_pair(noh_a_rest_normal);
#endif
    gl_Position = noh_view_projection * vec4(v.position, 1.0);
    gl_Position.z += u_towards.x * gl_Position.w; /* in front of the surface under the mark */
}
