/* common_skin.glsl: vertices moved by the joints of a palette.
 *
 * It follows common_layers.glsl. noh_fetch of common_vertex.glsl calls all of it; without noh_fetch
 * (shaders_es/README.md), call noh_morph_vertex for the vertex whose deltas to fetch, add them in the bind pose, then
 * call noh_skin_vertex, whose result is still in the mesh's own space. Morphing comes before skinning, for normals and
 * tangents too (Granberg, Character Animation with Direct3D, 2009, ch. 8). Defines, written by noh_gl_variant_defines:
 *
 *   NOH_INFLUENCES        joints stored per vertex: 1, 2, 4 or 8; 0: not skinned
 *   NOH_DRAWN             joints used, the strongest ones, with weights scaled to a sum of 1
 *   NOH_PALETTE_TEXTURE   defined: palettes are in a texture; else in a uniform block
 *   NOH_DUAL_QUATERNION   defined: a joint is 4 rows, a rotation, a dual part and a stretch in two; else
 *                         3 rows of a matrix
 *   NOH_MORPH_TEXELS      defined: the mesh has NOH_MESH_TEXELS, in which split vertices share an accumulation texel
 *   NOH_CROWD             defined: one draw has many instances; needs NOH_PALETTE_TEXTURE
 *   NOH_DEPTH_ONLY        defined: normals and tangents are unchanged */
#if NOH_INFLUENCES == 1
layout(location = 5) in highp uint noh_a_influences;
#elif NOH_INFLUENCES == 2
layout(location = 5) in highp uvec2 noh_a_influences;
#elif NOH_INFLUENCES == 4
layout(location = 5) in highp uvec3 noh_a_influences;
#elif NOH_INFLUENCES == 8
layout(location = 5) in highp uvec4 noh_a_influences;
layout(location = 6) in highp uvec3 noh_a_more_influences;
#endif

/* ---- inputs ---- */

#ifdef NOH_MORPH_TEXELS
layout(location = 7) in highp uint noh_a_texel; /* the lowest 22 bits; above them, the vertex's palette */

int noh_morph_vertex()
{
    return int(noh_a_texel & 0x3fffffu);
}
#else
int noh_morph_vertex()
{
    return gl_VertexID;
}
#endif

#ifdef NOH_DUAL_QUATERNION
#define NOH_JOINT_ROWS 4
#else
#define NOH_JOINT_ROWS 3
#endif

#ifdef NOH_PALETTE_TEXTURE
uniform highp sampler2D noh_palettes;
/* first row, rows from an instance to the next, width log2, the palette's row in an instance */
uniform highp ivec4 noh_skin;

vec4 noh_skin_texel(int i)
{
    return texelFetch(noh_palettes, ivec2(i & ((1 << noh_skin.z) - 1), i >> noh_skin.z), 0);
}

int noh_skin_instance()
{
#ifdef NOH_CROWD
    return noh_skin.x + gl_InstanceID * noh_skin.y;
#else
    return noh_skin.x;
#endif
}

/* Rows 0 to 2 place the instance in the world, row 3 is its tile and tint: noh_tile_row. Its w counts the vertices that
 * targets move; the fraction is half of what targets open the lips. */
vec4 noh_crowd_row(int i)
{
    return noh_skin_texel(noh_skin_instance() + i);
}

int noh_rows_ahead = 0; /* to an instance's rows of the last frame, while they are read */
#define NOH_JOINT_ROW(i) (noh_skin_instance() + noh_rows_ahead + noh_skin.w + NOH_JOINT_ROWS * (i))
#define NOH_PALETTE_ROW(i) noh_skin_texel(i)
#elif NOH_INFLUENCES > 0 /* else a std140 block would stay active, and WebGL needs active blocks bound */
layout(std140) uniform noh_palette_block {
    highp vec4 noh_palette[256 * NOH_JOINT_ROWS];
};
#define NOH_JOINT_ROW(i) (NOH_JOINT_ROWS * (i))
#define NOH_PALETTE_ROW(i) noh_palette[i]
#endif

/* ---- the game's values of an instance ---- */

/* In a crowd, x: its row in an instance; 0: none. */
uniform highp vec4 noh_user_values;

/* noh_appearance.user, noh_gl_skin_set_user or noh_gl_draw_instance: four floats, unused by the library but for
 * complexions; zeros if not set. */
vec4 noh_user()
{
#ifdef NOH_CROWD
    return noh_user_values.x > 0.0 ? noh_crowd_row(int(noh_user_values.x)) : vec4(0.0);
#else
    return noh_user_values;
#endif
}

/* ---- influences: format.h ---- */

#if NOH_INFLUENCES > 0
#if NOH_INFLUENCES == 1
#define NOH_PLACES_LOW noh_a_influences
#else
#define NOH_PLACES_LOW noh_a_influences.x
#endif
#if NOH_INFLUENCES == 8
#define NOH_PLACES_HIGH noh_a_influences.y
#else
#define NOH_PLACES_HIGH 0u
#endif

/* The first row of the i-th joint. */
int noh_joint_row(int i)
{
    uint places = i < 4 ? NOH_PLACES_LOW : NOH_PLACES_HIGH;
    return NOH_JOINT_ROW(int(places >> uint(8 * (i & 3)) & 255u));
}

/* All weights, in units of 2^-22. The first is not stored: it is 1 minus the others. */
void noh_stored_weights(out float w[NOH_INFLUENCES])
{
#if NOH_INFLUENCES == 2
    w[1] = float(noh_a_influences.y);
#elif NOH_INFLUENCES > 2
#if NOH_INFLUENCES == 4
    uvec2 words = noh_a_influences.yz;
#else
    uvec2 words = noh_a_influences.zw;
    uvec3 more = noh_a_more_influences;
    w[4] = float(more.x & 0x1fffffu);
    w[5] = float(more.x >> 21 | (more.y & 0x3ffu) << 11);
    w[6] = float(more.y >> 10 & 0x1fffffu);
    w[7] = float(more.y >> 31 | (more.z & 0xfffffu) << 1);
#endif
    w[1] = float(words.x & 0x3fffffu);
    w[2] = float(words.x >> 22 | (words.y & 0x7ffu) << 10);
    w[3] = float(words.y >> 11);
#endif
    w[0] = 4194304.0;
    for (int i = 1; i < NOH_INFLUENCES; i++) {
        w[0] -= w[i];
    }
}

/* The weights of the joints used, except for the first, which is again 1 minus the others. */
void noh_drawn_weights(out float drawn[NOH_DRAWN])
{
    float stored[NOH_INFLUENCES], sum = 4194304.0;
    noh_stored_weights(stored);
#if NOH_DRAWN < NOH_INFLUENCES
    sum = stored[0];
    for (int i = 1; i < NOH_DRAWN; i++) {
        sum += stored[i];
    }
#endif
    for (int i = 1; i < NOH_DRAWN; i++) {
        drawn[i] = stored[i] / sum;
    }
}

/* 1 with a number's sign, and 1 for both zeros. Not a choice between -1 and 1: compilers would turn a product with it
 * into a choice between the two products, and keep both. */
float noh_side(float x)
{
    return uintBitsToFloat((floatBitsToUint(x + 1e-30) & 0x80000000u) | 0x3f800000u);
}

vec3 noh_unit_or(vec3 v, vec3 otherwise)
{
    float square = dot(v, v);
    return square > 1e-30 ? v * inversesqrt(square) : otherwise;
}

/* ---- the two ways to blend ---- */

/* Both add the first joint last: its weight is known then, and the others need not be kept. */

#ifdef NOH_DUAL_QUATERNION
vec3 noh_rotate(vec4 q, vec3 v)
{
    return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v);
}

/* Dual quaternion blending (Kavan et al., "Geometric Skinning with Approximate Dual Quaternion Blending", 2008) with a
 * stretch. Each joint is a stretch, the symmetric matrix xx yy zz xy xz yz, and then a rigid motion, a unit dual
 * quaternion. Stretches are blended linearly and applied first. As q and -q are the same rotation, each dual quaternion
 * is added with the sign that puts it in the strongest joint's hemisphere, so that the blend takes the shorter arc; the
 * sum is normalised. Its translation is twice the vector part of dual * conjugate(rotation). */
void noh_skin_vertex(inout vec3 position, inout vec3 normal, inout vec4 tangent)
{
    float w[NOH_DRAWN];
    int row = noh_joint_row(0);
    vec4 pivot = NOH_PALETTE_ROW(row), rotation = vec4(0.0), dual = rotation, h = rotation, more = rotation;
    vec3 x, y, z, cx, cy, cz;
    float size, side, first = 1.0;
    noh_drawn_weights(w);
    for (int i = 1; i < NOH_DRAWN; i++) {
        vec4 q;
        row = noh_joint_row(i);
        q = NOH_PALETTE_ROW(row);
        side = noh_side(dot(pivot, q));
        rotation += q * (side * w[i]);
        dual += NOH_PALETTE_ROW(row + 1) * (side * w[i]);
        h += NOH_PALETTE_ROW(row + 2) * w[i];
        more += NOH_PALETTE_ROW(row + 3) * w[i];
        first -= w[i];
    }
    row = noh_joint_row(0);
    rotation += pivot * first;
    dual += NOH_PALETTE_ROW(row + 1) * first;
    h += NOH_PALETTE_ROW(row + 2) * first;
    more += NOH_PALETTE_ROW(row + 3) * first;
    size = 1.0 / sqrt(dot(rotation, rotation));
    rotation *= size;
    dual *= size;
    x = vec3(h.x, h.w, more.x);
    y = vec3(h.w, h.y, more.y);
    z = vec3(more.x, more.y, h.z);
    cx = cross(y, z);
    cy = cross(z, x);
    cz = cross(x, y);
    side = noh_side(dot(x, cx));
    position = noh_rotate(rotation, vec3(dot(x, position), dot(y, position), dot(z, position))) +
               2.0 * (rotation.w * dual.xyz - dual.w * rotation.xyz + cross(rotation.xyz, dual.xyz));
#ifndef NOH_DEPTH_ONLY
    normal = noh_unit_or(noh_rotate(rotation, vec3(dot(cx, normal), dot(cy, normal), dot(cz, normal)) * side), normal);
    tangent = vec4(noh_unit_or(noh_rotate(rotation, vec3(dot(x, tangent.xyz), dot(y, tangent.xyz), dot(z, tangent.xyz))), tangent.xyz),
                   tangent.w * side);
#endif
}
#else
/* Linear blending (Granberg 2009, ch. 3): the matrices are blended first, then applied once. Scales need not be
 * uniform, so normals are transformed by the cofactors of the blend, which are its inverse transpose up to a factor.
 * A blend that mirrors flips their sign and the tangent's handedness. */
void noh_skin_vertex(inout vec3 position, inout vec3 normal, inout vec4 tangent)
{
    float w[NOH_DRAWN];
    int row;
    vec4 x = vec4(0.0), y = x, z = x, p = vec4(position, 1.0);
    vec3 cx, cy, cz;
    float side, first = 1.0;
    noh_drawn_weights(w);
    for (int i = 1; i < NOH_DRAWN; i++) {
        row = noh_joint_row(i);
        x += NOH_PALETTE_ROW(row) * w[i];
        y += NOH_PALETTE_ROW(row + 1) * w[i];
        z += NOH_PALETTE_ROW(row + 2) * w[i];
        first -= w[i];
    }
    row = noh_joint_row(0);
    x += NOH_PALETTE_ROW(row) * first;
    y += NOH_PALETTE_ROW(row + 1) * first;
    z += NOH_PALETTE_ROW(row + 2) * first;
    cx = cross(y.xyz, z.xyz);
    cy = cross(z.xyz, x.xyz);
    cz = cross(x.xyz, y.xyz);
    side = noh_side(dot(x.xyz, cx));
    position = vec3(dot(x, p), dot(y, p), dot(z, p));
#ifndef NOH_DEPTH_ONLY
    normal = noh_unit_or(vec3(dot(cx, normal), dot(cy, normal), dot(cz, normal)) * side, normal);
    tangent = vec4(noh_unit_or(vec3(dot(x.xyz, tangent.xyz), dot(y.xyz, tangent.xyz), dot(z.xyz, tangent.xyz)), tangent.xyz),
                   tangent.w * side);
#endif
}
#endif
#else
void noh_skin_vertex(inout vec3 position, inout vec3 normal, inout vec4 tangent)
{
}
#endif
