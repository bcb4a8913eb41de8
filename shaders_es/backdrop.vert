#version 300 es
/* backdrop.vert: one triangle over the whole picture, with rays from the eye. */
precision highp float;

uniform vec4 u_rays[3]; /* world: ray at the lower left corner, difference over the width, difference over the height */

out vec3 v_ray;

void main()
{
    vec2 at = vec2(float(gl_VertexID & 1) * 2.0, float(gl_VertexID >> 1) * 2.0);
    v_ray = u_rays[0].xyz + at.x * u_rays[1].xyz + at.y * u_rays[2].xyz;
    gl_Position = vec4(at * 2.0 - 1.0, 1.0, 1.0);
}
