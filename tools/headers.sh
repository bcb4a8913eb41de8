#!/bin/sh
# headers.sh HEADER...: these headers of runtime/ and all that they include from there, one path a line, each after what
# it includes. What noh.h and noh_gl.h reach is public: it is installed, documented and in the amalgam, and nothing else is.
# Headers that are not there are left out, so that noh_gl.h may be named before it exists.
set -eu
cd "$(dirname "$0")/../runtime"
seen=' '
visit() {
    case $seen in *" $1 "*) return 0 ;; esac
    seen="$seen$1 "
    # The names first: the loop below calls this function again.
    for include in $(sed -n 's/^ *# *include *"\([^"]*\)".*/\1/p' "$1"); do
        [ ! -f "$include" ] || visit "$include"
    done
    echo "$1"
}
for header in "$@"; do
    [ ! -f "$header" ] || visit "$header"
done
