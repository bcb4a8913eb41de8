# techniques.awk: the rows of the tables of techniques in tests/README.md, one a line, by tabs:
# code, test, mutant, command, what the row is.
BEGIN { FS = " *[|] *" }
NF == 8 && $2 != "source" && $2 !~ /^-+$/ {
    gsub("`", "")
    for (i = 4; i <= 7; i++) if ($i == "") $i = "?"
    print $4 "\t" $5 "\t" $6 "\t" $7 "\t" $2 ": " $3
}
