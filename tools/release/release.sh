#!/bin/sh
# release.sh OUT [PART...]: what a release consists of, in the folder OUT. The same sources give the same bytes, in any
# folder and at any time.
#
#   source    noh-VERSION.tar.gz: the files of the repository
#   debian    libnoh-dev, noh-tools and noh-doc, built from that archive by dpkg-buildpackage (debhelper is needed)
#   npm       noh-character-VERSION.tgz, if `make npm` has built it
#   ports     noh-VERSION-vcpkg.tar.gz and noh-VERSION-conan.tar.gz: a port and a recipe that name the archive's checksum
#   spdx      noh-VERSION.spdx: every file of the archive with its checksum and licence
#   sums      SHA256SUMS of all of these
#
# Without PART: all of them. `make release` calls it, with VERSION set. Dates are of the last commit, or of
# SOURCE_DATE_EPOCH.
set -eu
cd "$(dirname "$0")/../.."
out=$1
shift
case $out in /*) ;; *) out=$PWD/$out ;; esac
parts=${*:-source debian npm ports spdx sums}
name=noh-$VERSION
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$out"
export LC_ALL=C TZ=UTC
if [ -z "${SOURCE_DATE_EPOCH:-}" ]; then
    # A source archive is no repository: its files have the date.
    if [ -e .git ]; then SOURCE_DATE_EPOCH=$(git log -1 --format=%ct); else SOURCE_DATE_EPOCH=$(stat -c %Y CHANGELOG.md); fi
fi
export SOURCE_DATE_EPOCH

# A version is released with its heading in the CHANGELOG and its API in api.txt.
grep -q "^## $VERSION\$" CHANGELOG.md || { echo "release: CHANGELOG.md has no heading '## $VERSION'; add it" >&2; exit 1; }
[ "$(head -n 1 tools/release/api.txt)" = "noh $VERSION" ] ||
    { echo "release: tools/release/api.txt is the API of $(head -n 1 tools/release/api.txt); run 'make api-update'" >&2; exit 1; }

wants() { # PART
    case " $parts " in *" $1 "*) return 0 ;; *) return 1 ;; esac
}

# pack FOLDER OUT: a folder of $work as an archive.
pack() {
    tar -C "$work" --sort=name --mtime="@$SOURCE_DATE_EPOCH" --owner=0 --group=0 --numeric-owner --mode=u+rw,go=rX,go-w \
        -cf - "$1" | gzip -9n >"$2.new"
    mv "$2.new" "$2"
}

sum() { # FILE
    sha256sum "$1" | cut -d' ' -f1
}

archive=$out/$name.tar.gz
if wants source; then
    mkdir "$work/$name"
    if [ -e .git ]; then
        git ls-files -z
    else
        find . -type f ! -path './build*' -print0
    fi | tar --null -T - -cf - | tar -C "$work/$name" -xf -
    pack "$name" "$archive"
    rm -rf "${work:?}/$name"
fi
[ -f "$archive" ] || { echo "release: $archive is missing; make it first: release.sh $out source" >&2; exit 1; }

if wants debian; then
    if ! command -v dh >/dev/null 2>&1; then
        echo 'release: no Debian packages: debhelper is not installed' >&2
    else
        tree=$work/debian
        mkdir "$tree"
        tar -C "$tree" -xzf "$archive"
        cp -r "$tree/$name/tools/release/debian" "$tree/$name/debian"
        {
            printf 'noh (%s-1) unstable; urgency=medium\n\n  * %s of noh; the CHANGELOG says what is new.\n\n' "$VERSION" "Version $VERSION"
            printf ' -- The noh authors <noh@localhost>  %s\n' "$(date -u -R -d "@$SOURCE_DATE_EPOCH")"
        } >"$tree/$name/debian/changelog"
        (cd "$tree/$name" && dpkg-buildpackage -b -us -uc -d >"$out/debian.log" 2>&1) ||
            { tail -n 20 "$out/debian.log" >&2; echo "release: dpkg-buildpackage failed; its output is in $out/debian.log" >&2; exit 1; }
        rm -f "$out/debian.log"
        cp "$tree"/*.deb "$out"
        rm -rf "$tree"
    fi
fi

if wants npm; then
    package=${NOH_BUILD:-build}/npm/noh-character-$VERSION.tgz
    if [ -f "$package" ]; then cp "$package" "$out"; else echo "release: no npm package: 'make npm' builds $package" >&2; fi
fi

if wants ports; then
    for port in vcpkg conan; do
        mkdir "$work/$port"
        for file in tools/release/$port/*; do
            sed "s/@VERSION@/$VERSION/g; s/@SHA256@/$(sum "$archive")/g; s/@SHA512@/$(sha512sum "$archive" | cut -d' ' -f1)/g" "$file" >"$work/$port/${file##*/}"
        done
        pack "$port" "$out/$name-$port.tar.gz"
    done
fi

if wants spdx; then
    tar -C "$work" -xzf "$archive"
    (
        cd "$work/$name"
        find . -type f | sort | tr '\n' '\0' | xargs -0 sha1sum | awk '{
            file = substr($0, 43)
            id = substr(file, 3)
            gsub(/[^A-Za-z0-9.]/, "-", id)
            printf "FileName: %s\nSPDXID: SPDXRef-%s-%d\nFileChecksum: SHA1: %s\nLicenseConcluded: MIT\n", file, id, NR, $1
            printf "LicenseInfoInFile: NOASSERTION\nFileCopyrightText: NOASSERTION\n\n"
        }'
    ) >"$work/files"
    # The verification code of SPDX 2.3, 7.9: the SHA-1 of the files' sorted SHA-1s.
    code=$(sed -n 's/^FileChecksum: SHA1: //p' "$work/files" | sort | tr -d '\n' | sha1sum | cut -d' ' -f1)
    cat >"$out/$name.spdx" <<END
SPDXVersion: SPDX-2.3
DataLicense: CC0-1.0
SPDXID: SPDXRef-DOCUMENT
DocumentName: $name
DocumentNamespace: https://spdx.org/spdxdocs/$name-$(sum "$archive")
Creator: Organization: the noh authors
Created: $(date -u -d "@$SOURCE_DATE_EPOCH" +%Y-%m-%dT%H:%M:%SZ)

PackageName: noh
SPDXID: SPDXRef-Package
PackageVersion: $VERSION
PackageFileName: $name.tar.gz
PackageDownloadLocation: NOASSERTION
FilesAnalyzed: true
PackageVerificationCode: $code
PackageChecksum: SHA256: $(sum "$archive")
PackageLicenseConcluded: MIT
PackageLicenseInfoFromFiles: NOASSERTION
PackageLicenseDeclared: MIT
PackageCopyrightText: $(grep -m 1 Copyright LICENSE)
Relationship: SPDXRef-DOCUMENT DESCRIBES SPDXRef-Package

$(cat "$work/files")
END
fi

if wants sums; then
    (cd "$out" && ls | grep -v '^SHA256SUMS' | sort | xargs sha256sum) >"$out/SHA256SUMS.new"
    mv "$out/SHA256SUMS.new" "$out/SHA256SUMS"
    cat "$out/SHA256SUMS"
fi
