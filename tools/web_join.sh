#!/bin/sh
# web_join.sh OUT 'NAME...' MODULE...: writes OUT, one module of several, given in the order in which they need each other.
# It exports the names. Modules import only from each other, by a line each; names at their top are all different. Made
# small by web_small.sh.
set -eu
out=$1 names=$2
shift 2
{
    cat "$@" | sed "/^import .* from '\.\/.*';\$/d; /^export { .* } from '\.\/.*';\$/d; s/^export //"
    echo "export { $(echo "$names" | sed 's/ /, /g') };"
} >"$out.new"
if grep -n "^import \|^export default" "$out.new"; then
    echo "web_join.sh: what $out imports is not joined" >&2
    exit 1
fi
sh "$(dirname "$0")/web_small.sh" <"$out.new" >"$out.small"
mv "$out.small" "$out"
rm "$out.new"
