#!/usr/bin/perl
# prose.pl FILES...: finds phrases in comments, strings and documents; prose.sh calls it. Rules on stdin, one a line:
# PHRASE -> REMEDY, where PHRASE is a Perl expression, matched without case from the start of a word, also across lines.
use strict;
use warnings;
use File::Find;

my @rules = map { chomp; my ($phrase, $remedy) = split /\s*->\s*/; $phrase =~ s/ /\\s+/g; [qr/\b(?:$phrase)/i, $remedy] }
    grep { /->/ } <STDIN>;
my (@files, $failed);
find({ no_chdir => 1, wanted => sub { push @files, $_ if -f && /\.([ch]|cpp|js|glsl|vert|frag|sh|mk|md|txt)$/ } }, @ARGV);

# The text with all else blanked out, at the same places. Strings with nothing but space between them are one text;
# \x01 stands between texts.
sub prose {
    my ($all) = @_;
    my $out = $all;
    $out =~ s/[^\n]/\x01/g;
    my $end = 0;
    while ($all =~ m{(/\*.*?\*/|//[^\n]*)|"((?:[^"\\\n]|\\.)*)"|'(?:[^'\\\n]|\\.)+'}gs) {
        my ($text, $at) = ($&, $-[0]);
        if (defined $1) {
            $text =~ s{^/[/*]}{  };
            $text =~ s{\*/$}{. };
            $text =~ s{\n( *)\*}{\n$1 }g;
        } elsif (defined $2) {
            $text =~ s/^"|"$/ /g;
            $text =~ s/\\[nt]/  /g;
            my $gap = substr $all, $end, $at - $end;
            substr($out, $end, $at - $end) = $gap if $gap =~ /^\s*$/ && $end;
        } else {
            next;
        }
        substr($out, $at, length $text) = $text;
        $end = $at + length $text;
    }
    return $out;
}

for my $file (sort @files) {
    open my $in, '<', $file or die "$file: $!";
    my $text = do { local $/; <$in> };
    $text = prose($text) if $file =~ /\.([ch]|cpp|js|glsl|vert|frag)$/;
    $text =~ s/\n *#/\n  /g if $file =~ /\.sh$/;
    my $bad = 0;
    for my $rule (@rules) {
        while ($text =~ /$rule->[0]/g) {
            my ($found, $line) = ($&, 1 + (substr($text, 0, $-[0]) =~ tr/\n//));
            $found =~ s/\s+/ /g;
            print "$file:$line: $found -> $rule->[1]\n";
            $bad = 1;
        }
    }
    $failed += $bad;
}
$failed = $failed || 0;
printf "%d passed, %d failed, 0 skipped\n", @files - $failed, $failed;
exit($failed ? 1 : 0);
