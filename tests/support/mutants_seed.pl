#!/usr/bin/perl
# mutants_seed.pl: what tests/mutants_seed.sh needs to know of C.
#
#   plan MAP SEED COUNT FILES...  the first COUNT mutants that SEED draws, one a line, fields between tabs: a key of the
#                      mutant in this text of its file, operator, file, line, offset, length, new text, what changes,
#                      programs that run the line, those first that take least time for the lines that they run
#   plant PLAN NUMBER FOLDER      puts one of them into the tree in FOLDER
#   lines DATA OBJECTS  prints "FILE LINES - LINES" for each file of runtime/ that ran: the lines that ran, then the lines
#                      that did not. Reads the .gcda files below DATA and the .gcno files below OBJECTS
#   uncovered MAP MOST FILES...   prints the share of lines that programs run, and the MOST largest functions that none
#                      runs
#
# MAP is a folder of NAME.lines, as `lines` prints them, after a line "NAME SECONDS". Operators: arithmetic, compare,
# constant (an integer or an index, one more or one less), order (two calls swapped, or one removed). Mutants are inside
# functions; comments, strings, the preprocessor's lines and asserts are left alone.
use strict;
use warnings;
use Digest::MD5 'md5_hex';
use File::Find;

sub text_of {
    my ($file) = @_;
    local $/;
    open my $in, '<', $file or die "$file: $!\n";
    return scalar <$in>;
}

# The text with what is no code blanked out, at the same places.
sub code_of {
    my $code = text_of($_[0]);
    my $blank = sub { my $text = shift; $text =~ s/[^\n]/ /g; $text };
    $code =~ s{(/\*.*?\*/|//[^\n]*|"(?:[^"\\\n]|\\.)*"|'(?:[^'\\\n]|\\.)+')}{$blank->($1)}gse;
    $code =~ s{^([ \t]*#(?:[^\n]*\\\n)*[^\n]*)}{$blank->($1)}gme;
    $code =~ s{\b(NOH_(?:ASSERT|VALIDATE|STATIC_ASSERT)\w*\s*(\((?:[^()]++|(?2))*\)))}{$blank->($1)}ge;
    return $code;
}

# [name, begin, end] of each function's body.
sub functions_of {
    my ($code) = @_;
    my ($depth, $head, $open, @out) = (0, 0);
    while ($code =~ /([{};])/g) {
        my $at = $-[0];
        if ($1 eq '{') {
            my $before = substr $code, $head, $at - $head;
            $open = $before =~ /(\w+)\s*(\((?:[^()]++|(?2))*\))\s*$/ ? [$1, $at] : undef if !$depth;
            $depth++;
        } elsif ($1 eq '}') {
            $depth--;
            push @out, [@$open, $at] if !$depth && $open;
        }
        $head = $at + 1 if !$depth;
    }
    return @out;
}

my %other = ('+' => '-', '-' => '+', '*' => '/', '/' => '*', '+=' => '-=', '-=' => '+=', '*=' => '/=', '/=' => '*=',
    '<' => '<=', '<=' => '<', '>' => '>=', '>=' => '>', '==' => '!=', '!=' => '==', '&&' => '||', '||' => '&&');

# [operator, offset, length, new text] of each mutant of a body.
sub sites_of {
    my ($code, $begin, $end) = @_;
    my $body = substr $code, $begin, $end - $begin;
    my @out;
    # Layout tells what is binary: a space before and after.
    while ($body =~ m{(?<=\S )([-+*/]=?|[<>]=?|==|!=|&&|\|\|)(?=[ \n])}g) {
        push @out, [index('+-*/', substr $1, 0, 1) < 0 ? 'compare' : 'arithmetic', $-[1], length $1, $other{$1}];
    }
    while ($body =~ /(?<![\w.])(\d+)([uU]?)(?![\w.])/g) {
        my ($at, $long, $number, $suffix) = ($-[0], length $&, $1, $2);
        my ($line) = substr($body, 0, $at) =~ /([^\n]*)$/;
        next if $line =~ /^\s*(?:static |const |struct )*(?!return\b|else\b|case\b)\w+ \**\w+\[[^=]*$/; # a size
        push @out, ['constant', $at, $long, ($number + $_) . $suffix] for $number ? (1, -1) : 1;
    }
    while ($body =~ /(?<=\w)\[([^\[\]\n]*[A-Za-z_][^\[\]\n]*)\]/g) {
        my ($at, $long, $index) = ($-[1], length $1, $1);
        my ($line) = substr($body, 0, $at) =~ /([^\n]*)$/;
        next if $line =~ /^\s*(?:static |const |struct )*(?!return\b|else\b|case\b)\w+ \**\w+\[[^=]*$/;
        push @out, ['constant', $at, $long, "($index) $_ 1"] for '+', '-';
    }
    my $last;
    my $word = qr/(?!(?:return|if|for|while|switch|do|else|case|sizeof|NOH_\w+)\b)[A-Za-z_]/;
    while ($body =~ /(?<=[;{}\n])( *)($word[\w.>-]*(\((?:[^(){};]++|(?3))*\));)/g) {
        my ($at, $call, $pad, $next) = ($-[2], $2, $1, pos $body);
        next if substr($body, 0, $at) !~ /[;{})]\s*$/;
        (my $gone = $call) =~ s/[^\n]/ /g;
        push @out, ['order', $at, length $call, substr($gone, 0, -1) . ';'];
        if ($last && $last->[1] eq $pad && $last->[2] ne $call) {
            my $between = substr $body, $last->[3], $at - $last->[3];
            my $long = $at + length($call) - $last->[0];
            push @out, ['order', $last->[0], $long, $call . $between . $last->[2]] if $between =~ /^\s*$/;
        }
        $last = [$at, $pad, $call, $at + length $call];
    }
    $_->[1] += $begin for @out;
    return @out;
}

sub line_at { my ($code, $at) = @_; return 1 + (substr($code, 0, $at) =~ tr/\n//); }
sub short { my $s = join ' ', split ' ', $_[0]; return length $s > 70 ? substr($s, 0, 67) . '...' : $s; }

# {FILE}{LINE} of all lines with code: the programs that run them; then {PROGRAM} its seconds, {PROGRAM} its lines.
sub map_of {
    my ($folder) = @_;
    my (%map, @programs);
    find({ no_chdir => 1, wanted => sub { push @programs, $_ if /\.lines$/ } }, $folder);
    my (%seconds, %runs);
    for my $path (@programs) {
        my ($head, @rows) = split /\n/, text_of($path);
        my ($name, $seconds) = split ' ', $head;
        next if $seconds eq 'fails';
        $seconds{$name} = $seconds;
        for (@rows) {
            my ($file, @lines) = split ' ';
            my $lines = $map{$file} ||= {};
            my $runs = 1;
            for my $line (@lines) {
                if ($line eq '-') {
                    $runs = 0;
                } else {
                    my $by = $lines->{$line} ||= [];
                    push(@$by, $name), $runs{$name}++ if $runs;
                }
            }
        }
    }
    return (\%map, \%seconds, \%runs);
}

# The programs of a line; of a line without code of its own, as in a long expression, of its neighbours.
sub programs_at {
    my ($map, $file, $line) = @_;
    my $lines = $map->{$file} or return [];
    return $lines->{$line} if $lines->{$line};
    my %all;
    for my $way (-1, 1) {
        for (my $at = $line + $way; abs($at - $line) < 8; $at += $way) {
            next if !$lines->{$at};
            $all{$_} = 1 for @{$lines->{$at}};
            last;
        }
    }
    return [keys %all];
}

# {OPERATOR}: [rank, file, offset, length, new text] of each mutant, in an order that the seed draws. The rank is of the
# text that the mutant changes, so that it stays where other lines are edited.
sub drawn {
    my ($seed, @files) = @_;
    my (%sites, %seen);
    for my $file (sort @files) {
        my ($code, $text) = (code_of($file), text_of($file));
        my @texts = map { join ' ', split ' ' } split /\n/, $text;
        for my $function (functions_of($code)) {
            my ($name, @range) = @$function;
            for my $site (sites_of($code, @range)) {
                my ($operator, $at, $long, $new) = @$site;
                my $what = join "\t", $file, $name, $texts[line_at($code, $at) - 1], substr($text, $at, $long), $new;
                push @{$sites{$operator}}, [md5_hex(join "\t", $seed, $what, $seen{$what}++), $file, $at, $long, $new];
            }
        }
    }
    $_ = [sort { $a->[0] cmp $b->[0] } @$_] for values %sites;
    return \%sites;
}

sub plan {
    my ($folder, $seed, $count, @files) = @_;
    my ($map, $seconds, $runs) = map_of($folder);
    my $sites = drawn($seed, @files);
    my @operators = sort keys %$sites;
    # A program that runs few lines and takes little time comes first: it starts in a twentieth of a second.
    my %cost = map { $_ => ($seconds->{$_} + 0.05) * ($runs->{$_} || 1) } keys %$seconds;
    for (my $i = 0, my $told = 0; $told < $count && grep { @$_ } values %$sites; $i++) {
        my $operator = $operators[$i % @operators];
        my $site = shift @{$sites->{$operator}} or next;
        my ($rank, $file, $at, $long, $new) = @$site;
        my ($code, $text) = (code_of($file), text_of($file));
        my $line = line_at($code, $at);
        my $old = substr $text, $at, $long;
        my $change = $operator eq 'order' ? ($new =~ /^[\s;]*$/ ? "without $old" : "swapped $old")
            : short((split /\n/, $text)[$line - 1]) . ": $old -> $new";
        my @programs = sort { $cost{$a} <=> $cost{$b} || $a cmp $b } @{programs_at($map, $file, $line)};
        my $key = md5_hex("$rank\t$text");
        $new =~ s/\n/\\n/g;
        print join("\t", $key, $operator, $file, $line, $at, $long, $new, join(' ', split ' ', $change),
            join(' ', map { "$_:$seconds->{$_}" } @programs) || '-'), "\n";
        $told++;
    }
}

sub plant {
    my ($plan, $number, $folder) = @_;
    my (undef, undef, $file, undef, $at, $long, $new) = split /\t/, (split /\n/, text_of($plan))[$number - 1];
    my $text = text_of($file);
    $new =~ s/\\n/\n/g;
    substr($text, $at, $long) = $new;
    open my $out, '>', "$folder/$file" or die "$folder/$file: $!\n";
    print $out $text;
    close $out or die "$folder/$file: $!\n";
}

sub lines {
    my ($folder, $objects) = @_;
    my (@notes, $source, %count);
    find({ no_chdir => 1, wanted => sub {
        return if !/^\Q$folder$objects\E(.*)\.gcda$/;
        symlink "$objects$1.gcno", "$folder$objects$1.gcno";
        push @notes, "$folder$objects$1.gcno";
    } }, $folder);
    open my $in, '-|', 'gcov', '-t', sort @notes or die "gcov: $!\n";
    while (<$in>) {
        if (/^ *-: *0:Source:(.*)/) {
            $source = $1;
        } elsif ($source =~ /^runtime\// && /^ *(\d+|[#=]+)\*?: *([1-9]\d*):/) {
            my ($runs, $line) = ($1, $2);
            $count{$source}{$line} ||= $runs =~ /[1-9]/ ? 1 : 0;
        }
    }
    for my $file (sort keys %count) {
        my ($of, %by) = $count{$file};
        push @{$by{$of->{$_}}}, $_ for sort { $a <=> $b } keys %$of;
        print join(' ', $file, @{$by{1}}, '-', @{$by{0} || []}), "\n" if $by{1};
    }
}

sub uncovered {
    my ($folder, $most, @files) = @_;
    my ($map) = map_of($folder);
    my ($run, $all, @left) = (0, 0);
    for my $file (sort @files) {
        my $code = code_of($file);
        for my $function (functions_of($code)) {
            my ($begin, $end) = map { line_at($code, $_) } @$function[1, 2];
            # Of a file that no program runs, each line counts.
            my @lines = grep { !$map->{$file} || $map->{$file}{$_} } $begin .. $end;
            my @not = grep { !$map->{$file} || !@{$map->{$file}{$_}} } @lines;
            $all += @lines;
            $run += @lines - @not;
            push @left, [scalar @not, scalar @lines, "$file:$begin", $function->[0], $not[0]] if @not;
        }
    }
    @left = sort { $b->[0] <=> $a->[0] || $a->[2] cmp $b->[2] } @left;
    printf "%d of %d lines of runtime/ run in a test (%.1f %%)\n", $run, $all, $all ? 100 * $run / $all : 0;
    splice @left, $most if @left > $most;
    printf "  %3d of %3d lines not run: %s %s, first line %d\n", @$_ for @left;
}

my $verb = shift // '';
my %verbs = (plan => \&plan, plant => \&plant, lines => \&lines, uncovered => \&uncovered);
$verbs{$verb} or die "mutants_seed.pl: plan, plant, lines or uncovered\n";
$verbs{$verb}->(@ARGV);
