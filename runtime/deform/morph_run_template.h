/* morph_run_template.h (private to deform/): the kernel that adds one run of words to the layers, for vectors of any
 * width; included once for each, by morph_kernel_internal.h.
 *
 * Vectors are stored where a layer has their alignment, since one that crosses a cache line takes as long as two. So the
 * first one begins `lead` words before the run, and the last one ends behind it. Of these two only the run's lanes
 * change; the other floats are read, and written as they were. */

RUN_INLINE void RUN(add)(const uint32_t *words, morph_field f, float *layer)
{
    RUN(store)(layer, RUN(sum)(words, f, RUN(load)(layer)));
}

RUN_INLINE void RUN(add_some)(const uint32_t *words, RUN_MASK mask, morph_field f, float *layer)
{
    const RUN_TYPE before = RUN(load)(layer);
    RUN(store)(layer, RUN(choose)(mask, RUN(sum)(words, f, before), before));
}

/* layer_count: two or three, a constant wherever this is inlined. In a loop over the layers, or called, gcc would look
 * shifts and weights up in every step, which takes up to twice as long. lead: up to NOH_MORPH_LANES - 1 words and floats
 * before the run, and as many behind it, may be touched; or NOH_MORPH_ALONE */
RUN_INLINE void RUN(run)(const uint32_t *words, size_t count, size_t lead, const morph_field f[3],
                         float *const layers[3], int layer_count)
{
    size_t i = RUN_LANES, end;
    RUN_MASK mask;
    float *a, *b, *c;
    if (lead == NOH_MORPH_ALONE) {
        noh_run_scalar(words, count, f, layers, layer_count);
        return;
    }
    lead %= RUN_LANES;
    end = lead + count;
    words -= lead;
    a = layers[0] - lead;
    b = layers[1] - lead;
    c = layer_count == 3 ? layers[2] - lead : NULL;
    mask = RUN(mask)(lead, end);
    RUN(add_some)(words, mask, f[0], a);
    RUN(add_some)(words, mask, f[1], b);
    if (layer_count == 3) RUN(add_some)(words, mask, f[2], c);
    for (; i + RUN_LANES <= end; i += RUN_LANES) {
        RUN(add)(words + i, f[0], a + i);
        RUN(add)(words + i, f[1], b + i);
        if (layer_count == 3) RUN(add)(words + i, f[2], c + i);
    }
    if (i < end) {
        mask = RUN(mask)(0, end - i);
        RUN(add_some)(words + i, mask, f[0], a + i);
        RUN(add_some)(words + i, mask, f[1], b + i);
        if (layer_count == 3) RUN(add_some)(words + i, mask, f[2], c + i);
    }
}

#undef RUN
#undef RUN_LANES
#undef RUN_TYPE
#undef RUN_MASK
#undef RUN_INLINE
