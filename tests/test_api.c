/* test_api.c - the interface as a whole: version, sentences of codes and outcomes, defaults. */
#define GPROJ_STATIC
#include "gprojt.h"

GPROJT_TEST(version) {
    char text[32], first[128] = "";
    FILE *header = fopen("../guidedproj.h", "r");
    snprintf(text, sizeof text, "%d.%d", GPROJ_VERSION_MAJOR, GPROJ_VERSION_MINOR);
    GPROJT_CHECK(!strcmp(text, GPROJ_VERSION));
    GPROJT_CHECK(gproj_version() == GPROJ_VERSION_NUMBER);
    GPROJT_CHECK(GPROJ_VERSION_NUMBER == 1000 * GPROJ_VERSION_MAJOR + GPROJ_VERSION_MINOR);
    GPROJT_REQUIRE(header != NULL);
    GPROJT_CHECK(fgets(first, sizeof first, header) && strstr(first, " v" GPROJ_VERSION " "));
    fclose(header);
}

/* Sentences of their own for 0..last, and none beyond. */
static void gprojt_check_sentences(const char *(*sentence)(int), int last, const char *unknown) {
    int i, j;
    for (i = 0; i <= last; ++i) {
        GPROJT_CHECK(strlen(sentence(i)) > 7 && strcmp(sentence(i), unknown));
        for (j = 0; j < i; ++j) GPROJT_CHECK(strcmp(sentence(i), sentence(j)));
    }
    GPROJT_CHECK(!strcmp(sentence(last + 1), unknown) && !strcmp(sentence(-1), unknown));
    GPROJT_CHECK(!strcmp(sentence(0x7fffffff), unknown));
}

static const char *gprojt_code(int i) { return gproj_code_string((gproj_code)i); }
static const char *gprojt_outcome(int i) { return gproji_outcome_string((gproj_outcome)i); }

GPROJT_TEST(sentences) {
    gprojt_check_sentences(gprojt_code, GPROJ_ERROR_STATE, "unknown error");
    gprojt_check_sentences(gprojt_outcome, GPROJ_FAILED, "unknown outcome");
    GPROJT_CHECK(!strcmp(gproj_code_string(GPROJ_OK), "no error"));
    GPROJT_CHECK(!strcmp(gproj_code_string(GPROJ_ERROR_SIZE), "a count is too large"));
    GPROJT_CHECK(!strcmp(gproji_outcome_string(GPROJ_TIME_OUT), "the time budget ran out"));
}

GPROJT_TEST(zeros_are_the_defaults) { /* as check_api.sh writes them in C++ */
    gproj_host host = {0};
    gproj_error error = {0};
    const char *text = "v 0 0 0\nv 1 0 0\nv 1 1 .2\nv 0 1 0\nf 1 2 3 4\n";
    gproj_mesh *mesh = gproj_mesh_read(text, strlen(text), GPROJ_FORMAT_OBJ, &host, &error);
    gproj_form *form = gproj_form_create(mesh, &host);
    gproj_solve_options options = {0};
    gproj_add_planarity(form, 1);
    GPROJT_CHECK(gproj_solve(form, 20, &options).outcome == GPROJ_CONVERGED);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* Zeros but for a clock that does not run backwards; a solve with a budget goes by it. */
GPROJT_TEST(default_host) {
    gproj_host host = gproj_default_host();
    const char *text = "v 0 0 0\nv 1 0 0\nv 1 1 .2\nv 0 1 0\nf 1 2 3 4\n";
    gproj_mesh *mesh = gproj_mesh_read(text, strlen(text), GPROJ_FORMAT_OBJ, &host, NULL);
    gproj_form *form = gproj_form_create(mesh, &host);
    gproj_solve_options options = {0};
    double before;
    int i;
    GPROJT_CHECK(!host.allocator.allocate && !host.parallel.run && host.allocator.limit == 0);
    GPROJT_REQUIRE(host.clock.now != NULL);
    before = host.clock.now(host.clock.user);
    for (i = 0; i < 1000; ++i) {
        double now = host.clock.now(host.clock.user);
        GPROJT_CHECK(now >= before);
        before = now;
    }
    gproj_add_planarity(form, 1);
    options.time_budget = 1e6;
    GPROJT_CHECK(gproj_solve(form, 20, &options).outcome == GPROJ_CONVERGED);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

int main(void) {
    GPROJT_RUN(version);
    GPROJT_RUN(sentences);
    GPROJT_RUN(zeros_are_the_defaults);
    GPROJT_RUN(default_host);
    return gprojt_report();
}
