#!/bin/sh
# demo_assets --puppet: the same bytes every time, no warning in conversion; errors of demo_assets.
. "$(dirname "$0")/lib.sh"

check 'the puppet is made' "$build/demo_assets" --puppet "$work/puppet.glb"
check 'the same bytes every time' cmp "$work/puppet.glb" "$build/demo/puppet.glb"
check 'the mask is made' "$build/demo_assets" "$work/mask.glb"
check 'and has the same bytes too' cmp "$work/mask.glb" "$build/mask.glb"
check 'the head is made' "$build/demo_assets" --nell "$work/nell.glb"
check 'with the same bytes as well' cmp "$work/nell.glb" "$build/demo/nell.glb"

noh build "$work/puppet.glb" -o "$work/puppet.noh" --plain --wrinkles face --effort 1
expect 0 'the converter takes the puppet'
check 'without a warning' sh -c '! grep -q warning "$1"' sh "$work/err"
noh info "$work/puppet.noh"
check 'two meshes, five clips' grep -q '2 meshes, 49 nodes, 1 skeleton, 5 clips' "$work/out"

for arguments in '' '--puppet' '--nell' '--arm' '--other x.glb' 'a.glb b.glb'; do
    # shellcheck disable=SC2086
    "$build/demo_assets" $arguments >"$work/out" 2>"$work/err"
    code=$?
    expect 2 "demo_assets '$arguments' is a usage error"
done
"$build/demo_assets" --puppet "$work/no/such/folder.glb" >"$work/out" 2>"$work/err"
code=$?
expect 1 'a place that cannot be written to is an error'
check 'that names it' grep -q 'cannot write .*folder.glb' "$work/err"
finish
