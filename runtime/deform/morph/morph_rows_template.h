/* morph_rows_template.h (private to deform/): the kernel that adds rows of words to the layers, for vectors of any
 * width; included once for each, by morph_kernel_internal.h.
 *
 * Vectors are stored where a layer has their alignment, since one that crosses a cache line takes as long as two. So the
 * first one begins `lead` words before its row, and the last one ends behind it. Of these two only the row's lanes
 * change; the other floats are read, and written as they were.
 *
 * The layers are written out: in a loop over them gcc would look shifts and weights up in every step, which takes up to
 * twice as long. Nor can it know that no layer lies over the words or the fields, so the words of a step are loaded once
 * for all layers by hand, and the fields are copied. */

ROWS_INLINE void ROWS(add)(ROWS_WORDS words, morph_field f, float *layer)
{
    ROWS(store)(layer, ROWS(sum)(words, f, ROWS(load)(layer)));
}

ROWS_INLINE void ROWS(add_some)(ROWS_WORDS words, ROWS_MASK mask, morph_field f, float *layer)
{
    const ROWS_TYPE before = ROWS(load)(layer);
    ROWS(store)(layer, ROWS(choose)(mask, ROWS(sum)(words, f, before), before));
}

ROWS_INLINE void ROWS(add_step)(const uint32_t *from, const morph_field f[3], float *const layers[3], size_t at)
{
    const ROWS_WORDS words = ROWS(words)(from);
    ROWS(add)(words, f[0], layers[0] + at);
    ROWS(add)(words, f[1], layers[1] + at);
    if (layers[2]) ROWS(add)(words, f[2], layers[2] + at);
}

ROWS_INLINE void ROWS(add_end)(const uint32_t *from, ROWS_MASK mask, const morph_field f[3], float *const layers[3],
                               size_t at)
{
    const ROWS_WORDS words = ROWS(words)(from);
    ROWS(add_some)(words, mask, f[0], layers[0] + at);
    ROWS(add_some)(words, mask, f[1], layers[1] + at);
    if (layers[2]) ROWS(add_some)(words, mask, f[2], layers[2] + at);
}

ROWS_INLINE void ROWS(add_rows)(const noh_morph_rows *r, const morph_field f[3], float *const layers[3])
{
    const size_t count = r->count, rows = r->rows, stride = r->stride, lead = r->lead % ROWS_LANES, end = lead + count;
    const size_t whole = end - end % ROWS_LANES;
    const ROWS_MASK head = ROWS(mask)(lead, end), tail = ROWS(mask)(0, end - whole);
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
        size_t i = ROWS_LANES;
        ROWS(add_end)(words, head, g, to, at);
        for (; i < whole; i += ROWS_LANES) ROWS(add_step)(words + i, g, to, at + i);
        if (i < end) ROWS(add_end)(words + i, tail, g, to, at + i);
    }
}

#undef ROWS
#undef ROWS_LANES
#undef ROWS_TYPE
#undef ROWS_WORDS
#undef ROWS_MASK
#undef ROWS_INLINE
