/* bench_cholmod.c - the other side of tools/bench: CHOLMOD, supernodal, ordered by AMD, on OpenBLAS. */
#include "bench.h"
#include <cblas.h>
#include <suitesparse/cholmod.h>

extern char *openblas_get_config(void);
extern char *openblas_get_corename(void);

struct bench_cholmod {
    cholmod_common common;
    cholmod_factor *factor;
    cholmod_sparse matrix; /* upper triangle */
    cholmod_dense *b, *x, *y, *e;
    int32_t *column_start, *row;
    double *value;
    /* Product a <= b of row r goes to value[place[product[r] + b (b + 1) / 2 + a]]; the diagonal of column j is the
       last entry there. */
    int64_t *product;
    int32_t *place;
    double rows_bytes, pattern_bytes;
    double pattern_seconds, setup_seconds;
};

/* The rows by variable: entries first[j]..first[j+1]-1 of `row` and of `local`, the variable's place in that row. */
typedef struct bench_transposed {
    int64_t *first;
    int32_t *row, *local;
} bench_transposed;

static bench_transposed bench_transpose(const bench_rows *rows) {
    size_t entries = (size_t)rows->start[rows->rows];
    bench_transposed t;
    int64_t l;
    int32_t r, j;
    t.first = (int64_t *)bench_take((size_t)rows->variables + 2, sizeof *t.first);
    t.row = (int32_t *)malloc((entries + 1) * sizeof *t.row);
    t.local = (int32_t *)malloc((entries + 1) * sizeof *t.local);
    if (!t.row || !t.local) abort();
    for (l = 0; l < (int64_t)entries; ++l) t.first[rows->variable[l] + 2]++;
    for (j = 0; j < rows->variables; ++j) t.first[j + 2] += t.first[j + 1];
    for (r = 0; r < rows->rows; ++r) {
        for (l = rows->start[r]; l < rows->start[r + 1]; ++l) {
            int64_t at = t.first[rows->variable[l] + 1]++;
            t.row[at] = r;
            t.local[at] = (int32_t)(l - rows->start[r]);
        }
    }
    return t;
}

/* Where the products of each row begin; returns how many there are. */
static int64_t bench_count_products(bench_cholmod *c, const bench_rows *rows) {
    int64_t count = 0, k;
    int32_t r;
    c->product = (int64_t *)malloc(((size_t)rows->rows + 1) * sizeof *c->product);
    for (r = 0; r < rows->rows; ++r) {
        k = rows->start[r + 1] - rows->start[r];
        c->product[r] = count;
        count += k * (k + 1) / 2;
    }
    c->product[rows->rows] = count;
    return count;
}

/* Column j of the pattern: the variables up to j of the rows that have j, and the places of their products. Returns the
   end of the column. `mark`: the place of each variable seen in this column (place >= begin), the diagonal last. */
static int32_t bench_fill_column(bench_cholmod *c, const bench_rows *rows, const bench_transposed *t, int32_t j,
                                 int32_t begin, int32_t *mark) {
    int32_t end = begin;
    int64_t k, a;
    for (k = t->first[j]; k < t->first[j + 1]; ++k) {
        int64_t b = t->local[k];
        const int32_t *variable = rows->variable + rows->start[t->row[k]];
        int32_t *place = c->place + c->product[t->row[k]] + b * (b + 1) / 2;
        for (a = 0; a < b; ++a) {
            int32_t i = variable[a];
            if (mark[i] < begin) {
                c->row[end] = i;
                mark[i] = end++;
            }
            place[a] = mark[i];
        }
    }
    for (k = t->first[j]; k < t->first[j + 1]; ++k) {
        int64_t b = t->local[k];
        c->place[c->product[t->row[k]] + b * (b + 1) / 2 + b] = end;
    }
    c->row[end++] = j;
    return end;
}

/* The upper triangle of J'J by columns, not sorted within a column, and the place of each product. */
static void bench_make_pattern(bench_cholmod *c, const bench_rows *rows) {
    bench_transposed t = bench_transpose(rows);
    int64_t products = bench_count_products(c, rows);
    int32_t *mark = (int32_t *)malloc((size_t)rows->variables * sizeof *mark), j, end = 0;
    size_t capacity = 16 * (size_t)rows->variables + 64;
    c->place = (int32_t *)malloc((size_t)products * sizeof *c->place);
    c->column_start = (int32_t *)malloc(((size_t)rows->variables + 1) * sizeof *c->column_start);
    c->row = (int32_t *)malloc(capacity * sizeof *c->row);
    if (!mark || !c->place || !c->column_start || !c->row) abort();
    for (j = 0; j < rows->variables; ++j) mark[j] = -1;
    for (j = 0; j < rows->variables; ++j) {
        if ((size_t)end + (size_t)j + 1 > capacity) {
            capacity = 2 * capacity + (size_t)j + 1;
            c->row = (int32_t *)realloc(c->row, capacity * sizeof *c->row);
            if (!c->row) abort();
        }
        c->column_start[j] = end;
        end = bench_fill_column(c, rows, &t, j, end, mark);
    }
    c->column_start[j] = end;
    c->row = (int32_t *)realloc(c->row, (size_t)end * sizeof *c->row);
    c->value = (double *)malloc((size_t)end * sizeof *c->value);
    if (!c->row || !c->value) abort();
    c->pattern_bytes = 4.0 * (double)products + 8.0 * rows->rows + 4.0 * rows->variables + 12.0 * end;
    c->rows_bytes = 12.0 * (double)rows->start[rows->rows] + 24.0 * rows->rows;
    free(mark);
    free(t.first);
    free(t.row);
    free(t.local);
}

bench_cholmod *bench_cholmod_create(const bench_rows *rows) {
    bench_cholmod *c = (bench_cholmod *)bench_take(1, sizeof *c);
    double began = bench_now();
    bench_make_pattern(c, rows);
    c->pattern_seconds = bench_now() - began;
    cholmod_start(&c->common);
    c->common.supernodal = CHOLMOD_SUPERNODAL;
    c->common.nmethods = 1;
    c->common.method[0].ordering = CHOLMOD_AMD;
    c->common.print = 0;
    c->matrix.nrow = c->matrix.ncol = (size_t)rows->variables;
    c->matrix.nzmax = (size_t)c->column_start[rows->variables];
    c->matrix.p = c->column_start;
    c->matrix.i = c->row;
    c->matrix.x = c->value;
    c->matrix.stype = 1;
    c->matrix.itype = CHOLMOD_INT;
    c->matrix.xtype = CHOLMOD_REAL;
    c->matrix.dtype = CHOLMOD_DOUBLE;
    c->matrix.packed = 1;
    c->factor = cholmod_analyze(&c->matrix, &c->common);
    c->setup_seconds = bench_now() - began;
    c->b = cholmod_allocate_dense((size_t)rows->variables, 1, (size_t)rows->variables, CHOLMOD_REAL, &c->common);
    if (c->factor && c->b) return c;
    bench_cholmod_destroy(c);
    return NULL;
}

void bench_cholmod_destroy(bench_cholmod *c) {
    if (!c) return;
    cholmod_free_factor(&c->factor, &c->common);
    cholmod_free_dense(&c->b, &c->common);
    cholmod_free_dense(&c->x, &c->common);
    cholmod_free_dense(&c->y, &c->common);
    cholmod_free_dense(&c->e, &c->common);
    cholmod_finish(&c->common);
    free(c->column_start);
    free(c->row);
    free(c->value);
    free(c->product);
    free(c->place);
    free(c);
}

/* value = sum w^2 g g' + eps^2 D, b = - sum w^2 phi g */
static void bench_assemble(bench_cholmod *c, const bench_rows *rows) {
    const int32_t *place = c->place;
    double *value = c->value, *right = (double *)c->b->x;
    int32_t r, j;
    int64_t a, b;
    memset(value, 0, (size_t)c->column_start[rows->variables] * sizeof *value);
    memset(right, 0, (size_t)rows->variables * sizeof *right);
    for (r = 0; r < rows->rows; ++r) {
        const double *g = rows->gradient + rows->start[r];
        const int32_t *variable = rows->variable + rows->start[r];
        int64_t count = rows->start[r + 1] - rows->start[r];
        double w2 = rows->weight2[r], pull = w2 * rows->phi[r];
        for (b = 0; b < count; ++b) {
            double scale = w2 * g[b];
            right[variable[b]] -= pull * g[b];
            for (a = 0; a <= b; ++a) value[place[a]] += scale * g[a];
            place += b + 1;
        }
    }
    for (j = 0; j < rows->variables; ++j) value[c->column_start[j + 1] - 1] += rows->regularisation[j];
}

bool bench_cholmod_step(bench_cholmod *c, const bench_rows *rows, double seconds[BENCH_PHASES], double *dx) {
    double lap = bench_now(), now;
    bench_assemble(c, rows);
    now = bench_now(), seconds[BENCH_ASSEMBLE] = now - lap, lap = now;
    if (!cholmod_factorize(&c->matrix, c->factor, &c->common) || c->common.status != CHOLMOD_OK) return false;
    now = bench_now(), seconds[BENCH_FACTOR] = now - lap, lap = now;
    if (!cholmod_solve2(CHOLMOD_A, c->factor, c->b, NULL, &c->x, NULL, &c->y, &c->e, &c->common)) return false;
    seconds[BENCH_SOLVE] = bench_now() - lap;
    memcpy(dx, c->x->x, (size_t)rows->variables * sizeof *dx);
    return true;
}

bool bench_cholmod_refine(bench_cholmod *c, const bench_rows *rows, double *dx) {
    int32_t n = rows->variables, r, j;
    long double *residual = (long double *)bench_take((size_t)n, sizeof *residual);
    int64_t l;
    bool solved;
    for (j = 0; j < n; ++j) residual[j] = -(long double)rows->regularisation[j] * dx[j];
    for (r = 0; r < rows->rows; ++r) { /* - w^2 (phi + g'dx) g */
        long double pull = rows->phi[r];
        for (l = rows->start[r]; l < rows->start[r + 1]; ++l)
            pull += (long double)rows->gradient[l] * dx[rows->variable[l]];
        pull *= rows->weight2[r];
        for (l = rows->start[r]; l < rows->start[r + 1]; ++l) residual[rows->variable[l]] -= pull * rows->gradient[l];
    }
    for (j = 0; j < n; ++j) ((double *)c->b->x)[j] = (double)residual[j];
    free(residual);
    solved = cholmod_solve2(CHOLMOD_A, c->factor, c->b, NULL, &c->x, NULL, &c->y, &c->e, &c->common);
    for (j = 0; solved && j < n; ++j) dx[j] += ((const double *)c->x->x)[j];
    return solved;
}

bench_facts bench_cholmod_facts(const bench_cholmod *c) {
    bench_facts facts;
    memset(&facts, 0, sizeof facts);
    facts.unknowns = (int32_t)c->matrix.ncol;
    facts.entries = c->common.lnz;
    facts.flops = c->common.fl;
    facts.part_seconds = c->pattern_seconds;
    facts.setup_seconds = c->setup_seconds;
    facts.rows_bytes = c->rows_bytes;
    facts.peak_bytes = (double)c->common.memory_usage + c->pattern_bytes;
    return facts;
}

/* -- the machine -- */

double bench_dgemm_peak(void) {
    static const int sizes[] = {256, 384, 512, 768, 1024};
    enum {
        LARGEST = 1024 * 1024
    };
    double best = 0, *a = (double *)bench_take(3 * LARGEST, sizeof *a);
    int s, run, i;
    for (i = 0; i < 2 * LARGEST; ++i) a[i] = 1.0 / (1 + i % 17);
    for (s = 0; s < 5; ++s) {
        int n = sizes[s], runs = n < 512 ? 12 : 5;
        for (run = 0; run < runs; ++run) {
            double began = bench_now(), rate;
            cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, n, n, n, 1, a, n, a + LARGEST, n, 0, a + 2 * LARGEST,
                        n);
            rate = 2.0 * n * n * n / (bench_now() - began);
            if (rate > best) best = rate;
        }
    }
    free(a);
    return best;
}

/* The processor's name, as the system tells it. */
static void bench_processor(char *name, size_t size) {
    FILE *file = fopen("/proc/cpuinfo", "r");
    char line[256], *colon;
    snprintf(name, size, "unknown processor");
    while (file && fgets(line, sizeof line, file)) {
        if (strncmp(line, "model name", 10) != 0 || !(colon = strchr(line, ':'))) continue;
        colon[strcspn(colon, "\n")] = 0;
        snprintf(name, size, "%.*s", (int)size - 1, colon + 2);
        break;
    }
    if (file) fclose(file);
}

bench_machine bench_this_machine(void) {
    bench_machine machine;
    int version[3];
    memset(&machine, 0, sizeof machine);
    cholmod_version(version);
    bench_processor(machine.processor, sizeof machine.processor);
#ifdef __clang__
    snprintf(machine.compiler, sizeof machine.compiler, "clang %d.%d", __clang_major__, __clang_minor__);
#else
    snprintf(machine.compiler, sizeof machine.compiler, "gcc %d.%d", __GNUC__, __GNUC_MINOR__);
#endif
    snprintf(machine.cholmod, sizeof machine.cholmod, "%d.%d.%d", version[0], version[1], version[2]);
    snprintf(machine.openblas, sizeof machine.openblas, "%s", openblas_get_config());
    snprintf(machine.kernels, sizeof machine.kernels, "%s", openblas_get_corename());
    machine.peak = bench_dgemm_peak();
    return machine;
}
