#!/bin/sh
# check_rooms.sh: the rooms of runtime/, the public headers in runtime/noh, and the order in which they include and call.
#   - a room includes and calls only itself and the rooms in front of it (tools/docs/rooms.sh order); each public header
#     belongs to a room (tools/docs/rooms.sh headers)
#   - public headers include nothing private; private ones end in _internal.h or _template.h, and name themselves
#   - the folders of all rooms have an order, too: no two include each other, however indirectly
#   - comments and help name headers that exist
#   - GL headers are included in gl/ alone; nothing else from outside but the compiler's own headers
#   - a folder has at most fifty files
#   - each README's picture is what the code calls, and the README is a page
. "$(dirname "$0")/cli/lib.sh"
order=$(sh tools/docs/rooms.sh order)
echo "# rooms: $order"
find runtime -mindepth 1 -maxdepth 1 -type d ! -name noh | sed 's|.*/||' | sort >"$work/found"
echo "$order" | tr ' ' '\n' | sort >"$work/listed"
check 'every folder of runtime/ is a room of the list' cmp "$work/found" "$work/listed"

# ROOM/FOLDER INCLUDED for each include of the library's own.
grep -n '^ *# *include *"' runtime/*/*.[ch] runtime/*/*/*.[ch] 2>/dev/null |
    sed 's|^runtime/\([^:]*\)/[^/:]*:.*"\([^"]*\)".*|\1 \2|' | sort -u >"$work/includes"
grep -v '^noh ' "$work/includes" | awk '$2 !~ "^([a-z]+/[a-z]+|noh)/[a-z0-9_]+[.]h$" && $2 != "shaders.gen.h"' >"$work/unnamed"
check 'includes name room, folder and file' sh -c '! grep . "$1"' - "$work/unnamed"
grep '^noh ' "$work/includes" | grep -v ' [a-z0-9_]*\.h$' >"$work/private"
check 'public headers include nothing private' sh -c '! grep . "$1"' - "$work/private"
awk '$1 != "noh" && $2 ~ "/" && $2 !~ "^noh/" { sub("/[^/]*$", "", $2); if ($1 != $2) print $2, $1 }' "$work/includes" |
    sort -u >"$work/folders"
check 'the includes were read' grep -q '^core/base gl/draw$' "$work/folders"

# Public headers by room: what is included, what they include, and what is called.
sh tools/docs/rooms.sh headers >"$work/headers"
sed 's/ .*//; s|.*|runtime/noh/&.h|' "$work/headers" | sort >"$work/listed"
find runtime/noh -name '*.h' | sort >"$work/found"
check 'every public header has a room' cmp "$work/found" "$work/listed"
{
    sed -n 's|^\([^ ]*\) noh/\(.*\)\.h$|\1 \2|p' "$work/includes" | grep -v '^noh '
    for header in runtime/noh/*.h; do
        name=$(basename "$header" .h)
        sed -n "s|^ *# *include *\"\\(.*\\)\\.h\"|$name \\1|p" "$header"
    done
} | awk 'NR == FNR { room[$1] = $2; next } { from = $1 in room ? room[$1] : $1; sub("/.*", "", from); print room[$2], from }' "$work/headers" - |
    sort -u >"$work/by_header"
check 'public headers are included' grep -q '^core stage$' "$work/by_header"
sh tools/docs/rooms.sh calls | awk '{ split($1, a, "/"); split($2, b, "/"); print b[1], a[1] }' | sort -u >"$work/by_call"
check 'calls are found' grep -q '^core stage$' "$work/by_call"
awk -v order="$order" '
    BEGIN { n = split(order, room, " "); for (i = 1; i <= n; i++) rank[room[i]] = i }
    { split($1, a, "/"); split($2, b, "/"); if (rank[a[1]] > rank[b[1]]) print $2 " uses " $1 }' \
    "$work/folders" "$work/by_header" "$work/by_call" >"$work/upward"
check 'a room includes and calls only the rooms in front of it' sh -c '! grep . "$1"' - "$work/upward"
tsort "$work/folders" >"$work/order" 2>"$work/circles"
check 'no folders include each other in a circle' sh -c '! grep . "$1"' - "$work/circles"
echo "# folders, each including only from those before it: $(tr '\n' ' ' <"$work/order")"

# The compiler's own headers, memcpy's, and SIMD intrinsics.
grep -Hn '^ *# *include *<' runtime/*/*.[ch] runtime/*/*/*.[ch] 2>/dev/null |
    grep -v '<\(stddef\|stdint\|float\|string\|emmintrin\|immintrin\|arm_neon\)\.h>' >"$work/system"
check 'only gl/ includes GL headers, nothing else is included' sh -c '! grep -v "^runtime/gl/.*<GLES[23]*/" "$1"' - "$work/system"

find runtime -name '*.h' ! -path 'runtime/noh/*' | grep -v '_internal\.h$\|_template\.h$' >"$work/public_looking"
check 'private headers end in _internal.h or _template.h' sh -c '! grep . "$1"' - "$work/public_looking"
find runtime tools tests platform -name '*.h' | while read -r header; do
    sed -n "1s|^/\* \([a-z0-9_]*\.h\):.*|\1|p" "$header" | grep -vx "$(basename "$header")" | sed "s|^|$header says |"
done >"$work/misnamed"
check 'a header that begins with a name begins with its own' sh -c '! grep . "$1"' - "$work/misnamed"
find runtime tools platform tests -name '*.[ch]' | sed 's|.*/||' | sort -u >"$work/files"
find runtime tools platform tests -name '*.[ch]' -o -name '*.cpp' | xargs grep -noE '\(([a-z]+/)*[a-z0-9_]+\.h\)' |
    awk -F: 'NR == FNR { known[$0]; next } { name = $3; gsub("[()]|.*/", "", name); if (!(name in known)) print }' "$work/files" - |
    grep -v ':(\(std[a-z]*\|math\|float\|errno\)\.h)' >"$work/unknown"
check 'a comment that points to a header names one that exists' sh -c '! grep . "$1"' - "$work/unknown"

for folder in runtime/*/*/; do
    [ "$(find "$folder" -type f | wc -l)" -le 50 ] || echo "$folder: $(find "$folder" -type f | wc -l) files"
done >"$work/full"
check 'a folder has at most fifty files' sh -c '! grep . "$1"' - "$work/full"

check 'the pictures in the READMEs are what the code calls' sh tools/docs/rooms.sh check
for room in '' $order; do
    readme=runtime/${room:+$room/}README.md
    [ "$(wc -l <"$readme")" -le 90 ] && [ "$(wc -c <"$readme")" -le 9000 ] || echo "$readme"
done >"$work/long"
check 'each README of a room is a page' sh -c '! grep . "$1"' - "$work/long"
finish
