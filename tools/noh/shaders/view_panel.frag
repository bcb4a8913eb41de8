#version 300 es
/* view_panel.frag: colours and textures are sRGB bytes and stay so. */
precision highp float;

uniform sampler2D u_picture;

in vec2 v_uv;
in vec4 v_color;

layout(location = 0) out vec4 o_color;

void main()
{
    o_color = v_color * texture(u_picture, v_uv);
}
