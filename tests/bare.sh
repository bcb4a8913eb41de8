#!/bin/sh
# bare.sh [FOLDER]: the README's commands on a minimal Debian, timed. debootstrap installs it in FOLDER (build/bare)
# with only the README's prerequisites (git, gcc and make) and a clean clone of HEAD. During the first minute of `make
# demo`, another process holds the package manager's lock. NOH_BARE_CHECK=1: then run `make check`, without NOH_ASSETS.
# Needs root and debootstrap; uses this machine's package sources. Ends like run.sh.
set -eu
cd "$(dirname "$0")/.."
build=${NOH_BUILD:-build}
root=${1:-$build/bare}
suite=$(. /etc/os-release && echo "$VERSION_CODENAME")
lock_s=${NOH_BARE_LOCK_S:-60}

leave_out() {
    echo "bare skipped: $1"
    echo '0 passed, 0 failed, 1 skipped'
    exit 0
}
command -v debootstrap >/dev/null 2>&1 || leave_out 'no debootstrap here'
[ "$(id -u)" = 0 ] || leave_out 'not root'
mirror=$(sed -n 's/^URIs: *//p; s/^deb *\(\[[^]]*\] *\)*\([^ ]*\) .*/\2/p' /etc/apt/sources.list /etc/apt/sources.list.d/* 2>/dev/null | head -n 1)
[ -n "$mirror" ] || leave_out 'no package source'

passed=0 failed=0
mkdir -p "$root"
root=$(cd "$root" && pwd)
inside() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 "$@"; }
tidy() {
    umount "$root/proc" "$root/dev/shm" 2>/dev/null || true
}
trap tidy EXIT

if [ ! -e "$root/etc/debian_version" ]; then
    debootstrap --variant=minbase --include=git,gcc,make,libc6-dev,ca-certificates "$suite" "$root" "$mirror" >"$root.log" 2>&1 || {
        tail -n 5 "$root.log"
        leave_out 'debootstrap failed'
    }
fi
# The same sources and proxies as here; package lists are not downloaded yet.
cp -r /etc/apt/sources.list* "$root/etc/apt/" 2>/dev/null || true
cp -r /etc/apt/apt.conf.d/. "$root/etc/apt/apt.conf.d/" 2>/dev/null || true
cp /etc/resolv.conf "$root/etc/resolv.conf" 2>/dev/null || true
cp /etc/hosts "$root/etc/hosts" 2>/dev/null || true
mkdir -p "$root/dev/shm" && mount -t tmpfs tmpfs "$root/dev/shm"
mount -t proc proc "$root/proc"
rm -rf "$root/root/noh"
git clone -q . "$root/root/noh"

# An fcntl lock, like apt's and dpkg's; every Debian has perl.
inside perl -e '
    open my $f, ">>", "/var/lib/dpkg/lock-frontend" or die; my $l = pack("s s x![q] q q i", 1, 0, 0, 0, 0);
    fcntl($f, 6, $l) or die "lock: $!"; sleep $ARGV[0]' "$lock_s" &

# NAME COMMAND...: run in the clone, timed.
run() {
    name=$1
    shift
    begin=$(date +%s)
    if inside sh -c 'cd /root/noh && exec "$@"' - "$@" >"$root/$name.txt" 2>&1; then
        passed=$((passed + 1)) said=
    else
        failed=$((failed + 1)) said=' FAILED'
        tail -n 20 "$root/$name.txt" | sed 's/^/    | /'
    fi
    echo "$*: $(($(date +%s) - begin)) s$said"
}
echo "a bare $suite; its package manager is busy for $lock_s s"
run demo make demo
grep -q 'CPU bytes' "$root/demo.txt" || { echo 'make demo prints no table'; failed=$((failed + 1)); }
[ -s "$root/root/noh/build/nell_faces.png" ] || { echo 'make demo makes no picture'; failed=$((failed + 1)); }
if [ -n "${NOH_BARE_CHECK:-}" ]; then
    run check make check
    tail -n 1 "$root/check.txt"
fi
echo "$passed passed, $failed failed, 0 skipped"
[ "$failed" = 0 ]
