#!/bin/sh
# headers.sh: the public headers, one path a line below runtime/, each after what it includes. They are installed and
# documented; every other header is private.
set -eu
cd "$(dirname "$0")/../runtime"
seen=' '
visit() {
    case $seen in *" $1 "*) return 0 ;; esac
    seen="$seen$1 "
    # The names first: the loop below calls this function again.
    for include in $(sed -n 's/^ *# *include *"\([^"]*\)".*/\1/p' "noh/$1"); do
        visit "$include"
    done
    echo "noh/$1"
}
for header in noh/*.h; do
    visit "${header#noh/}"
done
