/* What the parts of the C99 program share. */
#ifndef RELIEVO_TESTS_CHECK_H
#define RELIEVO_TESTS_CHECK_H

#include <relievo.h>

#include <stdio.h>

extern int failures;

#define CHECK(condition)                                                         \
  do {                                                                           \
    if (!(condition)) {                                                          \
      ++failures;                                                                \
      fprintf(stderr, "%s:%d: %s does not hold\n", __FILE__, __LINE__, #condition); \
    }                                                                            \
  } while (0)

/* Says why a call failed that should not have. */
int succeeds(relievo_status status, const relievo_error* error, const char* file, int line);
#define OK(call) succeeds((call), &error, __FILE__, __LINE__)

/* Edits a technique in `folder`/edited, which is there and empty, while a reloader watches `folder`. */
void use_reloader(const char* folder);
void use_reloading_thread(void);

#endif
