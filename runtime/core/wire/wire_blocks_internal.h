/* wire_blocks_internal.h (private to wire/): the units of 8 bytes in block-compressed textures, and their known
 * neighbours during coding. */
#ifndef NOH_WIRE_BLOCKS_INTERNAL_H
#define NOH_WIRE_BLOCKS_INTERNAL_H

#include "core/wire/wire_internal.h"
#include "noh/base.h"

/* ---- models, by number of contexts ---- */

#define NOH_BLOCKS_HOW 0u                                    /* [4 equalities][4][4 modes beside] */
#define NOH_BLOCKS_BASE (NOH_BLOCKS_HOW + 64u)               /* [3 channels][8] of five bits */
#define NOH_BLOCKS_SMALL (NOH_BLOCKS_BASE + 24u)             /* [3][8] of four */
#define NOH_BLOCKS_SECOND (NOH_BLOCKS_SMALL + 24u)           /* [3][8] differences of the second colour */
#define NOH_BLOCKS_TABLE (NOH_BLOCKS_SECOND + 24u)           /* [8 spreads][8 tables beside] */
#define NOH_BLOCKS_TABLE2 (NOH_BLOCKS_TABLE + 64u)           /* [8 spreads][8 first tables] */
#define NOH_BLOCKS_DISTANCE (NOH_BLOCKS_TABLE2 + 64u)        /* [8 spreads] */
#define NOH_BLOCKS_PLANE (NOH_BLOCKS_DISTANCE + 8u)          /* [3 corners][3 channels][8] */
#define NOH_BLOCKS_SELECTOR (NOH_BLOCKS_PLANE + 72u)         /* [3 kinds][8][8] */
#define NOH_BLOCKS_HOLE (NOH_BLOCKS_SELECTOR + 192u)         /* [3 beside][5 guesses] */
#define NOH_BLOCKS_RAW (NOH_BLOCKS_HOLE + 15u)               /* 1 */
#define NOH_BLOCKS_EAC_HOW (NOH_BLOCKS_RAW + 1u)             /* [4 equalities] */
#define NOH_BLOCKS_EAC_BASE (NOH_BLOCKS_EAC_HOW + 4u)        /* [8] */
#define NOH_BLOCKS_EAC_TIMES (NOH_BLOCKS_EAC_BASE + 8u)      /* [8 spreads] */
#define NOH_BLOCKS_EAC_TABLE (NOH_BLOCKS_EAC_TIMES + 8u)     /* [16 times] */
#define NOH_BLOCKS_EAC_SELECTOR (NOH_BLOCKS_EAC_TABLE + 16u) /* [2 kinds][8][8] */
#define NOH_BLOCKS_END (NOH_BLOCKS_EAC_SELECTOR + 128u)

NOH_STATIC_ASSERT(NOH_BLOCKS_END < NOH_WIRE_MODELS, models_of_blocks); /* the last is for large values */

/* A mip level. */
typedef struct noh_wire_level {
    uint32_t columns, rows; /* of blocks */
    uint8_t *at;
} noh_wire_level;

#define NOH_WIRE_UNKNOWN (-1) /* a light: there is no such texel, or it is transparent */

/* A texel: red, green, blue, and how much of it is there, 0..4. Of one channel all three are that. */
typedef struct noh_wire_texel_value {
    int32_t c[3], share;
} noh_wire_texel_value;

typedef struct noh_wire_unit {
    uint32_t format; /* of its texels: ETC2_RGB or _RGBA1; ETC2_RGBA: a channel of 8 bits, EAC_RG: of 11 */
    uint32_t offset; /* in the block */
    uint32_t bytes;  /* of the block */
    uint32_t x, y;   /* of the block */
    const noh_wire_level *here, *other;
    int finer; /* the other level is */
    uint8_t *now;
    const uint8_t *left, *above;    /* NULL: none */
    uint32_t equal;                 /* bit 0: what is to the left and the corner, 1: what is above and the corner */
    noh_wire_texel_value beside[8]; /* to the left, top to bottom; above, left to right */
    noh_wire_texel_value guess[16]; /* [4 y + x] by the other level, or by those beside */
    int32_t light[5][5];            /* [1 + y][1 + x]: those beside, then its own as they become known */
} noh_wire_unit;

static inline int32_t noh_wire_light(const int32_t c[3])
{
    return c[0] + 2 * c[1] + c[2];
}

static inline int32_t noh_wire_held(int32_t value, int32_t most)
{
    return value < 0 ? 0 : value > most ? most : value;
}

/* Fill in what is known: needed only where the unit is none of those beside. */
void noh_wire_look_beside(noh_wire_unit *unit);
/* What the texel is by its neighbours. */
int32_t noh_wire_light_beside(const noh_wire_unit *unit, uint32_t x, uint32_t y);
/* Where a light falls among rising ones: twice the nearest, and 1 where it is above that. */
uint32_t noh_wire_zone(const int32_t *lights, uint32_t count, int32_t light);
/* How far texels of the guess are apart, as one of 8 classes; first: the texels that count, as bits. */
uint32_t noh_wire_spread(const noh_wire_unit *unit, uint32_t texels);

void noh_wire_code_colors(noh_wire_filter *filter, noh_wire_unit *unit);
void noh_wire_code_channel(noh_wire_filter *filter, noh_wire_unit *unit);

#endif
