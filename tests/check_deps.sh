#!/bin/sh
# check_deps.sh: tools/deps.sh with a fake apt-get, which installs nothing: another process holds apt's lock,
# unavailable packages, errors.
. tests/cli/lib.sh

# Each call is a line of $work/calls. While there are lines in $work/says, a call prints the first and fails.
mkdir "$work/bin"
cat >"$work/bin/apt-get" <<END
#!/bin/sh
echo "\$*" >>"$work/calls"
line=\$(head -n 1 "$work/says")
sed -i 1d "$work/says"
[ -z "\$line" ] || { echo "\$line" >&2; exit 100; }
END
printf '#!/bin/sh\n' >"$work/bin/dpkg-query" # nothing is installed
printf '#!/bin/sh\necho 0\n' >"$work/bin/id"
printf '#!/bin/sh\n' >"$work/bin/sleep"
# A hundred seconds pass between two looks at the clock.
printf '#!/bin/sh\necho . >>"%s"\necho $(($(wc -l <"%s") * 100))\n' "$work/clock" "$work/clock" >"$work/bin/date"
chmod +x "$work"/bin/*

deps() { # LINE THAT APT-GET SAYS, OR NOTHING...
    : >"$work/calls" >"$work/says" >"$work/clock"
    for line in "$@"; do echo "$line" >>"$work/says"; done
    PATH="$work/bin:$PATH" sh tools/deps.sh web >"$work/out" 2>"$work/err"
    code=$?
}
calls() {
    grep -c -- "$1" "$work/calls"
}
lock='E: Could not get lock /var/lib/apt/lists/lock. It is held by process 7 (apt-get)'

deps
expect 0 'installs what is missing'
check 'what must be there by name' grep -q 'install -y --no-install-recommends .*libcmocka-dev' "$work/calls"
check 'what may be there in one call' test "$(calls dpkg-dev)" = 1

deps "$lock" "$lock"
expect 0 'waits for the lock of the package lists'
check 'by trying again' test "$(calls update)" = 3
deps '' 'E: Could not get lock /var/cache/apt/archives/lock. It is held by process 7 (apt-get)'
expect 0 'and for the lock of the archives'
deps "$lock" "$lock" "$lock" "$lock" "$lock" "$lock"
expect 1 'for five minutes'
check 'and says who holds it' grep -q 'process 7' "$work/err"

deps '' 'E: Unable to locate package libcmocka-dev'
expect 1 'does not go on without what must be there'
check 'does not try again' test "$(calls libcmocka-dev)" = 1
check 'and says why' grep -q 'Unable to locate package libcmocka-dev' "$work/err"

deps '' '' 'E: Unable to locate package dpkg-dev' 'E: Unable to locate package'
expect 0 'goes on without what may be missing'
check 'tries the others one by one' test "$(calls dpkg-dev)" -ge 1 -a "$(wc -l <"$work/calls")" -ge 4
check 'and says what is left out' grep -q 'is not available: what needs it is left out' "$work/out"
finish
