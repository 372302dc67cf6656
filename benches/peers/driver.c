/*
 * Drives the same lap model out of several FMUs, as an importer does, and prints what a communication step costs:
 * set both loads, step, get displacements and velocities.
 *
 *   driver NAME VERSION LIBRARY RESOURCES TOKEN REFERENCES ...      six arguments for each FMU
 *
 * VERSION is 2 or 3; RESOURCES is a URI for 2 and a path for 3; TOKEN is the token or GUID, or "?" to ask the library's
 * function `peer_token`; REFERENCES are the value references of a.F b.F a.y a.v b.y b.v, separated by commas.
 * All FMUs are measured in turns, so that they share whatever else the machine does. The first is what the others are
 * compared with, in time and in results.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { INPUTS = 2, OUTPUTS = 4, PERIOD = 64, ROUNDS = 501, FMUS_MAX = 16, CHECKED_STEPS = 1000 };

static const double STEP_S = 1e-5;
static const double ROUND_NS = 2e5;

struct callbacks2 {
    void (*log)(void *, const char *, int, const char *, const char *, ...);
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void (*step_finished)(void *, int);
    void *environment;
};

typedef int set_fn(void *, const uint32_t *, size_t, const double *);
typedef int get_fn(void *, const uint32_t *, size_t, double *);
typedef int set3_fn(void *, const uint32_t *, size_t, const double *, size_t);
typedef int get3_fn(void *, const uint32_t *, size_t, double *, size_t);
typedef int step2_fn(void *, double, double, int);
typedef int step3_fn(void *, double, double, bool, bool *, bool *, bool *, double *);

struct fmu {
    const char *name;
    int version;
    void *instance;
    union {
        set_fn *two;
        set3_fn *three;
    } set;
    union {
        get_fn *two;
        get3_fn *three;
    } get;
    union {
        step2_fn *two;
        step3_fn *three;
    } step;
    uint32_t references[INPUTS + OUTPUTS];
    long taken;
    int status;
    double samples[ROUNDS];
    long steps_per_round;
};

static double loads[PERIOD][INPUTS];

static void log_2(void *environment, const char *name, int status, const char *category, const char *message, ...)
{
    (void)environment, (void)category;
    if (status > 1)
        fprintf(stderr, "%s: %s\n", name, message);
}

static void log_3(void *environment, int status, const char *category, const char *message)
{
    (void)environment, (void)category;
    if (status > 1)
        fprintf(stderr, "%s\n", message);
}

static void fail(const char *name, const char *what)
{
    fprintf(stderr, "%s: %s\n", name, what);
    exit(1);
}

static void *function(void *library, const char *fmu, const char *name)
{
    void *found = dlsym(library, name);
    if (!found)
        fail(fmu, dlerror());
    return found;
}

static void load(struct fmu *fmu, char **arguments)
{
    static const struct callbacks2 callbacks = { log_2, calloc, free, NULL, NULL };
    const char *name = arguments[0], *resources = arguments[3], *token = arguments[4];
    memset(fmu, 0, sizeof *fmu);
    fmu->name = name;
    fmu->version = atoi(arguments[1]);
    void *library = dlopen(arguments[2], RTLD_NOW | RTLD_LOCAL);
    if (!library)
        fail(name, dlerror());
    if (!strcmp(token, "?"))
        token = ((const char *(*)(void))function(library, name, "peer_token"))();
    char *rest = arguments[5];
    for (int i = 0; i < INPUTS + OUTPUTS; i++)
        fmu->references[i] = (uint32_t)strtoul(rest + (i > 0), &rest, 10);
    int status;
    if (fmu->version == 2) {
        void *(*instantiate)(const char *, int, const char *, const char *, const struct callbacks2 *, int, int) =
            function(library, name, "fmi2Instantiate");
        int (*set_up)(void *, int, double, double, int, double) = function(library, name, "fmi2SetupExperiment");
        int (*enter)(void *) = function(library, name, "fmi2EnterInitializationMode");
        int (*leave)(void *) = function(library, name, "fmi2ExitInitializationMode");
        fmu->set.two = function(library, name, "fmi2SetReal");
        fmu->get.two = function(library, name, "fmi2GetReal");
        fmu->step.two = function(library, name, "fmi2DoStep");
        fmu->instance = instantiate(name, 1, token, resources, &callbacks, 0, 0);
        if (!fmu->instance)
            fail(name, "cannot be instantiated");
        status = set_up(fmu->instance, 0, 0.0, 0.0, 0, 0.0) | enter(fmu->instance) | leave(fmu->instance);
    } else {
        void *(*instantiate)(const char *, const char *, const char *, bool, bool, bool, bool, const uint32_t *, size_t,
                             void *, void (*)(void *, int, const char *, const char *), void (*)(void)) =
            function(library, name, "fmi3InstantiateCoSimulation");
        int (*enter)(void *, bool, double, double, bool, double) =
            function(library, name, "fmi3EnterInitializationMode");
        int (*leave)(void *) = function(library, name, "fmi3ExitInitializationMode");
        fmu->set.three = function(library, name, "fmi3SetFloat64");
        fmu->get.three = function(library, name, "fmi3GetFloat64");
        fmu->step.three = function(library, name, "fmi3DoStep");
        fmu->instance = instantiate(name, token, resources, 0, 0, 0, 0, NULL, 0, NULL, log_3, NULL);
        if (!fmu->instance)
            fail(name, "cannot be instantiated");
        status = enter(fmu->instance, 0, 0.0, 0.0, 0, 0.0) | leave(fmu->instance);
    }
    if (status)
        fail(name, "cannot be initialised");
}

/* Takes communication steps; the sum of all outputs on the way. */
static double take(struct fmu *fmu, long steps)
{
    double outputs[OUTPUTS] = { 0 }, sum = 0.0;
    const uint32_t *in = fmu->references, *out = fmu->references + INPUTS;
    for (long n = 0; n < steps; n++) {
        const double *load = loads[fmu->taken % PERIOD];
        const double time = STEP_S * (double)fmu->taken++;
        if (fmu->version == 2) {
            fmu->status |= fmu->set.two(fmu->instance, in, INPUTS, load);
            fmu->status |= fmu->step.two(fmu->instance, time, STEP_S, 1);
            fmu->status |= fmu->get.two(fmu->instance, out, OUTPUTS, outputs);
        } else {
            bool event, terminate, early;
            double last;
            fmu->status |= fmu->set.three(fmu->instance, in, INPUTS, load, INPUTS);
            fmu->status |= fmu->step.three(fmu->instance, time, STEP_S, 1, &event, &terminate, &early, &last);
            fmu->status |= fmu->get.three(fmu->instance, out, OUTPUTS, outputs, OUTPUTS);
        }
        for (int i = 0; i < OUTPUTS; i++)
            sum += outputs[i];
    }
    return sum;
}

static double time_of(struct fmu *fmu, long steps)
{
    struct timespec start, end;
    clock_gettime(CLOCK_MONOTONIC, &start);
    volatile double sum = take(fmu, steps);
    (void)sum;
    clock_gettime(CLOCK_MONOTONIC, &end);
    return (double)(end.tv_sec - start.tv_sec) * 1e9 + (double)(end.tv_nsec - start.tv_nsec);
}

static int ascending(const void *left, const void *right)
{
    const double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

int main(int count, char **arguments)
{
    static struct fmu fmus[FMUS_MAX];
    const int fmu_count = (count - 1) / 6;
    if (fmu_count < 1 || fmu_count > FMUS_MAX || (count - 1) % 6) {
        fprintf(stderr, "usage: driver NAME VERSION LIBRARY RESOURCES TOKEN REFERENCES ...\n");
        return 2;
    }
    for (int n = 0; n < PERIOD; n++) {
        const double phase = 2.0 * acos(-1.0) * n / PERIOD;
        loads[n][0] = 100.0 * sin(phase);
        loads[n][1] = 50.0 * cos(phase);
    }
    double expected = 0.0;
    for (int i = 0; i < fmu_count; i++) {
        struct fmu *fmu = &fmus[i];
        load(fmu, arguments + 1 + 6 * i);
        const double sum = take(fmu, CHECKED_STEPS);
        if (i == 0)
            expected = sum;
        if (fmu->status || !(fabs(sum - expected) <= 1e-9 * fabs(expected))) {
            fprintf(stderr, "%s: status %d, sum of results %.15g, that of %s %.15g\n", fmu->name, fmu->status, sum,
                    fmus[0].name, expected);
            return 1;
        }
        const double trial = time_of(fmu, CHECKED_STEPS) / CHECKED_STEPS;
        fmu->steps_per_round = (long)(ROUND_NS / trial) + 1;
    }
    for (int round = 0; round < ROUNDS; round++)
        for (int i = 0; i < fmu_count; i++)
            fmus[i].samples[round] = time_of(&fmus[i], fmus[i].steps_per_round) / (double)fmus[i].steps_per_round;
    printf("%-42s %14s %10s\n", "set + step + get", "ns", "ratio");
    double first = 0.0;
    for (int i = 0; i < fmu_count; i++) {
        struct fmu *fmu = &fmus[i];
        if (fmu->status)
            fail(fmu->name, "a call was not answered with OK");
        qsort(fmu->samples, ROUNDS, sizeof(double), ascending);
        const double median = fmu->samples[ROUNDS / 2];
        if (i == 0)
            first = median;
        printf("%-42s %14.1f %10.2f\n", fmu->name, median, median / first);
    }
    return 0;
}
