#include "paint.h"

static const V3 red = { 0.330, 0.030, 0.022 }, ivory = { 0.640, 0.520, 0.330 };
static const V3 gold = { 0.520, 0.300, 0.070 }, white = { 0.780, 0.740, 0.660 };
static const V3 skin = { 0.800, 0.690, 0.540 }, ink = { 0.012, 0.010, 0.009 };
static const V3 indigo = { 0.030, 0.045, 0.095 }, hem = { 0.055, 0.080, 0.150 };

int paint_material(Paint paint)
{
    return paint == PAINT_SKIN ? MATERIAL_SKIN : paint == PAINT_HAIR ? MATERIAL_HAIR : MATERIAL_CLOTH;
}

static V3 base_colour(Paint paint)
{
    switch (paint) {
    case PAINT_RED:
    case PAINT_LINING: return red;
    case PAINT_IVORY: return ivory;
    case PAINT_COLLAR:
    case PAINT_SASH:
    case PAINT_BAND: return gold;
    case PAINT_UNDER:
    case PAINT_SOCK: return white;
    case PAINT_CORD: return v3(0.260, 0.020, 0.020);
    case PAINT_SKIRT: return indigo;
    case PAINT_SKIRT_HEM: return hem;
    case PAINT_SKIRT_INSIDE: return v3_scale(indigo, 0.6);
    case PAINT_SKIN: return skin;
    case PAINT_HAIR: return ink;
    case PAINT_COAT: return v3(0.020, 0.150, 0.120);
    }
    return ink;
}

/* Old dye: lighter and darker from place to place. */
V3 paint_colour(Paint paint, V3 at, double open)
{
    double worn = noise2(at.x * 23 + at.z * 17, at.y * 21) + 0.5 * noise2(at.x * 61 - at.z * 47, at.y * 58);
    V3 colour = v3_scale(base_colour(paint), 1 + 0.10 * worn);
    double k = 1 - open;
    return v3(colour.x * (1 - 0.80 * k), colour.y * (1 - 0.88 * k), colour.z * (1 - 0.92 * k));
}
