#!/bin/sh
# budgets.sh: the exact bytes of the demo's packs and of stages with each feature, part by part. Any change is a
# difference to tests/golden/budgets.txt, visible in review.
#
#   budgets.sh           compare (in `make check`), TAP
#   budgets.sh update    rewrite the table (`make budgets-update`)
#
# The GPU is a nominal GLES 3.2 device, so that no driver counts. Rows apply to packs with the checksums in the table;
# rows of other packs are skipped with a message.
set -u
cd "$(dirname "$0")/.." || exit 1
build=${NOH_BUILD:-build}
case $build in /*) ;; *) build=$PWD/$build ;; esac
table=tests/golden/budgets.txt
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT

# PACK NAME OPTIONS...: the lines "PACK CHECKSUM NAME: PART CPU GPU", tabs between
rows() {
    pack=$1 name=$2
    shift 2
    file=$build/$pack
    [ -f "$file" ] || return
    sum=$(cksum <"$file" | cut -d' ' -f1)
    case " $* " in *' --no-gpu '*) ;; *) set -- --nominal "$@" ;; esac
    case " $* " in *' --desc '*) ;; *) set -- "$file" "$@" ;; esac
    if ! "$build/noh" budget "$@" >"$work/out" 2>"$work/err"; then
        printf '%s\t%s\t%s\tfailed: %s\n' "$pack" "$sum" "$name" "$(head -n 1 "$work/err")"
        return
    fi
    awk -v head="$pack	$sum	$name" '/^  [a-z].* [0-9]+ +[0-9]+$/ {
        gpu = $NF; cpu = $(NF - 1); $NF = ""; $(NF - 1) = ""; sub(/^ +/, ""); sub(/ +$/, ""); print head "\t" $0 "\t" cpu "\t" gpu }' "$work/out"
}

# NAME SETTINGS: twenty puppets with these settings of a kind
cast() {
    printf 'kind cast\nmesh %s\nactor_count 20\n%b\n' "$build/demo/puppet_levels.noh" "$2" >"$work/cast.txt"
    rows demo/puppet_levels.noh "twenty, $1" --desc "$work/cast.txt"
}

all() {
    for path in cpu mrt layered per-layer gather direct streams; do rows mask.noh "alone, $path, f32" --path $path --accumulate f32; done
    rows mask.noh 'alone, mrt, f16' --path mrt --accumulate f16
    rows demo/nell.noh 'alone, mrt, f16' --path mrt --accumulate f16
    rows wig.noh 'with hair' --path cpu --accumulate f32
    rows demo/puppet.noh 'with springs' --path cpu --accumulate f32
    rows mask_far.noh 'a hundred far heads' --actors 100
    rows demo/puppet_levels.noh 'twenty actors' --actors 20
    rows demo/puppet_levels.noh 'twenty in 2 MiB' --actors 20 --bytes 2097152
    rows demo/puppet_levels.noh 'twenty, four jobs' --actors 20 --jobs 4
    cast 'faces' 'face 0.03 1.45 0.08 -0.03 1.45 0.08'
    cast 'graphs' 'graphs "*"'
    cast 'inertia' 'inertia 1'
    cast 'root motion' 'root_axes ground'
    cast 'one layer of one track' 'layer body tracks=1'
    printf 'motion 1\nsort_blended 1\nkind cast\nmesh %s\nactor_count 20\n' "$build/demo/puppet_levels.noh" >"$work/cast.txt"
    rows demo/puppet_levels.noh 'twenty, motion, sorted' --desc "$work/cast.txt"
    rows demo/puppet_levels.noh 'a hundred' --actors 100
    rows demo/puppet_levels.noh 'twenty without GPU' --actors 20 --no-gpu
    rows demo/puppet_levels.noh 'twenty, four fall' --actors 20 --ragdolls 4
    rows demo/puppet_levels.noh 'a festival of six hundred' --actors 600 --place tools/demo_assets/festival/festival.place --ragdolls 16
}

all >"$work/now"
if [ "${1:-}" = update ]; then
    ! grep 'failed:' "$work/now" && cp "$work/now" "$table" && echo "$table is written"
    exit
fi
# If the table has a pack with this checksum, its lines must be equal.
awk -F '\t' -v table="$table" '
    BEGIN { while ((getline line < table) > 0) { split(line, f, "\t"); known[f[1] FS f[2]] = 1; wanted[line] = 1; of[line] = f[1] FS f[2] } }
    { here[$1 FS $2] = 1; seen[$0] = 1
      if (!(($1 FS $2) in known)) { skipped[$1] = 1; next }
      if (!($0 in wanted)) { print "now  " $0; bad = 1 } }
    END { for (line in wanted) if ((of[line] in here) && !(line in seen)) { print "then " line; bad = 1 }
          for (pack in skipped) print "skip " pack
          exit bad }' "$work/now" >"$work/differences"
status=$?
if [ $status != 0 ]; then
    echo "not ok 1 - budgets equal $table"
    grep -v '^skip' "$work/differences" | sort -k2 | sed 's/^/# /'
    echo '# if that is meant: make budgets-update'
else
    echo "ok 1 - budgets equal $table"
fi
if grep -q '^skip' "$work/differences"; then
    echo "SKIP: $(sed -n 's/^skip //p' "$work/differences" | tr '\n' ' ')came out with other bytes than in the table"
    echo 'ok 2 - every pack is in the table # SKIP packs came out with other bytes here'
else
    echo 'ok 2 - every pack is in the table'
fi
echo '1..2'
exit $status
