// c_test NAME: runs one test; ends with 1 if a check failed.
#include <stdio.h>

#include "check.h"

static const struct {
  const char* name;
  void (*run)(void);
} tests[] = {
    {"worlds", test_worlds},
    {"doubles", test_doubles},
    {"updates", test_updates},
    {"closest", test_closest},
    {"occluded", test_occluded},
    {"all_hits", test_all_hits},
    {"each_hit", test_each_hit},
    {"contains", test_contains},
    {"closest_points", test_closest_points},
    {"signed_distances", test_signed_distances},
    {"inside_rules", test_inside_rules},
    {"mesh_check", test_mesh_check},
    {"meshes", test_meshes},
    {"mesh_errors", test_mesh_errors},
    {"removals", test_removals},
    {"surfaces", test_surfaces},
    {"progress", test_progress},
    {"misuse", test_misuse},
    {"errors", test_errors},
    {"memory", test_memory},
};

int main(int argc, char** argv) {
  for (size_t i = 0; argc == 2 && i < sizeof tests / sizeof *tests; ++i)
    if (strcmp(argv[1], tests[i].name) == 0) {
      tests[i].run();
      return failures > 0;
    }
  fprintf(stderr, "c_test: expected the name of a test\n");
  return 2;
}
