#!/usr/bin/perl
# Lists each comment above a function (definition, declaration, FN of the dialect) that does not begin with a verb in the
# third person: its first word must end in s and be none of the plurals below. Arguments: files. Exits 1 if there are any.
use strict;
use warnings;

my %noun = map { $_ => 1 } qw(
    This Its Thus As Likewise Nothing Less Across Besides Perhaps Always Towards Actions Bands Blanks Brackets Buttons Bytes
    Channels Choices Coefficients Colours Corners Crevices Digits Directions Drivers Edges Entries Events Extremes Facets
    Fibres Files Flakes Ids Images Inputs Integers Items Letters Libraries Lines Lobes Members Middles Neighbours Nodes
    Normals Numbers Options Pairs Parameters Pixels Points Polynomials Positions Powers Ratios Roughnesses Rows
    Seconds Sides Spectra Statements Sums Swatches Tables Texels Textures Threads Types Values Variables Vertices Warnings
    Weights Words);
my $found = 0;
for my $file (@ARGV) {
    open my $stream, '<', $file or die "$file: $!\n";
    my $text = do { local $/; <$stream> };
    close $stream;
    while ($text =~ m{^[ ]*/\*((?:[^*]|\*(?!/))*)\*/[ ]*\n}gm) {
        my ($comment, $line, $next) = ($1, 1 + (substr($text, 0, $-[0]) =~ tr/\n//), substr($text, pos $text, 600));
        next if $comment =~ /^\s*[a-z_0-9.]+ - |^ ---- .* ---- $/;    # the opening comment of a file, and headings
        next unless $next =~ m{^\s*(?:[A-Z_]*FN\b|static|inline|const|void|bool|int|float|double|size_t|char|[A-Z]\w+|u?int\d+_t|unsigned|long)
            \b[^;={}\#]*?\b\w+\s*\([^;{}]*\)\s*(?:[A-Z_]+(?:\([^)]*\))?\s*)?[;\{]}sx;
        my ($word) = $comment =~ /^\s*(\S*?)[,;:.]?(?:\s|$)/;
        next if $word =~ /^[A-Z][a-z]+s$/ && !$noun{$word} || $word =~ /^(Return|Define|Free)$/;    # those of several
        $comment =~ s/\s*\n\s*\*?\s*/ /g;
        print "$file:$line: a comment above a function that begins with no verb:", substr($comment, 0, 80), "\n";
        $found = 1;
    }
}
exit $found;
