/* decal_fragment.glsl: the marks on a surface, looked up by a pixel's position in the bind pose. After #version:
 * noh_gl_shader_prefix.
 *
 * A mark is a row of u_decals: centre and size; right and tile; normal and alpha; sRGB colour and roughness. It is a
 * square around its centre, within a sphere, on surfaces that face its direction. Later rows cover earlier ones. With
 * u_corners, a mark covers only its own triangles, whose last corners are listed there. */
uniform highp sampler2D u_decals;
uniform sampler2D u_picture;
uniform highp usampler2D u_corners; /* where each mark's corners begin; each mark's corners, ascending */
uniform highp int u_corner_row;     /* row of the first mark; -1: none, marks cover all surfaces near them */
uniform highp vec3 u_marks; /* number of rows; columns and rows of tiles of the picture, 0: round spots */

in vec3 v_world;
in vec3 v_normal;
in vec4 v_tangent;
in vec2 v_uv;
in vec4 v_color;
in highp vec3 v_rest;
in vec3 v_rest_normal;
flat in highp int v_corner;

#ifdef NOH_DEPTH_ONLY
void main()
{
    discard;
}
#else
layout(location = 0) out vec4 o_color;

vec3 linear_of(vec3 c)
{
    return mix(pow((c + 0.055) / 1.055, vec3(2.4)), c / 12.92, vec3(lessThanEqual(c, vec3(0.04045))));
}

highp uint corner_at(int i)
{
    return texelFetch(u_corners, ivec2(i & 255, i >> 8), 0).x; /* NOH_PATCH_WIDTH texels wide */
}

bool is_own(int row)
{
    if (u_corner_row < 0) return true;
    int low = int(corner_at(u_corner_row + row)), end = int(corner_at(u_corner_row + row + 1)), high = end;
    while (low < high) {
        int middle = (low + high) / 2;
        if (corner_at(middle) < uint(v_corner)) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low < end && corner_at(low) == uint(v_corner);
}

/* A round spot with a soft edge; or a tile. at: -1 to 1 */
vec4 mark_at(vec2 at, float tile, vec2 dx, vec2 dy)
{
    if (u_marks.y < 0.5) {
        return vec4(1.0, 1.0, 1.0, 1.0 - smoothstep(0.8, 1.0, length(at)));
    }
    vec2 scale = 0.5 / u_marks.yz, corner = vec2(mod(tile, u_marks.y), floor(tile / u_marks.y)) / u_marks.yz;
    return textureGrad(u_picture, corner + (vec2(at.x, -at.y) + 1.0) * scale, dx * scale, dy * scale);
}

void main()
{
    highp vec3 along_x = dFdx(v_rest), along_y = dFdy(v_rest);
    vec3 facing = normalize(v_rest_normal);
    vec4 over = vec4(0.0);
    float roughness = 0.0;
    for (int i = 0; i < int(u_marks.x); i++) {
        highp vec4 centre = texelFetch(u_decals, ivec2(0, i), 0);
        highp vec3 to = (v_rest - centre.xyz) / centre.w;
        if (dot(to, to) >= 2.0) continue;
        highp vec4 right = texelFetch(u_decals, ivec2(1, i), 0), normal = texelFetch(u_decals, ivec2(2, i), 0);
        highp vec3 up = cross(normal.xyz, right.xyz);
        vec2 at = vec2(dot(to, right.xyz), dot(to, up));
        if (max(abs(at.x), abs(at.y)) >= 1.0 || dot(facing, normal.xyz) < 0.2) continue;
        if (!is_own(i)) continue;
        vec4 color = texelFetch(u_decals, ivec2(3, i), 0);
        vec2 dx = vec2(dot(along_x, right.xyz), -dot(along_x, up)) / centre.w;
        vec2 dy = vec2(dot(along_y, right.xyz), -dot(along_y, up)) / centre.w;
        vec4 mark = mark_at(at, right.w, dx, dy) * vec4(linear_of(color.rgb), normal.w);
        over = vec4(mark.rgb * mark.a, mark.a) + over * (1.0 - mark.a);
        roughness = color.a * mark.a + roughness * (1.0 - mark.a);
    }
    if (over.a < 0.004) discard;
    noh_cut(noh_base(v_uv, v_color).a);
    noh_surface s = noh_surface_of(vec4(over.rgb / over.a, 1.0), v_world, v_normal, v_tangent, v_uv);
    s.roughness = roughness / over.a;
    s.metallic = 0.0;
    o_color = vec4(noh_encode(noh_material.w > 0.5 ? over.rgb / over.a : noh_light(s)), over.a);
    noh_fade();
}
#endif
