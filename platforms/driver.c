/* Steps one FMU through both ABIs of its library and prints the bits of all that comes out, for platforms/try.
 *
 *     driver LIBRARY TOKEN RESOURCES URI lap|element
 *
 * The inputs are fractions that every machine computes alike. Declared here is what the FMI headers declare. */
#include <inttypes.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef _WIN32
#include <windows.h>
static void *open_library(const char *path) { return (void *)LoadLibraryA(path); }
static void *find(void *library, const char *name) { return (void *)GetProcAddress((HMODULE)library, name); }
#else
#include <dlfcn.h>
static void *open_library(const char *path) { return dlopen(path, RTLD_NOW | RTLD_LOCAL); }
static void *find(void *library, const char *name) { return dlsym(library, name); }
#endif

enum { STEPS = 600, MOST = 16 };
static const double STEP = 1.0 / 4096.0;

struct model {
    const char *name;
    uint32_t inputs[MOST], outputs[MOST];
    size_t input_count, output_count;
    double amplitude;
};

static const struct model models[] = {
    /* loads on both bodies; motion, load in the joint, energy and power, accelerations */
    {"lap", {9, 10, 11, 12}, {1, 2, 3, 4, 5, 6, 7, 8, 13, 14, 15, 16, 38, 39, 40, 41}, 4, 16, 1000.0},
    /* motion of both sides; loads on both sides, energy and power */
    {"element", {1, 2, 3, 4, 5, 6, 7, 8}, {9, 10, 11, 12, 13, 14, 15, 16}, 8, 8, 0.001},
};

static void fail(const char *what) {
    fprintf(stderr, "driver: %s\n", what);
    exit(1);
}

static void check(int status, const char *what) {
    if (status > 1) {
        fail(what);
    }
}

static void *function(void *library, const char *name) {
    void *found = find(library, name);
    if (found == NULL) {
        fail(name);
    }
    return found;
}

static void print_bits(const char *label, const double *values, size_t count) {
    printf("%s", label);
    for (size_t i = 0; i < count; i++) {
        uint64_t bits;
        memcpy(&bits, &values[i], sizeof bits);
        printf(" %016" PRIx64, bits);
    }
    printf("\n");
}

static void print_bytes(const char *label, const uint8_t *bytes, size_t count) {
    uint64_t hash = UINT64_C(0xcbf29ce484222325); /* FNV-1a */
    for (size_t i = 0; i < count; i++) {
        hash = (hash ^ bytes[i]) * UINT64_C(0x100000001b3);
    }
    printf("%s %u bytes, hash %016" PRIx64 "\n", label, (unsigned)count, hash);
}

static void inputs_at(const struct model *model, int step, double *values) {
    for (size_t i = 0; i < model->input_count; i++) {
        int phase = (step * (7 + 4 * (int)i) + 13 * (int)i) % 101;
        values[i] = model->amplitude * (phase - 50) / 64.0 / (1 + (int)i % 2);
    }
}

static void message3(void *environment, int status, const char *category, const char *message) {
    printf("%s log %d %s: %s\n", (const char *)environment, status, category, message);
}

typedef void *(*instantiate3)(const char *, const char *, const char *, bool, bool, bool, bool, const uint32_t *, size_t,
                              void *, void (*)(void *, int, const char *, const char *), void *);
typedef int (*initialise3)(void *, bool, double, double, bool, double);
typedef int (*plain)(void *);
typedef int (*get3)(void *, const uint32_t *, size_t, double *, size_t);
typedef int (*set3)(void *, const uint32_t *, size_t, const double *, size_t);
typedef int (*step3)(void *, double, double, bool, bool *, bool *, bool *, double *);
typedef int (*state)(void *, void **);
typedef int (*set_state)(void *, void *);
typedef int (*size_of_state)(void *, void *, size_t *);
typedef int (*serialise)(void *, void *, uint8_t *, size_t);
typedef int (*directional3)(void *, const uint32_t *, size_t, const uint32_t *, size_t, const double *, size_t, double *,
                            size_t);

static void run3(void *library, const char *token, const char *resources, const struct model *model, char *label) {
    void *fmu = ((instantiate3)function(library, "fmi3InstantiateCoSimulation"))(
        "joint", token, resources, false, true, false, false, NULL, 0, label, message3, NULL);
    if (fmu == NULL) {
        fail("fmi3InstantiateCoSimulation");
    }
    get3 get = (get3)function(library, "fmi3GetFloat64");
    set3 set = (set3)function(library, "fmi3SetFloat64");
    step3 do_step = (step3)function(library, "fmi3DoStep");
    check(((initialise3)function(library, "fmi3EnterInitializationMode"))(fmu, false, 0, 0, false, 0), "initialise");
    check(((plain)function(library, "fmi3ExitInitializationMode"))(fmu), "initialise");
    double in[MOST], out[MOST], seed[MOST];
    for (int n = 0; n < STEPS; n++) {
        bool event, terminate, early;
        double last;
        inputs_at(model, n, in);
        check(set(fmu, model->inputs, model->input_count, in, model->input_count), "fmi3SetFloat64");
        check(do_step(fmu, n * STEP, STEP, true, &event, &terminate, &early, &last), "fmi3DoStep");
        check(get(fmu, model->outputs, model->output_count, out, model->output_count), "fmi3GetFloat64");
        print_bits(label, out, model->output_count);
    }
    for (size_t i = 0; i < model->input_count; i++) {
        seed[i] = 1.0 / (1.0 + (double)i);
    }
    check(((directional3)function(library, "fmi3GetDirectionalDerivative"))(
              fmu, model->outputs, model->output_count, model->inputs, model->input_count, seed, model->input_count, out,
              model->output_count),
          "fmi3GetDirectionalDerivative");
    print_bits("derivative", out, model->output_count);
    void *saved = NULL;
    size_t size = 0;
    check(((state)function(library, "fmi3GetFMUState"))(fmu, &saved), "fmi3GetFMUState");
    check(((size_of_state)function(library, "fmi3SerializedFMUStateSize"))(fmu, saved, &size), "fmi3SerializedFMUStateSize");
    uint8_t *bytes = malloc(size);
    check(((serialise)function(library, "fmi3SerializeFMUState"))(fmu, saved, bytes, size), "fmi3SerializeFMUState");
    print_bytes("state", bytes, size);
    free(bytes);
    check(((set_state)function(library, "fmi3SetFMUState"))(fmu, saved), "fmi3SetFMUState");
    check(((state)function(library, "fmi3FreeFMUState"))(fmu, &saved), "fmi3FreeFMUState");
    /* refused, with messages */
    const uint32_t unknown = 12345;
    printf("unknown reference: status %d\n", get(fmu, &unknown, 1, out, 1));
    bool flag;
    double last;
    printf("negative step: status %d\n", do_step(fmu, STEPS * STEP, -1.0, true, &flag, &flag, &flag, &last));
    check(((plain)function(library, "fmi3Terminate"))(fmu), "fmi3Terminate");
    ((void (*)(void *))function(library, "fmi3FreeInstance"))(fmu);
}

struct callbacks {
    void (*log)(void *, const char *, int, const char *, const char *, ...);
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void (*finished)(void *, int);
    void *environment;
};

static void message2(void *environment, const char *instance, int status, const char *category, const char *message, ...) {
    printf("%s log %s %d %s: %s\n", (const char *)environment, instance, status, category, message);
}

typedef void *(*instantiate2)(const char *, int, const char *, const char *, const struct callbacks *, int, int);
typedef int (*setup2)(void *, int, double, double, int, double);
typedef int (*get2)(void *, const unsigned *, size_t, double *);
typedef int (*set2)(void *, const unsigned *, size_t, const double *);
typedef int (*step2)(void *, double, double, int);

static void run2(void *library, const char *token, const char *uri, const struct model *model, char *label) {
    const struct callbacks callbacks = {message2, calloc, free, NULL, label};
    void *fmu = ((instantiate2)function(library, "fmi2Instantiate"))("joint", 1, token, uri, &callbacks, 0, 1);
    if (fmu == NULL) {
        fail("fmi2Instantiate");
    }
    get2 get = (get2)function(library, "fmi2GetReal");
    set2 set = (set2)function(library, "fmi2SetReal");
    step2 do_step = (step2)function(library, "fmi2DoStep");
    check(((setup2)function(library, "fmi2SetupExperiment"))(fmu, 0, 0, 0, 0, 0), "fmi2SetupExperiment");
    check(((plain)function(library, "fmi2EnterInitializationMode"))(fmu), "initialise");
    check(((plain)function(library, "fmi2ExitInitializationMode"))(fmu), "initialise");
    double in[MOST], out[MOST];
    for (int n = 0; n < STEPS; n++) {
        inputs_at(model, n, in);
        check(set(fmu, model->inputs, model->input_count, in), "fmi2SetReal");
        check(do_step(fmu, n * STEP, STEP, 1), "fmi2DoStep");
        check(get(fmu, model->outputs, model->output_count, out), "fmi2GetReal");
        print_bits(label, out, model->output_count);
    }
    printf("negative step: status %d\n", do_step(fmu, STEPS * STEP, -1.0, 1));
    check(((plain)function(library, "fmi2Terminate"))(fmu), "fmi2Terminate");
    ((void (*)(void *))function(library, "fmi2FreeInstance"))(fmu);
}

int main(int count, char **arguments) {
    if (count != 6) {
        fail("takes five arguments: LIBRARY TOKEN RESOURCES URI lap|element");
    }
    const struct model *model = strcmp(arguments[5], "lap") == 0 ? &models[0] : &models[1];
    void *library = open_library(arguments[1]);
    if (library == NULL) {
        fail("the library does not load");
    }
    run3(library, arguments[2], arguments[3], model, "fmi3");
    /* without a resource path the library looks where it was loaded from */
    run3(library, arguments[2], NULL, model, "found");
    run2(library, arguments[2], arguments[4], model, "fmi2");
    return 0;
}
