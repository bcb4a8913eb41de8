#version 300 es
/* bench_depth.frag: a shadow or depth pass: no colour. */
precision highp float;

void main()
{
}
