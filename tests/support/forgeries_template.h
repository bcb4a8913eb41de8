/* forgeries_template.h: lies_are_refused, a test of a chunk's checker. Before it, a test defines
 *   forged      a struct: uint8_t *bytes, size_t count: a copy of a good pack; noh_pack_chunk *chunk; what is lied about
 *   forge       fills one
 *   FORGERIES   X(name, a word of the message, the lie about f) for each lie
 * Each lie is refused as bad data, with its word and a place in the chunk. */
typedef struct forgery {
    const char *name, *what;
    void (*lie)(forged *f);
} forgery;

#define LIE(name, what, lie)          \
    static void lie_##name(forged *f) \
    {                                 \
        lie;                          \
    }
FORGERIES(LIE)
#define ROW(name, what, lie) { #name, what, lie_##name },
static const forgery forgeries[] = { FORGERIES(ROW) };

static void lies_are_refused(void **state)
{
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(forgeries); i++) {
        noh_error error = { NOH_OK, "", 0, 0 };
        noh_pack pack;
        forged f;
        forge(&f);
        forgeries[i].lie(&f);
        pack_repair(f.bytes, f.count);
        if (noh_pack_open(f.bytes, f.count, &pack, &error) != NOH_ERR_DATA || !strstr(error.what, forgeries[i].what)) {
            fail_msg("%s: '%s'", forgeries[i].name, error.what);
        }
        assert_in_range(error.where, f.chunk->offset, f.chunk->offset + f.chunk->bytes);
        free(f.bytes);
    }
}
