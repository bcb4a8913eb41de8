#version 300 es
/* blob.vert: a quad on the ground for each spot; corners by number, spots by instance. */
precision highp float;

uniform mat4 u_camera;
uniform vec4 u_rows[3 * NOH_BLOBS_DRAWN]; /* centre and darkness; along; across */

out vec2 v_at;
out float v_darkness;

void main()
{
    vec4 centre = u_rows[3 * gl_InstanceID];
    vec3 along = u_rows[3 * gl_InstanceID + 1].xyz, across = u_rows[3 * gl_InstanceID + 2].xyz;
    vec3 up = cross(across, along);
    v_at = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 2.0 - 1.0;
    v_darkness = centre.w;
    up *= (up.y < 0.0 ? -0.02 : 0.02) * inversesqrt(max(length(up), 1e-12)); /* above the ground by 2 % of its size */
    gl_Position = u_camera * vec4(centre.xyz + v_at.x * along + v_at.y * across + up, 1.0);
}
