/* common_vertex.glsl: noh_fetch, a vertex of a noh_gl_mesh morphed, skinned and placed in the world.
 *
 * It follows common_layers.glsl, common_attributes.glsl, common_skin.glsl and common_transfer.glsl in
 * noh_gl_shader_prefix. Its own defines, written by noh_gl_variant_defines:
 *
 *   NOH_DEPTH_ONLY   defined: only depth is drawn. Normals, tangents and their deltas are neither fetched nor
 *                    computed, and are 0; nor are colours and uv, except with
 *   NOH_ALPHA_CUT    defined: pixels are discarded by their alpha. Needs no define without NOH_DEPTH_ONLY
 *   NOH_OUTLINE      defined: the hull of a toon's outline: positions are moved along the normals
 *   NOH_UV_TARGETS   defined: the mesh has NOH_MESH_UV_TARGETS, and its texture coordinates are fetched */
uniform mat4 noh_view_projection;
uniform vec4 noh_world[3];      /* rows of 3 x 4 */
uniform vec4 noh_normal[3];     /* rows of the inverse transpose of its 3 x 3 part, up to a positive factor */
#ifdef NOH_UV_TARGETS
uniform vec4 noh_uv[2];         /* offset, scale; x: texture coordinates for a unit in their texel */
#else
uniform vec4 noh_uv;            /* offset, scale */
#endif

layout(location = 0) in vec3 noh_a_position;
#ifndef NOH_DEPTH_ONLY
layout(location = 1) in ivec2 noh_a_normal;
layout(location = 2) in ivec2 noh_a_tangent;
#endif
#if !defined(NOH_DEPTH_ONLY) || defined(NOH_ALPHA_CUT)
layout(location = 3) in vec2 noh_a_uv;
layout(location = 4) in vec4 noh_a_color;
#ifdef NOH_UV_TARGETS
layout(location = 14) in highp int noh_a_uv_texel;
#endif
#endif

/* The bind pose. Where the CPU finishes vertices (noh_gl_morph_desc.vertices), noh_a_position and noh_a_normal are
 * morphed. A shader of your own that needs the bind pose defines NOH_REST. */
#if defined(NOH_STREAMS)
#define noh_a_rest noh_a_position
#define noh_a_rest_normal noh_a_normal
#elif defined(NOH_REST) || \
    (!defined(NOH_DEPTH_ONLY) && (defined(NOH_WRINKLES) || defined(NOH_EYE) || defined(NOH_TEETH) || defined(NOH_SKIN) || NOH_TRANSFER > 0))
layout(location = 10) in vec3 noh_a_rest;
layout(location = 11) in ivec2 noh_a_rest_normal;
#endif

#if defined(NOH_WRINKLES) && !defined(NOH_DEPTH_ONLY)
uniform vec3 noh_center; /* middle of the mesh's bounds, to keep positions small and differences exact */
uniform highp ivec2 noh_wrinkle_models; /* common_wrinkle.glsl; x with 8: row 4 of an instance has its regions */
out vec3 noh_v_rest;
out vec3 noh_v_moved;
#ifndef NOH_WRINKLE_PIXEL
uniform vec4 noh_wrinkle_regions[3]; /* component c of the k-th: region 3 * c + k, channel c of map k; not in crowds */
uniform mediump sampler2D noh_wrinkle_weights_0;
uniform mediump sampler2D noh_wrinkle_weights_1;
uniform mediump sampler2D noh_wrinkle_weights_2;
out vec2 noh_v_wrinkles; /* 0..1 by regions and by channels */
#elif defined(NOH_CROWD)
flat out highp ivec4 noh_v_regions; /* three regions of 8 bits in each component */
#endif
#endif

#if defined(NOH_COLORS) && defined(NOH_CROWD) && !defined(NOH_DEPTH_ONLY)
flat out vec4 noh_v_colors; /* weights of the regions of the colour map */
#endif

#if defined(NOH_PHONE) && defined(NOH_LIT) && !defined(NOH_DEPTH_ONLY)
out vec3 noh_v_ambient; /* of a white matte surface */
#endif

/* A surface drawn by two programs, one for depth and one for colour, has the same depth in both. */
invariant gl_Position;

struct noh_vertex {
    vec3 position; /* world */
    vec3 normal;   /* world; not unit */
    vec4 tangent;  /* world; not unit. w: handedness, 1 or -1 */
    vec2 uv;
    vec4 color;    /* linear; alpha last */
    vec4 tint;     /* of the instance; linear. alpha: 1 if the material does not blend */
    vec3 model;    /* position in the mesh's own space: morphed and skinned, not placed */
};

#if defined(NOH_WRINKLES) && !defined(NOH_DEPTH_ONLY)
#ifdef NOH_CROWD
/* A crowd's row has three regions of 8 bits in each component. */
ivec4 noh_region_bits()
{
    return (noh_wrinkle_models.x & 8) != 0 ? ivec4(noh_crowd_row(4)) : ivec4(0);
}
#endif

#ifdef NOH_WRINKLE_PIXEL
void noh_wrinkle_vertex(vec2 uv)
{
#ifdef NOH_CROWD
    noh_v_regions = noh_region_bits();
#endif
}
#else
/* The weights of regions of one map. */
vec4 noh_regions_of(int map)
{
#ifdef NOH_CROWD
    return vec4(noh_region_bits() >> 8 * map & 255) / 255.0;
#else
    return noh_wrinkle_regions[map];
#endif
}

float noh_largest(vec4 v)
{
    return max(max(v.x, v.y), max(v.z, v.w));
}

/* The wrinkle strength of a vertex by regions and by channels. */
void noh_wrinkle_vertex(vec2 uv)
{
    noh_v_wrinkles = vec2(0.0);
    if ((noh_wrinkle_models.x & 6) != 0) {
        vec4 regions = noh_regions_of(0), first = textureLod(noh_wrinkle_weights_0, uv, 0.0);
        if ((noh_wrinkle_models.x & 4) != 0) {
            noh_v_wrinkles.y = min(dot(first.rgb, vec3(1.0, regions.yz)), 1.0);
        }
        if ((noh_wrinkle_models.x & 2) != 0) {
            float most = noh_largest(first * regions);
            most = max(most, noh_largest(textureLod(noh_wrinkle_weights_1, uv, 0.0) * noh_regions_of(1)));
            noh_v_wrinkles.x = max(most, noh_largest(textureLod(noh_wrinkle_weights_2, uv, 0.0) * noh_regions_of(2)));
        }
    }
}
#endif
#endif

#ifdef NOH_OUTLINE
uniform vec3 noh_surface_more[4];                /* common_material.glsl */
uniform mediump sampler2D noh_wrinkle_weights_2; /* g: multiplies the width */

/* From a surface to the hull of its outline. scale: of the world. Below 0 the width is in heights of the picture. */
vec3 noh_outline_step(noh_vertex v, float scale)
{
    mat4 m = noh_view_projection;
    float height = 2.0 * dot(vec4(m[0].w, m[1].w, m[2].w, m[3].w), vec4(v.position, 1.0)) / length(vec3(m[0].y, m[1].y, m[2].y));
    float width = noh_surface_more[3].x * textureLod(noh_wrinkle_weights_2, v.uv, 0.0).g;
    return normalize(v.normal) * max(width * scale, -width * height);
}
#endif

vec4 noh_world_row(int i)
{
#ifdef NOH_CROWD
    return noh_crowd_row(i);
#else
    return noh_world[i];
#endif
}

/* Transform a normal to the world: by the cofactors of a crowd's rows, which are never mirrored, else by the rows of
 * noh_normal. */
vec3 noh_world_normal(vec4 x, vec4 y, vec4 z, vec3 normal)
{
#ifdef NOH_CROWD
    return vec3(dot(cross(y.xyz, z.xyz), normal), dot(cross(z.xyz, x.xyz), normal), dot(cross(x.xyz, y.xyz), normal));
#else
    return vec3(dot(noh_normal[0].xyz, normal), dot(noh_normal[1].xyz, normal), dot(noh_normal[2].xyz, normal));
#endif
}

/* The tile's numbers, with white minus the tint in their high bits. */
ivec4 noh_tile_row()
{
#ifdef NOH_CROWD
    return ivec4(noh_crowd_row(3));
#else
    return noh_morph;
#endif
}

#if !defined(NOH_DEPTH_ONLY) || defined(NOH_ALPHA_CUT)
uniform int noh_blends; /* bits: 1: the material blends: the tint's alpha applies; 2: its colour does not;
                         * 4 times the part of a complexion that it shows */

/* Decode a tint of 8-bit sRGB and alpha. left: white minus the tint */
vec4 noh_tint_of(ivec4 left)
{
    vec4 tint = vec4(1.0);
    if (left != ivec4(0)) {
        tint -= vec4(left) / 255.0;
        tint.rgb = mix(pow((tint.rgb + 0.055) / 1.055, vec3(2.4)), tint.rgb / 12.92, vec3(lessThanEqual(tint.rgb, vec3(0.04045))));
        tint.rgb = (noh_blends & 2) != 0 ? vec3(1.0) : tint.rgb;
        tint.a = (noh_blends & 1) != 0 ? tint.a : 1.0;
    }
    return tint;
}
#endif

#if !defined(NOH_DEPTH_ONLY) || defined(NOH_ALPHA_CUT)
/* Texture coordinates, with the changes by targets. */
vec2 noh_uv_of(ivec4 tile)
{
#ifdef NOH_UV_TARGETS
    vec2 uv = noh_uv[0].xy + noh_uv[0].zw * noh_a_uv;
    int texel = noh_a_uv_texel;
    if (texel < tile.w) {
#ifdef NOH_DIRECT
        uv += noh_morph_sums(tile, texel).position.xy * noh_uv[1].x;
#else
        uv += NOH_LAYER_FETCH(noh_morph_texel(tile, texel), 0).xy * noh_uv[1].x;
#endif
    }
    return uv;
#else
    return noh_uv.xy + noh_uv.zw * noh_a_uv;
#endif
}
#endif

/* What is read early and used late. A V3D reads all attributes first and keeps them across branches and loops: where it
 * would spill, each is kept in one word, and unpacked with the same bits. */
#if NOH_TRANSFER > 0 && (NOH_DRAWN == 8 || defined(NOH_CROWD))
#define NOH_BYTES int

int noh_keep(ivec4 bytes)
{
    bytes &= 255;
    return bytes.x | bytes.y << 8 | bytes.z << 16 | bytes.w << 24;
}

ivec4 noh_kept_bytes(int word)
{
    return ivec4(word << 24, word << 16, word << 8, word) >> 24;
}
#else
#define NOH_BYTES ivec4
#define noh_keep(whole) whole
#define noh_kept_bytes(whole) whole
#endif

/* In an order that needs few registers: eight joints in turn are blended first, since their loop needs as many as all
 * else, and its result few. The blend is used up, and the transfer's axis turned, before the rows of the world are
 * fetched, these are used up before the rest of the transfer, and what needs neither comes last. Otherwise a V3D or a
 * Mali spills, and the vertices of a crowd cost up to five times as much (tools/phones). */
noh_vertex noh_fetch()
{
    noh_vertex v = noh_vertex(vec3(0.0), vec3(0.0), vec4(0.0), vec2(0.0), vec4(1.0), vec4(1.0), noh_a_position);
#if NOH_TRANSFER > 0
    NOH_BYTES first = noh_keep(noh_a_lobe), more = noh_keep(noh_more_lobe());
#endif
#ifdef NOH_JOINTS_IN_TURN
    noh_blend blend = noh_blend_joints();
#endif
    ivec4 row = noh_tile_row(), tile = ivec4(row.xy & 0xffff, row.z & 0xff, row.w);
#if !defined(NOH_DEPTH_ONLY) || defined(NOH_ALPHA_CUT)
#ifdef NOH_UV_TARGETS
    v.uv = noh_uv_of(tile);
#endif
    NOH_BYTES tint = noh_keep(ivec4(row.xy >> 16, row.z >> 8, row.z >> 16));
#endif
#ifndef NOH_DEPTH_ONLY
#ifdef NOH_TEETH
    noh_face_vertex(noh_a_rest);
#endif
#if defined(NOH_SKIN) && !defined(NOH_JOINTS_IN_TURN)
    noh_face_vertex(noh_a_rest, noh_direction_of_pair(noh_a_rest_normal));
#endif
    v.normal = noh_direction_of_pair(noh_a_normal);
    v.tangent = noh_tangent_of_pair(noh_a_tangent);
#endif
    if (noh_morph_fetch_tile(tile, noh_morph_vertex(), v.model, v.normal, v.tangent.xyz)) {
        noh_morph_frame(v.normal, v.tangent.xyz);
    }
#ifndef NOH_DEPTH_ONLY
#if defined(NOH_SKIN) && defined(NOH_JOINTS_IN_TURN)
    noh_face_vertex(noh_a_rest, noh_direction_of_pair(noh_a_rest_normal));
#endif
#ifdef NOH_WRINKLES
    noh_v_moved = v.model - noh_a_rest;
#endif
#endif
#ifndef NOH_JOINTS_IN_TURN
    noh_blend blend = noh_blend_joints();
#endif
#if defined(NOH_EYE) && !defined(NOH_DEPTH_ONLY)
    vec3 gaze, nowhere = v.model;
    vec4 up;
    noh_gaze_vertex(noh_direction_of_pair(noh_a_rest_normal), v.normal, gaze, up);
    noh_skin_by(blend, nowhere, gaze, up);
#endif
    noh_skin_by(blend, v.model, v.normal, v.tangent);
#if NOH_TRANSFER > 0
    vec3 axis = noh_lobe_axis(noh_kept_bytes(more), noh_direction_of_pair(noh_a_rest_normal), normalize(v.normal));
#endif
    vec4 x = noh_world_row(0), y = noh_world_row(1), z = noh_world_row(2), p = vec4(v.model, 1.0);
#if NOH_TRANSFER > 0
    axis = normalize(noh_world_normal(x, y, z, axis));
#endif
    v.position = vec3(dot(x, p), dot(y, p), dot(z, p));
#ifndef NOH_DEPTH_ONLY
    v.normal = noh_world_normal(x, y, z, v.normal);
    v.tangent.xyz = vec3(dot(x.xyz, v.tangent.xyz), dot(y.xyz, v.tangent.xyz), dot(z.xyz, v.tangent.xyz));
    v.tangent.w *= dot(cross(x.xyz, y.xyz), z.xyz) < 0.0 ? -1.0 : 1.0; /* a mirror inverts the frame */
#ifdef NOH_EYE
    noh_face_vertex(noh_a_rest, gaze, up.xyz, x, y, z);
#endif
#endif
#if NOH_TRANSFER > 0
    noh_lobe lobe = noh_lobe_of(noh_kept_bytes(first), noh_kept_bytes(more));
    lobe.occlusion = clamp(lobe.occlusion + noh_morph_occlusion, 0.0, 1.0);
    noh_v_transfer = noh_lobe_shade(lobe, axis);
#endif
#if !defined(NOH_DEPTH_ONLY) || defined(NOH_ALPHA_CUT)
#ifndef NOH_UV_TARGETS
    v.uv = noh_uv_of(tile);
#endif
#endif
#ifndef NOH_DEPTH_ONLY
#ifdef NOH_WRINKLES
    noh_v_rest = noh_a_rest - noh_center;
    noh_wrinkle_vertex(v.uv);
#endif
#ifdef NOH_COMPLEXION
    noh_complexion_vertex(noh_blends >> 2);
#ifdef NOH_SKIN
    noh_freckles_vertex(noh_a_rest, noh_direction_of_pair(noh_a_rest_normal));
#endif
#endif
#if defined(NOH_COLORS) && defined(NOH_CROWD)
    noh_v_colors = noh_crowd_row(5);
#endif
#endif
#if defined(NOH_PHONE) && defined(NOH_LIT) && !defined(NOH_DEPTH_ONLY)
    noh_v_ambient = noh_ambient(normalize(v.normal));
#endif
#if !defined(NOH_DEPTH_ONLY) || defined(NOH_ALPHA_CUT)
    v.color = vec4(noh_a_color.rgb * noh_a_color.rgb, noh_a_color.a);
    v.tint = noh_tint_of(noh_kept_bytes(tint) & 255);
#endif
#ifdef NOH_OUTLINE
    v.position += noh_outline_step(v, length(x.xyz));
#endif
    return v;
}

/* ---- extra attributes ---- */

/* Define NOH_EXTRAS to read them. Without it their locations are free. */
#ifdef NOH_EXTRAS
layout(location = 15) in highp ivec4 noh_a_extra;
#ifndef NOH_UV_TARGETS
layout(location = 14) in highp ivec4 noh_a_more_extra;
#endif
uniform highp vec4 noh_extras[15]; /* noh_extra_row of the pack for each: offset, step; first bit, bits, components */

highp int noh_extra_word(int i)
{
#ifndef NOH_UV_TARGETS
    if (i >= 4) return i < 6 ? (i == 4 ? noh_a_more_extra.x : noh_a_more_extra.y) : (i == 6 ? noh_a_more_extra.z : noh_a_more_extra.w);
#endif
    return i < 2 ? (i == 0 ? noh_a_extra.x : noh_a_extra.y) : (i == 2 ? noh_a_extra.z : noh_a_extra.w);
}

highp float noh_extra_number(highp ivec3 place, int component)
{
    int bit = place.x + component * place.y;
    return component < place.z ? float(noh_extra_word(bit >> 5) >> (bit & 31) & (1 << place.y) - 1) : 0.0;
}

/* The attribute at a place of the list of noh build --attributes; 0 where the mesh or the attribute has none. */
highp vec4 noh_extra(int index)
{
    highp ivec3 place = ivec3(noh_extras[3 * index + 2].xyz);
    return noh_extras[3 * index] + noh_extras[3 * index + 1] * vec4(noh_extra_number(place, 0), noh_extra_number(place, 1),
                                                                    noh_extra_number(place, 2), noh_extra_number(place, 3));
}
#endif

/* ---- the last frame ---- */

/* Columns of its view projection; of a single instance, rows of its world matrix and its tile; x: rows from an
 * instance's own rows to its rows of the last frame. */
uniform highp vec4 noh_before[9];

vec4 noh_before_row(int i)
{
#ifdef NOH_CROWD
    return noh_crowd_row(int(noh_before[8].x) + i);
#else
    return noh_before[4 + i];
#endif
}

/* Where the vertex was in the last frame, in clip space. */
vec4 noh_clip_before()
{
    ivec4 row = ivec4(noh_before_row(3));
    vec3 position = noh_a_position, normal = vec3(0.0, 0.0, 1.0);
    vec4 tangent = vec4(1.0, 0.0, 0.0, 1.0);
    noh_morph_fetch_tile(ivec4(row.xy & 0xffff, row.z & 0xff, row.w), noh_morph_vertex(), position, normal, tangent.xyz);
#ifdef NOH_PALETTE_TEXTURE
    noh_rows_ahead = int(noh_before[8].x);
#endif
    noh_skin_vertex(position, normal, tangent);
#ifdef NOH_PALETTE_TEXTURE
    noh_rows_ahead = 0;
#endif
    vec4 p = vec4(position, 1.0);
    p = vec4(dot(noh_before_row(0), p), dot(noh_before_row(1), p), dot(noh_before_row(2), p), 1.0);
    return mat4(noh_before[0], noh_before[1], noh_before[2], noh_before[3]) * p;
}
