#!/bin/sh
# check_api.sh: the public headers against the API of the last release, tools/release/api.txt. Within a minor version
# nothing that it lists may be gone or changed; a new minor version may change it, and prints how much.
. tests/cli/lib.sh
export LC_ALL=C
table=tools/release/api.txt
if ! command -v perl >/dev/null 2>&1; then
    skip 'the API' 'no perl here'
    finish
fi
released=$(sed -n '1s/^noh //p' "$table")
version=$(sed -n 's/^#define NOH_VERSION "\(.*\)"/\1/p' runtime/noh/base.h)
check 'the table names its version' test -n "$released"
check 'the headers are read' sh -c 'sh tools/release/api.sh >"$1/now" && [ "$(grep -c "^function .*noh_stage_" "$1/now")" -ge 20 ]' - "$work"
check 'nothing but declarations is printed' sh -c '! grep -v "^function .*noh_\|^macro NOH_\|^member \|^enumerator \|^type \|^variable .*noh_" "$1/now"' - "$work"

# gone OLD NEW: the lines of file OLD that file NEW does not have
gone() {
    sort "$1" >"$work/before" && sort "$2" >"$work/after" && comm -23 "$work/before" "$work/after"
}
tail -n +2 "$table" >"$work/released"
grep -v '^function .*noh_stage_spawn(' "$work/now" >"$work/less"
check 'a function that is gone would be seen' sh -c '[ "$(wc -l <"$1")" = 1 ]' - "$(gone "$work/now" "$work/less" >"$work/seen"; echo "$work/seen")"
gone "$work/released" "$work/now" >"$work/broken"
if [ "${released%.*}" = "${version%.*}" ]; then
    check "$version has all of $released's API, or the minor version has to rise" sh -c '! grep . "$1"' - "$work/broken"
else
    ok "$version may change $released's API: $(wc -l <"$work/broken") lines are gone or changed"
fi
finish
