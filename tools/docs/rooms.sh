#!/bin/sh
# rooms.sh: the order of the rooms of runtime/, and the pictures in their READMEs, drawn from what the code calls.
#
#   rooms.sh order       the rooms, in the order in which they may include and call
#   rooms.sh headers     "HEADER ROOM" for each public header: the room that implements it
#   rooms.sh calls       "FOLDER FOLDER" for each folder that calls functions of another one
#   rooms.sh graph       Mermaid: the rooms, and which of them each calls
#   rooms.sh graph ROOM  Mermaid: the folders of a room, and the rooms that they call
#   rooms.sh check       exit 1 and a line for each README whose picture is not what the code calls
#   rooms.sh update      puts the pictures into the READMEs
#
# An arrow points to what is called. Where A calls B, and B calls C, the arrow from A to C is left out.
set -eu
cd "$(dirname "$0")/../.."
order='core motion deform life stage gl'

headers='base core  format core  pack core  low_core core
    clip motion  graph motion  low_motion motion
    deform deform
    face life  body life  low_life life
    noh stage  modules stage  marks stage  crowd stage  low_stage stage
    light gl  gl_device gl  noh_gl gl  low_gl gl  noh_low gl'

# "FOLDER FOLDER": the first calls a function, or reads a table, that the second defines. Found once.
calls() {
    [ -s "$called" ] || find_calls >"$called"
    cat "$called"
}
find_calls() {
    awk '
        function folder(file,    part) { split(file, part, "/"); return part[2] "/" part[3] }
        FNR == 1 { pass = FILENAME in seen ? 2 : 1; seen[FILENAME] = 1; comment = 0 }
        {
            line = $0
            if (comment) { if (!match(line, /\*\//)) next; line = substr(line, RSTART + 2); comment = 0 }
            while (match(line, /\/\*/)) {
                rest = substr(line, RSTART + 2)
                line = substr(line, 1, RSTART - 1)
                if (match(rest, /\*\//)) line = line " " substr(rest, RSTART + 2); else { comment = 1; break }
            }
        }
        pass == 1 {
            if (line ~ /^[a-zA-Z].*[ *]noh_[a-z0-9_]+\(/ && line !~ /;[ \t]*$/ && line !~ /^typedef/) {
                match(line, /noh_[a-z0-9_]+\(/)
                name = substr(line, RSTART, RLENGTH - 1)
                if (FILENAME ~ /\.c$/ || line ~ /inline|INLINE/) home[name] = folder(FILENAME)
            } else if (line ~ /^const .*noh_[a-z0-9_]+(\[.*\])? = / && FILENAME ~ /\.c$/) {
                match(line, /noh_[a-z0-9_]+(\[[^=]*\])? = /)
                name = substr(line, RSTART, RLENGTH); sub(/[^a-z0-9_].*/, "", name)
                home[name] = folder(FILENAME)
            }
            next
        }
        FILENAME ~ /\.c$/ {
            from = folder(FILENAME)
            while (match(line, /noh_[a-z0-9_]+/)) {
                name = substr(line, RSTART, RLENGTH)
                line = substr(line, RSTART + RLENGTH)
                if (name in home && home[name] != from) edge[from " " home[name]] = 1
            }
        }
        END { for (e in edge) print e }' runtime/*/*/*.[ch] runtime/*/*/*.[ch] | sort
}

# Reads "FROM TO" lines, prints a flowchart without the arrows that others imply. $1 is the room, or nothing.
chart() {
    awk -v room="${1:-}" -v order="$order" '
        function reaches(a, b,    n, i, next_) {
            if ((a, b) in known) return known[a, b]
            known[a, b] = 0
            n = split(out[a], next_, " ")
            for (i = 1; i <= n; i++) if (next_[i] == b || reaches(next_[i], b)) known[a, b] = 1
            return known[a, b]
        }
        function implied(a, b,    n, i, next_) {
            n = split(out[a], next_, " ")
            for (i = 1; i <= n; i++) if (next_[i] != b && reaches(next_[i], b)) return 1
            return 0
        }
        BEGIN {
            n = split(order, rooms, " ")
            # A room stands for all the rooms in front of it that it may call: the nearest arrow is enough.
            if (room != "") for (i = 2; i <= n; i++) out["the_" rooms[i]] = "the_" rooms[i - 1]
        }
        { if (!(($1, $2) in edge)) { edge[$1, $2] = 1; out[$1] = out[$1] " " $2; from[++count] = $1; to[count] = $2 } }
        END {
            print "```mermaid"
            print "flowchart TD"
            for (i = 1; i <= count; i++) if (!implied(from[i], to[i])) {
                target = to[i]
                if (sub(/^the_/, "", target)) target = to[i] "([" target "/])"
                print "    " from[i] " --> " target
            }
            print "```"
        }'
}

graph() {
    if [ -z "${1:-}" ]; then
        calls | awk '{ split($1, a, "/"); split($2, b, "/"); if (a[1] != b[1]) print a[1], b[1] }' | sort -u | chart
        return
    fi
    calls | awk -v room="$1" '
        function node(path,    part, n) {
            n = split(path, part, "/")
            if (part[1] != room) return "the_" part[1]
            return part[2]
        }
        $1 ~ "^" room "/" { a = node($1); b = node($2); if (a != b) print a, b }' | sort -u | chart "$1"
}

# The README of a room with the picture of today.
with_picture() { # README [ROOM]
    graph ${2:+"$2"} >"$picture"
    awk -v picture="$picture" '
        /^```mermaid/ && !done { while ((getline line <picture) > 0) print line; inside = 1; done = 1; next }
        inside { if (/^```/) inside = 0; next }
        { print }' "$1"
}

picture=$(mktemp) called=$(mktemp)
trap 'rm -f "$picture" "$picture.new" "$called"' EXIT
case ${1:-} in
order) echo "$order" ;;
headers) echo "$headers" | tr -s ' ' '\n' | sed '/^$/d' | paste -d ' ' - - ;;
calls) calls ;;
graph) graph "${2:-}" ;;
check | update)
    bad=0
    for room in '' $order; do
        readme=runtime/${room:+$room/}README.md
        with_picture "$readme" "$room" >"$picture.new"
        if [ "$1" = update ]; then
            cmp -s "$picture.new" "$readme" || cp "$picture.new" "$readme"
        elif ! grep -q '^```mermaid' "$readme" || ! cmp -s "$picture.new" "$readme"; then
            echo "$readme: its picture is not what the code calls; run: sh tools/docs/rooms.sh update"
            bad=1
        fi
    done
    exit $bad
    ;;
*)
    echo "usage: rooms.sh order | headers | calls | graph [ROOM] | check | update" >&2
    exit 2
    ;;
esac
