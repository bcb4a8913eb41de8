#include "folds.h"

#include "eye.h"
#include "face.h"

#include <math.h>

static V3 slit_edge(const Seed *seed, const Pose *pose)
{
    FacePoint point = { seed->s, seed->t, seed->eye, seed->mouth };
    return face_place(point, pose);
}

/* From the lid's edge back to just behind the surface of the eyeball, so that
 * no gap shows between the two in any pose. */
V3 lid_fold_place(const Seed *seed, const Pose *pose)
{
    static const double depth[] = { 0, 0.22, 0.55, 0.9, 1 };
    static const double spread[] = { 0, 0.0001, 0.0004, 0.0012, 0.0028 };
    int row = (int)seed->k;
    V3 edge = slit_edge(seed, pose);
    double inner = ball_front(seed->s > 0 ? LEFT : RIGHT, edge.x, edge.y) - 0.0012;
    V3 at = edge;
    at.y += seed->eye * spread[row] * sqrt(eye_almond(seed->s));
    at.z = mix(edge.z, inner, depth[row]);
    return at;
}

/* From the lip's edge inwards, curling up (or down) behind the lip. */
V3 lip_fold_place(const Seed *seed, const Pose *pose)
{
    static const double back[] = { 0, 0.0008, 0.0019, 0.0030, 0.0040, 0.0046, 0.0050 };
    static const double spread[] = { 0, 0.0001, 0.0007, 0.0020, 0.0042, 0.0072, 0.0105 };
    int row = (int)seed->k;
    double almond = mouth_almond(seed->s);
    V3 at = slit_edge(seed, pose);
    at.y += seed->mouth * spread[row] * sqrt(almond);
    at.z -= back[row];
    return at;
}
