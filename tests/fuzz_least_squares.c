/* fuzz_least_squares.c - libFuzzer target for gproj_solve_least_squares: sparse problems, right and wrong ones.
   make -C tests fuzz FUZZ=least_squares SECONDS=300 */
#define GPROJT_FUZZ "least_squares"
#include "gprojt_fuzz.h"

enum {
    GPROJT_ROWS = 24,
    GPROJT_COLUMNS = 16,
    GPROJT_ENTRIES = 96
};

typedef struct gprojt_problem {
    gproj_least_squares p;
    int64_t start[GPROJT_COLUMNS + 1];
    int32_t row[GPROJT_ENTRIES];
    double value[GPROJT_ENTRIES], b[GPROJT_ROWS], lower[GPROJT_COLUMNS], upper[GPROJT_COLUMNS], x[GPROJT_COLUMNS];
} gprojt_problem;

static double gprojt_entry(gprojt_input *in, int ways) {
    double small = (gprojt_next(in) - 128) / 32.0;
    if (!(ways & 1)) return small;
    return gprojt_next_number(in, (ways & 2) != 0);
}

static void gprojt_problem_of_bytes(gprojt_input *in, gprojt_problem *t) {
    int ways = gprojt_next(in);
    gproj_least_squares *p = &t->p;
    int32_t j;
    int64_t count = 0;
    memset(t, 0, sizeof *t);
    p->rows = gprojt_next_of(in, GPROJT_ROWS + 1), p->columns = gprojt_next_of(in, GPROJT_COLUMNS + 1);
    p->start = t->start, p->row = t->row, p->value = t->value, p->b = t->b;
    for (j = 0; j < p->columns; ++j) {
        int entries = p->rows ? gprojt_next(in) % 8 : 0;
        t->start[j] = count;
        for (; entries > 0 && count < GPROJT_ENTRIES; --entries, ++count)
            t->row[count] = gprojt_next_of(in, p->rows), t->value[count] = gprojt_entry(in, ways);
    }
    t->start[p->columns] = count;
    for (j = 0; j < p->rows; ++j) t->b[j] = gprojt_entry(in, ways);
    for (j = 0; j < p->columns; ++j) {
        int kind = gprojt_next(in) % 6;
        t->lower[j] = kind < 2 ? -HUGE_VAL : kind == 5 ? gprojt_entry(in, ways) : 0;
        t->upper[j] = kind < 4 ? HUGE_VAL : kind == 4 ? t->lower[j] : fmax(t->lower[j], gprojt_entry(in, ways));
        t->x[j] = kind & 1 ? gprojt_entry(in, ways) : 0;
    }
    if (ways & 4) p->lower = t->lower;
    if (ways & 8) p->upper = t->upper;
    if (ways & 16) p->damping = gprojt_next_number(in, (ways & 2) != 0);
    if ((ways & 224) != 224) return; /* wrong in one place */
    switch (gprojt_next(in) % 8) {
    case 0: p->rows = -1; break;
    case 1: p->columns = -gprojt_next(in); break;
    case 2:
        t->start[gprojt_next_of(in, GPROJT_COLUMNS + 1)] = gprojt_next(in) % (2 * GPROJT_ENTRIES) - GPROJT_ENTRIES;
        break;
    case 3: t->row[gprojt_next_of(in, GPROJT_ENTRIES)] = gprojt_next(in) - 128; break;
    case 4: p->b = NULL; break;
    case 5: p->value = NULL; break;
    case 6: t->lower[gprojt_next_of(in, GPROJT_COLUMNS)] = NAN; break;
    default: p->start = NULL; break;
    }
}

/* |A x - b|, and the largest violation of the conditions of optimality over the largest size of what was summed, in
   units that give the columns of A length 1; in long doubles, and column by column as given. */
static double gprojt_violation(const gprojt_problem *t, const double *x, double *residual) {
    const gproj_least_squares *p = &t->p;
    long double r[GPROJT_ROWS], about[GPROJT_ROWS], sum = 0, worst = 0, largest = 0;
    int32_t i, j;
    int64_t e;
    for (i = 0; i < p->rows; ++i) r[i] = -t->b[i], about[i] = fabsl(r[i]);
    for (j = 0; j < p->columns; ++j)
        for (e = t->start[j]; e < t->start[j + 1]; ++e) {
            r[t->row[e]] += (long double)t->value[e] * x[j];
            about[t->row[e]] += fabsl((long double)t->value[e] * x[j]);
        }
    for (i = 0; i < p->rows; ++i) sum += r[i] * r[i];
    for (j = 0; j < p->columns; ++j) {
        long double g = (long double)p->damping * p->damping * x[j], size = fabsl(g), unit = 0;
        for (e = t->start[j]; e < t->start[j + 1]; ++e) {
            g += t->value[e] * r[t->row[e]];
            size += fabsl(t->value[e] * about[t->row[e]]);
            unit += (long double)t->value[e] * t->value[e];
        }
        unit = unit > 0 ? sqrtl(unit) : 1;
        if (p->lower && x[j] == p->lower[j] && g > 0) g = 0;
        if (p->upper && x[j] == p->upper[j] && g < 0) g = 0;
        worst = fmaxl(worst, fabsl(g) / unit), largest = fmaxl(largest, size / unit);
    }
    *residual = (double)sqrtl(sum);
    return worst > 1e-15L ? (double)(worst / largest) : 0; /* next to 0 everything is optimal */
}

static bool gprojt_moderate(const gprojt_problem *t) {
    const gproj_least_squares *p = &t->p;
    int64_t e;
    int32_t i;
    if (p->damping != 0 && !(fabs(p->damping) > 1e-3 && fabs(p->damping) < 1e3)) return false;
    for (e = 0; e < t->start[p->columns]; ++e)
        if (t->value[e] != 0 && !(fabs(t->value[e]) > 1e-3 && fabs(t->value[e]) < 1e3)) return false;
    for (i = 0; i < p->rows; ++i)
        if (t->b[i] != 0 && !(fabs(t->b[i]) > 1e-3 && fabs(t->b[i]) < 1e3)) return false;
    return true;
}

static void gprojt_check_solution(const gprojt_problem *t, const double *x, const gproj_least_squares_result *result) {
    double residual, violation = gprojt_violation(t, x, &residual);
    double largest = 0;
    int32_t j, bounds = 0;
    for (j = 0; j < t->p.columns; ++j) {
        largest = fmax(largest, fabs(x[j]));
        GPROJT_MUST(fabs(x[j]) < HUGE_VAL);
        GPROJT_MUST(!t->p.lower || x[j] >= t->p.lower[j]);
        GPROJT_MUST(!t->p.upper || x[j] <= t->p.upper[j]);
        bounds += (t->p.lower && x[j] == t->p.lower[j]) || (t->p.upper && x[j] == t->p.upper[j]);
    }
    GPROJT_MUST(result->at_bounds == bounds);
    GPROJT_MUST(result->kkt >= 0 && result->factorisations >= 0 && result->factorisations <= 80);
    GPROJT_MUST(result->residual >= 0 && result->residual < HUGE_VAL);
    if (result->outcome == GPROJ_LEAST_SQUARES_SOLVED) GPROJT_MUST(result->kkt < 1e-9);
    if (result->outcome == GPROJ_LEAST_SQUARES_SOLVED && gprojt_moderate(t)) GPROJT_MUST(violation < 1e-6);
    if (gprojt_moderate(t)) GPROJT_MUST(fabs(result->residual - residual) <= 1e-9 * (1 + residual + largest));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    gprojt_input in = {data, size, 0};
    gproj_least_squares_result result;
    gprojt_failing failing;
    gproj_error error;
    gproj_host host;
    gprojt_problem t;
    double x[GPROJT_COLUMNS];
    int fails = gprojt_next(&in);
    gproj_code code;
    memset(&failing, 0, sizeof failing);
    if (fails >= 240) failing.fail_at = 1 + gprojt_next(&in) % 32;
    host = gprojt_failing_host(&failing);
    gprojt_problem_of_bytes(&in, &t);
    memcpy(x, t.x, sizeof x);
    code = gproj_solve_least_squares(&t.p, &host, x, &result, &error);
    GPROJT_MUST(failing.held == 0 && failing.wrong_sizes == 0 && code == error.code);
    GPROJT_MUST((code == GPROJ_OK) == (result.outcome != GPROJ_LEAST_SQUARES_FAILED));
    if (code == GPROJ_OK) {
        gprojt_check_solution(&t, x, &result);
    } else {
        gprojt_check_error(&error);
        GPROJT_MUST(!memcmp(x, t.x, sizeof x));
    }
    return 0;
}
