#!/bin/sh
# characters.sh BUILD FOLDER [OUT]: what becomes of characters of others: every .glb, .gltf, .vrm, .fbx and .obj of a
# folder is built, sent (noh pack), verified on each path, and drawn into OUT (a temporary folder). Prints a table in
# Markdown: bytes of the file, the pack and its wire form, bytes on the GPU, what was warned of. Fails where a file is
# built but does not verify; one that is refused is a row with the reason.
set -eu
build=${1:?"characters.sh BUILD FOLDER [OUT]"}
folder=${2:?"the folder of models"}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
out=${3:-$work}
mkdir -p "$out"
failed=0

number() { # NAME: the first one of that name in the JSON that comes in
    sed -n "s/.*\"$1\": \([0-9]*\).*/\1/p" | head -n 1
}
thousands() {
    awk -v n="$1" 'BEGIN { s = sprintf("%d", n); while (match(s, /[0-9][0-9][0-9][0-9](,|$)/)) s = substr(s, 1, RSTART) "," substr(s, RSTART + 1); print s }'
}

echo '| model | file | pack | sent | GPU | differing | warned of |'
echo '|---|---:|---:|---:|---:|---:|---|'
for file in "$folder"/*.glb "$folder"/*.gltf "$folder"/*.vrm "$folder"/*.fbx "$folder"/*.obj; do
    [ -f "$file" ] || continue
    name=$(basename "$file")
    bytes=$(wc -c <"$file")
    if ! "$build/noh" build "$file" -o "$work/a.noh" --plain --wrinkles face >"$work/said" 2>"$work/err"; then
        grep -q '^noh: ' "$work/err" || { cat "$work/err" >&2 && exit 1; } # it did not run
        echo "| $name | $(thousands "$bytes") | refused | | | | $(sed 's/^noh: //; s/|/\\|/g' "$work/err" | head -n 1) |"
        continue
    fi
    "$build/noh" pack "$work/a.noh" -o "$work/a.nohz" --error-um 10 >"$work/packed" 2>&1 || failed=1
    "$build/noh" budget "$work/a.noh" --json >"$work/budget"
    if "$build/noh" verify "$work/a.noh" >"$work/verify" 2>&1; then
        differing=0
    else
        differing=FAILED failed=1
    fi
    "$build/noh" render "$work/a.noh" -o "$out/${name%.*}.png" --size 384x384 >/dev/null 2>&1 || failed=1
    warnings=$(sed -n 's/^warning: //p' "$work/said" "$work/err" | sed "s/'[^']*'/.../g; s/ *(.*//" | sort | uniq -c | sort -rn |
        awk '{ n = $1; $1 = ""; printf("%s%s%s", (NR > 1 ? ";" : ""), (n > 1 ? " " n " times" : ""), $0) }' | sed 's/|/\\|/g; s/^ //')
    echo "| $name | $(thousands "$bytes") | $(thousands "$(wc -c <"$work/a.noh")") | $(thousands "$(wc -c <"$work/a.nohz")") | $(thousands "$(number gpu_bytes <"$work/budget")") | $differing | $warnings |"
done
exit $failed
