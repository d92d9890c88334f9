#!/bin/sh
# Names in the comments of src and include exist: of files, by their last part, since folders change; and of functions,
# written as name() or weft_name. Examples stand in quotes, "toy.h"; NAME.h and NAME.gen.h stand for several files.
# Argument: source folder.
set -eu
cd "$1"

# Headers of the C library, and files of other programs that comments cite as sources.
others='^(math|stdbool|bsdf_(microfacet|sheen|ashikhmin_velvet))\.h$|^(CubemapIBL\.cpp|sinf\.c)$'

find . \( -name build -o -name out -o -name .git \) -prune -o -type f -print | sed 's,.*/,,' |
    OTHERS=$others perl -e '
    my %files = map { chomp; ($_ => 1) } <STDIN>;
    my (%names, @found);
    my $token = qr{(?<comment>/\*.*?\*/|//[^\n]*)|"(?:[^"\\\n]|\\.)*"}s;
    my @sources = sort split /\n/, `find src include tests -name "*.[ch]" -o -name "*.cpp" -o -name "*.glsl"`;
    my %text;
    for my $file (@sources) {
        open my $in, "<", $file or die "$file: $!\n";
        local $/;
        $text{$file} = <$in>;
        (my $code = $text{$file}) =~ s{/\*.*?\*/|//[^\n]*}{ }gs;
        $names{$1} = 1 while $code =~ /(\w+)/g;
    }
    my $named = qr{"[^"\n]*"|<[\w./]+>|([\w.-]+\.(?:c|h|cpp|md))\b(?![\w(])|\b(\w+)\(\)|\b(weft_\w*[a-z0-9])\b};
    for my $file (grep { m{^(src|include)/} } @sources) {
        while ($text{$file} =~ /$token/g) {
            my ($comment, $start) = ($+{comment}, $-[0]);
            next unless defined $comment;
            while ($comment =~ /$named/g) {
                my ($name, $function, $line) = ($1, $2 // $3, substr($text{$file}, 0, $start + $-[0]) =~ tr/\n// + 1);
                push @found, "$file:$line: no file is called $name"
                    if $name && !$files{$name} && $name !~ /[A-Z]{4}|\.gen\.h$/ && $name !~ /$ENV{OTHERS}/;
                push @found, "$file:$line: no function is called $function"
                    if $function && !$names{$function} && !$names{$function =~ s/^weft_(?=\w+_)//r};
            }
        }
    }
    print "$_\n" for @found;
    exit(@found > 0);
'
