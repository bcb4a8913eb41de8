#version 300 es
/* floor.vert: a square on a level floor, around a disc. */
precision highp float;

uniform mat4 u_camera;
uniform vec4 u_disc; /* centre, radius */

out vec3 v_position;
out vec2 v_at; /* -1 to 1 */

void main()
{
    v_at = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 2.0 - 1.0;
    v_position = u_disc.xyz + u_disc.w * vec3(v_at.x, 0.0, v_at.y);
    gl_Position = u_camera * vec4(v_position, 1.0);
}
