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

/* The quotient and the remainder, by way of floats: a GPU has no division of integers, and what stands for it takes most
 * of a Mali's registers. Exact for quotients below 2^22. */
ivec2 divide(int n, int by)
{
    int quotient = int(float(n) / float(by)), rest = n - quotient * by;
    int more = rest < 0 ? -1 : rest >= by ? 1 : 0;
    return ivec2(quotient + more, rest - more * by);
}

/* The n-th texel from a row on. */
vec3 fetch_from(int row, int n)
{
    ivec2 at = divide(n, int(u_counts.x) * int(u_curl.w));
    return fetch(at.y, row + at.x);
}

void add_hair(int hair, ivec4 at, vec4 place, vec4 slope, float share, inout vec3 position, inout vec3 tangent)
{
    ivec2 row = divide(hair, int(u_curl.w));
    int x = row.y * int(u_counts.x);
    vec3 a = fetch(x + at.x, row.x), b = fetch(x + at.y, row.x), c = fetch(x + at.z, row.x), d = fetch(x + at.w, row.x);
    position += share * (a * place.x + b * place.y + c * place.z + d * place.w);
    tangent += share * (a * slope.x + b * slope.y + c * slope.z + d * slope.w);
}

/* The place of a head: rows from head space. */
struct head {
    vec4 x, y, z;
};

/* Texels of a record: four of the place, and one of the first control hair, fade and melanin, and strips drawn. */
head head_of(int record)
{
    int row = int(u_crowd.z);
    vec3 a = fetch_from(row, record), b = fetch_from(row, record + 1), c = fetch_from(row, record + 2);
    return head(vec4(a, b.x), vec4(b.yz, c.xy), vec4(c.z, fetch_from(row, record + 3)));
}

vec2 melanin_of(float bytes)
{
    ivec2 melanin = ivec2(int(bytes) & 255, int(bytes) >> 8);
    melanin -= 256 * ivec2(greaterThan(melanin, ivec2(127)));
    return vec2(melanin) / vec2(32.0, 64.0);
}

vec3 to_world(head h, vec3 p, float w)
{
    vec4 q = vec4(p, w);
    return vec3(dot(h.x, q), dot(h.y, q), dot(h.z, q));
}

void main()
{
    ivec2 of_head = divide(gl_InstanceID, int(u_crowd.x)), of_patch = divide(of_head.y, int(u_counts.z));
    uint strip = uint(of_head.y), turn = uint(of_patch.x), seed = mixed(uint(of_patch.y) + 1u);
    int count = int(u_counts.x), texel = of_patch.y * 2, record = (int(u_crowd.y) + of_head.x) * 5;
    vec3 own = fetch_from(int(u_crowd.z), record + 4); /* of the head */
    ivec2 near = ivec2(fetch_from(int(u_counts.y), texel).xy) + int(own.x);
    ivec2 far = ivec2(fetch_from(int(u_counts.y), texel + 1).xy) + int(own.x);
    float u = share_of(turn * 0xc13fa9a9u + seed), v = share_of(turn * 0x91e10da6u + mixed(seed));
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
    head h = head_of(record); /* here: fetched earlier, it spills registers of a Mali G57 */
    vec3 away = p - u_middle.xyz;
    away.y = max(away.y, 0.0); /* below the middle of the skull, hair faces away from the vertical axis */
    float scale = length(vec3(h.x.x, h.y.x, h.z.x));
    v_position = to_world(h, p, 1.0);
    v_tangent = normalize(to_world(h, t, 0.0));
    vec3 view = u_eye.w > 0.5 ? u_eye.xyz - v_position : u_light.xyz;
    vec3 wide = cross(v_tangent, view);
    wide = dot(wide, wide) > 1e-12 * dot(view, view) ? normalize(wide) : normalize(to_world(h, side, 0.0));
    v_at = vec2((gl_VertexID & 1) == 0 ? -1.0 : 1.0, along);
    float widen = u_crowd.w / max(own.z, 1.0) * scale;
    v_position += v_at.x * widen * mix(u_widths.x, u_widths.y, along) * smoothstep(-0.02, 0.025, along) * wide;
    vec3 normal = to_world(h, away - dot(away, t) * t, 0.0);
    v_normal = dot(normal, normal) > 1e-20 ? normalize(normal) : wide;
    v_strip = b;
    v_fade = 2.0 * fract(own.y); /* bytes of melanin, with half of the fade behind the point */
    v_melanin = melanin_of(own.y);
    gl_Position = float(strip) < own.z ? u_view_projection * vec4(v_position, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
}
