#!/bin/sh
# Writes src/capi/f32/ from src/capi/f64/. With --check: fails when that would change something.
set -eu
cd "$(dirname "$0")/../src/capi"
mkdir -p f32/grasp
for file in f64/*.rs f64/grasp/*.rs; do
    name=${file#f64/}
    {
        echo "// generated from f64/$name by \`make header\`; do not edit"
        sed -e 's/f64/f32/g; s/F64/F32/g; s/DBL_MAX (float: FLT_MAX)/FLT_MAX/; s/-DBL_MAX or FLT_MAX/-FLT_MAX or FLT_MAX/' "$file"
    } >"f32/$name.new"
    if [ "${1:-}" = --check ]; then
        cmp -s "f32/$name" "f32/$name.new" || stale="${stale:-} $name"
        rm "f32/$name.new"
    else
        mv "f32/$name.new" "f32/$name"
    fi
done
if [ -n "${stale:-}" ]; then
    echo "src/capi/f32: stale:$stale; run \`make header\`" >&2
    exit 1
fi
