#!/bin/sh
# The glossary's rules that a program can check: no retired word in an identifier of the sources or in a symbol of what
# was built, comments and headings that are sentences, no header or type name that stands for two things, and names of
# tests that say what is tested.
# Arguments: source folder, then files with symbols.
set -eu
cd "$1"
shift
bad=0
found() {
    echo "$1"
    bad=1
}

# Words of the list that are ordinary words too may stand in identifiers with their ordinary meaning.
ordinary='^(order|rest|look|tell|settle|house|mend|wear|worn|far away|closed form)$'
retired=$(sed -n '/^## Retired words/,$p' docs/glossary.md | sed -n '/^```text/,/^```$/{/^```/d; s/ *|.*//; p;}' |
    grep -vE "$ordinary" | paste -sd '|')
[ -n "$retired" ] || found "docs/glossary.md: no list of retired words"

sources() { find src include \( -name '*.c' -o -name '*.h' -o -name '*.cpp' \) ! -path '*/tables/*'; }

# The words of identifiers, one identifier a line: painter_start and PainterStart are "painter start".
words() { sed -E 's/([a-z0-9])([A-Z])/\1 \2/g; s/_/ /g' | tr '[:upper:]' '[:lower:]'; }
code() { # without comments and texts
    perl -0777 -pe 's{/\*.*?\*/|//[^\n]*|"(?:[^"\\\n]|\\.)*"}{ }gs' "$@"
}
identifiers() { grep -oE '[A-Za-z_][A-Za-z0-9_]*' | sort -u; }

names=$(mktemp)
trap 'rm -f "$names"' EXIT
sources | xargs cat | code | identifiers >"$names"
for file; do nm "$file" 2>/dev/null | awk '{ print $NF }' | grep -v '^__' | identifiers >>"$names"; done
hits=$(words <"$names" | grep -nwE "($retired)(s|es|ed|ing)?" | cut -d: -f1 || true)
for line in $hits; do found "retired word in the identifier $(sed -n "${line}p" "$names")"; done

# Comments are sentences; the opening comment of a file is a noun.
check() { # message, pattern
    hit=$(sources | xargs grep -nE "$2" | head -5 || true)
    [ -z "$hit" ] || found "$1
$hit"
}
check 'a comment that is no sentence' '^ */\* (What|Whether|Where|How|Of|As|The same)\b'
check 'the opening comment of a file is no noun' '^/\* [a-z0-9_.-]+ - (what|how|where|of|that|from|whether)\b'
check 'a pronoun without its noun' '[;,] +/\* (it|its|that|which|from that)\b'
check 'a function whose name is a participle' \
    '^FN [A-Za-z]+ [a-z_0-9]+_(under|beyond|sound|one|four|drawn|tailed|mixed|lit|weighed|seen|sure|again|by|held|turned)\('
check 'a message that is no plain English' \
    '"[^"]*(can(not)? be (had|meant)|in vain|that there is not|not asked for|gave out|tells all|there is none)[^"]*"'

# A comment above a function begins with a verb.
hit=$(sources | xargs perl tests/verbs.pl || true)
[ -z "$hit" ] || found "$hit"

# A header has a name of its own, but for a lobe or model beside its table of numbers.
twice=$(find src -name '*.h' ! -path '*/tables/*' -exec basename {} \; | sort | uniq -d)
[ -z "$twice" ] || found "two headers of one name: $twice"

# So has a type: a typedef or a record of the dialect, whichever file it is in.
types=$(sources | xargs perl -0777 -ne '
    s{/\*.*?\*/|//[^\n]*|"(?:[^"\\\n]|\\.)*"}{ }gs;
    my %own;
    $own{$1} = 1 while /^(?:typedef (?:struct|enum|union) |STRUCT\()(\w+)/gm;
    print "$_\n" for keys %own;' | sort | uniq -d)
for type in $types; do
    # A handle is declared in one file and defined in another.
    defined=$(sources | xargs grep -lE "^(typedef )?struct $type \{|^typedef (enum|union) $type \{|^STRUCT\($type\)" | wc -l)
    [ "$defined" -le 1 ] || found "two types of one name: $type"
done

# A test says subject, condition and outcome: three words at least, the first of which is no pronoun.
vague=$(grep -rhoE '^static void [a-z_0-9]+\(void \*\*' tests --include='test_*.c' | sed 's/static void //; s/(.*//' |
    grep -E '^(it|its|that|they|what|whatever|whoever|which|nothing|nonsense|everything|test)_|^[a-z0-9]+(_[a-z0-9]+)?$' || true)
for test in $vague; do found "a test whose name has no subject or no outcome: $test"; done
exit $bad
