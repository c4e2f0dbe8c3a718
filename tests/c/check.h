#ifndef TESTS_C_CHECK_H
#define TESTS_C_CHECK_H
// Checks that say what failed and let the test go on.

#include <grelha.h>
#include <math.h>
#include <string.h>

extern int failures;

void check(int holds, const char* what, const char* file, int line);
/// The last call must have failed with this status, and said `text` among others.
void check_error(
    grelha_status status, grelha_status expected, const char* text, const char* file, int line);

#define CHECK(condition) check((condition), #condition, __FILE__, __LINE__)
#define CHECK_OK(call) check((call) == GRELHA_OK, #call, __FILE__, __LINE__)
#define CHECK_ERROR(call, status, text) check_error((call), (status), (text), __FILE__, __LINE__)

// Each is one test of main.c.
void test_worlds(void);
void test_doubles(void);
void test_updates(void);
void test_closest(void);
void test_occluded(void);
void test_all_hits(void);
void test_each_hit(void);
void test_contains(void);
void test_closest_points(void);
void test_signed_distances(void);
void test_inside_rules(void);
void test_mesh_check(void);
void test_meshes(void);
void test_mesh_errors(void);
void test_removals(void);
void test_surfaces(void);
void test_progress(void);
void test_misuse(void);
void test_errors(void);
void test_memory(void);

#endif
