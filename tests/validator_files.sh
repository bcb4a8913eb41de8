#!/bin/sh
# validator_files.sh DIR: runs noh build on each file of the glTF validator's tests (KhronosGroup/glTF-Validator,
# test/base/data), which are not included. Run by `make check-validator DIR=...`.
#
# Prints a line per file: "refused", "warned" or "read", and the message. Fails if noh crashes, hangs, or exits without
# a message, and if a file that the validator reports as broken is read without a warning, unless `harmless` gives a
# reason.
set -eu

dir=${1:?a folder of .gltf and .glb files is needed: make check-validator DIR=...}
build=${NOH_BUILD:-build}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
count=0 refused=0 warned=0 silent=0 failed=0

# Errors of the validator that noh may ignore: bounds of accessors, which noh computes, and an extension that is used as
# required but not declared so.
harmless='no_bounds|KHR_mesh_quantization/'

say() {
    printf '%-8s %-60s %s\n' "$1" "$2" "$(head -c 160 "$work/message" | tr '\n' ' ')"
}

find "$dir" -name '*.gltf' -o -name '*.glb' | sort >"$work/files"
while read -r file; do
    name=${file#"$dir"/}
    count=$((count + 1))
    code=0
    (ulimit -S -t 30 && exec timeout 600 "$build/noh" build "$file" -o "$work/out.noh") >"$work/text" 2>"$work/message" || code=$?
    grep '^warning' "$work/text" >"$work/warnings" || true
    if [ $code = 1 ] && [ -s "$work/message" ]; then
        refused=$((refused + 1))
        sed -i "s|^noh: $file: ||" "$work/message"
        say refused "$name"
    elif [ $code = 0 ] && [ -s "$work/warnings" ]; then
        warned=$((warned + 1))
        cp "$work/warnings" "$work/message"
        say warned "$name"
    elif [ $code = 0 ]; then
        errors=$(sed -n 's/.*"numErrors": \([0-9]*\).*/\1/p' "$file.report.json" 2>/dev/null | head -n 1)
        : >"$work/message"
        if [ "${errors:-0}" -gt 0 ] && ! echo "$name" | grep -qE "$harmless"; then
            silent=$((silent + 1))
            grep -m1 '"message"' "$file.report.json" >"$work/message" || true
            say SILENT "$name"
        else
            say read "$name"
        fi
    else
        failed=$((failed + 1))
        say "FAILED $code" "$name"
    fi
done <"$work/files"
echo "$count files: $refused refused, $warned warned of, $((count - refused - warned - failed)) read, $silent of them broken and read in silence, $failed failed"
[ "$count" -gt 0 ] && [ $failed = 0 ] && [ $silent = 0 ]
