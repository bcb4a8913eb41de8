/* common_transfer.glsl: ambient light by a vertex's precomputed transfer, with the arithmetic of light.h. It follows
 * common_layers.glsl and precedes common_vertex.glsl in noh_gl_shader_prefix. Defines, written by
 * noh_gl_variant_defines:
 *
 *   NOH_TRANSFER             the order of the mesh's transfer, 4 or 6; 0: none, or the renderer is not lit
 *   NOH_TRANSFER_ON_NORMAL   defined: lobes are centred on the normals, records have no axis */
#if NOH_TRANSFER > 0
layout(location = 8) in highp ivec4 noh_a_lobe; /* occlusion, unsigned with all 8 bits, and shape of bands 1 to 3 */
#if NOH_TRANSFER == 6 && !defined(NOH_TRANSFER_ON_NORMAL)
layout(location = 9) in highp ivec4 noh_a_more_lobe; /* shape of bands 4 and 5, axis */
#elif NOH_TRANSFER == 6 || !defined(NOH_TRANSFER_ON_NORMAL)
layout(location = 9) in highp ivec2 noh_a_more_lobe; /* shape of bands 4 and 5, or axis */
#endif

uniform vec4 noh_rest[NOH_TRANSFER * NOH_TRANSFER]; /* noh_lighting_pack_rest */

out vec4 noh_v_transfer; /* ambient light that a white matte surface reflects; occlusion */

struct noh_lobe {
    float occlusion;
    vec3 axis; /* unit, model space */
    float shape[NOH_TRANSFER];
};

/* The change of a vertex's occlusion by targets, stored or summed with the positions that noh_morph_fetch_tile adds. */
float noh_fetch_occlusion(ivec4 tile, int vertex)
{
#if defined(NOH_VERTICES)
    return 0.0;
#elif defined(NOH_DIRECT)
    return noh_morph_occlusion;
#else
    if (vertex >= tile.w) {
        return 0.0;
    }
    ivec3 texel = ivec3(noh_morph_texel(tile, vertex), 0);
#ifdef NOH_LAYERS_UINT
    return uintBitsToFloat(texelFetch(noh_layers, texel, 0).w);
#else
    return texelFetch(noh_layers, texel, 0).w;
#endif
#endif
}

/* Rotate `axis` by the smallest rotation from `from` to `to`, both unit: Rodrigues' formula, with the sine as the
 * length of the cross product. Opposite directions do not rotate. */
vec3 noh_lobe_turn(vec3 axis, vec3 from, vec3 to)
{
    vec3 across = cross(from, to);
    float cosine = dot(from, to);
    if (cosine < -0.9999) {
        return axis;
    }
    return normalize(axis * cosine + cross(across, axis) + across * (dot(across, axis) / (1.0 + cosine)));
}

/* The vertex's lobe. from, to: its normal in the bind pose and now, unit, model space */
noh_lobe noh_lobe_of(vec3 from, vec3 to)
{
    noh_lobe lobe;
    vec3 low = vec3(noh_a_lobe.yzw) / 127.0;
    lobe.occlusion = float(noh_a_lobe.x & 255) / 255.0;
    lobe.shape[0] = 1.0;
    lobe.shape[1] = low.x;
    lobe.shape[2] = low.y;
    lobe.shape[3] = low.z;
#if NOH_TRANSFER == 6
    lobe.shape[4] = float(noh_a_more_lobe.x) / 127.0;
    lobe.shape[5] = float(noh_a_more_lobe.y) / 127.0;
#endif
#ifdef NOH_TRANSFER_ON_NORMAL
    lobe.axis = to;
#elif NOH_TRANSFER == 6
    lobe.axis = noh_lobe_turn(noh_unfold(vec2(noh_a_more_lobe.zw) / 127.0), from, to);
#else
    lobe.axis = noh_lobe_turn(noh_unfold(vec2(noh_a_more_lobe) / 127.0), from, to);
#endif
    return lobe;
}

/* The light received by the lobe, and its occlusion. axis: of the lobe, in the world, unit. The basis is noh_sh_basis,
 * m by m, without the factors, which are in noh_rest. */
vec4 noh_lobe_shade(noh_lobe lobe, vec3 axis)
{
    vec3 sum = vec3(0.0);
    vec2 power = vec2(1.0, 0.0);
    float first = 1.0;
    for (int m = 0; m < NOH_TRANSFER; m++) {
        float before = 0.0, now = first;
        for (int l = m; l < NOH_TRANSFER; l++) {
            int middle = l * (l + 1);
            vec3 light = noh_rest[middle + m].rgb * power.x;
            if (m > 0) {
                light += noh_rest[middle - m].rgb * power.y;
            }
            sum += light * (now * lobe.shape[l]);
            float next = (axis.z * float(2 * l + 1) * now - float(l + m) * before) / float(l + 1 - m);
            before = now;
            now = next;
        }
        power = vec2(power.x * axis.x - power.y * axis.y, power.x * axis.y + power.y * axis.x);
        first *= float(2 * m + 1);
    }
    return vec4(sum * lobe.occlusion, lobe.occlusion);
}
#endif
