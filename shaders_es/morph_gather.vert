#version 300 es
/* morph_gather.vert: one quad over the accumulation texels of one instance. */
precision highp float;
precision highp int;

uniform vec2 u_atlas;     /* 2 / size of the accumulation texture */

in uvec4 a_tile;          /* tile x | y << 16, first start, rows of blocks, width log2 in blocks */

flat out uvec3 f_tile;    /* tile, first start, width log2 in blocks */

void main()
{
    uvec2 size = uvec2(4u << a_tile.w, 4u * a_tile.z);
    uvec2 at = uvec2(a_tile.x & 0xffffu, a_tile.x >> 16) + uvec2(gl_VertexID & 1, gl_VertexID >> 1) * size;
    f_tile = a_tile.xyw;
    gl_Position = vec4(vec2(at) * u_atlas - 1.0, 0.0, 1.0);
}
