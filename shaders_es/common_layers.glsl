/* common_layers.glsl: the accumulated deltas of a vertex. noh_fetch of common_vertex.glsl adds them; without it, call
 * noh_morph_fetch, which adds them, and if it returns true noh_morph_frame (shaders_es/README.md). Define
 * NOH_LAYERS_UINT if noh_gl_morph_binding.is_uint is 1, NOH_TWO_LAYERS if its layer_count is 2, NOH_DEPTH_ONLY if
 * positions are enough. */
#ifdef NOH_LAYERS_UINT
uniform highp usampler2DArray noh_layers;
#define NOH_LAYER_FETCH(texel, layer) uintBitsToFloat(texelFetch(noh_layers, ivec3(texel, layer), 0).xyz)
#else
uniform highp sampler2DArray noh_layers;
#define NOH_LAYER_FETCH(texel, layer) texelFetch(noh_layers, ivec3(texel, layer), 0).xyz
#endif
uniform highp ivec4 noh_morph; /* tile x, tile y, width log2, touched vertices */

/* Add a vertex's deltas from an instance's tile, given by the four numbers of noh_morph. Texel i of the tile belongs to
 * vertex i. The vertices that no target moves are the last ones of a mesh and have no texel: for them the result is
 * false, and noh_morph_frame is not needed. */
bool noh_morph_fetch_tile(ivec4 tile, int vertex, inout vec3 position, inout vec3 normal, inout vec3 tangent)
{
    bool touched = vertex < tile.w;
    if (touched) {
        ivec2 texel = tile.xy + ivec2(vertex & ((1 << tile.z) - 1), vertex >> tile.z);
        position += NOH_LAYER_FETCH(texel, 0);
#ifndef NOH_DEPTH_ONLY
        normal += NOH_LAYER_FETCH(texel, 1);
#ifndef NOH_TWO_LAYERS
        tangent += NOH_LAYER_FETCH(texel, 2);
#endif
#endif
    }
    return touched;
}

bool noh_morph_fetch(int vertex, inout vec3 position, inout vec3 normal, inout vec3 tangent)
{
    return noh_morph_fetch_tile(noh_morph, vertex, position, normal, tangent);
}

/* Sums of directions are not unit: make the normal unit, the tangent unit and perpendicular to it (Gram-Schmidt). */
void noh_morph_frame(inout vec3 normal, inout vec3 tangent)
{
#ifndef NOH_DEPTH_ONLY
    normal = normalize(normal);
    tangent -= normal * dot(normal, tangent);
    float square = dot(tangent, tangent);
    tangent = square > 1e-30 ? tangent * inversesqrt(square) : vec3(0.0);
#endif
}
