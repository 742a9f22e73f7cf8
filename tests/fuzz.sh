#!/bin/bash
# fuzz.sh SECONDS NAME... - runs the libFuzzer targets build/fuzz/NAME, JOBS at a time; fails when one finds something.
# With SEED=1 (any number but 0) each goes the same way on every fresh clone, as far as the seconds reach.
set -u
cd "$(dirname "$0")" || exit 2
export seconds=$1
shift
export ASAN_OPTIONS="${ASAN_OPTIONS:-allocator_may_return_null=1}"
fuzz() {
    local name=$1 folder=build/fuzz
    [ -x $folder/$name ] || { echo "fuzz: $name did not build"; return 1; }
    python3 corpus.py start "${name#fuzz_}"
    local used code seeded='' fixed='' inputs=$folder/$name.corpus TIMEFORMAT=%U
    if [ "${SEED:-0}" != 0 ]; then # a folder's order and addresses are chance: inputs are sorted, addresses fixed if they can be
        setarch -R true 2>/dev/null && fixed='setarch -R'
        ls $inputs/* | paste -s -d , >$folder/$name.inputs
        seeded="-seed=$SEED -seed_inputs=@$folder/$name.inputs" inputs=$folder/$name.seeded
        rm -rf $inputs && mkdir $inputs
    fi
    used=$({
        time $fixed $folder/$name -max_total_time=$seconds -timeout=60 -rss_limit_mb=2048 -max_len=4096 -len_control=0 -print_final_stats=1 -verbosity=0 \
            -artifact_prefix=$folder/$name- $seeded $inputs >$folder/$name.log 2>&1 </dev/null
    } 2>&1)
    code=$?
    if [ $code -eq 0 ]; then
        echo "fuzz: $name found nothing in $(sed -n 's/.*number_of_executed_units: *//p' $folder/$name.log) runs, $used s of processor time"
    else
        echo "fuzz: $name FAILED"
        tail -n 60 $folder/$name.log
        return 1
    fi
}
export -f fuzz
[ $# -gt 0 ] || { echo 'fuzz: no targets'; exit 1; }
printf '%s\n' "$@" | xargs -P "${JOBS:-2}" -I{} bash -c 'fuzz {}'
