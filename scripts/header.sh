#!/bin/sh
# Writes include/qdist.h, include/qdist_grasp.h and include/qdist_mesh.h. With --check: fails when that would change one of them.
set -eu
cd "$(dirname "$0")/.."
version=0.29.4
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
out=$dir/qdist.h

if ! cbindgen --version 2>/dev/null | grep -qF "cbindgen $version"; then
    echo "installing cbindgen $version" >&2
    cargo install --quiet --locked cbindgen --version "=$version"
fi

# The most functions that the headers may have together.
most=170

# Functions of the chapter $2 with the settings $1. A file by itself refers to types of other files: those warnings are left out;
# the C compiler checks the whole.
chapter() {
    sed -n 's|^//! \{0,1\}||p' "$2" | awk -v suffix="$3" '
        NR == 1 {
            title = $0 suffix
            line = sprintf("%" int((126 - length(title)) / 2) "s", "")
            gsub(/ /, "=", line)
            text = "\n/* " line " " title " " line
            next
        }
        suffix == "" { text = text "\n *" ($0 == "" ? "" : " " $0) }
        END { print text " */\n" }'
    # Checked arguments are pointers (capi/src/pointer.rs).
    sed 's/\bIn<\([^<>]*\)>/*const \1/g; s/\bOut<\([^<>]*\)>/*mut \1/g' "$2" >"$dir/plain.rs"
    cbindgen --config "$1" "$dir/plain.rs" 2>"$out.warnings" || { cat "$out.warnings" >&2; exit 1; }
    grep -vE "^WARN: (Can't find qdist_|Skip .*::_ |Skip .*not .pub.|Skip(ping)? .*not .no_mangle.)|^$" "$out.warnings" >&2 || true
}

# The chapters with the functions of the dimensions 3 to 6, and those of the other scalar, as capi/build.rs makes them.
mkdir -p "$dir/f64/grasp" "$dir/f32/grasp"
for file in capi/src/f64/*.rs capi/src/f64/grasp/*.rs; do
    name=${file#capi/src/f64/}
    awk '
        { print }
        /^#\[unsafe\(no_mangle\)\]/ { text = "" }
        { text = text "\n" $0 }
        match($0, /fn qdist_[a-z_]*2_f64\(/) { function_of_2 = substr($0, RSTART + 3, RLENGTH - 8) }
        /^\/\/ Likewise in dimensions 3 to 6\.$/ {
            for (n = 3; n <= 6; n++) {
                other = text
                gsub(/2_f64\(/, n "_f64(", other)
                print "/// The same in dimension " n ".\n///\n/// Status: as of " function_of_2 "." other
            }
        }' "$file" >"$dir/f64/$name"
    sed -f capi/f32.sed "$dir/f64/$name" >"$dir/f32/$name"
done

# A header: what it begins with, chapters without a scalar, and chapters for both.
header() {
    cat "$1"
    for file in $2; do chapter cbindgen.toml "capi/src/$file.rs" ""; done
    for file in $3; do chapter cbindgen.toml "$dir/f64/$file.rs" ""; done
    for file in $3; do chapter "$out.toml" "$dir/f32/$file.rs" ", FLOAT"; done
    printf '\n#ifdef __cplusplus\n}\n#endif\n\n#endif\n'
}

{ echo 'documentation = false'; cat cbindgen.toml; } >"$out.toml"
header capi/src/prelude.h "status version workspace symmetry" "solver sets shapes points join half_space combine unit_sets query plane span warm" |
    cat -s >"$out"
header capi/src/grasp_prelude.h grasp "grasp/contacts grasp/wrenches grasp/quality grasp/forces grasp/gradients grasp/fingers grasp/linearized grasp/pyramids" | cat -s >"$out.grasp"
header capi/src/mesh_prelude.h "mesh/allocator mesh/model mesh/pair mesh/metric mesh/depth mesh/tracker" "" | cat -s >"$out.mesh"

count=$(cat "$out" "$out.grasp" "$out.mesh" | grep -c '^QDIST_API')
if [ "$count" -gt $most ]; then
    echo "the headers have $count functions, more than $most: what is no interface is not exported" >&2
    exit 1
fi

# Every function that returns a status says which argument causes which.
silent=$(cat "$out" "$out.grasp" "$out.mesh" | awk '
    /^\/\/\// { text = text $0; next }
    /^QDIST_API$/ { next }
    match($0, /qdist_status qdist_[a-z0-9_]+\(/) {
        name = substr($0, RSTART + 13, RLENGTH - 14)
        if (name !~ /_f32$/ && text !~ /Status: /) print name
    }
    { text = "" }')
if [ -n "$silent" ]; then
    echo "the texts of these functions say nothing of their statuses:" $silent >&2
    exit 1
fi

# $1: what was written, $2: the header.
install() {
    if [ "$check" = --check ]; then
        diff -u "$2" "$1" || { echo "$2: stale; run \`./x header\`" >&2; exit 1; }
    else
        cp "$1" "$2"
        chmod 644 "$2"
    fi
}
check=${1:-}
install "$out" include/qdist.h
install "$out.grasp" include/qdist_grasp.h
install "$out.mesh" include/qdist_mesh.h
