#!/bin/sh
# Proves that no panic, no malloc and no libc symbol can be reached from the exported functions: with `must-not-panic` the
# panic handler calls a symbol that does not exist, and the library is linked with every function of the header as a root
# and nothing else but the mem* functions, which compilers expect everywhere. Then prints sizes, and proves that a program of
# one shape, dimension and scalar contains no other, and that a program in float computes nothing in double: on a processor
# with an FPU for float only, each such operation would be a call of a software routine.
set -eu
cd "$(dirname "$0")/.."
target=${CARGO_TARGET_DIR:-target}/purity
cc=${CC:-cc}

echo "building the library with must-not-panic"
cargo rustc --quiet --locked --package qdist-capi --lib --release --features grasp,must-not-panic --crate-type staticlib --target-dir "$target"
lib=$target/release/libqdist_capi.a

# Functions of the header, from its declarations after the preprocessor.
functions=$("$cc" -E -P -Iinclude include/qdist_grasp.h | tr '\n' ' ' | tr ';' '\n' | sed -n 's/^.*[ *]\(qdist_[a-z0-9_]*\)(.*$/\1/p' | sort -u)
count=$(echo "$functions" | wc -l)
roots=$(echo "$functions" | sed 's/^/-u /')
memory='--defsym=memcpy=0 --defsym=memset=0 --defsym=memmove=0 --defsym=memcmp=0 --defsym=bcmp=0'

echo "linking with $count functions as roots"
# shellcheck disable=SC2086
if ! ld --gc-sections -e qdist_version $roots $memory -o "$target/all" "$lib" 2>"$target/all.log"; then
    cat "$target/all.log" >&2
    echo "purity: something that is not in the library is reachable" >&2
    exit 1
fi
for function in $functions; do
    nm "$target/all" | grep -q " T $function\$" || { echo "purity: $function is not exported" >&2; exit 1; }
done
# Would the link fail if a panic were reachable? The library must contain the call.
cat >"$target/reach.c" <<'C'
extern void qdist_panic_is_reachable(void);
void reach(void) { qdist_panic_is_reachable(); }
C
"$cc" -c "$target/reach.c" -o "$target/reach.o"
# shellcheck disable=SC2086
if ld --gc-sections -e reach $memory -o "$target/reach" "$target/reach.o" "$lib" 2>/dev/null; then
    echo "purity: the check itself does not work" >&2
    exit 1
fi
echo "purity: $count functions reach no panic, no allocation and no libc"

echo "sizes in bytes:"
# shellcheck disable=SC2086
size "$target/all" | awk 'NR == 2 { printf "  whole library: text %d, data %d, bss %d\n", $1, $2, $3 }'
# box_program SUFFIX: the depth of two boxes in space, what a firmware would call.
box_program() {
    sed "s/SUFFIX/$1/g" >"$target/box_$1.c" <<'C'
#include "qdist.h"
qdist_status box_depth(qdist_solver *solver, const qdist_box_SUFFIX *a, const qdist_box_SUFFIX *b, qdist_depth_SUFFIX *depth);
qdist_status box_depth(qdist_solver *solver, const qdist_box_SUFFIX *a, const qdist_box_SUFFIX *b, qdist_depth_SUFFIX *depth) {
    qdist_body_SUFFIX x, y;
    if (qdist_body_box_SUFFIX(&x, a) != QDIST_OK || qdist_body_box_SUFFIX(&y, b) != QDIST_OK) return 1;
    return qdist_depth3_SUFFIX(solver, &x, &y, 0, depth);
}
C
    "$cc" -O2 -ffunction-sections -ffreestanding -Iinclude -c "$target/box_$1.c" -o "$target/box_$1.o"
    # shellcheck disable=SC2086
    ld --gc-sections -e box_depth -u "qdist_solver_init_$1" $memory -o "$target/box_$1" "$target/box_$1.o" "$lib"
}
box_program f32
size "$target/box_f32" | awk 'NR == 2 { printf "  boxes, 3-D, float: text %d, data %d, bss %d\n", $1, $2, $3 }'
# What a program does not use is not linked. (The whole library contains the names that are searched for.)
for plan in conewise rays shoot warm span; do
    nm -C "$target/all" | grep -E ' [tT] ' | grep -q "$plan" || { echo "purity: no symbol is named $plan" >&2; exit 1; }
done
foreign=$(nm -C "$target/box_f32" | grep -E ' [tT] ' | grep -E '_f64|ellipsoid|cone|cylinder|capsule|points|hull|_unit_|half_space|join|sectors|arcs|solve[2-6]|rays|shoot|warm|span' || true)
if [ -n "$foreign" ]; then
    echo "purity: a program of boxes contains what it does not use:" >&2
    echo "$foreign" >&2
    exit 1
fi

# Functions of a program that calculate, compare or convert in double. Loads and stores of 8 bytes are movsd too, and bit masks
# are no arithmetic.
doubles() {
    objdump --disassemble --demangle --no-show-raw-insn "$1" | awk '
        /^[0-9a-f]+ </ { name = $0; sub(/^[0-9a-f]+ /, "", name) }
        $2 ~ /^v?(add|sub|mul|div|sqrt|max|min|u?comi|cmp[a-z]*|round|fn?m(add|sub)[0-9]*)(sd|pd)$/ ||
            ($2 ~ /^v?cvt/ && $2 ~ /(sd|pd)/) || $2 ~ /^f(ld|st|add|sub|mul|div|sqrt)/ { print "  " name " " $2 }' | sort | uniq -c
}
if [ "$(uname -m)" = x86_64 ]; then
    box_program f64
    if [ -z "$(doubles "$target/box_f64")" ]; then
        echo "purity: the search for double arithmetic does not work" >&2
        exit 1
    fi
    found=$(doubles "$target/box_f32")
    if [ -n "$found" ]; then
        echo "purity: a program in float calculates in double:" >&2
        echo "$found" >&2
        exit 1
    fi
    echo "purity: a program of boxes in float contains nothing else and calculates nothing in double"
else
    echo "purity: double arithmetic is searched on x86-64 only"
fi
