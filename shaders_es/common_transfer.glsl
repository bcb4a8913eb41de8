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
    float shape[NOH_TRANSFER];
};

/* The second half of a vertex's record: shape of bands 4 and 5, and the axis. */
ivec4 noh_more_lobe()
{
#ifdef NOH_TRANSFER_ON_NORMAL
#if NOH_TRANSFER == 6
    return ivec4(noh_a_more_lobe, 0, 0);
#else
    return ivec4(0);
#endif
#elif NOH_TRANSFER == 6
    return noh_a_more_lobe;
#else
    return ivec4(0, 0, noh_a_more_lobe);
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

/* The vertex's lobe from the two halves of its record. */
noh_lobe noh_lobe_of(ivec4 first, ivec4 more)
{
    noh_lobe lobe;
    vec3 low = vec3(first.yzw) / 127.0;
    lobe.occlusion = float(first.x & 255) / 255.0;
    lobe.shape[0] = 1.0;
    lobe.shape[1] = low.x;
    lobe.shape[2] = low.y;
    lobe.shape[3] = low.z;
#if NOH_TRANSFER == 6
    lobe.shape[4] = float(more.x) / 127.0;
    lobe.shape[5] = float(more.y) / 127.0;
#endif
    return lobe;
}

/* The axis of the vertex's lobe, unit, model space. more: the second half of its record; from, to: the normal in the
 * bind pose and now, unit, model space */
vec3 noh_lobe_axis(ivec4 more, vec3 from, vec3 to)
{
#ifdef NOH_TRANSFER_ON_NORMAL
    return to;
#else
    return noh_lobe_turn(noh_unfold(vec2(more.zw) / 127.0), from, to);
#endif
}

/* Adds the terms of one m. first: the product of the odd numbers below 2 m */
void noh_lobe_add(noh_lobe lobe, vec3 axis, int m, float first, inout vec2 power, inout vec3 sum)
{
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
}

/* The light received by the lobe, and its occlusion. axis: of the lobe, in the world, unit. The basis is noh_sh_basis,
 * m by m, without the factors, which are in noh_rest. */
vec4 noh_lobe_shade(noh_lobe lobe, vec3 axis)
{
    vec3 sum = vec3(0.0);
    vec2 power = vec2(1.0, 0.0);
#if NOH_TRANSFER == 4
    /* Compilers unroll no loop around a loop, and would look up each coefficient by its index. */
    noh_lobe_add(lobe, axis, 0, 1.0, power, sum);
    noh_lobe_add(lobe, axis, 1, 1.0, power, sum);
    noh_lobe_add(lobe, axis, 2, 3.0, power, sum);
    noh_lobe_add(lobe, axis, 3, 15.0, power, sum);
#else
    float first = 1.0;
    for (int m = 0; m < NOH_TRANSFER; m++) { /* 36 terms in a row would spill registers of a Mali */
        noh_lobe_add(lobe, axis, m, first, power, sum);
        first *= float(2 * m + 1);
    }
#endif
    return vec4(sum * lobe.occlusion, lobe.occlusion);
}
#endif
