/* common_layers.glsl: the accumulated deltas of a vertex. In your own vertex shader call morph_fetch, which adds
 * them, and if it returns true morph_frame (shaders_es/README.md). Define LAYERS_UINT if noh_gl_morph_binding.is_uint
 * is 1. */
#ifdef LAYERS_UINT
uniform highp usampler2DArray u_layers;
#define LAYER_FETCH(texel, layer) uintBitsToFloat(texelFetch(u_layers, ivec3(texel, layer), 0).xyz)
#else
uniform highp sampler2DArray u_layers;
#define LAYER_FETCH(texel, layer) texelFetch(u_layers, ivec3(texel, layer), 0).xyz
#endif
uniform highp ivec4 u_morph; /* tile x, tile y, width log2, touched vertices */

/* Add a vertex's deltas from an instance's tile, given by the four numbers of u_morph. Texel i of the tile belongs to
 * vertex i. The vertices that no target moves are the last ones of a mesh and have no texel: for them the result is
 * false, and morph_frame is not needed. */
bool morph_fetch_tile(ivec4 tile, int vertex, inout vec3 position, inout vec3 normal, inout vec3 tangent)
{
    bool touched = vertex < tile.w;
    if (touched) {
        ivec2 texel = tile.xy + ivec2(vertex & ((1 << tile.z) - 1), vertex >> tile.z);
        position += LAYER_FETCH(texel, 0);
        normal += LAYER_FETCH(texel, 1);
        tangent += LAYER_FETCH(texel, 2);
    }
    return touched;
}

bool morph_fetch(int vertex, inout vec3 position, inout vec3 normal, inout vec3 tangent)
{
    return morph_fetch_tile(u_morph, vertex, position, normal, tangent);
}

/* Sums of directions are not unit: make the normal unit, the tangent unit and perpendicular to it (Gram-Schmidt). */
void morph_frame(inout vec3 normal, inout vec3 tangent)
{
    normal = normalize(normal);
    tangent -= normal * dot(normal, tangent);
    float square = dot(tangent, tangent);
    tangent = square > 1e-30 ? tangent * inversesqrt(square) : vec3(0.0);
}
