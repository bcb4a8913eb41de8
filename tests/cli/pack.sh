#!/bin/sh
# noh pack: packs survive the round trip, other verbs read the wire form, rounded packs look the same, refused input,
# outputs that cannot be written.
. "$(dirname "$0")/lib.sh"

pack=$build/mask.noh full=$build/mask_levels.noh

# ---- there and back ----

noh pack "$pack" -o "$work/mask.nohz"
expect 0 'pack'
check 'reports the bytes' grep -q "mask.nohz: [0-9]* bytes of [0-9]*, unpacked in a block of" "$work/out"
check 'smaller than a half' test "$(wc -c <"$work/mask.nohz")" -lt $(($(wc -c <"$pack") / 2))
noh strip "$work/mask.nohz" -o "$work/mask.noh" --from-level 0 --quiet
expect 0 'another verb reads it'
check 'the pack comes back to the byte' cmp "$work/mask.noh" "$pack"
noh pack "$work/mask.nohz" -o "$work/again.nohz" --quiet
expect 0 'pack what is packed'
check 'the same bytes again' cmp "$work/again.nohz" "$work/mask.nohz"
check 'quietly' test ! -s "$work/out"
noh pack "$full" -o "$work/levels.nohz"
expect 0 'pack LOD levels'
check 'the coarsest come first' grep -q 'the coarsest levels first (a pack of' "$work/out"
check 'says that tangents are left out' grep -q "^mesh 'mask': no material needs tangents" "$work/out"
noh pack "$full" -o "$work/kept.nohz" --keep-tangents --at-once
expect 0 '--keep-tangents --at-once'
check 'at once' sh -c '! grep -q "coarsest" "$1"' - "$work/out"
noh strip "$work/kept.nohz" -o "$work/kept.noh" --from-level 0 --quiet
check 'all of it comes back' cmp "$work/kept.noh" "$full"

# ---- rounded ----

noh pack "$full" -o "$work/ten.nohz" --error-um 10 --json
expect 0 '--error-um 10'
check 'moved by at most that' sh -c 'tr , "\n" <"$1" | sed -n "s/.*\"moved_um\": *//p" | awk "\$1 > 10 || \$1 < 1 { bad = 1 } END { exit bad || !NR }"' - "$work/out"
check 'about half of what it is as it is' test "$(wc -c <"$work/ten.nohz")" -lt $(($(wc -c <"$work/levels.nohz") * 2 / 3))
noh verify "$work/ten.nohz"
expect 0 'verify'
for verb in budget info; do
    noh $verb "$work/ten.nohz"
    expect 0 "$verb"
done
noh render "$full" -o "$work/full.png" --size 160x180 --weight smile=1
noh render "$work/ten.nohz" -o "$work/ten.png" --size 160x180 --weight smile=1
expect 0 'render'
check 'nearly the same picture' "$build/tests/gl/picture_diff" "$work/full.png" "$work/ten.png" 0.3 0.005

# ---- refused ----

head -c 20000 "$work/mask.nohz" >"$work/cut.nohz"
noh info "$work/cut.nohz"
expect 1 'a file that was cut short'
says 'the wire form was cut short'
check 'and prints nothing' test ! -s "$work/out"
head -c 40 "$work/mask.nohz" >"$work/head.nohz"
noh info "$work/head.nohz"
expect 1 'half a header'
says 'shorter than its header'
{ head -c 30000 "$work/mask.nohz"; printf 'XXXX'; tail -c +30005 "$work/mask.nohz"; } >"$work/damaged.nohz"
noh info "$work/damaged.nohz"
expect 1 'a damaged file'
says 'checksum of a block of the wire form is wrong'
{ cat "$work/mask.nohz"; echo more; } >"$work/longer.nohz"
noh info "$work/longer.nohz"
expect 1 'bytes behind the end'
says 'follow the end'
noh pack "$pack" -o "$work/no.nohz" --error-um -1
expect 2 'a bound below 0'
says '--error-um must be'
check 'nothing is written' test ! -e "$work/no.nohz"
noh pack "$pack" -o "$work/no/such/folder.nohz"
expect 1 'a folder that is not there'
says 'cannot write'

noh bench "$build/mask.noh" --only wire --quick --json
if [ $code != 0 ] && grep -q 'no GL context' "$work/err"; then
    skip 'what unpacking costs' 'no GL context here'
    finish
fi
expect 0 'what unpacking costs'
check 'against copying' grep -q '"baseline": "memcpy"' "$work/out"
finish
