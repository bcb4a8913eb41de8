#version 300 es
/* hair.vert: a strip of hair out of its number and four control hairs: noh_haircut_vertex in the vertex shader. */
precision highp float;
precision highp int;

uniform highp sampler2D u_points; /* rows of control hairs, then two texels a patch: its corners */
uniform vec4 u_counts;            /* points of a hair, hairs, patches, segments of a strip */
uniform vec4 u_widths;            /* half of a strip's at root and tip, how far strips stray, gloss */
uniform vec4 u_curl;              /* radius, turns */
uniform vec4 u_middle;            /* of the skull, head space */
uniform vec4 u_world[3];          /* from head space */
uniform mat4 u_view_projection;
uniform vec4 u_eye;               /* world; w 0: the view is parallel */
uniform vec4 u_light;             /* unit, towards the light */

out vec3 v_position;
out vec3 v_tangent;
out vec3 v_normal;
out vec2 v_at;           /* across, -1 to 1; along, 0 to 1 */
flat out float v_strip;  /* a number of the strip's own, 0 to 1 */

float share_of(uint bits)
{
    return float(bits >> 8) * (1.0 / 16777216.0);
}

uint mixed(uint x)
{
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
}

vec3 fetch(int point, float hair)
{
    return texelFetch(u_points, ivec2(point, int(hair)), 0).xyz;
}

void add_hair(float hair, ivec4 at, vec4 place, vec4 slope, float share, inout vec3 position, inout vec3 tangent)
{
    vec3 a = fetch(at.x, hair), b = fetch(at.y, hair), c = fetch(at.z, hair), d = fetch(at.w, hair);
    position += share * (a * place.x + b * place.y + c * place.z + d * place.w);
    tangent += share * (a * slope.x + b * slope.y + c * slope.z + d * slope.w);
}

vec3 to_world(vec3 p, float w)
{
    vec4 q = vec4(p, w);
    return vec3(dot(u_world[0], q), dot(u_world[1], q), dot(u_world[2], q));
}

void main()
{
    uint strip = uint(gl_InstanceID), patches = uint(u_counts.z), index = strip % patches, turn = strip / patches;
    int count = int(u_counts.x), texel = int(index) * 2;
    vec2 near = texelFetch(u_points, ivec2(texel % count, int(u_counts.y) + texel / count), 0).xy;
    vec2 far = texelFetch(u_points, ivec2((texel + 1) % count, int(u_counts.y) + (texel + 1) / count), 0).xy;
    float u = share_of(turn * 0xc13fa9a9u + 0x80000000u), v = share_of(turn * 0x91e10da6u + 0x80000000u);
    float along = float(gl_VertexID >> 1) / u_counts.w;
    float x = along * (0.8 + 0.2 * share_of(mixed(strip * 3u))) * float(count - 1);
    int i = min(int(x), count - 2);
    float f = x - float(i), f2 = f * f, f3 = f2 * f;
    ivec4 at = ivec4(max(i - 1, 0), i, i + 1, min(i + 2, count - 1));
    vec4 place = 0.5 * vec4(2.0 * f2 - f - f3, 2.0 - 5.0 * f2 + 3.0 * f3, f + 4.0 * f2 - 3.0 * f3, f3 - f2);
    vec4 slope = 0.5 * vec4(4.0 * f - 1.0 - 3.0 * f2, 9.0 * f2 - 10.0 * f, 1.0 + 8.0 * f - 9.0 * f2, 3.0 * f2 - 2.0 * f);
    vec3 p = vec3(0.0), t = vec3(0.0);
    add_hair(near.x, at, place, slope, (1.0 - u) * (1.0 - v), p, t);
    add_hair(near.y, at, place, slope, u * (1.0 - v), p, t);
    add_hair(far.x, at, place, slope, (1.0 - u) * v, p, t);
    add_hair(far.y, at, place, slope, u * v, p, t);
    t = dot(t, t) > 1e-30 ? normalize(t) : vec3(0.0, -1.0, 0.0);
    float a = share_of(mixed(strip * 3u + 1u)), b = share_of(mixed(strip * 3u + 2u));
    float angle = 6.2831853 * (u_curl.y * along + a);
    float rise = 1.0 / max(1.0 - t.y, 1e-4); /* steady but straight up, where hardly any hair points */
    vec3 side = vec3(1.0 - t.x * t.x * rise, t.x, -t.x * t.z * rise), across = vec3(-t.x * t.z * rise, t.z, 1.0 - t.z * t.z * rise);
    p += (u_widths.z * along * (2.0 * a - 1.0) + u_curl.x * along * cos(angle)) * side;
    p += (u_widths.z * along * (2.0 * b - 1.0) + u_curl.x * along * sin(angle)) * across;
    vec3 away = p - u_middle.xyz;
    away.y = max(away.y, 0.0); /* below the skull's middle hair faces away from a line */
    float scale = length(vec3(u_world[0].x, u_world[1].x, u_world[2].x));
    v_position = to_world(p, 1.0);
    v_tangent = normalize(to_world(t, 0.0));
    vec3 view = u_eye.w > 0.5 ? u_eye.xyz - v_position : u_light.xyz;
    vec3 wide = cross(v_tangent, view);
    wide = dot(wide, wide) > 1e-12 * dot(view, view) ? normalize(wide) : normalize(to_world(side, 0.0));
    v_at = vec2((gl_VertexID & 1) == 0 ? -1.0 : 1.0, along);
    v_position += v_at.x * scale * mix(u_widths.x, u_widths.y, along) * smoothstep(-0.02, 0.025, along) * wide;
    vec3 normal = to_world(away - dot(away, t) * t, 0.0);
    v_normal = dot(normal, normal) > 1e-20 ? normalize(normal) : wide;
    v_strip = b;
    gl_Position = u_view_projection * vec4(v_position, 1.0);
}
