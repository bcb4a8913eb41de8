#!/bin/sh
# clip_ratio.sh BUILD CLIPS CSV: every raw clip of a folder, also at 30 Hz where its rate is above 60, built at
# 0.01 cm with a 3 cm shell and at 0.1 cm with a 10 cm shell; our bytes, the reference's over ours, and the
# geometric means. CSV names each clip and has the reference's bytes in the columns acl_bind_bytes (the first
# setting) and acl_loose_bytes (the second). Fails where a clip is larger than the reference's.
set -eu

build=${1:?"clip_ratio.sh BUILD CLIPS CSV"}
clips=${2:?"the folder of .rcl clips"}
csv=${3:?"a table of reference sizes"}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# column NAME: its number
column() {
    sed -n 1p "$csv" | tr ',' '\n' | grep -nx "$1" | cut -d: -f1
}
tight=$(column acl_bind_bytes)
loose=$(column acl_loose_bytes)
rate=$(column rate_hz)

# bytes FILE ERROR SHELL [OPTIONS]: of the compressed clip
bytes() {
    file=$1 error=$2 shell=$3
    shift 3
    "$build/noh" build "$file" -o "$work/clip.noh" --quiet --error-cm "$error" --shell-cm "$shell" "$@"
    "$build/noh" clip "$work/clip.noh" --json | sed -n 's/.*"bytes": \([0-9]*\).*/\1/p'
}

sed 1d "$csv" | while IFS= read -r line; do
    name=$(echo "$line" | cut -d, -f1)
    file=$clips/${name%@*}.rcl
    [ -f "$file" ] || { echo "$name: no $file" >&2; continue; }
    set --
    [ "$name" = "${name%@*}" ] || set -- --rate "$(echo "$line" | cut -d, -f"$rate")"
    echo "$name $(echo "$line" | cut -d, -f"$tight") $(bytes "$file" 0.01 3 "$@") \
        $(echo "$line" | cut -d, -f"$loose") $(bytes "$file" 0.1 10 "$@")"
done | awk '
    BEGIN { printf "%-40s %10s %8s %12s %8s\n", "", "0.01 cm/3", "ratio", "0.1 cm/10", "ratio" }
    {
        a = $2 / $3; b = $4 / $5
        printf "%-40s %10d %8.2f %12d %8.2f\n", $1, $3, a, $5, b
        sa += log(a); sb += log(b); ba += $3; bb += $5; n++
        if (n == 1 || a < wa) wa = a
        if (n == 1 || b < wb) wb = b
    }
    END {
        if (!n) { print "no clips"; exit 1 }
        printf "%-40s %10d %8.2f %12d %8.2f\n", "geometric mean of " n " (bytes: sum)", ba, exp(sa / n), bb, exp(sb / n)
        printf "%-40s %10s %8.2f %12s %8.2f\n", "worst", "", wa, "", wb
        exit !(wa >= 1 && wb >= 1)
    }'
