/* The sweep of components/learner/backup.py, line by line, for comparison. */
#include <math.h>
#include <stdint.h>

void sweep(int64_t sweeps, int64_t mirror, double *q, double *v, int64_t cells, const uint32_t *successor,
           const double *weight, int64_t slots, const int32_t *degree, const double *reward, const double *rate,
           const int32_t *image, int64_t actions)
{
    int64_t goal = cells / 2, last = mirror ? goal : cells;
    for (int64_t n = 0; n < sweeps; n++)
        for (int64_t cell = 0; cell < last; cell++) {
            int known = 0;
            double best = -INFINITY;
            for (int64_t pair = cell * actions; pair < (cell + 1) * actions; pair++) {
                if (degree[pair] > 0) {
                    known = 1;
                    double target = reward[pair];
                    for (int64_t slot = 0; slot < degree[pair]; slot++)
                        target += weight[pair * slots + slot] * v[successor[pair * slots + slot]];
                    q[pair] += rate[pair] * (target - q[pair]);
                }
                if (q[pair] > best) best = q[pair];
            }
            if (known && cell != goal) {
                v[cell] = best;
                if (mirror) {
                    int64_t other = cells - 1 - cell;
                    for (int64_t a = 0; a < actions; a++) q[other * actions + image[a]] = q[cell * actions + a];
                    v[other] = best;
                }
            }
        }
}
