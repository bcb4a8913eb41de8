#version 300 es
/* hair.vert: a strip of hair from its number and four control hairs: noh_haircut_vertex as a vertex shader. */
precision highp float;
precision highp int;

uniform highp sampler2D u_points; /* rows of control hairs, then two texels for the corners of each patch, then five for
                                   * each head */
uniform vec4 u_counts;            /* points of a control hair, rows of control hairs, patches, segments of a strip */
uniform vec4 u_widths;            /* half the width of a strip at root and tip, how far strips stray, gloss */
uniform vec4 u_curl;              /* radius, turns, unused, control hairs in a row of texels */
uniform vec4 u_crowd;             /* strips drawn of each head, the first head, the row of heads, strips of a haircut */
uniform vec4 u_middle;            /* of the skull, head space */
uniform mat4 u_view_projection;
uniform vec4 u_eye;               /* world; w 0: parallel projection */
uniform vec4 u_light;             /* unit, towards the light */

out vec3 v_position;
out vec3 v_tangent;
out vec3 v_normal;
out vec2 v_at;           /* across, -1 to 1; along, 0 to 1 */
flat out float v_strip;  /* random number of the strip, 0 to 1 */
flat out vec2 v_melanin;
flat out float v_fade;

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

vec3 fetch(int x, int y)
{
    return texelFetch(u_points, ivec2(x, y), 0).xyz;
}

/* The n-th texel from a row on. */
vec3 fetch_from(int row, int n)
{
    int width = int(u_counts.x) * int(u_curl.w);
    return fetch(n % width, row + n / width);
}

void add_hair(int hair, ivec4 at, vec4 place, vec4 slope, float share, inout vec3 position, inout vec3 tangent)
{
    int in_row = int(u_curl.w), row = hair / in_row, x = (hair - row * in_row) * int(u_counts.x);
    vec3 a = fetch(x + at.x, row), b = fetch(x + at.y, row), c = fetch(x + at.z, row), d = fetch(x + at.w, row);
    position += share * (a * place.x + b * place.y + c * place.z + d * place.w);
    tangent += share * (a * slope.x + b * slope.y + c * slope.z + d * slope.w);
}

/* The hair of the head that an instance belongs to. */
struct head {
    vec4 x, y, z; /* rows from head space */
    uint strip;
    int first; /* index of its first control hair */
    float fade, widen;
    vec2 melanin;
    bool is_drawn;
};

head head_of(uint instance)
{
    uint each = uint(u_crowd.x), body = instance / each;
    int at = (int(u_crowd.y) + int(body)) * 5, row = int(u_crowd.z);
    vec3 a = fetch_from(row, at), b = fetch_from(row, at + 1), c = fetch_from(row, at + 2);
    vec3 d = fetch_from(row, at + 3), own = fetch_from(row, at + 4);
    uint strip = instance - body * each;
    int bytes = int(own.y); /* with half of the fade behind the point */
    ivec2 melanin = ivec2(bytes & 255, bytes >> 8);
    melanin -= 256 * ivec2(greaterThan(melanin, ivec2(127)));
    return head(vec4(a, b.x), vec4(b.yz, c.xy), vec4(c.z, d), strip, int(own.x), 2.0 * fract(own.y),
                u_crowd.w / max(own.z, 1.0), vec2(melanin) / vec2(32.0, 64.0), float(strip) < own.z);
}

vec3 to_world(head h, vec3 p, float w)
{
    vec4 q = vec4(p, w);
    return vec3(dot(h.x, q), dot(h.y, q), dot(h.z, q));
}

void main()
{
    head h = head_of(uint(gl_InstanceID));
    uint strip = h.strip, patches = uint(u_counts.z), index = strip % patches, turn = strip / patches;
    int count = int(u_counts.x), texel = int(index) * 2;
    ivec2 near = ivec2(fetch_from(int(u_counts.y), texel).xy) + h.first;
    ivec2 far = ivec2(fetch_from(int(u_counts.y), texel + 1).xy) + h.first;
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
    float rise = 1.0 / max(1.0 - t.y, 1e-4); /* continuous except straight up, where hardly any hair points */
    vec3 side = vec3(1.0 - t.x * t.x * rise, t.x, -t.x * t.z * rise), across = vec3(-t.x * t.z * rise, t.z, 1.0 - t.z * t.z * rise);
    p += (u_widths.z * along * (2.0 * a - 1.0) + u_curl.x * along * cos(angle)) * side;
    p += (u_widths.z * along * (2.0 * b - 1.0) + u_curl.x * along * sin(angle)) * across;
    vec3 away = p - u_middle.xyz;
    away.y = max(away.y, 0.0); /* below the middle of the skull, hair faces away from the vertical axis */
    float scale = length(vec3(h.x.x, h.y.x, h.z.x));
    v_position = to_world(h, p, 1.0);
    v_tangent = normalize(to_world(h, t, 0.0));
    vec3 view = u_eye.w > 0.5 ? u_eye.xyz - v_position : u_light.xyz;
    vec3 wide = cross(v_tangent, view);
    wide = dot(wide, wide) > 1e-12 * dot(view, view) ? normalize(wide) : normalize(to_world(h, side, 0.0));
    v_at = vec2((gl_VertexID & 1) == 0 ? -1.0 : 1.0, along);
    v_position += v_at.x * h.widen * scale * mix(u_widths.x, u_widths.y, along) * smoothstep(-0.02, 0.025, along) * wide;
    vec3 normal = to_world(h, away - dot(away, t) * t, 0.0);
    v_normal = dot(normal, normal) > 1e-20 ? normalize(normal) : wide;
    v_strip = b;
    v_fade = h.fade;
    v_melanin = h.melanin;
    gl_Position = h.is_drawn ? u_view_projection * vec4(v_position, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
}
