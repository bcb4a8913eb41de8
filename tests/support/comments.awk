# The code of C files and shaders without its comments, into the file `code`; the comments, each line behind "FILE: ", into
# `text`. Comments do not nest and strings hold no "/*".
FNR == 1 { inside = 0 }
{
    line = $0
    while (line != "") {
        if (inside) {
            at = index(line, "*/")
            print FILENAME ": " (at ? substr(line, 1, at - 1) : line) >text
            line = at ? substr(line, at + 2) : ""
            if (at) inside = 0
        } else {
            at = index(line, "/*")
            print at ? substr(line, 1, at - 1) : line >code
            line = at ? substr(line, at + 2) : ""
            if (at) inside = 1
        }
    }
}
