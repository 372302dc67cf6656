/*
 * The lap as a small FMU for Co-Simulation of FMI 3.0 written by hand in C: a state structure, one Runge-Kutta step for
 * each communication step, no more checks than it takes to be usable. What a C programmer writes when nothing else
 * matters but that it runs.
 */
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { OK = 0, ERROR = 3 };

/* by value reference */
enum { TIME, A_FORCE, B_FORCE, A_Y, B_Y, A_V, B_V, VARIABLE_COUNT };

struct lap {
    double variables[VARIABLE_COUNT];
};

static const double M = 2.35, K = 10.56e5, C = 31.5;
static const double JOINT_K = 4.56e6, JOINT_C = 10.0, JOINT_K3 = 5e12;

static inline void rate(const double x[4], const double force[2], double dx[4])
{
    const double r = x[0] - x[1];
    const double joint = JOINT_K * r + JOINT_C * (x[2] - x[3]) + JOINT_K3 * r * r * r;
    dx[0] = x[2];
    dx[1] = x[3];
    dx[2] = (force[0] - K * x[0] - C * x[2] - joint) / M;
    dx[3] = (force[1] - K * x[1] - C * x[3] + joint) / M;
}

const char *peer_token(void)
{
    return "plain";
}

const char *fmi3GetVersion(void)
{
    return "3.0";
}

void *fmi3InstantiateCoSimulation(const char *name, const char *token, const char *resources, bool visible, bool logging,
                                  bool event_mode, bool early_return, const uint32_t *intermediate, size_t count,
                                  void *environment, void *log, void *update)
{
    (void)name, (void)resources, (void)visible, (void)logging, (void)event_mode, (void)early_return;
    (void)intermediate, (void)count, (void)environment, (void)log, (void)update;
    return token && !strcmp(token, peer_token()) ? calloc(1, sizeof(struct lap)) : NULL;
}

void fmi3FreeInstance(void *instance)
{
    free(instance);
}

int fmi3EnterInitializationMode(void *instance, bool tolerance_defined, double tolerance, double start,
                                bool stop_defined, double stop)
{
    (void)tolerance_defined, (void)tolerance, (void)stop_defined, (void)stop;
    ((struct lap *)instance)->variables[TIME] = start;
    return OK;
}

int fmi3ExitInitializationMode(void *instance)
{
    (void)instance;
    return OK;
}

int fmi3SetFloat64(void *instance, const uint32_t references[], size_t count, const double values[], size_t value_count)
{
    struct lap *lap = instance;
    if (count != value_count)
        return ERROR;
    for (size_t i = 0; i < count; i++) {
        if (references[i] != A_FORCE && references[i] != B_FORCE)
            return ERROR;
        lap->variables[references[i]] = values[i];
    }
    return OK;
}

int fmi3GetFloat64(void *instance, const uint32_t references[], size_t count, double values[], size_t value_count)
{
    const struct lap *lap = instance;
    if (count != value_count)
        return ERROR;
    for (size_t i = 0; i < count; i++) {
        if (references[i] >= VARIABLE_COUNT)
            return ERROR;
        values[i] = lap->variables[references[i]];
    }
    return OK;
}

int fmi3DoStep(void *instance, double time, double step, bool no_set_prior, bool *event, bool *terminate, bool *early,
               double *last)
{
    struct lap *lap = instance;
    const double force[2] = { lap->variables[A_FORCE], lap->variables[B_FORCE] };
    double x[4], y[4], k1[4], k2[4], k3[4], k4[4];
    (void)no_set_prior;
    memcpy(x, lap->variables + A_Y, sizeof x);
    rate(x, force, k1);
    for (int i = 0; i < 4; i++)
        y[i] = x[i] + 0.5 * step * k1[i];
    rate(y, force, k2);
    for (int i = 0; i < 4; i++)
        y[i] = x[i] + 0.5 * step * k2[i];
    rate(y, force, k3);
    for (int i = 0; i < 4; i++)
        y[i] = x[i] + step * k3[i];
    rate(y, force, k4);
    for (int i = 0; i < 4; i++)
        x[i] += step / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
    memcpy(lap->variables + A_Y, x, sizeof x);
    lap->variables[TIME] = time + step;
    *event = *terminate = *early = false;
    *last = lap->variables[TIME];
    return OK;
}
