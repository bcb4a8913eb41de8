#!/bin/sh
# web_join.sh OUT 'NAME...' MODULE...: writes OUT, one module of several, given in the order in which they need each other.
# It exports the names. Modules import only from each other, by a line each; names at their top are all different. Lines
# that are comments stay behind.
set -eu
out=$1 names=$2
shift 2
{
    cat "$@" | sed "/^import .* from '\.\/.*';\$/d; /^export { .* } from '\.\/.*';\$/d; s/^export //; /^ *\/\/ /d"
    echo "export { $(echo "$names" | sed 's/ /, /g') };"
} >"$out.new"
if grep -n "^import \|^export default" "$out.new"; then
    echo "web_join.sh: what $out imports is not joined" >&2
    exit 1
fi
mv "$out.new" "$out"
