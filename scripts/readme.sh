#!/bin/sh
# README's examples in C: every block is compiled as C99 and as C++ without a warning; one with a `main` is run, too, with the library that README links
# it with, and prints what its comment `/* prints: ... */` says. (The examples in Rust are doctests.) Arguments: the freestanding library, the
# hosted one, and a directory to work in.
set -u
cd "$(dirname "$0")/.." || exit
lib=$1 hosted=$2 out=$3
warnings='-Wall -Wextra -Wpedantic -Wconversion -Werror'
passed=0 failed=0
rm -rf "$out"
mkdir -p "$out"

count() {
    if [ "$1" = 0 ]; then passed=$((passed + 1)); else failed=$((failed + 1)) && echo "README's example $2 (${out}/$2.c): $3"; fi
}

awk -v out="$out" '/^```c$/ { file = out "/" ++n ".c"; next } /^```/ { file = "" } file { print > file }' README.md
for source in "$out"/*.c; do
    name=$(basename "$source" .c)
    # shellcheck disable=SC2086
    "${CC:-cc}" -std=c99 -O2 $warnings -Iinclude -c "$source" -o "$out/$name.o"
    count $? "$name" "does not compile as C99"
    # shellcheck disable=SC2086
    "${CXX:-c++}" -std=c++17 -O2 $warnings -Iinclude -x c++ -c "$source" -o "$out/$name.cpp.o"
    count $? "$name" "does not compile as C++"
    grep -q 'int main(' "$source" || continue
    libs="$lib -Wl,--gc-sections"
    ! grep -q 'qdist_mesh.h' "$source" || libs="$hosted -lpthread -ldl -lm"
    # shellcheck disable=SC2086
    "${CC:-cc}" "$out/$name.o" $libs -o "$out/$name" && "$out/$name" >"$out/$name.printed"
    count $? "$name" "does not link or run"
    sed -n 's|.*/\* prints: \(.*\) \*/.*|\1|p' "$source" >"$out/$name.promised"
    diff "$out/$name.promised" "$out/$name.printed"
    count $? "$name" "prints something else"
done
echo "readme: $passed passed, $failed failed"
[ "$failed" = 0 ]
