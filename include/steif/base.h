/* steif/base.h: status codes, the context with its last message, specs such as "radau:s=3".
 *
 * Every function that can fail returns an int: 0 is success, a positive value is recoverable
 * (the caller may try a smaller step), a negative value is final. Constructors return NULL on
 * failure. In both cases the context keeps the code and one sentence with the values, the place
 * and the remedy: read it with steif_message(). The library never prints, exits or aborts, and
 * it has no global state; one context must not be used by two threads at the same time. Many runs side by
 * side: a context of its own, with setup.threads = 1, for each thread, and solvers made from it; problems may
 * be shared where their callbacks allow that. Every run has the bits that it has alone.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_BASE_H
#define STEIF_BASE_H

#include <stddef.h>
#include <sundials/sundials_nvector.h>
#include <sundials/sundials_types.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define STEIF_EXPORT __attribute__((visibility("default")))
#define STEIF_PRINTF(f, a) __attribute__((format(printf, f, a)))
#else
#define STEIF_EXPORT
#define STEIF_PRINTF(f, a)
#endif

#define STEIF_VERSION_MAJOR 0
#define STEIF_VERSION_MINOR 1
#define STEIF_VERSION_PATCH 0

enum steif_code {
  STEIF_OK = 0,
  STEIF_RETRY = 1,           /* a callback or a stage failed recoverably: try a smaller step */
  STEIF_EVENT = 2,           /* a terminal event ended the run; no failure */
  STEIF_NO_MEMORY = -1,      /* an allocation failed */
  STEIF_BAD_INPUT = -2,      /* an argument is out of range, inconsistent or missing */
  STEIF_UNKNOWN_NAME = -3,   /* no method, problem, table or parameter of that name */
  STEIF_NOT_FINITE = -4,     /* NaN or infinity in data or in what a callback returned */
  STEIF_SINGULAR = -5,       /* s E - A could not be factored, or has no digits at any s */
  STEIF_NO_CONVERGENCE = -6, /* Newton's iteration did not converge */
  STEIF_CALLBACK = -7,       /* a callback asked to stop, or kept failing recoverably */
  STEIF_UNSUPPORTED = -8,    /* the method does not fit the form of the problem or the matrix */
  STEIF_STEP_LIMIT = -9,     /* options.max_steps reached */
  STEIF_STEP_SIZE = -10,     /* the step became too small for the clock */
  STEIF_IO = -11,            /* a file could not be read or written */
  STEIF_BASELINE = -12,      /* CVODE, IDA or ARKODE gave up; the sentence says why */
  STEIF_NOT_CERTIFIED = -13, /* a verdict or tolerance could not be guaranteed */
  STEIF_TIME_LIMIT = -14,    /* options.max_seconds have passed */
  STEIF_STOPPED = -15,       /* options.stop was set */
  STEIF_INFEASIBLE = -16     /* a declared constraint such as y_i >= 0 cannot be kept */
};

typedef struct steif_context steif_context;

/* What a context may be given; {0} or NULL means the C allocator and all cores. allocate and release are called by
 * several threads at once where contexts of several threads have them, as those of steif_ensemble. */
typedef struct steif_setup {
  void *(*allocate)(size_t bytes, void *user); /* must return NULL on failure, never abort */
  void (*release)(void *block, void *user);    /* accepts NULL */
  void *user;                                  /* handed to both */
  int threads; /* for independent factorisations; 0: all cores */
} steif_setup;

/* NULL if memory is short. steif_context_free accepts NULL and sets the pointer to NULL; free
 * it after everything that was made from it. */
STEIF_EXPORT steif_context *steif_context_new(const steif_setup *setup);
STEIF_EXPORT void steif_context_free(steif_context **ctx);

/* The last failure: "ok" and 0 when there was none since the last steif_forget(). */
STEIF_EXPORT const char *steif_message(const steif_context *ctx);
STEIF_EXPORT int steif_status(const steif_context *ctx);
STEIF_EXPORT void steif_forget(steif_context *ctx);

/* The SUNDIALS context inside, for users who build their own vectors and matrices. */
STEIF_EXPORT SUNContext steif_sundials(steif_context *ctx);

/* "STEIF_NO_CONVERGENCE", "no convergence" and "make the step smaller ..." of a code. */
STEIF_EXPORT const char *steif_code_symbol(int code);
STEIF_EXPORT const char *steif_code_name(int code);
STEIF_EXPORT const char *steif_code_remedy(int code);

/* Version of the library at run time, "0.1.0". */
STEIF_EXPORT const char *steif_version(void);

/* A spec is a name with parameters: "radau:s=5", "heat:n=400", "dirk:alexander2" (a bare word
 * is the parameter with the empty key), "bdf:p=3,start=cq". Letters, digits and . - + _ only;
 * in values also / for paths. */
enum {
  STEIF_SPEC_PARAMS = 64,
  STEIF_SPEC_WORD = 48,
  STEIF_SPEC_KEY = 104,
  STEIF_SPEC_VALUE = 400
};
typedef struct steif_spec {
  char name[STEIF_SPEC_WORD];
  int count;
  struct {
    char key[STEIF_SPEC_KEY], value[STEIF_SPEC_VALUE];
  } param[STEIF_SPEC_PARAMS];
} steif_spec;

STEIF_EXPORT int steif_spec_parse(steif_context *ctx, const char *text, steif_spec *spec);

#ifdef __cplusplus
}
#endif
#endif
