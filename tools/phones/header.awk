# header.awk: table.txt as a C header, for `noh budget --gpu`: the costs alone, 0 where there is no figure.
/^#/ { next }
$1 == "program" {
    print "/* Made by tools/phones/header.awk. Do not edit. */"
    printf "#define PHONE_COLUMNS %d\n", NF - 2
    print "typedef struct phone_row {\n    const char *program, *stage;\n    double cost[PHONE_COLUMNS];\n} phone_row;"
    printf "static const char *const phone_columns[PHONE_COLUMNS] = {"
    for (i = 3; i <= NF; i++) printf " \"%s\",", $i
    print " };\nstatic const phone_row phone_rows[] = {"
    next
}
{
    printf "    { \"%s\", \"%s\", {", $1, $2
    for (i = 3; i <= NF; i++) printf " %s,", $i + 0
    print " } },"
}
END { print "};" }
