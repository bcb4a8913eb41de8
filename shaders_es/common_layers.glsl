/* common_layers.glsl: what a vertex shader needs to fetch its accumulated deltas.
 * Include it in your own vertex shader, call morph_fetch, add and renormalise. */
#ifdef LAYERS_UINT
uniform highp usampler2DArray u_layers;
#define LAYER_FETCH(texel, layer) uintBitsToFloat(texelFetch(u_layers, ivec3(texel, layer), 0).xyz)
#else
uniform highp sampler2DArray u_layers;
#define LAYER_FETCH(texel, layer) texelFetch(u_layers, ivec3(texel, layer), 0).xyz
#endif
uniform highp ivec4 u_morph; /* tile x, tile y, width log2, touched vertices */

/* Add the deltas of a vertex; vertices that no target touches have none. */
void morph_fetch(int vertex, inout vec3 position, inout vec3 normal, inout vec3 tangent)
{
    if (vertex < u_morph.w) {
        ivec2 texel = u_morph.xy + ivec2(vertex & ((1 << u_morph.z) - 1), vertex >> u_morph.z);
        position += LAYER_FETCH(texel, 0);
        normal += LAYER_FETCH(texel, 1);
        tangent += LAYER_FETCH(texel, 2);
    }
}

/* Unit normal; unit tangent at right angles to it (row A11). */
void morph_frame(inout vec3 normal, inout vec3 tangent)
{
    normal = normalize(normal);
    tangent -= normal * dot(normal, tangent);
    float square = dot(tangent, tangent);
    tangent = square > 1e-30 ? tangent * inversesqrt(square) : vec3(0.0);
}
