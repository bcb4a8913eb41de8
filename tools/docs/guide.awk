# guide.awk: a page of the guide as Doxygen reads it. The page gets the name guide_NAME; links between pages become
# references, links to files of the repository become their text, and names of the library in backticks become links to
# their documentation, so that a name that does not exist is a warning.
BEGIN { fence = 0 }
FNR == 1 {
    page = FILENAME
    sub(/.*\//, "", page)
    sub(/\.md$/, "", page)
    inside = page ~ /^(find_your_way|add_)/ # pages about the code name private functions
    print $0 " {#guide_" page "}"
    next
}
/^```/ { fence = !fence; sub(/^```glsl/, "```c"); print; next }
fence { print; next }
/^## / { $0 = $0 " {#guide_" page "_" ++sections[page] "}" } # search.awk counts likewise
{
    out = ""
    while (match($0, /!?\[[^]]*\]\([^)]*\)|`[^`]*`/)) {
        out = out substr($0, 1, RSTART - 1)
        token = substr($0, RSTART, RLENGTH)
        $0 = substr($0, RSTART + RLENGTH)
        out = out (token ~ /^`/ ? code(token) : link(token))
    }
    print out $0
}
function link(token,   text, target) {
    text = target = token
    sub(/^!?\[/, "", text)
    sub(/\]\(.*/, "", text)
    sub(/.*\]\(/, "", target)
    sub(/\)$/, "", target)
    if (token ~ /^!/) { # Doxygen looks images up by their names
        sub(/.*\//, "", target)
        return "![" text "](" target ")"
    }
    if (target ~ /^[a-z_]+\.md$/) {
        sub(/\.md$/, "", target)
        return "@ref guide_" target " \"" text "\""
    }
    return target ~ /^https?:/ ? token : text
}
function code(token,   name) {
    name = substr(token, 2, length(token) - 2)
    if (!inside && name ~ /^(noh_[a-z0-9_]+|NOH_[A-Z0-9_]+)$/) return "@ref " name " \"" name "\""
    if (!inside && name ~ /^noh_[a-z0-9_]+\.[a-z0-9_]+$/ && name !~ /\.h$/) {
        sub(/\./, "::", name)
        return "@ref " name " \"" substr(token, 2, length(token) - 2) "\""
    }
    return token
}
