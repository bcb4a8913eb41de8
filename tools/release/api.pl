# api.pl < PREPROCESSED: the API in C declarations, a line each, sorted: functions, variables, types, members of structs,
# enumerators with their values, and macros (from lines "#define"). Comments and layout do not count; names of parameters
# do not either.
use strict;
use warnings;

local $/;
my $text = <STDIN>;
my @lines;
while ($text =~ /^#define\s+(NOH_\w+(?:\([^)]*\))?)\s*(.*)$/mg) {
    my ($name, $value) = ($1, $2);
    next if $name =~ /_H$/;
    $value =~ s/\s*##\s*/##/g; # compilers differ here, and in the blanks of parameters
    $value =~ s/\s+/ /g;
    $name =~ s/\s+//g;
    push @lines, "macro $name $value";
}
$text =~ s/^#.*$//mg;
$text =~ s/extern\s+"C"\s*\{//g;
$text =~ s/\s+/ /g;

# Split into declarations: at ';' or at the end of a function's body, outside braces.
my ($depth, $start, @declarations) = (0, 0);
for (my $i = 0; $i < length $text; $i++) {
    my $c = substr $text, $i, 1;
    $depth++ if $c eq '{';
    $depth-- if $c eq '}';
    my $body = $c eq '}' && $depth == 0 && substr($text, $start, $i - $start) =~ /^\s*(static|inline)\b/;
    next unless $depth == 0 && ($c eq ';' || $body);
    push @declarations, substr $text, $start, $i - $start;
    $start = $i + 1;
}

# A type with its parameters' names removed, where the last word is a name.
sub unnamed {
    my ($parameter) = @_;
    $parameter =~ s/^\s+|\s+$//g;
    return $parameter if $parameter =~ /\(\*/;
    $parameter =~ s/(?<=[\s*])\w+((?:\[[^\]]*\])*)$/$1/ if $parameter =~ /\w[\s*]+\w+(\[[^\]]*\])*$/ && $parameter !~ /^(?:unsigned|const|struct) \w+$/;
    $parameter =~ s/\s+$//;
    return $parameter;
}

sub members {
    my ($of, $list) = @_;
    my $depth = 0;
    my $part = '';
    for my $c (split //, $list) {
        $depth++ if $c =~ /[{(]/;
        $depth-- if $c =~ /[})]/;
        if ($c eq ';' && $depth == 0) {
            $part =~ s/^\s+|\s+$//g;
            push @lines, "member $of: $part" if length $part;
            $part = '';
        } else {
            $part .= $c;
        }
    }
}

for (@declarations) {
    s/^\s+|\s+$//g;
    if (/^(?:typedef )?enum(?: \w+)? ?\{(.*)\} ?(\w*)$/) {
        my ($list, $of, $value) = ($1, $2 || 'enum', -1);
        for my $item (split /,(?![^(]*\))/, $list) {
            my ($name, $given) = $item =~ /^\s*(\w+)\s*(?:=\s*(.*?))?\s*$/ or next;
            $value = defined $given ? $given : $value =~ /^-?\d+$/ ? $value + 1 : "after $value";
            push @lines, "enumerator $of: $name = $value";
        }
    } elsif (/^typedef (?:struct|union) \w* ?\{(.*)\} (\w+)$/) {
        my ($list, $of) = ($1, $2);
        push @lines, "type $of";
        members($of, $list);
    } elsif (/^(?:struct|union) (\w+) ?\{(.*)\}$/) {
        my ($of, $list) = ($1, $2);
        push @lines, "type $of";
        members($of, $list);
    } elsif (/^typedef (.*)$/) {
        push @lines, "type $1";
    } elsif (/^(.*?)\b(noh_\w+) ?\((.*)\)/ && !/^typedef/) {
        my ($returns, $name, $parameters) = ($1, $2, $3);
        $returns =~ s/\b(static|inline|extern) //g;
        $parameters =~ s/\).*// if /\{/;
        push @lines, "function $returns$name(" . join(', ', map { unnamed($_) } split /,(?![^()]*\))/, $parameters) . ')';
    } elsif (/^extern (.*)$/) {
        push @lines, "variable $1";
    }
}
# Counts grow when something is added, and the version has its own rules.
@lines = grep { !/ NOH_\w+_COUNT\b| NOH_VERSION/ } @lines;
my %seen;
print map { s/\s+/ /gr . "\n" } sort grep { !$seen{$_}++ } @lines;
