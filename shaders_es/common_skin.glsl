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

#if NOH_DRAWN == 8 && (defined(NOH_PALETTE_TEXTURE) || defined(NOH_DUAL_QUATERNION))
/* The joints after the first, one at a time. The loop ends where no weight is left, so that no compiler unrolls it:
 * unrolled, the palette's rows of several joints wait in registers, and a V3D and a Mali spill (tools/phones). */
#define NOH_JOINTS_IN_TURN
struct noh_others {
    uvec2 places;
    uvec4 low; /* weights, from the lowest bit up; high: the last word */
    uint high;
    int row; /* the first of the joint's */
    float weight;
};

noh_others noh_others_of()
{
    uvec3 more = noh_a_more_influences;
    return noh_others(noh_a_influences.xy, uvec4(noh_a_influences.zw, more.xy), more.z, 0, 0.0);
}

#define NOH_OTHERS_LEFT(o, i) (o.low != uvec4(0u) || o.high != 0u)

void noh_next(inout noh_others o, int i)
{
    uint bits = i == 1 ? 22u : 21u;
    o.places = uvec2(o.places.x >> 8 | o.places.y << 24, o.places.y >> 8);
    o.row = NOH_JOINT_ROW(int(o.places.x & 255u));
    o.weight = float(o.low.x & (1u << bits) - 1u) / 4194304.0;
    o.low = o.low >> bits | uvec4(o.low.yzw, o.high) << 32u - bits;
    o.high >>= bits;
}
#else
struct noh_others {
    float weights[NOH_DRAWN];
    int row;
    float weight;
};

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
noh_others noh_others_of()
{
    noh_others o;
    float stored[NOH_INFLUENCES], sum = 4194304.0;
    noh_stored_weights(stored);
#if NOH_DRAWN < NOH_INFLUENCES
    sum = stored[0];
    for (int i = 1; i < NOH_DRAWN; i++) {
        sum += stored[i];
    }
#endif
    for (int i = 1; i < NOH_DRAWN; i++) {
        o.weights[i] = stored[i] / sum;
    }
    return o;
}

#define NOH_OTHERS_LEFT(o, i) (i < NOH_DRAWN)

void noh_next(inout noh_others o, int i)
{
    uint places = i < 4 ? NOH_PLACES_LOW : NOH_PLACES_HIGH;
    o.row = NOH_JOINT_ROW(int(places >> uint(8 * (i & 3)) & 255u));
    o.weight = o.weights[i];
}
#endif

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
#define NOH_FIRST_ROW NOH_JOINT_ROW(int(NOH_PLACES_LOW & 255u))

#ifdef NOH_DUAL_QUATERNION
struct noh_blend {
    vec4 rotation, dual;
    vec3 x, y, z; /* rows of the stretch */
};

vec3 noh_rotate(vec4 q, vec3 v)
{
    return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v);
}

/* Dual quaternion blending (Kavan et al., "Geometric Skinning with Approximate Dual Quaternion Blending", 2008) with a
 * stretch. Each joint is a stretch, the symmetric matrix xx yy zz xy xz yz, and then a rigid motion, a unit dual
 * quaternion. Stretches are blended linearly and applied first. As q and -q are the same rotation, each dual quaternion
 * is added with the sign that puts it in the strongest joint's hemisphere, so that the blend takes the shorter arc; the
 * sum is normalised. Its translation is twice the vector part of dual * conjugate(rotation). */
noh_blend noh_blend_joints()
{
    noh_others o = noh_others_of();
    int row = NOH_FIRST_ROW;
    vec4 pivot = NOH_PALETTE_ROW(row), rotation = vec4(0.0), dual = rotation, h = rotation, more = rotation;
    float first = 1.0;
    for (int i = 1; NOH_OTHERS_LEFT(o, i); i++) {
        noh_next(o, i);
        vec4 q = NOH_PALETTE_ROW(o.row);
        float signed_weight = noh_side(dot(pivot, q)) * o.weight;
        rotation += q * signed_weight;
        dual += NOH_PALETTE_ROW(o.row + 1) * signed_weight;
        h += NOH_PALETTE_ROW(o.row + 2) * o.weight;
        more += NOH_PALETTE_ROW(o.row + 3) * o.weight;
        first -= o.weight;
    }
    rotation += pivot * first;
    dual += NOH_PALETTE_ROW(row + 1) * first;
    h += NOH_PALETTE_ROW(row + 2) * first;
    more += NOH_PALETTE_ROW(row + 3) * first;
    float size = 1.0 / sqrt(dot(rotation, rotation));
    return noh_blend(rotation * size, dual * size, vec3(h.x, h.w, more.x), vec3(h.w, h.y, more.y), vec3(more.xy, h.z));
}

void noh_skin_by(noh_blend b, inout vec3 position, inout vec3 normal, inout vec4 tangent)
{
    vec3 cx = cross(b.y, b.z), cy = cross(b.z, b.x), cz = cross(b.x, b.y);
    float side = noh_side(dot(b.x, cx));
    position = noh_rotate(b.rotation, vec3(dot(b.x, position), dot(b.y, position), dot(b.z, position))) +
               2.0 * (b.rotation.w * b.dual.xyz - b.dual.w * b.rotation.xyz + cross(b.rotation.xyz, b.dual.xyz));
#ifndef NOH_DEPTH_ONLY
    vec3 stretched = vec3(dot(cx, normal), dot(cy, normal), dot(cz, normal)) * side;
    normal = noh_unit_or(noh_rotate(b.rotation, stretched), normal);
    stretched = vec3(dot(b.x, tangent.xyz), dot(b.y, tangent.xyz), dot(b.z, tangent.xyz));
    tangent = vec4(noh_unit_or(noh_rotate(b.rotation, stretched), tangent.xyz), tangent.w * side);
#endif
}
#else
struct noh_blend {
    vec4 x, y, z; /* rows */
};

/* Linear blending (Granberg 2009, ch. 3): the matrices are blended first, then applied once. Scales need not be
 * uniform, so normals are transformed by the cofactors of the blend, which are its inverse transpose up to a factor.
 * A blend that mirrors flips their sign and the tangent's handedness. */
noh_blend noh_blend_joints()
{
    noh_others o = noh_others_of();
    noh_blend b = noh_blend(vec4(0.0), vec4(0.0), vec4(0.0));
    float first = 1.0;
    for (int i = 1; NOH_OTHERS_LEFT(o, i); i++) {
        noh_next(o, i);
        b.x += NOH_PALETTE_ROW(o.row) * o.weight;
        b.y += NOH_PALETTE_ROW(o.row + 1) * o.weight;
        b.z += NOH_PALETTE_ROW(o.row + 2) * o.weight;
        first -= o.weight;
    }
    int row = NOH_FIRST_ROW;
    b.x += NOH_PALETTE_ROW(row) * first;
    b.y += NOH_PALETTE_ROW(row + 1) * first;
    b.z += NOH_PALETTE_ROW(row + 2) * first;
    return b;
}

void noh_skin_by(noh_blend b, inout vec3 position, inout vec3 normal, inout vec4 tangent)
{
    vec4 p = vec4(position, 1.0);
    vec3 cx = cross(b.y.xyz, b.z.xyz), cy = cross(b.z.xyz, b.x.xyz), cz = cross(b.x.xyz, b.y.xyz);
    float side = noh_side(dot(b.x.xyz, cx));
    position = vec3(dot(b.x, p), dot(b.y, p), dot(b.z, p));
#ifndef NOH_DEPTH_ONLY
    normal = noh_unit_or(vec3(dot(cx, normal), dot(cy, normal), dot(cz, normal)) * side, normal);
    vec3 turned = vec3(dot(b.x.xyz, tangent.xyz), dot(b.y.xyz, tangent.xyz), dot(b.z.xyz, tangent.xyz));
    tangent = vec4(noh_unit_or(turned, tangent.xyz), tangent.w * side);
#endif
}
#endif
#else
#define noh_blend int
#define noh_blend_joints() 0
#define noh_skin_by(blend, position, normal, tangent)
#endif

void noh_skin_vertex(inout vec3 position, inout vec3 normal, inout vec4 tangent)
{
    noh_skin_by(noh_blend_joints(), position, normal, tangent);
}
