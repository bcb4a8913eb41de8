#!/bin/sh
# check_packages.sh [FOLDER]: the Debian packages as somebody else has them. They are built twice, in two folders, with
# the same bytes; lintian has nothing to say; in a minimal Debian they are installed, a program is compiled with them and
# run, and they are removed without a trace.
#
# `make release-check` calls it, with VERSION set. FOLDER (build/release) may hold the packages of `make release`: then
# one build is left to do. Needs root, debhelper, lintian, debootstrap and a package source; two whole builds (ten
# minutes of a processor each), 1 GB of disk. NOH_CHROOT=DIR: a minimal Debian that is there already. Prints TAP.
set -u
cd "$(dirname "$0")/../.." || exit 1
. tests/cli/lib.sh
out=${1:-$build/release}
chroot=${NOH_CHROOT:-$work/chroot}
for tool in dh lintian debootstrap; do
    command -v $tool >/dev/null 2>&1 || { skip 'Debian packages' "no $tool here"; finish; }
done
[ "$(id -u)" = 0 ] || { skip 'Debian packages' 'not root'; finish; }

# ---- the same bytes, and lintian ----

packages() { ls "$1"/*.deb 2>/dev/null; }
[ -n "$(packages "$out")" ] || sh tools/release/release.sh "$out" source debian >"$work/out" 2>&1
names='libnoh-dev noh-tools noh-doc'
for name in $names; do check "$name" test -s "$(packages "$out" | grep "/${name}_")"; done
# Of the same archive, with the same date, in another folder.
mkdir "$work/again"
cp "$out/noh-$VERSION.tar.gz" "$work/again"
sh tools/release/release.sh "$work/again" debian >"$work/out" 2>&1
for package in $(packages "$out"); do
    check "${package##*/}: the same bytes from another folder" cmp "$package" "$work/again/${package##*/}"
done
# Tags that are left out: this source has never been uploaded, so there is no bug to close; and it names no mailbox,
# which is for the one who uploads it.
left_out=initial-upload-closes-no-bugs,bogus-mail-host,bogus-mail-host-in-debian-changelog
check 'lintian has nothing to say' sh -c '! lintian --no-cfg --allow-root --fail-on none --suppress-tags "$2" "$1"/*.deb | grep .' \
    - "$out" "$left_out"

# ---- installed, used, removed ----

if [ ! -e "$chroot/etc/debian_version" ]; then
    mirror=$(sed -n 's/^URIs: *//p; s/^deb *\(\[[^]]*\] *\)*\([^ ]*\) .*/\2/p' /etc/apt/sources.list /etc/apt/sources.list.d/* 2>/dev/null | head -n 1)
    check 'a minimal Debian' debootstrap --variant=minbase "$(. /etc/os-release && echo "$VERSION_CODENAME")" "$chroot" "$mirror"
fi
cp -r /etc/apt/apt.conf.d/. "$chroot/etc/apt/apt.conf.d/" 2>/dev/null
cp /etc/resolv.conf /etc/hosts "$chroot/etc/" 2>/dev/null
rm -rf "$chroot/packages"
mkdir "$chroot/packages"
for name in $names; do cp "$out/${name}"_*.deb "$chroot/packages"; done
cp tools/release/debian/tests/first-program "$chroot/packages"
inside() { chroot "$chroot" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
    ${http_proxy:+http_proxy="$http_proxy"} "$@"; }
# Everything but what programs keep for themselves: dpkg's state, logs and caches.
files() { (cd "$chroot" && find . -xdev \( -path ./packages -o -path ./proc -o -path ./sys -o -path ./var/lib/dpkg -o -path ./var/lib/apt \
    -o -path ./var/log -o -path ./var/cache -o -path ./tmp -o -path ./root \) -prune -o -print | sort); }
needs=$(for package in "$chroot"/packages/*.deb; do dpkg-deb -f "$package" Depends; done | tr ',' '\n' |
    sed 's/^ *//; s/[ (|].*//; /^$/d' | sort -u | tr '\n' ' ')
check 'what they need is there' inside sh -c "apt-get update -qq && apt-get install -y -qq --no-install-recommends gcc libc6-dev pkg-config $needs"
files >"$work/before"
check 'they are installed' inside sh -c 'dpkg -i /packages/*.deb'
check 'a program is built with them and runs' inside sh /packages/first-program
check 'they are removed' inside dpkg -P $names
files >"$work/after"
check 'no file is left' diff "$work/before" "$work/after"
finish
