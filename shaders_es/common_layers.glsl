/* common_layers.glsl: the accumulated deltas of a vertex. noh_fetch of common_vertex.glsl adds them; without it, call
 * noh_morph_fetch, which adds them, and if it returns true noh_morph_frame (shaders_es/README.md). Define
 * NOH_LAYERS_UINT if noh_gl_morph_binding.is_uint is 1, NOH_TWO_LAYERS if its layer_count is 2, NOH_DEPTH_ONLY if
 * positions are enough, NOH_VERTICES if vertices are already morphed, NOH_DIRECT if this shader sums the deltas
 * (after common_delta.glsl and common_walk.glsl). */
#if defined(NOH_VERTICES) || defined(NOH_DIRECT)
/* no layers */
#elif defined(NOH_LAYERS_UINT)
uniform highp usampler2DArray noh_layers;
#define NOH_LAYER_FETCH(texel, layer) uintBitsToFloat(texelFetch(noh_layers, ivec3(texel, layer), 0))
#else
uniform highp sampler2DArray noh_layers;
#define NOH_LAYER_FETCH(texel, layer) texelFetch(noh_layers, ivec3(texel, layer), 0)
#endif
uniform highp ivec4 noh_morph; /* tile x, tile y, width log2, touched vertices; with NOH_DIRECT: noh_morph_sums */

#ifdef NOH_STREAMS
/* Deltas of up to four targets as vertex attributes, words as in common_delta.glsl, added in index order. noh_streams:
 * weight times scale of positions, normals and tangents; the widths of the fields */
uniform highp vec4 noh_streams[4];
layout(location = 10) in highp uvec3 noh_a_stream_0;
layout(location = 11) in highp uvec3 noh_a_stream_1;
layout(location = 12) in highp uvec3 noh_a_stream_2;
layout(location = 13) in highp uvec3 noh_a_stream_3;

void noh_add_stream(uvec3 words, vec4 stream, inout vec3 position, inout vec3 normal, inout vec3 tangent)
{
    uint bits = uint(stream.w), p = bits & 255u, n = bits >> 8 & 255u, t = bits >> 16;
    position += vec3(ivec3(words) >> (32u - p)) * stream.x;
#ifndef NOH_DEPTH_ONLY
    normal += vec3(ivec3(words << p) >> (32u - n)) * stream.y;
    tangent += vec3(ivec3(words << (p + n)) >> (32u - t)) * stream.z;
#endif
}

void noh_add_streams(inout vec3 position, inout vec3 normal, inout vec3 tangent)
{
    vec3 p = vec3(0.0), n = vec3(0.0), t = vec3(0.0);
    noh_add_stream(noh_a_stream_0, noh_streams[0], p, n, t);
    noh_add_stream(noh_a_stream_1, noh_streams[1], p, n, t);
    noh_add_stream(noh_a_stream_2, noh_streams[2], p, n, t);
    noh_add_stream(noh_a_stream_3, noh_streams[3], p, n, t);
    position += p;
    normal += n;
#ifndef NOH_TWO_LAYERS
    tangent += t;
#endif
}
#endif

#ifdef NOH_DIRECT
/* The sums of accumulation texel i. tile: the low and high 16 bits of the tile's first start; log2 of the tile's width,
 * from bit 4 on of the width of the lists, and from bit 6 on of the starts, both less 8; touched vertices */
noh_sums noh_morph_sums(ivec4 tile, int i)
{
    int across = tile.z & 15, x = i & ((1 << across) - 1), y = i >> across;
    uint block = uint((tile.x | tile.y << 16) + (y >> 2 << (across - 2)) + (x >> 2));
    return noh_walk(block, ivec2(x, y) & 3, 8 + (tile.z >> 4 & 3), 8 + (tile.z >> 6 & 3));
}
#else
/* The position of accumulation texel i of a tile in the layers. */
ivec2 noh_morph_texel(ivec4 tile, int i)
{
    return tile.xy + ivec2(i & ((1 << tile.z) - 1), i >> tile.z);
}
#endif

#ifdef NOH_OCCLUSION
float noh_morph_occlusion = 0.0; /* how targets change the occlusion of the vertex that was fetched last */
#endif

/* Add a vertex's deltas from an instance's tile, given by the four numbers of noh_morph. Texel i of the tile belongs to
 * vertex i. Vertices that no target moves are the last ones of a mesh and have no texel: for them the result is false,
 * and noh_morph_frame is not needed. */
bool noh_morph_fetch_tile(ivec4 tile, int vertex, inout vec3 position, inout vec3 normal, inout vec3 tangent)
{
#ifdef NOH_VERTICES
    return false;
#else
    bool touched = vertex < tile.w;
    if (touched) {
#ifdef NOH_STREAMS
        noh_add_streams(position, normal, tangent);
#elif defined(NOH_DIRECT)
        noh_sums sums = noh_morph_sums(tile, vertex);
        position += sums.position;
        normal += sums.normal;
        tangent += sums.tangent;
#ifdef NOH_OCCLUSION
        noh_morph_occlusion = sums.occlusion;
#endif
#else
        ivec2 texel = noh_morph_texel(tile, vertex);
        vec4 first = NOH_LAYER_FETCH(texel, 0);
        position += first.xyz;
#ifdef NOH_OCCLUSION
        noh_morph_occlusion = first.w;
#endif
#ifndef NOH_DEPTH_ONLY
        normal += NOH_LAYER_FETCH(texel, 1).xyz;
#ifndef NOH_TWO_LAYERS
        tangent += NOH_LAYER_FETCH(texel, 2).xyz;
#endif
#endif
#endif
    }
    return touched;
#endif
}

bool noh_morph_fetch(int vertex, inout vec3 position, inout vec3 normal, inout vec3 tangent)
{
    return noh_morph_fetch_tile(noh_morph, vertex, position, normal, tangent);
}

/* Sums of directions are not unit: normalise the normal, and make the tangent unit and perpendicular to it
 * (Gram-Schmidt). */
void noh_morph_frame(inout vec3 normal, inout vec3 tangent)
{
#ifndef NOH_DEPTH_ONLY
    normal = normalize(normal);
    tangent -= normal * dot(normal, tangent);
    float square = dot(tangent, tangent);
    tangent = square > 1e-30 ? tangent * inversesqrt(square) : vec3(0.0);
#endif
}
