# lib.sh: shared by the test scripts. Each begins with `. "$(dirname "$0")/lib.sh"` or `. tests/cli/lib.sh`, reports its
# results with these functions and ends with `finish`.
#
#   noh ARGUMENTS        run the program: $code, $work/out, $work/err
#   expect CODE NAME     the last run had this exit code and no sanitizer report
#   says TEXT            ... and its stderr contains TEXT (fixed string), in one line from `noh: `
#   check NAME COMMAND   the command succeeds
#   skip NAME REASON
set -u
build=${NOH_BUILD:-build}
assets=${NOH_ASSETS:-}
work=$(mktemp -d "${TMPDIR:-/tmp}/noh_cli_XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
export NOH_CACHE="$work/cache"
tests=0 failures=0 code=0

ok() {
    tests=$((tests + 1))
    echo "ok $tests - $1"
}

not_ok() {
    tests=$((tests + 1)) failures=$((failures + 1))
    echo "not ok $tests - $1"
}

skip() {
    tests=$((tests + 1))
    echo "SKIP: $1: $2"
    echo "ok $tests - $1 # SKIP $2"
}

noh() {
    "$build/noh" "$@" >"$work/out" 2>"$work/err"
    code=$?
}

show() {
    echo "# exit code $code, stderr:"
    sed 's/^/#   /' "$work/err" | head -n 20
}

expect() {
    if [ "$code" = "$1" ] && ! grep -q 'Sanitizer\|runtime error' "$work/err"; then
        ok "$2"
    else
        not_ok "$2 (exit code $code, wanted $1)"
        show
    fi
}

says() {
    if grep -F -q -- "$1" "$work/err" && grep -q '^noh: ' "$work/err"; then
        ok "and says '$1'"
    else
        not_ok "and says '$1'"
        show
    fi
}

check() {
    checked=$1
    shift
    if "$@" >"$work/check" 2>&1; then
        ok "$checked"
    else
        not_ok "$checked"
        head -n 20 "$work/check" | sed 's/^/#   /'
    fi
}

# Set $json to a command that reads an object j from stdin as JSON, evaluates an expression on it and succeeds if it is
# true. Empty if no such command is available.
json=
if command -v node >/dev/null 2>&1; then
    json=json_node
elif command -v python3 >/dev/null 2>&1; then
    json=json_python
fi
json_node() {
    node -e 'const j = JSON.parse(require("fs").readFileSync(0, "utf8")); process.exit(eval(process.argv[1]) ? 0 : 1)' "$1"
}
# The subset of expressions used by the scripts: j.a.b, j.a[0].b, ===, !==, &&, null
json_python() {
    python3 -c '
import json, sys
class D(dict):
    __getattr__ = dict.__getitem__
j = json.load(sys.stdin, object_hook=D)
e = sys.argv[1].replace("!==", "!=").replace("===", "==").replace("&&", " and ").replace("true", "True").replace("false", "False").replace("null", "None")
sys.exit(0 if eval(e) else 1)' "$1"
}

finish() {
    echo "1..$tests"
    [ $failures = 0 ]
    exit
}
