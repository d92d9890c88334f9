#!/bin/sh
# Each loop over arrays (LOOP in src/shading/dialect/loop.h) is one of vectors: its machine code, as built for AVX2, has a
# loop of packed arithmetic without any of single numbers. Arguments: a compiled file with a LOOP, or a plugin, and the
# least number of its loops. Exit 77: skipped.
set -eu
command -v objdump >/dev/null || {
    echo "skipped: there is no objdump"
    exit 77
}
# charlie-neubelt-normalised picks taps and texels of a table, as ltc-fibre, its kin and fibre-table do
# where each element has a row of its own; F = none (mixed_0) has nothing to work out.
exceptions="charlie_neubelt_normalised_f_n charlie_neubelt_normalised_each_n ltc_fibre_each_n ltc_fibre_drawn_each_n \
ltc_fibre_published_each_n ltc_fibre_published_drawn_each_n ltc_fibre_half_each_n fibre_table_each_n mixed_0_n"
# woven has three where all pairs have one lobe: with few rounds, with some, and with all (BY_COUNT in
# src/shading/lobe/lobe_loop.h).
objdump -d --no-show-raw-insn "$1" | awk -v exceptions="$exceptions" -v least="$2" '
function judge(k, j, packed, single, best, good) {
    if (name == "" || (count <= 2 && op[1] ~ /^jmp/)) return # another with the same code
    best = 0
    for (k = 1; k <= count; k++) {
        if (op[k] !~ /^j/ || !(to[k] in at) || at[to[k]] > k) continue
        packed = single = 0
        for (j = at[to[k]]; j <= k; j++) {
            if (op[j] ~ /^v(add|sub|mul|div|sqrt|max|min|fn?m(add|sub)[0-9]*)ps$/ && line[j] ~ /%[yz]mm/) packed++
            if (op[j] ~ /^v(add|sub|mul|div|sqrt|max|min|fn?m(add|sub)[0-9]*)ss$/) single++
        }
        if (packed <= 2 || single) continue
        good++
        if (packed > best) best = packed
    }
    loops++
    if (name == "woven_shares_n" && good < 3) { print name " has " good + 0 " loops of vectors, not 3"; wrong = 1 }
    excepted = index(" " exceptions " ", " " name " ")
    if (!best && !excepted) { print name " is not vectorised"; wrong = 1 }
    if (best && excepted) { print name " is vectorised: no exception"; wrong = 1 }
}
/^[0-9a-f]+ <.*>:$/ {
    judge()
    name = ""
    count = 0
    split("", at)
    if ($2 ~ /_n_avx2(\.[a-z]+\.[0-9]+)*>:$/) { name = $2; sub(/^</, "", name); sub(/_avx2.*/, "", name) }
}
name != "" && $1 ~ /:$/ {
    address = $1
    sub(/:/, "", address)
    at[address] = ++count
    op[count] = $2
    to[count] = $3
    line[count] = $0
}
END {
    judge()
    print loops " loops"
    exit wrong || loops < least
}'
