#!/bin/sh
# Which answers of two records differ: a line a part, and the first lines that do. Exit code 1 when any does.
#
#   scripts/record_compare.sh A B
set -eu
[ $# = 2 ] || { echo "usage: ./x record-compare A=dir B=dir" >&2; exit 2; }
differ=0 compared=0
for part in convex grasps meshes; do
    before=$1/$part.txt after=$2/$part.txt
    if [ ! -f "$before" ] && [ ! -f "$after" ]; then continue; fi
    compared=$((compared + 1))
    if [ ! -f "$before" ] || [ ! -f "$after" ]; then
        echo "$part: only one of the two records has it"
        differ=1
    elif cmp -s "$before" "$after"; then
        echo "$part: $(wc -l <"$before") answers, all the same"
    else
        changed=$(diff "$before" "$after" | grep -c '^<') || true
        echo "$part: $changed of $(wc -l <"$before") answers differ, or are only in $1; the first of them:"
        diff "$before" "$after" | grep '^[<>]' | head -n 6 | cut -c 1-200 || true
        differ=1
    fi
done
[ "$compared" -gt 0 ] || { echo "neither $1 nor $2 has a record" >&2; exit 2; }
exit $differ
