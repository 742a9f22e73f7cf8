/* platform_state.c - states that one kind of machine writes and another goes on with; platforms.sh runs it.

       platform_state write FILE     two states of each design: at the beginning of a solve, and in the middle
       platform_state read FILE...   tests that such files come out again byte by byte, and that their solves go on

   A state belongs to a form with the same numbers to the last digit. Machines that round otherwise (x87, contracted
   products) may refuse each other's, with a sentence and without harm. Forms that begin have the same bytes on all
   machines that round each operation to double precision; steps, and first forces, which come from a least-squares
   solve, have other last digits, because kernels order sums differently. */
#include "gprojt_design.h"

enum {
    GPROJT_FRAMES = 3, /* between the two states */
    GPROJT_STATES = 2 * GPROJT_DESIGNS
};

#if (defined(FLT_EVAL_METHOD) && FLT_EVAL_METHOD == 2) || defined(__FMA__) /* x87; contraction */
enum {
    GPROJT_ROUNDS_OTHERWISE = 1
};
#else
enum {
    GPROJT_ROUNDS_OTHERWISE = 0
};
#endif

static gproj_form *gprojt_begun(gproj_mesh *mesh, int design, int32_t frames) {
    gproj_form *form = gprojt_design(mesh, design, NULL);
    int32_t i;
    GPROJT_CHECK(gproj_solve_begin(form, 40, NULL, NULL));
    for (i = 0; i < frames; ++i) gproj_solve_advance(form, 0);
    return form;
}

/* State 2 d of design d is at the beginning, state 2 d + 1 after GPROJT_FRAMES iterations. */
static uint8_t *gprojt_nth_state(int n, size_t *size) {
    gproj_mesh *mesh = gprojt_roof(4, 0.08);
    gproj_form *form = gprojt_begun(mesh, n / 2, n % 2 ? GPROJT_FRAMES : 0);
    uint8_t *state = gprojt_save(form, size);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    return state;
}

static int gprojt_write(const char *path) {
    FILE *file = fopen(path, "wb");
    int n, i;
    if (file) fputc(GPROJT_ROUNDS_OTHERWISE, file);
    for (n = 0; file && n < GPROJT_STATES; ++n) {
        size_t size;
        uint8_t *state = gprojt_nth_state(n, &size);
        for (i = 0; i < 4; ++i) fputc((int)(size >> 8 * i & 255), file);
        fwrite(state, 1, size, file);
        free(state);
    }
    return !file || fclose(file) != 0 || gprojt_failed_checks > 0;
}

static FILE *gprojt_file;

/* The file's next state; NULL: there is none. */
static uint8_t *gprojt_next_state(size_t *size) {
    uint8_t *state;
    int i;
    for (*size = 0, i = 0; i < 4; ++i) *size |= (size_t)(uint8_t)fgetc(gprojt_file) << 8 * i;
    state = *size < 10000000 ? (uint8_t *)malloc(*size + 1) : NULL;
    if (state && fread(state, 1, *size, gprojt_file) == *size) return state;
    free(state);
    return NULL;
}

/* The rest of a solve; the largest coordinate by which two meshes differ. */
static gproj_result gprojt_finish(gproj_form *form) {
    gproj_result result = gproj_solve_advance(form, 0);
    while (gproj_solve_is_on(form)) result = gproj_solve_advance(form, 0);
    return result;
}
static double gprojt_apart(const gproj_mesh *a, const gproj_mesh *b) {
    double most = 0;
    int32_t i;
    for (i = 0; i < 3 * a->vertex_count; ++i) most = fmax(most, fabs(a->position[i] - b->position[i]));
    return most;
}

GPROJT_TEST(states_of_another_machine) {
    bool otherwise = fgetc(gprojt_file) != 0 || GPROJT_ROUNDS_OTHERWISE;
    int n;
    for (n = 0; n < GPROJT_STATES; ++n) {
        gproj_mesh *mesh = gprojt_roof(4, 0.08), *own_mesh = gprojt_roof(4, 0.08);
        gproj_form *form = gprojt_begun(mesh, n / 2, 0),
                   *own = gprojt_begun(own_mesh, n / 2, n % 2 ? GPROJT_FRAMES : 0);
        gproj_result result, own_result;
        gproj_error error;
        size_t size, again_size, own_size;
        uint8_t *state = gprojt_next_state(&size), *again, *own_state = gprojt_save(own, &own_size);
        GPROJT_REQUIRE(state);
        memset(&error, 0, sizeof error);
        if (gproj_state_restore(form, state, size, &error) != GPROJ_OK) {
            if (!otherwise) printf("  state %d: %s\n", n, error.message);
            GPROJT_CHECK(otherwise && error.code == GPROJ_ERROR_ARGUMENT && strstr(error.message, "another form"));
            gproj_state_restore(form, own_state, own_size, &error);
            GPROJT_CHECK(error.code == GPROJ_OK);
            free(state), state = (uint8_t *)malloc(own_size + 1), size = own_size;
            if (!state) abort();
            memcpy(state, own_state, size);
        }
        again = gprojt_save(form, &again_size);
        GPROJT_CHECK(again_size == size && memcmp(again, state, size) == 0);
        if (n % 2 == 0 && n / 2 != GPROJT_STANDING && !otherwise) {
            GPROJT_CHECK(own_size == size && memcmp(own_state, state, size) == 0);
        }
        GPROJT_NEAR(gprojt_apart(mesh, own_mesh), 0, 1e-9);
        result = gprojt_finish(form), own_result = gprojt_finish(own);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && own_result.outcome == GPROJ_CONVERGED);
        GPROJT_NEAR(gprojt_apart(mesh, own_mesh), 0, 1e-6);
        free(state), free(again), free(own_state);
        gproj_form_destroy(form), gproj_form_destroy(own);
        gproj_mesh_destroy(mesh), gproj_mesh_destroy(own_mesh);
    }
    GPROJT_CHECK(fgetc(gprojt_file) == EOF);
}

int main(int count, char **argument) {
    int i;
    if (count == 3 && strcmp(argument[1], "write") == 0) return gprojt_write(argument[2]);
    for (i = 2; i < count; ++i) {
        printf("%s\n", argument[i]);
        gprojt_file = fopen(argument[i], "rb");
        if (!gprojt_file) return printf("it cannot be opened\n"), 1;
        GPROJT_RUN(states_of_another_machine);
        fclose(gprojt_file);
    }
    return gprojt_report();
}
