#!/bin/bash
# test_python.sh - examples/python/guidedproj.py: compiled by its own command, its structs, enumerators and functions compared
# with the header's in C, its numbers with those of a C program that calls the same library, then test_python.py. The
# add-on for Blender runs where Blender is installed. Skipped without a python3 that has numpy.
. "$(dirname "$0")/checks.sh"

python=$(python_with_numpy)
[ -n "$python" ] || { skip 'Python: no python3 with numpy (Debian: python3-numpy)'; report; }
have "${CC:-cc}" || { skip 'Python: no C compiler'; report; }
binding=$root/examples/python
export GUIDEDPROJ_CACHE=$PWD/build/python PYTHONDONTWRITEBYTECODE=1 LC_ALL=C.UTF-8
unset GUIDEDPROJ_LIBRARY
mkdir "$work/empty"

# The library is compiled once for all tests, as anyone does it; then a stand-in for the compiler shows when it is asked.
library=$($python "$binding/guidedproj.py" 2>"$work/said.txt") && [ -f "$library" ] && pass ||
    { fail "guidedproj.py does not compile the library: $(cat "$work/said.txt")"; report; }
[ "$($python "$binding/guidedproj.py" 2>&1)" = "$library" ] && pass || fail 'guidedproj.py compiles again'
cat >"$work/compiler" <<END_OF_COMPILER
#!/bin/bash
while [ "\$1" != -o ]; do shift; done
cp "$library" "\$2"
END_OF_COMPILER
chmod +x "$work/compiler"
asked() { CC=$work/compiler GUIDEDPROJ_CACHE=$work/cache $python "$binding/guidedproj.py" "$@" 2>&1; }
grep -q '^guidedproj: compiling .* once' <<<"$(asked)" && [ -f "$(asked)" ] && pass || fail "a new cache: $(asked)"
[ "$(asked "$work/new/named.so")" = "$work/new/named.so" ] && [ "$(ls "$work/new")" = named.so ] && pass ||
    fail 'guidedproj.py does not compile to the path that it is given'

clean 'guidedproj.py differs from the header' "$($python python_interface.py "$root/guidedproj.h" "$binding/guidedproj.py" \
    "$work" ${CC:-cc} 2>&1 | grep -vxE 'compared ([7-9][0-9]{2}|[0-9]{4,})')"
clean 'lines of more than 130 columns' "$(grep -nE '^.{131,}' "$binding"/*.py "$root"/examples/blender/*.py)"

# ---- to the bit as in C: the program's library is Python's ----

cat >"$work/agree.c" <<'END_OF_C'
#include "guidedproj.h"
#include <stdio.h>
#include <string.h>

static void bits(int count, const double *x) {
    int i;
    for (i = 0; i < count; ++i) {
        unsigned long long word;
        memcpy(&word, x + i, sizeof word);
        printf(i ? " %016llx" : "%016llx", word);
    }
}
static bool tell(void *user, gproj_system *system, const gproj_iteration *it) {
    double x[3];
    (void)user, (void)system;
    x[0] = it->residual, x[1] = it->merit, x[2] = it->step;
    printf("iteration %d ", (int)it->number), bits(3, x), puts("");
    return true;
}
static double gradient[100000], entries[100000];

int main(int count, char **argument) {
    gproj_mesh *mesh = count > 1 ? gproj_mesh_load(argument[1], NULL, NULL) : NULL, *copy = gproj_mesh_copy(mesh, NULL, NULL);
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_system *system = gproj_form_system(form);
    gproj_schedule fair = {0.2, 0.9, 6};
    gproj_solve_options options = {0};
    gproj_measures measures;
    gproj_result result;
    double x[3];
    int group, row, i, n;
    gproj_add_planarity(form, 1);
    gproj_add_fixed_corners(form, 1);
    gproj_add_length_bounds(form, 0, NULL, -1.0 / 0.0, 1.3 * gproj_mesh_mean_edge_length(mesh), 1);
    gproj_set_schedule(form, gproj_add_fairness(form, 0.2), fair);
    gproj_add_closeness(form, 0.01);
    x[0] = gproj_system_check_gradients(system);
    printf("gradients "), bits(1, x), puts("");
    for (group = 0; group < gproj_system_group_count(system); ++group) {
        gproj_group_info info = gproj_system_group_info(system, group);
        printf("group %s %d %d %d\n", info.name, (int)info.kind, (int)info.place, (int)info.rows);
        for (row = 0; row < info.rows; row += 1 + info.rows / 20) {
            x[0] = gproj_system_row_value(system, group, row, gradient);
            for (i = n = 0; i < gproj_system_variable_count(system); ++i)
                if (gradient[i] != 0) entries[n++] = gradient[i];
            printf("row %d ", row), bits(1, x), printf(" "), bits(n, entries), puts("");
        }
    }
    options.on_iteration = tell;
    result = gproj_solve(form, 12, &options);
    x[0] = result.residual, x[1] = result.tolerance;
    printf("%d %d ", (int)result.outcome, (int)result.iterations), bits(2, x), printf("\n%s\n", result.message);
    for (group = 0; group < gproj_system_group_count(system); ++group) {
        gproj_group_info info = gproj_form_group_info(form, group);
        x[0] = info.max, x[1] = info.rms;
        printf("after "), bits(2, x), printf(" %d %d\n", (int)info.worst_row, (int)info.worst_element);
    }
    measures = gproj_measure(mesh, copy->position, NULL);
    x[0] = measures.planarity_max, x[1] = measures.area_spread, x[2] = measures.deviation_rms;
    printf("measures "), bits(3, x), puts("");
    bits(3 * mesh->vertex_count, mesh->position), puts("");
    gproj_form_destroy(form);
    gproj_mesh_destroy(copy);
    gproj_mesh_destroy(mesh);
    return 0;
}
END_OF_C
${CC:-cc} -w -I"$root" "$work/agree.c" "$library" -Wl,-rpath,"$(dirname "$library")" -o "$work/agree" -lm && pass ||
    fail 'a C program cannot be linked with the library'

cat >"$work/tick.c" <<'END_OF_C'
#include <signal.h>
int ticks;
double now(void *user) {
    if (++ticks == 12) raise(SIGINT);
    return user ? 0 : ticks;
}
END_OF_C
${CC:-cc} -shared -fPIC "$work/tick.c" -o "$work/tick.so" || fail 'a shared library cannot be compiled'

# ---- the tests in Python ----

sums() { # sums WHAT: adds up what a program has said in tests.txt, "PASSED FAILED" alone on a line near the end
    read -r right wrong <<<"$(grep -xE '[0-9]+ [0-9]+' "$work/tests.txt" | tail -n 1)"
    if [ -n "${wrong:-}" ]; then
        passed=$((passed + right)) failed=$((failed + wrong))
        grep -A9 '^FAILED' "$work/tests.txt" | head -n 60
    else
        fail "$1 has not come to its end:"
        tail -n 30 "$work/tests.txt"
    fi
}
timeout 600 $python test_python.py "$root" "$work" >"$work/tests.txt" 2>&1
sums test_python.py

# ---- the add-on, in a Blender without a window and with folders of its own ----

if ! have blender; then
    skip 'the add-on for Blender: no blender (Debian: blender)'
elif ! blender --background --factory-startup --python-exit-code 3 --python-expr 'import numpy' >"$work/tests.txt" 2>&1; then
    skip "the add-on for Blender: it does not start, or has no numpy: $(tail -n 1 "$work/tests.txt")"
else
    mkdir -p "$work/blender/config" "$work/blender/scripts"
    BLENDER_USER_CONFIG=$work/blender/config BLENDER_USER_SCRIPTS=$work/blender/scripts HOME=$work/blender timeout 300 \
        blender --background --factory-startup --python test_blender.py -- "$root" >"$work/tests.txt" 2>&1
    sums test_blender.py
fi
report
