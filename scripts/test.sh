#!/bin/sh
# All tests: Rust, C and C++, the proofs about the freestanding library, and the comparison harness on the fixtures. The last
# line is the sum; the exit code is 0 when nothing failed.
set -u
cd "$(dirname "$0")/.." || exit
log=${CARGO_TARGET_DIR:-target}/test-logs
mkdir -p "$log"
passed=0 failed=0 skipped=0 broken=''

# sum WORD: of the numbers before this word in the closing lines of the log $name. cargo writes "test result: ok. 3 passed; 0 failed; 1 ignored;
# ...", the C programs "name: 3 passed, 0 failed".
sum() {
    grep -E '^(test result: |[a-zA-Z_]+: [0-9]+ passed, )' "$log/$name.log" | grep -Eo "[0-9]+ $1" | awk '{s += $1} END {print s + 0}'
}

# run NAME COMMAND...: runs it, shows it, and adds up its closing lines.
run() {
    name=$1
    shift
    printf '\n== %s\n' "$name"
    begin=$(date +%s)
    { "$@" 2>&1; echo $? >"$log/$name.status"; } | tee "$log/$name.log"
    echo "== $name took $(($(date +%s) - begin)) s"
    code=$(cat "$log/$name.status")
    p=$(sum passed) f=$(sum failed) s=$(($(sum ignored) + $(grep -c '^SKIPPED: ' "$log/$name.log")))
    passed=$((passed + p)) failed=$((failed + f)) skipped=$((skipped + s))
    if [ "$code" != 0 ]; then
        broken="$broken $name"
        [ "$f" != 0 ] || failed=$((failed + 1))
    elif [ "$p" = 0 ]; then
        passed=$((passed + 1)) # a check without a count of its own
    fi
}

./x need test || exit

# Tests of data that lie beside the project and not in it are ignored unless asked for. They run where the data are, and in CI, where
# their absence is a failure; elsewhere they count as skipped.
ignored=''
if [ -d ../shared/data ] || [ "${CI:-}" = true ]; then ignored=--include-ignored; fi

run x scripts/x_arguments.sh
# shellcheck disable=SC2086
run rust cargo test --locked --workspace --features std -- --show-output $ignored
run c make --no-print-directory test-c
run freestanding make --no-print-directory freestanding
run purity make --no-print-directory purity
run stack make --no-print-directory stack
run embedded make --no-print-directory embedded OUT="$log/embedded"
run instructions make --no-print-directory instructions
run figures python3 benches/report/figures.py
run compare make --no-print-directory compare CASES="$(echo tests/data/*.txt)" OUT="$log/compare" CHECK=--check

printf '\n'
[ -z "$broken" ] || echo "failed:$broken (logs in $log)"
[ "$skipped" = 0 ] || [ -n "$ignored" ] || echo "skipped: tests of the larger data sets, for want of ../shared/data"
echo "$passed passed, $failed failed, $skipped skipped"
[ -z "$broken" ] && [ "$failed" = 0 ]
