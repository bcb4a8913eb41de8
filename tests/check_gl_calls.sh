#!/bin/sh
# check_gl_calls.sh: the GL functions that a port has to provide.
#   - NOH_GL_REQUIRED (runtime/noh/gl_device.h) lists exactly the functions that runtime/ calls
#   - an optional function that runtime/ calls is compared with NULL somewhere
#   - only code that creates programs calls GetUniformLocation: draws use the locations it found
#   - platform/README.md has the same list, and the page implements each function (platform/web/package/gl.js)
set -u
. tests/cli/lib.sh
header=runtime/noh/gl_device.h

find runtime -name "*.c" -exec cat {} + >"$work/sources"

# The fields of a list in the header.
fields() {
    awk -v list="#define $1(X)" 'index($0, list) == 1 { on = 1; next } on { print } on && !/\\$/ { exit }' $header |
        sed -n 's/.*X(\([A-Za-z0-9_]*\),.*/\1/p' | sort -u
}
fields NOH_GL_REQUIRED >"$work/required"
fields NOH_GL_EXTRA >"$work/extra"
fields NOH_GL_OPTIONAL >"$work/optional"

# gl->DrawArrays(, api->..., m->gl->..., p->api->...
cat "$work/sources" | grep -oE '(gl|api)->[A-Z][A-Za-z0-9_]*\(' | sed 's/.*->//; s/(//' | sort -u >"$work/called"
comm -23 "$work/called" "$work/optional" >"$work/core"

check 'the lists were read' test "$(wc -l <"$work/required")" -gt 50 -a "$(wc -l <"$work/called")" -gt 50
echo "# the library calls $(wc -l <"$work/core") functions of ES 3.0, and $(comm -12 "$work/called" "$work/optional" | wc -l) more where they exist"
comm -23 "$work/core" "$work/required" >"$work/forgotten"
check 'all that is called is required (else move it to NOH_GL_REQUIRED)' sh -c '! grep . "$1"' - "$work/forgotten"
comm -13 "$work/core" "$work/required" >"$work/idle"
check 'all that is required is called (else move it to NOH_GL_EXTRA)' sh -c '! grep . "$1"' - "$work/idle"
comm -12 "$work/required" "$work/extra" >"$work/twice"
check 'no function is in both lists' sh -c '! grep . "$1"' - "$work/twice"
comm -12 "$work/called" "$work/optional" | while read -r name; do
    cat "$work/sources" | grep -qE "!(gl|api)->$name\>" || echo "$name"
done >"$work/unasked"
check 'optional functions are compared with NULL before they are called' sh -c '! grep . "$1"' - "$work/unasked"

cat >"$work/finders" <<'END'
runtime/gl/device/gl_caps.c
runtime/gl/device/gl_program.c
runtime/gl/draw/gl_shadow.c
runtime/gl/draw/gl_variants.c
runtime/gl/morph/gl_morph_blend.c
runtime/gl/morph/gl_morph_shared.c
runtime/gl/stage/drawable.c
END
grep -rlE '>GetUniformLocation\(' --include='*.c' runtime | sort >"$work/finding"
check 'uniforms are found where programs are created, never in a draw' cmp "$work/finders" "$work/finding"

awk '/^<!-- required -->/ { on = 1; next } /^<!-- end -->/ { on = 0 } on' platform/README.md |
    grep -oE 'gl[A-Z][A-Za-z0-9_]*' | sed 's/^gl//' | sort -u >"$work/documented"
check 'platform/README.md lists them' cmp "$work/required" "$work/documented"
# Gen and Delete functions of lists are named by template there: `glGen${what}`. Strings are C's.
grep -v '^ *//' platform/web/package/gl.js | cat - platform/web/context.c >"$work/page"
while read -r name; do
    case $name in Gen*s) part=${name#Gen} ;; Delete*s) part=${name#Delete} ;; *) part=$name ;; esac
    grep -qE "\<(gl)?($name|$part)\>" "$work/page" || echo "$name"
done <"$work/required" >"$work/not_on_the_page"
check 'the page has them (platform/web/package/gl.js)' sh -c '! grep . "$1"' - "$work/not_on_the_page"
finish
