#!/bin/sh
# check_ci.sh: .ci/run with a make that does nothing: which stages run, in which order, and what they add up to.
. "$(dirname "$0")/cli/lib.sh"

mkdir "$work/bin"
cat >"$work/bin/make" <<'END'
#!/bin/sh
echo "$1" >>"$CALLS"
[ "$1" != "$FAILS" ] || exit 2
[ "$1" = check-build ] || echo '3 passed, 0 failed, 1 skipped'
END
chmod +x "$work/bin/make"

# run FAILS STAGE...: $called has what make was called for, $said the last line
run() {
    fails=$1
    shift
    : >"$work/calls"
    env -u NOH_LONG DEPS=0 PATH="$work/bin:$PATH" CALLS="$work/calls" FAILS="$fails" .ci/run "$@" >"$work/log" 2>&1
    code=$?
    called=$(tr '\n' ' ' <"$work/calls") said=$(tail -n 1 "$work/log")
}
is() { test "$called|$said|$code" = "$1|$2|$3"; }

run none build
check 'a stage alone' is 'check-build ' '1 passed, 0 failed, 0 skipped' 0
run none check web
check 'stages add up, the one in the background, too' test "$said" = '7 passed, 0 failed, 2 skipped'
check 'the build comes before them' sh -c 'head -n 1 "$1" | grep -qx check-build && test "$(wc -l <"$1")" = 3' - "$work/calls"
run check-build check web
check 'without a build, no stage is in the background' is 'check-build check web-check ' '6 passed, 1 failed, 2 skipped' 1
run web-check web
check 'a stage that fails is one failure' is 'web-check ' '0 passed, 1 failed, 0 skipped' 1
run none chek phones
check 'names without a stage are failures' is '' '0 passed, 2 failed, 0 skipped' 1
check 'which are named' grep -q "no stage 'chek'" "$work/log"
finish
