#!/bin/sh
# Instructions a round of fixed queries takes, beside golden numbers: `query,instructions`, under a line that names the compiler. One that is off by more
# than 3 % is a failure, in either direction: what got faster is worth to be written down. Compilers make other code: with another one than the golden
# numbers' nothing is compared.
#
#   scripts/instructions.sh PROGRAM [write]
set -eu
program=$1 write=${2:-}
golden=$(dirname "$0")/../ffi-tests/instructions.csv
now=$program.csv
compiler="# $(rustc --version | cut -d ' ' -f 1-2), $(uname -sm)"

command -v valgrind >/dev/null || { echo "SKIPPED: valgrind is not there"; exit 0; }
[ -n "$write" ] || [ "$(head -n 1 "$golden")" = "$compiler" ] || { echo "SKIPPED: golden instructions are of another compiler ($(head -n 1 "$golden"))"; exit 0; }

# Of so many rounds. (A query that fails is no measure.)
counted() {
    "$program" "$1" 1 || { echo "$1 fails" >&2; exit 1; }
    valgrind --tool=callgrind --callgrind-out-file=/dev/null "$program" "$1" "$2" 2>&1 | sed -n 's/.*Collected : //p'
}

{
    echo "$compiler"
    echo "query,instructions"
    "$program" | while read -r query; do
        echo "\"$query\",$((($(counted "$query" 6) - $(counted "$query" 2)) / 4))"
    done
} >"$now"
if [ -n "$write" ]; then cp "$now" "$golden"; fi
# Names have commas, numbers have none.
awk '
    { key = $0; sub(/,[0-9]*$/, "", key); value = $0; sub(/.*,/, "", value); value += 0 }
    FNR < 3 { next }
    NR == FNR { was[key] = value; next }
    !(key in was) { print key ": not among the golden ones"; failed++; next }
    { seen[key] = 1; if (value > 1.03 * was[key] || value < 0.97 * was[key]) { print key ": " was[key] " before, " value " now"; failed++ } else passed++ }
    END {
        for (key in was) if (!(key in seen)) { print key ": golden, and not measured"; failed++ }
        print "instructions: " passed + 0 " passed, " failed + 0 " failed"
        exit failed > 0
    }
' "$golden" "$now"
