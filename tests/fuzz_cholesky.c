/* fuzz_cholesky.c - libFuzzer target for the factorisation: patterns and values, right and wrong ones.
   make -C tests fuzz FUZZ=cholesky SECONDS=300 */
#define GPROJT_FUZZ "cholesky"
#include "gprojt_fuzz.h"

enum {
    GPROJT_SIZE = 40,
    GPROJT_ENTRIES = 320
};

typedef struct gprojt_matrix {
    int32_t n;
    int64_t start[GPROJT_SIZE + 1];
    int32_t row[GPROJT_ENTRIES], permutation[GPROJT_SIZE];
    double value[GPROJT_ENTRIES], dense[GPROJT_SIZE * GPROJT_SIZE];
    bool tame, dominant; /* moderate numbers; larger on the diagonal than beside it */
} gprojt_matrix;

/* Each pair of row and column stands in one triangle, at random, and may be repeated there. */
static void gprojt_pattern_of_bytes(gprojt_input *in, gprojt_matrix *m) {
    int64_t count = 0;
    int32_t j;
    m->n = gprojt_next_of(in, GPROJT_SIZE + 1);
    for (j = 0; j < m->n; ++j) {
        int entries = gprojt_next(in) % 6;
        m->start[j] = count;
        if (entries && count < GPROJT_ENTRIES) m->row[count++] = j;
        for (; entries > 1 && count < GPROJT_ENTRIES; --entries) {
            int32_t i = gprojt_next_of(in, m->n), upper = (i + j) & 1;
            if (upper ? i <= j : i >= j) m->row[count++] = i;
        }
    }
    m->start[m->n] = count;
}

static void gprojt_values_of_bytes(gprojt_input *in, gprojt_matrix *m) {
    int ways = gprojt_next(in);
    int32_t i, j;
    int64_t e;
    double sum;
    memset(m->dense, 0, sizeof m->dense);
    for (e = 0; e < m->start[m->n]; ++e)
        m->value[e] = ways & 1 ? gprojt_next_number(in, (ways & 2) != 0) : (gprojt_next(in) - 128) / 32.0;
    m->tame = m->dominant = !(ways & 1);
    for (j = 0; j < m->n; ++j)
        for (e = m->start[j]; e < m->start[j + 1]; ++e) {
            m->dense[m->row[e] * GPROJT_SIZE + j] += m->value[e];
            if (m->row[e] != j) m->dense[j * GPROJT_SIZE + m->row[e]] += m->value[e];
        }
    for (j = 0; j < m->n; ++j) {
        for (i = 0, sum = 0; i < m->n; ++i) sum += i == j ? 0 : fabs(m->dense[j * GPROJT_SIZE + i]);
        if (ways & 4 && m->start[j] < m->start[j + 1] && m->row[m->start[j]] == j) { /* the diagonal comes first */
            m->value[m->start[j]] += sum + 1 - m->dense[j * GPROJT_SIZE + j];
            m->dense[j * GPROJT_SIZE + j] = sum + 1;
        }
        m->dominant = m->dominant && m->dense[j * GPROJT_SIZE + j] > 1.01 * sum + 1e-3;
    }
}

static bool gprojt_is_permutation(const int32_t *p, int32_t n) {
    bool seen[GPROJT_SIZE] = {false};
    int32_t i;
    for (i = 0; i < n; ++i) {
        if (p[i] < 0 || p[i] >= n || seen[p[i]]) return false;
        seen[p[i]] = true;
    }
    return true;
}

/* The largest |b - A x| over |A| |x| + |b|. */
static double gprojt_off(const gprojt_matrix *m, const double *b, const double *x) {
    double off = 0;
    int32_t i, j;
    for (i = 0; i < m->n; ++i) {
        long double r = -b[i], size = fabs(b[i]);
        for (j = 0; j < m->n; ++j) {
            r += (long double)m->dense[i * GPROJT_SIZE + j] * x[j];
            size += fabsl((long double)m->dense[i * GPROJT_SIZE + j] * x[j]);
        }
        if (size > 0) off = fmax(off, (double)(fabsl(r) / size));
    }
    return off;
}

/* A positive definite matrix has no pivot <= 0, and x solves; a matrix with a diagonal entry <= 0 is none. */
static void gprojt_check_factor(gprojt_input *in, gproj_cholesky *c, const gprojt_matrix *m,
                                const gprojt_failing *failing) {
    double b[2 * GPROJT_SIZE], x[2 * GPROJT_SIZE];
    gproj_factor_outcome outcome = gproj_cholesky_factor(c, m->value);
    gproj_cholesky_info info = gproj_cholesky_get_info(c);
    bool memory_fails = failing->fail_at > 0 && failing->calls >= failing->fail_at;
    int32_t i;
    GPROJT_MUST((outcome == GPROJ_FACTOR_FAILED) <= memory_fails || !m->tame);
    if (m->dominant && !memory_fails) GPROJT_MUST(outcome == GPROJ_FACTORED);
    if (outcome == GPROJ_FACTORED) {
        for (i = 0; i < m->n; ++i) GPROJT_MUST(m->dense[i * GPROJT_SIZE + i] > 0);
        GPROJT_MUST(info.failed_column == -1);
        for (i = 0; i < 2 * m->n; ++i) b[i] = (gprojt_next(in) - 128) / 16.0;
        GPROJT_MUST(gproj_cholesky_solve(c, 2, b, x) == GPROJ_OK);
        if (m->dominant) GPROJT_MUST(gprojt_off(m, b, x) < 1e-12 && gprojt_off(m, b + m->n, x + m->n) < 1e-12);
        if (m->dominant) {
            double off = gproj_cholesky_refine(c, m->start, m->row, m->value, b, x, 2);
            GPROJT_MUST(off >= 0 && off < 1e-10 && gprojt_off(m, b, x) < 1e-13);
        }
    } else {
        if (outcome == GPROJ_NOT_POSITIVE_DEFINITE) GPROJT_MUST(info.failed_column >= 0 && info.failed_column < m->n);
        for (i = 0; i < m->n; ++i) b[i] = x[i] = i;
        GPROJT_MUST(gproj_cholesky_solve(c, 1, b, x) != GPROJ_OK);
        for (i = 0; i < m->n; ++i) GPROJT_MUST(x[i] == i);
    }
}

static void gprojt_wrong(gprojt_input *in, gprojt_matrix *m) {
    switch (gprojt_next(in) % 5) {
    case 0: m->n = -1; break;
    case 1: m->start[gprojt_next_of(in, m->n + 1)] = gprojt_next(in) - 128; break;
    case 2: m->row[gprojt_next_of(in, GPROJT_ENTRIES)] = gprojt_next(in) - 128; break;
    default: break;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    gprojt_input in = {data, size, 0};
    gproj_cholesky_options options;
    gprojt_failing failing;
    gproj_cholesky *c;
    gproj_host host;
    gprojt_matrix m;
    int fails = gprojt_next(&in), ways = gprojt_next(&in), times, k;
    bool wrong = (ways & 224) == 224;
    memset(&failing, 0, sizeof failing);
    memset(&options, 0, sizeof options);
    memset(&m, 0, sizeof m);
    if (fails >= 240) failing.fail_at = 1 + gprojt_next(&in) % 48;
    host = gprojt_failing_host(&failing);
    c = gproj_cholesky_create(&host);
    options.ordering = (gproj_ordering)(ways % 6 % 5);
    options.disable_relaxation = ways & 8, options.disable_postorder = ways & 16;
    for (times = 1 + (fails & 1); c && times > 0; --times) {
        gproj_code code;
        gprojt_pattern_of_bytes(&in, &m);
        for (k = 0; k < m.n; ++k) m.permutation[k] = m.n - 1 - k;
        if (options.ordering == GPROJ_ORDERING_GIVEN) options.permutation = m.permutation;
        if (wrong && ways & 1 && m.n) m.permutation[gprojt_next_of(&in, m.n)] = gprojt_next(&in) - 128;
        if (wrong) gprojt_wrong(&in, &m);
        code = gproj_cholesky_analyse(c, m.n, m.start, m.row, &options);
        gprojt_check_error(gproj_cholesky_error(c));
        GPROJT_MUST(code == GPROJ_OK || wrong || failing.calls >= failing.fail_at);
        if (code != GPROJ_OK || wrong) break; /* what is wrong may be right: then arrays are not as large as they say */
        GPROJT_MUST(gprojt_is_permutation(gproj_cholesky_permutation(c), m.n));
        GPROJT_MUST(gproj_cholesky_get_info(c).factor_entries >= gproj_cholesky_get_info(c).exact_entries);
        for (k = 0; k < 2; ++k) {
            gprojt_values_of_bytes(&in, &m);
            gprojt_check_factor(&in, c, &m, &failing);
        }
    }
    gproj_cholesky_destroy(c);
    GPROJT_MUST(failing.held == 0 && failing.bytes == 0 && failing.wrong_sizes == 0);
    return 0;
}
