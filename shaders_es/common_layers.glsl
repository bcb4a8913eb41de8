/* common_layers.glsl: a vertex's accumulated deltas. In your own vertex shader call morph_fetch, which adds them, then
 * morph_frame where it returned true (shaders_es/README.md). */
#ifdef LAYERS_UINT
uniform highp usampler2DArray u_layers;
#define LAYER_FETCH(texel, layer) uintBitsToFloat(texelFetch(u_layers, ivec3(texel, layer), 0).xyz)
#else
uniform highp sampler2DArray u_layers;
#define LAYER_FETCH(texel, layer) texelFetch(u_layers, ivec3(texel, layer), 0).xyz
#endif
uniform highp ivec4 u_morph; /* tile x, tile y, width log2, touched vertices */

/* Add a vertex's deltas from the tile of an instance (the numbers of u_morph). Texel i of a tile belongs to vertex i; the
 * vertices that no target moves come last in a mesh and have none: then false, and morph_frame is not needed. */
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

/* Sums of directions are not unit: make the normal unit, and the tangent perpendicular to it and unit (Gram and Schmidt). */
void morph_frame(inout vec3 normal, inout vec3 tangent)
{
    normal = normalize(normal);
    tangent -= normal * dot(normal, tangent);
    float square = dot(tangent, tangent);
    tangent = square > 1e-30 ? tangent * inversesqrt(square) : vec3(0.0);
}
