/*
 * The lap's Runge-Kutta steps as one writes them in C: what a communication step of the FMU is measured against.
 *
 * To be compiled with -DDOFS=1 or 2 (degrees of freedom a side), -DCUBIC=0 or 1 (whether the joint has cubic springs)
 * and -DRECIPROCALS=0 or 1 (whether forces are divided by the inertias in every stage or multiplied by reciprocals).
 */
#include <stddef.h>
#include <stdint.h>

#define MOTIONS (2 * DOFS) /* displacements of body a, then of body b */
#define STATES (2 * MOTIONS) /* all displacements, then all velocities */

struct lap {
    double joint_k[DOFS][DOFS], joint_c[DOFS][DOFS], joint_k3[DOFS];
    double m[MOTIONS], k[MOTIONS], c[MOTIONS];
};

static inline void rate(const struct lap *p, const double x[STATES], const double load[MOTIONS], double dx[STATES])
{
    const double *v = x + MOTIONS;
    double joint[DOFS];
    for (int i = 0; i < DOFS; i++) {
        joint[i] = 0.0;
        for (int j = 0; j < DOFS; j++)
            joint[i] += p->joint_k[i][j] * (x[j] - x[DOFS + j]) + p->joint_c[i][j] * (v[j] - v[DOFS + j]);
#if CUBIC
        const double r = x[i] - x[DOFS + i];
        joint[i] += p->joint_k3[i] * r * r * r;
#endif
    }
    for (int i = 0; i < MOTIONS; i++) {
        const double on_body = i < DOFS ? -joint[i] : joint[i - DOFS];
        const double force = load[i] - p->k[i] * x[i] - p->c[i] * v[i] + on_body;
        dx[i] = v[i];
#if RECIPROCALS
        dx[MOTIONS + i] = force * p->m[i];
#else
        dx[MOTIONS + i] = force / p->m[i];
#endif
    }
}

static inline void step(const struct lap *p, double x[STATES], const double load[MOTIONS], double h)
{
    double k1[STATES], k2[STATES], k3[STATES], k4[STATES], y[STATES];
    rate(p, x, load, k1);
    for (int i = 0; i < STATES; i++)
        y[i] = x[i] + 0.5 * h * k1[i];
    rate(p, y, load, k2);
    for (int i = 0; i < STATES; i++)
        y[i] = x[i] + 0.5 * h * k2[i];
    rate(p, y, load, k3);
    for (int i = 0; i < STATES; i++)
        y[i] = x[i] + h * k3[i];
    rate(p, y, load, k4);
    for (int i = 0; i < STATES; i++)
        x[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
}

/* Number of doubles that the parameters are. */
size_t parameter_count(void)
{
    return sizeof(struct lap) / sizeof(double);
}

/*
 * Takes communication steps of `interval` in `substeps` equal Runge-Kutta steps each. The loads of step n are row
 * (first + n) mod period. Leaves the state in `state` and returns the sum of all states at the ends of the steps.
 */
double run(const struct lap *given, double state[STATES], const double loads[][MOTIONS], size_t period, size_t first,
           double interval, uint32_t substeps, uint64_t steps)
{
    struct lap p = *given;
#if RECIPROCALS
    for (int i = 0; i < MOTIONS; i++)
        p.m[i] = 1.0 / p.m[i];
#endif
    double x[STATES], sum = 0.0;
    for (int i = 0; i < STATES; i++)
        x[i] = state[i];
    const double h = interval / substeps;
    size_t row = first;
    for (uint64_t n = 0; n < steps; n++) {
        for (uint32_t s = 0; s < substeps; s++)
            step(&p, x, loads[row], h);
        for (int i = 0; i < STATES; i++)
            sum += x[i];
        row = row + 1 == period ? 0 : row + 1;
    }
    for (int i = 0; i < STATES; i++)
        state[i] = x[i];
    return sum;
}
