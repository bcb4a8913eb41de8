/* toon.h: the game's own shader of cast.c: stepped light with a shadow map. noh_fetch returns the morphed and skinned
 * vertex. */
#ifndef NOH_EXAMPLES_TOON_H
#define NOH_EXAMPLES_TOON_H

static const char toon_vertex[] =
    "uniform mat4 u_shadow;\n"
    "out vec3 v_normal; out vec4 v_color; out vec4 v_in_shadow;\n"
    "void main() {\n"
    "    noh_vertex v = noh_fetch();\n"
    "    v_normal = v.normal; v_color = v.color * v.tint; v_in_shadow = u_shadow * vec4(v.position, 1.0);\n"
    "    gl_Position = noh_view_projection * vec4(v.position, 1.0);\n"
    "}\n";
static const char toon_fragment[] =
    "uniform highp sampler2DShadow u_shadow_map; uniform vec3 u_light;\n"
    "in vec3 v_normal; in vec4 v_color; in vec4 v_in_shadow; out vec4 color;\n"
    "void main() {\n"
    "    noh_fade();\n"
    "    vec3 at = v_in_shadow.xyz / v_in_shadow.w * 0.5 + 0.5;\n"
    "    float lit = texture(u_shadow_map, vec3(at.xy, at.z - 0.004));\n"
    "    float toon = floor(3.0 * max(dot(normalize(v_normal), u_light), 0.0) * lit + 0.5) / 3.0;\n"
    "    color = vec4(v_color.rgb * (0.3 + 0.7 * toon), 1.0);\n"
    "}\n";

#endif
