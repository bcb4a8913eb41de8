# filter.awk: a header of the library as Doxygen reads it. The headers have plain comments with our own headings; this
# turns a comment in column 1 into a documentation comment, one behind a member into the member's, "shapes", "units" and
# the like into titled paragraphs, and lines that are indented (tables, examples) into verbatim blocks.
# What stands in backticks is code, and needs no escapes.
function escape(text,   at, out) {
    while (match(text, /`[^`]*`/)) {
        at = RSTART + RLENGTH
        out = out escape_words(substr(text, 1, RSTART - 1)) substr(text, RSTART, RLENGTH)
        text = substr(text, at)
    }
    return out escape_words(text)
}
function escape_words(text) {
    gsub(/\\/, "\\\\", text)
    gsub(/[@#<>%$&*~]/, "\\\\&", text)
    gsub(/ \.\.\./, " \\&hellip;", text) # a dot before a blank ends the brief text, or a list
    gsub(/ \.\. /, " to ", text)
    gsub(/\.\. /, " or more ", text)
    gsub(/\.\.,/, " or more,", text)
    gsub(/\.\.;/, " or more;", text)
    sub(/\.\.$/, " or more", text)
    gsub(/ \./, " \\.", text)
    return text
}
function close_block() {
    if (in_block) print " * @endverbatim"
    in_block = 0
}
# A line of a comment without its " * ".
function comment(text,   word) {
    if (text ~ /^   /) {
        if (!in_block) print " * @verbatim"
        in_block = 1
        print " * " text
        return
    }
    close_block()
    sub(/^ /, "", text)
    if (text ~ /^(shapes|units|ranges|memory|errors|source|cost|threads|returns|order|example|note)  /) {
        word = text
        sub(/ .*/, "", word)
        sub(/^[a-z]+ +/, "", text)
        print " * @par " word
        under_title = 1
    } else if (under_title) {
        sub(/^ +/, "", text)
    }
    print " * " escape(text)
}
BEGIN { first = 1 }
# A heading of the header, with or without a text of its own, which belongs to the file.
!inside && /^\/\* (=+|--+) .* (=+|--+) \*\/$/ { next }
!inside && /^\/\* =+ .* =+$/ {
    gsub(/^\/\* =+ | =+$/, "")
    print "/** @file"
    print " * @par " $0
    first = under_title = in_block = 0
    inside = 1
    next
}
!inside && /^\/\*/ {
    print first ? "/** @file" : "/**"
    first = under_title = in_block = 0
    inside = 1
    sub(/^\/\*/, "")
    if (/\*\/ *$/) {
        sub(/ *\*\/ *$/, "")
        inside = 0
    }
    comment($0)
    if (!inside) { close_block(); print " */" }
    next
}
inside {
    ends = /\*\/ *$/
    sub(/ *\*\/ *$/, "")
    sub(/^ \*/, "")
    if (ends && $0 == "") { close_block(); print " */"; inside = 0; next }
    comment($0)
    if (ends) { close_block(); print " */"; inside = 0 }
    next
}
# Behind a member, an enumerator or a define: /**< text */; a comment on lines of its own is left alone.
/[;,a-zA-Z0-9_)"}] *\/\* .*\*\/ *$/ && !/^ *\/\*/ {
    at = index($0, "/*")
    text = substr($0, at + 2)
    sub(/ *\*\/ *$/, "", text)
    print substr($0, 1, at - 1) "/**<" escape(text) " */"
    next
}
/[;,] *\/\* [^*]*$/ && !/\*\// {
    at = index($0, "/*")
    print substr($0, 1, at - 1) "/**<" escape(substr($0, at + 2))
    behind = 1
    next
}
behind {
    line = $0
    ends = line ~ /\*\/ *$/
    sub(/ *\*\/ *$/, "", line)
    print escape(line) (ends ? " */" : "")
    if (ends) behind = 0
    next
}
{ print }
