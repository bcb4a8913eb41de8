#include "axis.h"

#include "shared/maths.h"

#include <math.h>

void axis_spread(Axis *axis, int count, double half, double (*spacing)(double))
{
    enum { STEPS = 4000 };
    double total = 0, sum = 0, width = 2 * half / STEPS;
    for (int i = 0; i < STEPS; i++) {
        total += width / spacing(-half + (i + 0.5) * width);
    }
    int line = 0;
    axis->count = count;
    for (int i = 0; i < STEPS; i++) {
        double x = -half + i * width, step = width / spacing(x + width / 2);
        while (line < count && sum + step >= total * line / (count - 1)) {
            axis->at[line] = x + width * (total * line / (count - 1) - sum) / step;
            line++;
        }
        sum += step;
    }
    axis->at[0] = -half;
    for (; line < count; line++) {
        axis->at[line] = half;
    }
    axis->at[count - 1] = half;
}

void axis_snap(Axis *axis, const double *anchors, int anchor_count)
{
    Axis raw = *axis;
    int from = 0, last = axis->count - 1;
    for (int a = 0; a <= anchor_count; a++) {
        int to = last;
        if (a < anchor_count) {
            for (int i = 0; i < last; i++) {
                if (fabs(raw.at[i] - anchors[a]) < fabs(raw.at[to] - anchors[a])) {
                    to = i;
                }
            }
            axis->anchor[a] = to;
            axis->at[to] = anchors[a];
        }
        for (int i = from + 1; i < to; i++) {
            double k = (raw.at[i] - raw.at[from]) / (raw.at[to] - raw.at[from]);
            axis->at[i] = mix(axis->at[from], axis->at[to], k);
        }
        from = to;
    }
}
