#include "hold.h"

#include "jaw.h"
#include "mouth.h"
#include "wood.h"

static const Pose rest;

/* Parts without slits are treated like the border of the face next to them. */
static double border_hold(const Seed *seed)
{
    FacePoint point = { seed->s, seed->t, seed->t > EYE_Y ? 1 : -1, seed->t > MOUTH_Y ? 1 : -1 };
    return jaw_weight(point, &rest);
}

double jaw_hold(const Seed *seed)
{
    switch (seed->region) {
    case ON_SKIN:
    case ON_LIP_FOLD: {
        FacePoint point = { seed->s, seed->t, seed->eye, seed->mouth };
        return jaw_weight(point, &rest);
    }
    case ON_STROKE:
    case ON_RIM: return border_hold(seed);
    /* As in back_place: the middle of the back stays. */
    case ON_BACK: return border_hold(seed) * back_share(seed) * back_share(seed);
    case ON_TEETH: return seed->mouth > 0 ? 0 : 1;
    case ON_TONGUE: return 1;
    case ON_BAG: return bag_jaw_weight(seed);
    case ON_LID_FOLD:
    case ON_EAR:
    case ON_BALL: return 0;
    }
    return 0;
}
