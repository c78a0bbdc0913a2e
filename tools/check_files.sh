#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Rules that every file keeps: a licence line, a bounded size, LF line ends, nothing that only makes
# sense on one machine; and a source includes its own header first, so that this compiles alone.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

max_size=204800
violations=$(
    # The licence is the first line, or the second after a script's interpreter.
    tools/list_sources.sh '*.cpp' '*.hpp' '*.sh' '*.cmake' CMakeLists.txt dev run |
        while IFS= read -rd '' file; do
            { read -r first && read -r second; } <"$file" || true
            [[ $first != '#!'* ]] || first=$second
            [[ $first =~ ^(//|#)\ SPDX-License-Identifier:\ MIT$ ]] ||
                printf '%s:1: no SPDX-License-Identifier line\n' "$file"
        done
    tools/list_sources.sh '*.cpp' | while IFS= read -rd '' file; do
        header=${file%.cpp}.hpp
        [[ -f $header ]] || continue
        first=$(grep -m1 -oP '^ *# *include +["<]\K[^">]+' "$file" || true)
        [[ $header == */"$first" ]] || printf '%s: does not include its own header first\n' "$file"
    done
    tools/list_sources.sh '*' | xargs -0 stat -c '%s %n' | while read -r size file; do
        ((size <= max_size)) || printf '%s: %d bytes, more than %d\n' "$file" "$size" "$max_size"
    done
    # Golden files are compared byte by byte and may hold anything.
    tools/list_sources.sh '*' | { grep -zv '^\./tests/golden/' || true; } |
        xargs -0 grep -InP '\r$' | sed 's/$/  <- CR line end/' || true
    tools/list_sources.sh '*' |
        xargs -0 grep -InE '(^|[^[:alnum:]_.~*])/(home|work|root|Users)[/]|(deb|security)[.]debian[.]org|registry[.]npmjs|pypi[.]org' |
        sed 's/$/  <- path of one machine, or registry host/' || true
)
[[ -z $violations ]] || {
    printf '%s\n' "$violations"
    exit 1
}
