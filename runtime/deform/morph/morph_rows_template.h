/* morph_rows_template.h (private to deform/): the kernel that adds rows of words to the layers, for vectors of any
 * width; included once per width, by morph_kernel_internal.h.
 *
 * Vectors are stored at aligned positions of a layer, because a store that crosses a cache line takes as long as two.
 * So the first vector begins `lead` words before its row, and the last one ends after the row. In these two only the
 * row's lanes change; the other floats are written back unchanged.
 *
 * There is no loop over the layers: in a loop gcc reads shifts and weights from memory in every step, which takes up to
 * twice as long. As gcc cannot know that layers do not alias the words or the fields, the code loads the words of a
 * step once for all layers and copies the fields. */

/* A layer and the field that is added to it. */
LANES_INLINE LANES_TYPE LANES(with_field)(LANES_TYPE words, morph_field f, LANES_TYPE layer)
{
    const LANES_TYPE value = LANES(field)(words, (int)f.left, (int)f.right);
    return LANES(add)(layer, LANES(mul)(value, LANES(set)(f.weight)));
}

LANES_INLINE void LANES(add_field)(LANES_TYPE words, morph_field f, float *layer)
{
    LANES(store)(layer, LANES(with_field)(words, f, LANES(load)(layer)));
}

LANES_INLINE void LANES(add_some)(LANES_TYPE words, LANES_TYPE mask, morph_field f, float *layer)
{
    const LANES_TYPE before = LANES(load)(layer);
    LANES(store)(layer, LANES(choose)(mask, LANES(with_field)(words, f, before), before));
}

LANES_INLINE void LANES(add_step)(const uint32_t *from, const morph_field f[3], float *const layers[3], size_t at)
{
    const LANES_TYPE words = LANES(words)(from);
    LANES(add_field)(words, f[0], layers[0] + at);
    LANES(add_field)(words, f[1], layers[1] + at);
    if (layers[2]) LANES(add_field)(words, f[2], layers[2] + at);
}

LANES_INLINE void LANES(add_end)(const uint32_t *from, LANES_TYPE mask, const morph_field f[3], float *const layers[3],
                                 size_t at)
{
    const LANES_TYPE words = LANES(words)(from);
    LANES(add_some)(words, mask, f[0], layers[0] + at);
    LANES(add_some)(words, mask, f[1], layers[1] + at);
    if (layers[2]) LANES(add_some)(words, mask, f[2], layers[2] + at);
}

LANES_INLINE void LANES(add_rows)(const noh_morph_rows *r, const morph_field f[3], float *const layers[3])
{
    const size_t count = r->count, rows = r->rows, stride = r->stride, lead = r->lead % LANES_COUNT, end = lead + count;
    const size_t whole = end - end % LANES_COUNT;
    const LANES_TYPE head = LANES(between)(lead, end), tail = LANES(between)(0, end - whole);
    const morph_field g[3] = { f[0], f[1], f[2] };
    const uint32_t *words = r->words - lead;
    float *to[3];
    if (r->lead == NOH_MORPH_ALONE) {
        noh_add_rows_scalar(r, f, layers);
        return;
    }
    to[0] = layers[0] - lead;
    to[1] = layers[1] - lead;
    to[2] = layers[2] ? layers[2] - lead : NULL;
    for (size_t y = 0, at = 0; y < rows; y++, at += stride, words += count) {
        size_t i = LANES_COUNT;
        LANES(add_end)(words, head, g, to, at);
        for (; i < whole; i += LANES_COUNT) LANES(add_step)(words + i, g, to, at + i);
        if (i < end) LANES(add_end)(words + i, tail, g, to, at + i);
    }
}

#undef LANES
#undef LANES_TYPE
#undef LANES_COUNT
#undef LANES_INLINE
