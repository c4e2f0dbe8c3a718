#include "check.h"

#include <stdio.h>

int failures = 0;

void check(int holds, const char* what, const char* file, int line) {
  if (holds)
    return;
  ++failures;
  printf("%s:%d: failed: %s (last error: %s)\n", file, line, what, grelha_last_error());
}

void check_error(
    grelha_status status, grelha_status expected, const char* text, const char* file, int line) {
  if (status == expected && strstr(grelha_last_error(), text))
    return;
  ++failures;
  printf("%s:%d: expected status %d with \"%s\", found %d with \"%s\"\n",
         file,
         line,
         (int)expected,
         text,
         (int)status,
         grelha_last_error());
}
