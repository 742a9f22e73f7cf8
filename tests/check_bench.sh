#!/bin/bash
# check_bench.sh - tools/bench builds, measures a small case beside CHOLMOD, finds the same steps, and tells it in the forms
# that it promises. Times are not checked.
. "$(dirname "$0")/checks.sh"

tools() { "${MAKE:-make}" --no-print-directory -C "$root/tools" "$@"; }
needs='libsuitesparse-dev libopenblas-dev'
clean 'make -C tools without the libraries names the packages' \
    "$(tools -n HAVE_BENCH= all 2>&1 | grep -q "$needs" || echo 'it does not')"
tools HAVE_BENCH= bench >"$work/without.txt" 2>&1 && fail 'make -C tools bench succeeds without the libraries' || pass
grep -q "^bench needs .*$needs" "$work/without.txt" && pass || fail 'make -C tools bench does not say what it needs'

# A copy, so that a user's program and its objects stay as they are.
mkdir "$work/clone" && cp -r "$root/tools" "$root/guidedproj.h" "$work/clone" && rm -f "$work"/clone/tools/*.o
root=$work/clone
tools bench BENCH_FLAGS='-O0 -Wno-misleading-indentation' >"$work/make.txt" 2>&1
if grep -q '^bench needs' "$work/make.txt"; then
    skip "bench: no $needs"
    report
fi
clean 'bench compiles with warnings' "$(grep -E 'warning:|error:' "$work/make.txt")"
bench=$root/tools/bench
[ -x "$bench" ] || { fail 'bench does not build'; tail -n 20 "$work/make.txt"; report; }

cd "$work" || exit 2
"$bench" --help >help.txt 2>&1 && grep -q -- --quick help.txt && pass || fail 'bench --help'
"$bench" --nonsense >/dev/null 2>&1 && fail 'bench takes an unknown option' || pass
"$bench" --problem quad --size 500 --samples 3 --json bench.json --svg bench.svg >bench.txt 2>progress.txt
code=$?
clean 'bench fails, or its steps differ from those of CHOLMOD' "$([ $code = 0 ] || { echo "exit code $code"; cat bench.txt progress.txt; })"
grep -qE '^ratio quad 500 [0-9]+\.[0-9]{3}$' bench.txt && pass || fail 'no line "ratio quad 500 X"'
grep -qE '^quad +506 .*\| +[0-9.]+ +0\.35 (ok|above)' bench.txt && pass || fail 'no bound beside the ratio'
head -n 1 bench.txt | grep -qE 'CHOLMOD [0-9.]+.*OpenBLAS.*kernels \w+, dgemm [0-9.]+ GFlop/s' && pass ||
    fail 'the first line does not tell what runs'
if have python3; then
    clean 'bench --json' "$(python3 - 2>&1 <<'END_PYTHON'
import json
case, = json.load(open("bench.json"))["cases"]
assert (case["problem"], case["nominal"], case["vertices"]) == ("quad", 500, 506)
assert case["ours"]["unknowns"] == 21 * 22 # a multiplier for each quad
assert case["cholmod"]["unknowns"] == 3 * 506 + 3 * 21 * 22
assert case["agrees"] and case["our_error"] < 1e-8 and case["samples"] >= 3
for who in "our_seconds", "cholmod_seconds":
    phases = case[who]
    assert all(phases[p] > 0 for p in ("refresh", "assembly", "factor", "solve", "whole")), phases
assert abs(case["ratio"] - case["our_seconds"]["whole"] / case["cholmod_seconds"]["whole"]) < 1e-5
for who in "ours", "cholmod":
    facts = case[who]
    least = facts["unknowns"] * (10 if who == "ours" else 20)
    assert least < facts["entries"] < 5 * least and facts["flops"] > facts["entries"] and facts["setup_seconds"] > 0
    assert facts["peak_bytes"] > 8 * facts["entries"]
assert case["cblas_seconds"] > 0 and case["scalar_seconds"] > 0
END_PYTHON
)"
fi
head -c 4 bench.svg | grep -q '<svg' && tail -n 1 bench.svg | grep -qx '</svg>' && pass || fail 'bench.svg is no picture'
# OpenBLAS's kernels are tried once, above: bench begins as when it has chosen.
export GPROJ_BENCH_STAGE=run OPENBLAS_NUM_THREADS=1
problems='closed hex statics fairness hybrid'
"$bench" --quick --problem ${problems// / --problem } --size 200 --samples 1 >quick.txt 2>&1
clean 'bench --quick fails' "$([ $? = 0 ] || cat quick.txt)"
for problem in $problems; do
    grep -q "^ratio $problem 200 " quick.txt && pass || fail "bench --problem $problem"
done
"$bench" --problem volume --size 200 --samples 1 2>&1 | grep -q 'the global row *volume' && pass || fail 'bench --problem volume'
"$bench" --problem default --size 200 --samples 1 2>&1 | grep -q 'default over plain, metric at rest' && pass || fail 'bench --problem default'
"$bench" --quick --problem quad --size 500 --samples 1 --markdown 2>/dev/null | grep -q '^| planar quads | [0-9.]* |$' && pass ||
    fail 'bench --markdown'
report
