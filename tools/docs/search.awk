# search.awk: makes the site's search find words. Doxygen 1.9 finds names by how they begin, and all of ours begin with
# noh_. This adds an entry for each further word of a name, for each word of a page's title, and for each word of the
# headings of the guide.
#
#   awk -f search.awk HTML/search/searchdata.js HTML/search/all_*.js PAGE.md...
function add(words, payload, to,   n, i, word, part, name) {
    gsub(/&[a-z]+;/, " ", words)
    n = split(tolower(words), part, /[^a-z0-9]+/)
    for (i = 1; i <= n; i++) {
        word = part[i]
        if (length(word) < 2 || word == "noh" || word ~ /^(and|of|the|to|in|or|is|it|on|by|an|you|your|when)$/) continue
        if (!(substr(word, 1, 1) in file)) continue
        name = file[substr(word, 1, 1)]
        to[name] = to[name] "  ['" word "_w" ++count "'," payload "],\n"
    }
}
FILENAME ~ /searchdata\.js$/ {
    if (/^ *0: "[^"]*"/ && !letters) {
        letters = $0
        gsub(/^[^"]*"|"[^"]*$/, "", letters)
        folder = FILENAME
        sub(/searchdata\.js$/, "", folder)
        for (i = 1; i <= length(letters); i++) file[substr(letters, i, 1)] = folder "all_" sprintf("%x", i - 1) ".js"
    }
    next
}
FILENAME ~ /\.js$/ {
    if (/^\];/) next
    text[FILENAME] = text[FILENAME] (/^  \[/ && !/,$/ ? $0 "," : $0) "\n"
    if (match($0, /',\['[^']*'/)) {
        title = substr($0, RSTART + 4, RLENGTH - 5)
        payload = substr($0, RSTART + 2)
        sub(/\],?$/, "", payload)
        first = title
        sub(/^(noh|NOH)_|^[A-Za-z0-9]+/, "", first) # found already, but for noh_
        if (title ~ /^(noh|NOH)_/ || title ~ / /) add(first, payload, names)
    }
    next
}
FNR == 1 {
    page = FILENAME
    sub(/.*\//, "", page)
    sub(/\.md$/, "", page)
    title = substr($0, 3)
    number = fence = 0
}
/^```/ { fence = !fence }
!fence && /^## / {
    heading = substr($0, 4)
    gsub(/['"`<>&]/, "", heading)
    add(heading, "['" heading "',['../guide_" page ".html#guide_" page "_" ++number "',1,'" title "']]", headings)
}
END {
    for (name in text) {
        at = index(text[name], "[\n") + 2 # headings come first
        body = substr(text[name], 1, at - 1) headings[name] substr(text[name], at) names[name]
        sub(/,\n$/, "\n", body)
        printf "%s];\n", body >name
    }
}
