#!/bin/sh
# All tests: Rust, C and C++, the proofs about the freestanding library, and the comparison harness on the fixtures. Installs
# what it needs where it may. The last line is the sum; the exit code is 0 when nothing failed.
set -u
cd "$(dirname "$0")/.."
log=${CARGO_TARGET_DIR:-target}/test-logs
mkdir -p "$log"
passed=0 failed=0 skipped=0 broken=''

# run NAME COMMAND...: runs it, shows it, and adds up its closing lines.
run() {
    name=$1
    shift
    printf '\n== %s\n' "$name"
    { "$@" 2>&1; echo $? >"$log/$name.status"; } | tee "$log/$name.log"
    code=$(cat "$log/$name.status")
    # cargo: "test result: ok. 3 passed; 0 failed; 1 ignored; ..."; the C programs: "name: 3 passed, 0 failed".
    p=$(grep -Eo '[0-9]+ passed' "$log/$name.log" | awk '{s += $1} END {print s + 0}')
    f=$(grep -Eo '[0-9]+ failed' "$log/$name.log" | awk '{s += $1} END {print s + 0}')
    s=$(grep -cE '^SKIPPED' "$log/$name.log")
    passed=$((passed + p)) failed=$((failed + f)) skipped=$((skipped + s))
    if [ "$code" != 0 ]; then
        broken="$broken $name"
        [ "$f" != 0 ] || failed=$((failed + 1))
    elif [ "$p" = 0 ]; then
        passed=$((passed + 1)) # a check without a count of its own
    fi
}

need=''
for tool in cc:gcc c++:g++ python3:python3 valgrind:valgrind; do
    command -v "${tool%%:*}" >/dev/null || need="$need ${tool##*:}"
done
if [ -n "$need" ]; then
    if [ "$(id -u)" = 0 ]; then
        # shellcheck disable=SC2086
        apt-get update -qq && apt-get install -y -qq --no-install-recommends $need libc6-dev >/dev/null
    else
        echo "please install:$need" >&2
    fi
fi

run rust cargo test --locked --features std,capi -- --show-output
run c make --no-print-directory test-c
run freestanding make --no-print-directory freestanding
run purity make --no-print-directory purity
run stack make --no-print-directory stack
run compare make --no-print-directory compare CASES="$(echo tests/data/*.txt)" OUT="$log/compare" CHECK=--check

printf '\n'
[ -z "$broken" ] || echo "failed:$broken (logs in $log)"
[ "$skipped" = 0 ] || echo "skipped: the larger case sets, for want of ../shared/data"
echo "$passed passed, $failed failed, $skipped skipped"
[ -z "$broken" ] && [ "$failed" = 0 ]
